//! What the image tells of two pieces: which hides which, and what is hollow.
//!
//! In an organised cloud, what lies between two pieces is either seen, and then they are apart, or hidden
//! by something nearer. Three questions are asked of a piece's pixels:
//! - is it *hollow*: does the chord between the two ends of its rows pass in front of it, as in the
//!   inside of a cup?
//! - does it *hang*: is the support seen right under it?
//! - is the space between it and another piece *hidden* by a third?

use crate::segment::class::Class;
use crate::segment::sight::seen;
use crate::{Point, Vector};

/// An organised cloud and the piece that each pixel belongs to.
#[derive(Clone, Debug)]
pub(crate) struct Image<'a> {
    points: &'a [Point],
    class: &'a [Class],
    width: usize,
    eye: Point,
    /// The piece of each pixel, or `NOBODY`.
    owner: Vec<u32>,
}

/// The owner of pixels that are in no piece.
const NOBODY: u32 = u32::MAX;
/// Pixels without reading that are passed over under a piece.
const SKIP: usize = 8;
/// The bottom of a pot is at most this part of the image's width deep, in the image.
const ACROSS: usize = 6;
/// Pixels by which a piece may grow.
const GROWTH: usize = 3;
/// Way behind per way down from which the view is too oblique to miss a side: 22 degrees off the vertical.
const SLANT: f64 = 0.4;
/// A range that is nearer by this is in front, in metres.
const IN_FRONT: f64 = 0.008;

impl<'a> Image<'a> {
    /// The image of a cloud; `None` unless it has `width` columns in every row.
    pub(crate) fn new(
        points: &'a [Point],
        class: &'a [Class],
        width: usize,
        eye: Point,
    ) -> Option<Self> {
        let whole = width > 0 && points.len() == class.len() && points.len().is_multiple_of(width);
        let owner = vec![NOBODY; points.len()];
        whole.then_some(Self { points, class, width, eye, owner })
    }

    /// Says that the pixels belong to piece number `piece`.
    pub(crate) fn own(&mut self, pixels: &[u32], piece: usize) {
        for i in pixels {
            if let Some(owner) = self.owner.get_mut(*i as usize) {
                *owner = piece as u32;
            }
        }
    }

    fn range(&self, i: usize) -> f64 {
        self.points.get(i).map_or(f64::NAN, |p| (p - self.eye).norm())
    }

    /// Adds to a piece what is `Low` beside it, a few pixels deep: its edge on the support, and the holes
    /// that noise makes in a flat thing.
    pub(crate) fn grow(&mut self, pixels: &mut Vec<u32>) {
        let Some(own) = pixels.first().and_then(|i| self.owner.get(*i as usize)).copied() else {
            return;
        };
        let mut from = 0;
        for _ in 0..GROWTH {
            let to = pixels.len();
            for k in from..to {
                let i = pixels[k] as usize;
                let sides = [
                    i.checked_sub(self.width),
                    i.checked_sub(1),
                    Some(i + 1),
                    Some(i + self.width),
                ];
                for j in sides.into_iter().flatten() {
                    let free = self.class.get(j) == Some(&Class::Low) && self.owner[j] == NOBODY;
                    if free && (self.range(i) - self.range(j)).abs() < 2.0 * IN_FRONT {
                        self.owner[j] = own;
                        pixels.push(j as u32);
                    }
                }
            }
            from = to;
        }
        pixels.sort_unstable();
    }

    /// Share of a piece's rows (its pixels in ascending order) that curve away from the eye.
    pub(crate) fn hollow(&self, pixels: &[u32]) -> f64 {
        let (mut rows, mut sunk) = (0u32, 0u32);
        for row in pixels.chunk_by(|a, b| *a as usize / self.width == *b as usize / self.width) {
            let (Some(a), Some(b)) = (row.first(), row.last()) else { continue };
            let (a, b) = (*a as usize, *b as usize);
            let middle = (a + b) / 2;
            let (Some(p), Some(q)) = (self.points.get(a), self.points.get(b)) else { continue };
            if b - a < 8 || self.owner.get(middle) != self.owner.get(a) {
                continue;
            }
            rows += 1;
            let sag = self.range(middle) - 0.5 * (self.range(a) + self.range(b));
            sunk += u32::from(sag > 0.002 + 0.08 * (p - q).norm());
        }
        if rows < 6 { 0.0 } else { f64::from(sunk) / f64::from(rows) }
    }

