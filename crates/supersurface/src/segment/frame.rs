//! Where the sensor's view ends: a thing that is cut off there is not seen whole.

use crate::Point;
use crate::cloud::PointCloud;
use crate::segment::sight::{grid, seen};

/// Cameras leave a strip without readings along the border, at most this part of the image.
const STRIP: usize = 14;
/// Pixels from the border at which a thing may go on beyond it.
const NEAR: usize = 3;
/// Share of its size along the border of the image from which too much of a thing may be missing.
const CUT: f64 = 0.35;

/// The image proper of an organised cloud: first and last column, first and last row that have readings.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame<'a> {
    points: &'a [Point],
    width: usize,
    ends: [[usize; 2]; 2],
}

impl<'a> Frame<'a> {
    /// That of a cloud; `None` where it is not organised.
    pub(crate) fn of(cloud: &'a PointCloud) -> Option<Self> {
        let [width, height] = grid(cloud)?;
        let seen = |column: usize, row: usize| seen(&cloud.points[row * width + column]);
        let in_column = |u: usize| (0..height).filter(|v| seen(u, *v)).count();
        let in_row = |v: usize| (0..width).filter(|u| seen(*u, v)).count();
        let ends = [ends(in_column, width, height), ends(in_row, height, width)];
        Some(Self { points: &cloud.points, width, ends })
    }

    /// True when so much of a thing, given by its pixels, lies along the border that most of it may be missing.
    pub(crate) fn cuts(&self, pixels: &[u32]) -> bool {
        let at_border = |i: &&u32| {
            let at = [**i as usize % self.width, **i as usize / self.width];
            let near =
                |(x, [first, last]): (usize, [usize; 2])| x < first + NEAR || x + NEAR > last;
            at.into_iter().zip(self.ends).any(near)
        };
        let some = pixels.iter().step_by(pixels.len().div_ceil(2000).max(1));
        let border = diagonal(pixels.iter().filter(at_border).map(|i| &self.points[*i as usize]));
        border > CUT * diagonal(some.map(|i| &self.points[*i as usize]))
    }
}

/// Diagonal of the points' box, in metres; 0 for none.
fn diagonal<'a>(mut points: impl Iterator<Item = &'a Point>) -> f64 {
    let Some(first) = points.next() else { return 0.0 };
    let (low, high) = points.fold((*first, *first), |(l, h), p| (l.inf(p), h.sup(p)));
    (high - low).norm()
}

/// The first and the last of `lines` rows or columns without the strip that has hardly a reading, by how many of `full`
/// each has.
fn ends(readings: impl Fn(usize) -> usize, lines: usize, full: usize) -> [usize; 2] {
    let strip = lines / STRIP;
    let is_seen = |k: &usize| 5 * readings(*k) > full;
    let first = (0..=strip).find(is_seen).unwrap_or(0);
    let last = (0..=strip).map(|k| lines - 1 - k).find(is_seen).unwrap_or(lines - 1);
    [first, last]
}
