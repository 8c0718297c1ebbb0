//! How far along a direction a ring blocks a body, shown by a chain of slices.
//!
//! A slice that overlaps the body by more than a cell of directions is wide, at two lengths of the translation, does so
//! at all between, as its distance is a convex function of the translation.

use super::slices::Slice;
use crate::contact::{Convex, WarmStart};
use crate::shape::{Posed, Supertoroid};
use crate::{Pose, Vector};

/// Questions to slices after which nothing more is shown.
const MOST_ASKED: usize = 100_000;
/// Slices, with those that are added.
const MOST_SLICES: usize = 128;
/// A slice carries on where it blocks this much farther at least, relative to the length that is asked for.
const FARTHER: f64 = 1e-5;
/// The end of what a slice blocks is found to this, relative to the same.
const FOUND: f64 = 1e-4;
/// Steps of the search for that end.
const STEPS: usize = 12;

/// A body among the slices of a ring.
pub(super) struct Blocked<'a> {
    torus: &'a Posed<Supertoroid>,
    body: &'a Posed<Convex>,
    /// Those that blocked last are asked first.
    slices: Vec<(Slice, WarmStart)>,
    /// How often slices were asked.
    asked: usize,
}

impl<'a> Blocked<'a> {
    pub(super) fn new(
        torus: &'a Posed<Supertoroid>,
        body: &'a Posed<Convex>,
        slices: &[Slice],
    ) -> Self {
        let slices = slices.iter().map(|slice| (*slice, WarmStart::default())).collect();
        Self { torus, body, slices, asked: 0 }
    }

    /// One more slice to ask.
    pub(super) fn add(&mut self, slice: Slice) {
        self.slices.insert(0, (slice, WarmStart::default()));
    }

    /// True where slices were asked too often.
    pub(super) fn exhausted(&self) -> bool {
        self.asked >= MOST_ASKED
    }

    /// True where no more slices are taken.
    pub(super) fn full(&self) -> bool {
        self.slices.len() >= MOST_SLICES
    }

    /// Up to which length of a translation, but no more than `limit`, the ring is shown to block all unit directions
    /// within `spread` of one, given that it does so up to `reach`.
    pub(super) fn until(&mut self, way: &Vector, spread: f64, reach: f64, limit: f64) -> f64 {
        let mut reach = reach;
        'further: while reach < limit && self.asked < MOST_ASKED {
            for place in 0..self.slices.len() {
                let end = self.slice_until(place, way, spread, [reach, limit]);
                if end > reach + FARTHER * limit {
                    reach = end;
                    self.slices[..=place].rotate_right(1);
                    continue 'further;
                }
            }
            break;
        }
        reach
    }

    /// Negative where a slice blocks a translation and all within `spread` of its direction: convex in the length.
    fn overlap(&mut self, place: usize, way: &Vector, spread: f64, length: f64) -> f64 {
        let by = way * length;
        let body = self.body.moved(&Pose::translation(by.x, by.y, by.z));
        let (slice, start) = &mut self.slices[place];
        if slice.clear_of(&body) {
            return f64::INFINITY;
        }
        self.asked += 1;
        let contact = slice.touch(self.torus, &body, start).contact;
        // a single direction is only tried, a cell is proven
        spread * length + if spread > 0.0 { contact.bounds[1] } else { contact.distance }
    }

    /// Up to where a slice blocks from the lower of two lengths on: chords of a convex function fall short of its root.
    fn slice_until(
        &mut self,
        place: usize,
        way: &Vector,
        spread: f64,
        [low, high]: [f64; 2],
    ) -> f64 {
        let mut low = (low, self.overlap(place, way, spread, low));
        if low.1 >= 0.0 {
            return low.0;
        }
        let limit = high;
        let mut high = (high, self.overlap(place, way, spread, high));
        if high.1 < 0.0 {
            return limit;
        }
        for _ in 0..STEPS {
            let chord = low.0 + (high.0 - low.0) * (low.1 / (low.1 - high.1));
            let length = if high.1.is_finite() { chord } else { 0.5 * (low.0 + high.0) };
            let found = (length, self.overlap(place, way, spread, length));
            if found.1 >= 0.0 {
                high = found;
            } else {
                let near = high.1.is_finite() && found.0 - low.0 <= FOUND * limit;
                low = found;
                if near {
                    break;
                }
            }
            let middle = 0.5 * (low.0 + high.0);
            let found = (middle, self.overlap(place, way, spread, middle));
            if found.1 < 0.0 { low = found } else { high = found }
        }
        low.0
    }
}
