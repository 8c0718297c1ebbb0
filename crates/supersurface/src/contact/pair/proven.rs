//! What a search of the sphere of directions proved, for the next one of the same bodies a moment later.
//!
//! A body's points move by no more than its centre does and its turn times its reach, and so does `φ` at any direction:
//! a bound of `φ` over a cell, less that, still holds.

use super::cells::ROOTS;
use super::difference::{Difference, Triple, difference, dot};

/// Bounds of `φ` from below over the cells of the first level, in the pair's size.
#[derive(Clone, Copy, Debug)]
pub(super) struct Proven {
    semi_axes: [Triple; 2],
    dual: [[f64; 2]; 2],
    size: f64,
    turn: [Triple; 3],
    centre: Triple,
    /// Minus infinity where nothing is known.
    pub(super) bounds: [f32; ROOTS],
    /// Values and normals of the minima, or bounds of the values from below.
    pub(super) minima: [(f64, Triple); REMEMBERED],
}

/// Minima that are remembered: a box in a box has six.
const REMEMBERED: usize = 6;
/// No minimum.
const NONE: (f64, Triple) = (f64::NEG_INFINITY, [0.0; 3]);

impl Default for Proven {
    /// Nothing, of no bodies.
    fn default() -> Self {
        Self {
            semi_axes: [[f64::NAN; 3]; 2],
            dual: [[f64::NAN; 2]; 2],
            size: f64::NAN,
            turn: [[f64::NAN; 3]; 3],
            centre: [f64::NAN; 3],
            bounds: [f32::NEG_INFINITY; ROOTS],
            minima: [NONE; REMEMBERED],
        }
    }
}

impl Proven {
    /// What of it holds for a pair: nothing for other bodies.
    pub(super) fn carry(&mut self, to: &Difference) {
        let same = self.semi_axes == to.semi_axes && self.dual == to.dual && self.size == to.size;
        if same {
            let lost = self.motion(to);
            // and a bit of rounding
            self.bounds.iter_mut().for_each(|bound| *bound -= lost as f32 + 1e-6);
            self.minima.iter_mut().for_each(|(value, _)| *value -= lost);
        } else {
            self.bounds = [f32::NEG_INFINITY; ROOTS];
            self.minima = [NONE; REMEMBERED];
            (self.semi_axes, self.dual, self.size) = (to.semi_axes, to.dual, to.size);
        }
        (self.turn, self.centre) = (to.turn, to.centre);
    }

    /// Remembers the first of some minima.
    pub(super) fn remember(&mut self, minima: &[(f64, Triple)]) {
        self.minima = [NONE; REMEMBERED];
        self.minima.iter_mut().zip(minima).for_each(|(kept, found)| *kept = *found);
    }

    /// The longest way of a point of B in A's frame, in the pair's size.
    fn motion(&self, to: &Difference) -> f64 {
        let shift = difference(&to.centre, &self.centre);
        let turned = (0..3).map(|k| difference(&to.turn[k], &self.turn[k]));
        // a difference of rotations lengthens by at most its Frobenius norm over the root of 2
        let turn = (0.5 * turned.map(|row| dot(&row, &row)).sum::<f64>()).sqrt();
        let reach = dot(&to.semi_axes[1], &to.semi_axes[1]).sqrt();
        dot(&shift, &shift).sqrt() + turn * reach
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Convex;
    use crate::numeric::random::Stream;
    use crate::shape::{Posed, Superellipsoid};
    use crate::{Pose, Vector};

    #[test]
    fn nothing_moves_farther_than_the_motion() {
        for k in 0..200 {
            let mut stream = Stream::new(5, k);
            let mut draw = |low, high| stream.between(low, high);
            let convex = |axes, e| Convex::new(Superellipsoid::new(axes, e).unwrap()).unwrap();
            let a = convex([0.02; 3], [1.0; 2]);
            let axes = [draw(0.01, 0.1), draw(0.01, 0.1), draw(0.01, 0.1)];
            let b = convex(axes, [draw(0.05, 1.9), draw(0.05, 1.9)]);
            let mut pose = |step: f64| {
                let mut vector = |s: f64| Vector::new(draw(-s, s), draw(-s, s), draw(-s, s));
                Pose::new(vector(0.01 * step), vector(step))
            };
            let (first, by) = (pose(2.0), pose(0.1));
            let at = |pose: Pose| {
                let a = Posed::new(a, Pose::identity()).unwrap();
                Difference::new(&a, &Posed::new(b, pose).unwrap())
            };
            let (before, after) = (at(first), at(first * by));
            let mut proven = Proven::default();
            proven.carry(&before);
            proven.bounds = [0.0; ROOTS];
            proven.carry(&after);
            let lost = -f64::from(proven.bounds[0]);
            let mut most = 0.0f64;
            for _ in 0..300 {
                let n = Vector::new(stream.normal(), stream.normal(), stream.normal()).normalize();
                let value = |pair: &Difference| {
                    let n = n.into();
                    pair.value(&[n, pair.to_b(&n)])
                };
                most = most.max((value(&after) - value(&before)).abs());
            }
            assert!(most <= lost && lost < 30.0 * most, "{most} {lost}");
            // other bodies: nothing is known
            proven.carry(&Difference::new(
                &Posed::new(a, Pose::identity()).unwrap(),
                &Posed::new(a, first).unwrap(),
            ));
            assert!(proven.bounds[0] == f32::NEG_INFINITY);
        }
    }
}
