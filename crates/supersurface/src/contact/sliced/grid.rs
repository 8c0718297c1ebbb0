//! Slices of two bodies at equal intervals, and their pairs as the nodes of a grid.

use super::body::Sliced;
use super::slice::{Slice, Touch};
use crate::shape::InvalidShape;

/// The pairs of `of[0].len() * of[1].len()` slices, those of the second body next to each other.
pub(super) struct Grid {
    pub(super) of: [Vec<Slice>; 2],
    closed: [bool; 2],
    /// Half the interval of a slice of each body, in radians; 0 for one that is whole.
    pub(super) half: [f64; 2],
}

impl Grid {
    /// So many slices of a body that is cut, at the middles of their intervals.
    pub(super) fn new(bodies: [&Sliced; 2], count: usize) -> Result<Self, InvalidShape> {
        let slices = |body: &Sliced| {
            let [first, last] = body.span();
            let count = if first < last { count } else { 1 };
            let half = 0.5 * (last - first) / count as f64;
            // off the seams, where the slice of a ring is that of a corner for small ε2
            let place = |k: usize| first + (2 * k + 1) as f64 * half;
            let all: Result<Vec<Slice>, _> = (0..count).map(|k| body.slice(place(k))).collect();
            Ok((all?, half))
        };
        let [(a, half_a), (b, half_b)] = [slices(bodies[0])?, slices(bodies[1])?];
        let closed = bodies.map(Sliced::is_closed);
        Ok(Self { of: [a, b], closed, half: [half_a, half_b] })
    }

    pub(super) fn len(&self) -> usize {
        self.of[0].len() * self.of[1].len()
    }

    /// The slices of a node.
    pub(super) fn node(&self, k: usize) -> [&Slice; 2] {
        let row = self.of[1].len();
        [&self.of[0][k / row], &self.of[1][k % row]]
    }

    /// True for a node below which a minimum may lie: along each place its neighbour downhill is no lower, and rises
    /// away from it. What is not known counts as higher.
    pub(super) fn turns(&self, k: usize, known: impl Fn(usize) -> Option<Touch>) -> bool {
        let Some(node) = known(k) else { return false };
        (0..2).all(|axis| {
            let forward = node.slopes[axis] < 0.0;
            let next = self.next(k, axis, forward).and_then(&known);
            next.is_none_or(|next| {
                let away =
                    if forward { next.slopes[axis] >= 0.0 } else { next.slopes[axis] <= 0.0 };
                away && node.contact.distance <= next.contact.distance
            })
        })
    }

    /// The next node along one place, if there is one.
    fn next(&self, k: usize, axis: usize, forward: bool) -> Option<usize> {
        let counts = [self.of[0].len(), self.of[1].len()];
        let (count, stride) = (counts[axis], if axis == 0 { counts[1] } else { 1 });
        let place = k / stride % count;
        let to = match (forward, self.closed[axis]) {
            (true, true) => (place + 1) % count,
            (false, true) => (place + count - 1) % count,
            (true, false) => Some(place + 1).filter(|to| *to < count)?,
            (false, false) => place.checked_sub(1)?,
        };
        (to != place).then_some(k - place * stride + to * stride)
    }
}
