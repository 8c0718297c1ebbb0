//! An image cut into tiles of pixels, whose rays are looked at together.

use super::rays::{Along, MOST, RAYS};
use crate::camera::Camera;
use crate::numeric::random::normals;

/// Columns and rows of a tile.
const COLUMNS: usize = 16;
pub(super) const ROWS: usize = 8;
const _: () = assert!(COLUMNS * ROWS == MOST);
/// Pixels of a run.
pub(super) const RUN: usize = 8;
/// Rows of the pixels whose rays are a block.
const DEEP: usize = RAYS / RUN;

/// The tiles of an image, in rows.
pub(super) struct Tiles {
    size: [usize; 2],
    across: usize,
}

/// Neighbours in a row of a tile.
pub(super) struct Run {
    /// Of its first pixel in the tile.
    pub(super) place: usize,
    /// Of its first pixel in the image.
    pub(super) pixel: usize,
    /// Number of pixels, [`RUN`] but at the image's right end.
    pub(super) length: usize,
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

    /// Column and row of the first pixel of a tile's run: those of a block lie below each other.
    fn corner(&self, tile: usize, run: usize) -> [usize; 2] {
        let [left, top] = [tile % self.across * COLUMNS, tile / self.across * ROWS];
        let (block, row) = (run / DEEP, run % DEEP);
        let across = COLUMNS / RUN;
        [left + block % across * RUN, top + block / across * DEEP + row]
    }

    /// The runs of a tile that are in the image.
    pub(super) fn runs(&self, tile: usize) -> impl Iterator<Item = Run> {
        let [width, height] = self.size;
        (0..MOST / RUN).filter_map(move |k| {
            let [u, v] = self.corner(tile, k);
            let length = RUN.min(width.checked_sub(u)?);
            (length > 0 && v < height).then_some(Run {
                place: k * RUN,
                pixel: v * width + u,
                length,
            })
        })
    }

    /// Aims at the middles of a tile's pixels, off by normal numbers of a deviation in pixels; for places outside of the
    /// image, at its last column or row.
    pub(super) fn aim(
        &self,
        tile: usize,
        camera: &Camera,
        deviation: f64,
        seed: u64,
        along: &mut Along,
    ) {
        let Along { x, y } = along;
        (*x, *y) = ([0.0; MOST], [0.0; MOST]);
        if deviation != 0.0 {
            for Run { place, pixel, length } in self.runs(tile) {
                normals(seed, pixel as u64, 0, &mut x[place..place + length]);
                normals(seed, pixel as u64, 2, &mut y[place..place + length]);
            }
        }
        let last = self.size.map(|n| n.saturating_sub(1) as f64);
        let runs = x.as_chunks_mut::<RUN>().0.iter_mut().zip(y.as_chunks_mut::<RUN>().0);
        for (run, (x, y)) in runs.enumerate() {
            let [u, v] = self.corner(tile, run).map(|k| k as f64);
            for k in 0..RUN {
                x[k] = (u + k as f64).min(last[0]) + deviation * x[k];
                y[k] = v.min(last[1]) + deviation * y[k];
            }
        }
        camera.unproject_all(x, y);
    }
}
