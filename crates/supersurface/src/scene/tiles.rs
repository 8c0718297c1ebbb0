//! An image cut into tiles of pixels, whose rays are looked at together.

use super::rays::{Along, MOST};
use crate::camera::Camera;
use crate::numeric::random::normals;

/// Columns and rows of a tile.
const COLUMNS: usize = 16;
pub(super) const ROWS: usize = 8;
const _: () = assert!(COLUMNS * ROWS <= MOST);

/// The tiles of an image, in rows.
pub(super) struct Tiles {
    size: [usize; 2],
    across: usize,
}

/// A row of a tile.
pub(super) struct Run {
    /// Of its first pixel in the tile.
    pub(super) place: usize,
    /// Of its first pixel in the image.
    pub(super) pixel: usize,
    /// Number of pixels.
    pub(super) length: usize,
}

/// Where the rays of a tile pass the image.
pub(super) struct Places {
    count: usize,
    across: [f64; MOST],
    down: [f64; MOST],
}

impl Tiles {
    pub(super) fn of(camera: &Camera) -> Self {
        let size = camera.size();
        Self { size, across: size[0].div_ceil(COLUMNS) }
    }

    pub(super) fn count(&self) -> usize {
        self.across * self.size[1].div_ceil(ROWS)
    }

    /// The tiles of a band of [`ROWS`] rows of pixels.
    pub(super) fn band(&self, band: usize) -> std::ops::Range<usize> {
        band * self.across..(band + 1) * self.across
    }

    /// The rows of a tile.
    pub(super) fn runs(&self, tile: usize) -> impl Iterator<Item = Run> {
        let [left, top] = [tile % self.across * COLUMNS, tile / self.across * ROWS];
        let [width, height] = self.size;
        let length = COLUMNS.min(width - left);
        let run = move |row| Run { place: row * length, pixel: (top + row) * width + left, length };
        (0..ROWS.min(height - top)).map(run)
    }

    /// The middles of a tile's pixels, off by normal numbers of a deviation in pixels.
    pub(super) fn places(&self, tile: usize, deviation: f64, seed: u64) -> Places {
        let mut places = Places { count: 0, across: [0.0; MOST], down: [0.0; MOST] };
        for Run { place, pixel, length } in self.runs(tile) {
            let run = place..place + length;
            let (across, down) = (&mut places.across[run.clone()], &mut places.down[run]);
            if deviation != 0.0 {
                normals(seed, pixel as u64, 0, across);
                normals(seed, pixel as u64, 2, down);
            }
            let [u, v] = [pixel % self.size[0], pixel / self.size[0]];
            for (k, (across, down)) in across.iter_mut().zip(down).enumerate() {
                *across = (u + k) as f64 + deviation * *across;
                *down = v as f64 + deviation * *down;
            }
            places.count += length;
        }
        places
    }
}

impl Places {
    /// Their rays.
    pub(super) fn along(&self, camera: &Camera) -> Along {
        let mut along = Along { count: self.count, x: [0.0; MOST], y: [0.0; MOST] };
        let whole = ..self.count;
        camera.unproject_all(
            [&self.across[whole], &self.down[whole]],
            [&mut along.x[whole], &mut along.y[whole]],
        );
        along
    }
}
