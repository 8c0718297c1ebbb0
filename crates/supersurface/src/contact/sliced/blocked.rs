//! How far along a direction one body blocks another, shown by a chain of pairs of slices.
//!
//! Two slices that overlap by more than a cell of directions is wide, at two lengths of the translation, do so
//! at all between, as their distance is a convex function of the translation.

use super::grid::Grid;
use super::slice::{FEW, MANY, Slice};
use crate::Vector;
use crate::contact::WarmStart;

/// Questions to slices after which no more directions are tried, and nothing more is shown of cells.
const MOST_ASKED: [usize; 2] = [50_000; 2];
/// Pairs that are added.
const MOST_ADDED: usize = 64;
/// A pair carries on where it blocks this much farther at least, relative to the length that is asked for.
const FARTHER: f64 = 1e-5;
/// The end of what a pair blocks is found to this, relative to the same.
const FOUND: f64 = 1e-4;
/// Steps of the search for that end.
const STEPS: usize = 12;

/// The slices of a body among those of another.
pub(super) struct Blocked {
    /// Those that blocked last are asked first.
    pairs: Vec<([Slice; 2], WarmStart)>,
    added: usize,
    /// How often slices were asked for directions that were tried, and for cells.
    asked: [usize; 2],
}

impl Blocked {
    pub(super) fn new(grid: &Grid) -> Self {
        let pair = |k: usize| (grid.node(k).map(|slice| *slice), WarmStart::default());
        Self { pairs: (0..grid.len()).map(pair).collect(), added: 0, asked: [0; 2] }
    }

    /// One more pair to ask.
    pub(super) fn add(&mut self, pair: [Slice; 2]) {
        self.added += 1;
        self.pairs.insert(0, (pair, WarmStart::default()));
    }

    /// True where slices were asked too often for cells, or else for directions.
    pub(super) const fn exhausted(&self, cells: bool) -> bool {
        self.asked[cells as usize] >= MOST_ASKED[cells as usize]
    }

    /// True where no more pairs are taken.
    pub(super) const fn full(&self) -> bool {
        self.added >= MOST_ADDED
    }

    /// Up to which length of a translation, but no more than `limit`, the bodies are shown to block all unit directions
    /// within `spread` of one, given that they do so up to `reach`.
    pub(super) fn until(&mut self, way: &Vector, spread: f64, reach: f64, limit: f64) -> f64 {
        let mut reach = reach;
        'further: while reach < limit && !self.exhausted(spread > 0.0) {
            for place in 0..self.pairs.len() {
                let end = self.pair_until(place, way, spread, [reach, limit]);
                if end > reach + FARTHER * limit {
                    reach = end;
                    self.pairs[..=place].rotate_right(1);
                    continue 'further;
                }
            }
            break;
        }
        reach
    }

    /// Negative where a pair blocks a translation and all within `spread` of its direction: convex in the length.
    fn overlap(&mut self, place: usize, way: &Vector, spread: f64, length: f64) -> f64 {
        let ([a, b], start) = &mut self.pairs[place];
        let b = b.moved(&(way * length));
        if a.clear_of(&b) {
            return f64::INFINITY;
        }
        self.asked[usize::from(spread > 0.0)] += 1;
        let cells = if spread > 0.0 { MANY } else { FEW };
        let contact = a.touch(&b, start, cells).contact;
        // a single direction is only tried, a cell is proven
        spread * length + if spread > 0.0 { contact.bounds[1] } else { contact.distance }
    }

    /// Up to where a pair blocks from the lower of two lengths on: chords of a convex function fall short of its root.
    fn pair_until(
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