    /// The piece that hides this one along most of its lower edge, if any: met at once under it, or
    /// `across` other things, as the near wall of a pot is across its bottom.
    pub(crate) fn before(&self, pixels: &[u32], across: bool) -> Option<usize> {
        let own = self.owner.get(*pixels.first()? as usize)?;
        let mut fronts: Vec<usize> = Vec::new();
        let mut columns = 0usize;
        for i in lowest(pixels, self.width) {
            columns += 1;
            let other = if across {
                let mut under = self.under(i, self.width / ACROSS);
                under.find(|j| self.owner[*j] != NOBODY && self.owner[*j] != *own)
            } else {
                self.under(i, SKIP).find(|j| self.class[*j] != Class::Missing)
            };
            let hides =
                |j: &usize| self.owner[*j] != NOBODY && self.range(*j) < self.range(i) - IN_FRONT;
            fronts.extend(other.filter(hides).map(|j| self.owner[j] as usize));
        }
        fronts.sort_unstable();
        let front = fronts.chunk_by(|a, b| a == b).max_by_key(|run| run.len())?;
        (2 * front.len() > columns).then(|| front[0])
    }

    /// Whether a piece hangs, see [`hangs`].
    pub(crate) fn hangs(&self, pixels: &[u32], up: &Vector) -> bool {
        hangs(self.points, self.width, &self.eye, pixels, up)
    }

    /// The pixels under one, at most `reach` of them.
    fn under(&self, i: usize, reach: usize) -> impl Iterator<Item = usize> + '_ {
        (1..=reach).map(move |k| i + k * self.width).take_while(|j| *j < self.class.len())
    }

    /// True when in the rows that two pieces share, a third one that is nearer fills the space between.
    pub(crate) fn hidden_between(&self, a: &[u32], b: &[u32]) -> bool {
        let row = |i: &u32| *i as usize / self.width;
        let (mut rows, mut hidden) = (0, 0);
        let mut others = b.chunk_by(|i, j| row(i) == row(j)).peekable();
        for own in a.chunk_by(|i, j| row(i) == row(j)) {
            while others.next_if(|o| row(&o[0]) < row(&own[0])).is_some() {}
            let Some(other) = others.peek().filter(|o| row(&o[0]) == row(&own[0])) else {
                continue;
            };
            let ends = |r: &[u32]| (r[0] as usize, r[r.len() - 1] as usize);
            let ((a0, a1), (b0, b1)) = (ends(own), ends(other));
            let (from, to) = if a1 < b0 { (a1, b0) } else { (b1, a0) };
            if from >= to {
                continue;
            }
            rows += 1;
            let limit = self.range(from).min(self.range(to)) - IN_FRONT;
            let (mut seen, mut front) = (0, 0);
            for j in (from + 1..to).filter(|j| self.class[*j] != Class::Missing) {
                seen += 1;
                front += usize::from(self.owner[j] != NOBODY && self.range(j) < limit);
            }
            hidden += usize::from(front > 0 && 10 * front > 8 * seen);
        }
        rows >= 5 && 5 * hidden > 4 * rows
    }
}

/// True when under most of a piece's lower edge in an image something is seen that is well behind it: were there a side
/// below the edge, it would be seen instead. From straight above nothing can be told.
pub(crate) fn hangs(
    points: &[Point],
    width: usize,
    eye: &Point,
    pixels: &[u32],
    up: &Vector,
) -> bool {
    let range = |i: usize| (points[i] - eye).norm();
    let (mut columns, mut free) = (0, 0);
    for i in lowest(pixels, width) {
        let mut under = (1..=SKIP).map(|k| i + k * width).take_while(|j| *j < points.len());
        if let Some(j) = under.find(|j| seen(&points[*j])) {
            columns += 1;
            let step = points[j] - points[i];
            let drop = -step.dot(up);
            let behind = (step + up * drop).norm() > SLANT * drop.abs();
            free += usize::from(behind && range(j) > range(i) + 2.0 * IN_FRONT);
        }
    }
    columns >= 3 && 10 * free > 7 * columns
}

/// The lowest pixel of each column of a piece.
fn lowest(pixels: &[u32], width: usize) -> impl Iterator<Item = usize> + use<> {
    let mut lowest = vec![NOBODY; width];
    for i in pixels {
        lowest[*i as usize % width] = *i;
    }
    lowest.into_iter().filter(|i| *i != NOBODY).map(|i| i as usize)
}
