//! An image cut into squares of pixels, whose rays are looked at together.

use super::rays::MOST;
use crate::camera::Camera;

/// Pixels of a square's side.
pub(super) const SIDE: usize = 16;
const _: () = assert!(SIDE * SIDE <= MOST);

/// The squares of an image, in rows.
pub(super) struct Tiles {
    size: [usize; 2],
    across: usize,
}

impl Tiles {
    pub(super) fn of(camera: &Camera) -> Self {
        let size = camera.size();
        Self { size, across: size[0].div_ceil(SIDE) }
    }

    pub(super) fn count(&self) -> usize {
        self.across * self.size[1].div_ceil(SIDE)
    }

    /// The tiles of a band of [`SIDE`] rows of pixels.
    pub(super) fn band(&self, band: usize) -> std::ops::Range<usize> {
        band * self.across..(band + 1) * self.across
    }

    /// The rows of a tile: place of the first pixel in the tile, and in the image, and how many there are.
    pub(super) fn rows(&self, tile: usize) -> impl Iterator<Item = (usize, [usize; 2], usize)> {
        let [left, top] = [tile % self.across * SIDE, tile / self.across * SIDE];
        let length = SIDE.min(self.size[0] - left);
        let rows = 0..SIDE.min(self.size[1] - top);
        rows.map(move |row| (row * length, [left, top + row], length))
    }

    /// The pixels of a tile.
    pub(super) fn pixels(&self, tile: usize) -> impl Iterator<Item = [usize; 2]> {
        let rows = self.rows(tile);
        rows.flat_map(|(_, [left, v], length)| (left..left + length).map(move |u| [u, v]))
    }
}
