//! Which points are near a place: points sorted into the cells of a grid over their box.
//!
//! The cells are so large that an occupied one holds some points of a surface; rows of cells lie side by side in the
//! list, so that a neighbourhood is a few stretches of it. What is found does not depend on the cells.

use std::f64::consts::PI;
use std::ops::Range;

use crate::Vector;

/// Points of a surface in an occupied cell.
const POINTS: f64 = 4.0;
/// How many more than are wanted are looked for at first, as a ratio, and the ratio of the squared distances from one
/// trial to the next.
const AHEAD: f64 = 1.6;
const FARTHER: f64 = 2.0;
/// Most cells along an axis.
const MOST: usize = 64;

/// Points among which neighbours are sought.
#[derive(Clone, Debug)]
pub(super) struct Neighbours {
    /// Points and their places in the cloud, cell after cell.
    points: Vec<(Vector, u32)>,
    /// First point of each cell, and the number of points at the end.
    starts: Vec<u32>,
    low: Vector,
    cell: f64,
    counts: [usize; 3],
    near: Vec<(f64, u32)>,
}

impl Neighbours {
    pub(super) fn among(points: impl Iterator<Item = Vector>) -> Self {
        let points: Vec<Vector> = points.collect();
        let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(-f64::INFINITY));
        for p in &points {
            (low, high) = (low.inf(p), high.sup(p));
        }
        let side = high - low;
        let area = 2.0 * (side.x * side.y + side.y * side.z + side.z * side.x);
        let cell = (area * POINTS / points.len() as f64).sqrt().max(side.max() / MOST as f64);
        let cell = if cell > 0.0 { cell } else { f64::INFINITY };
        let counts = [0, 1, 2].map(|k| (side[k] / cell) as usize + 1);
        let mut out = Self {
            points: vec![(Vector::zeros(), 0); points.len()],
            starts: vec![0; counts.iter().product::<usize>() + 1],
            low,
            cell,
            counts,
            near: vec![(0.0, 0); points.len() + 1],
        };
        // counted, then laid down from the end of each cell to its beginning
        for p in &points {
            let cell = out.cell_of(p);
            out.starts[cell] += 1;
        }
        let mut sum = 0;
        for start in &mut out.starts {
            sum += *start;
            *start = sum;
        }
        for (i, p) in points.iter().enumerate().rev() {
            let cell = out.cell_of(p);
            out.starts[cell] -= 1;
            out.points[out.starts[cell] as usize] = (*p, i as u32);
        }
        out
    }

    fn cell_of(&self, p: &Vector) -> usize {
        let [x, y, z] = [0, 1, 2].map(|k| self.along(k, p[k]));
        (z * self.counts[1] + y) * self.counts[0] + x
    }

    /// The cell along an axis, the nearest one for places outside.
    fn along(&self, k: usize, x: f64) -> usize {
        (((x - self.low[k]) / self.cell) as usize).min(self.counts[k] - 1)
    }

    /// The nearest to a place, as (squared distance, index): `count` of them or all there are, the last of them the
    /// farthest, the others in no order.
    pub(super) fn nearest(&mut self, p: &Vector, count: usize) -> &[(f64, u32)] {
        let count = count.min(self.points.len());
        let mut reach = self.expected(p, AHEAD * count as f64);
        let found = loop {
            let found = self.within(p, reach).len();
            if found >= count || reach.is_infinite() {
                break found;
            }
            reach = if reach > 0.0 { FARTHER * reach } else { f64::INFINITY };
        };
        let Some(last) = count.min(found).checked_sub(1) else { return &[] };
        self.near[..found].select_nth_unstable_by(last, |a, b| a.0.total_cmp(&b.0));
        &self.near[..=last]
    }

    /// Squared distance within which about `count` points are expected, by the cell of a place and its neighbours.
    fn expected(&self, p: &Vector, count: f64) -> f64 {
        let [x, y, z] = [0, 1, 2].map(|k| self.along(k, p[k]));
        let row = (z * self.counts[1] + y) * self.counts[0];
        let many =
            |from: usize, to: usize| f64::from(self.starts[row + to] - self.starts[row + from]);
        let beside = many(x.saturating_sub(1), (x + 2).min(self.counts[0])) / 3.0;
        let density = many(x, x + 1).max(beside).max(0.5) / (self.cell * self.cell);
        count / (PI * density)
    }

    /// Those that are nearer to a place than the root of `reach`, as (squared distance, index).
    pub(super) fn within(&mut self, p: &Vector, reach: f64) -> &[(f64, u32)] {
        if self.points.is_empty() {
            return &[];
        }
        let radius = reach.sqrt();
        let [x, y, z]: [Range<usize>; 3] =
            [0, 1, 2].map(|k| self.along(k, p[k] - radius)..self.along(k, p[k] + radius) + 1);
        let mut found = 0;
        for z in z {
            for y in y.clone() {
                let row = (z * self.counts[1] + y) * self.counts[0];
                let [from, to] = [row + x.start, row + x.end].map(|c| self.starts[c] as usize);
                for (q, i) in &self.points[from..to] {
                    let square = (q - p).norm_squared();
                    // all are written and some kept: a branch would be guessed wrong too often
                    self.near[found] = (square, *i);
                    found += usize::from(square < reach);
                }
            }
        }
        &self.near[..found]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn finds_what_sorting_finds() {
        let mut random = Stream::new(2, 0);
        let points: Vec<Vector> =
            (0..301).map(|_| Vector::from_fn(|_, _| random.normal())).collect();
        let mut neighbours = Neighbours::among(points.iter().copied());
        for p in &points {
            let mut squares: Vec<f64> = points.iter().map(|q| (q - p).norm_squared()).collect();
            squares.sort_by(f64::total_cmp);
            let near = neighbours.nearest(p, 5);
            assert!(near.iter().any(|n| points[n.1 as usize] == *p));
            assert_eq!((near.len(), near[4].0), (5, squares[4]));
            assert_eq!(neighbours.within(p, squares[9]).len(), 9);
        }
        assert_eq!(neighbours.nearest(&points[0], 999).len(), 301);
        let mut same = Neighbours::among((0..9).map(|_| Vector::zeros()));
        assert_eq!(same.nearest(&Vector::zeros(), 4).len(), 4);
        assert_eq!(same.nearest(&Vector::x(), 4).len(), 4);
        assert!(Neighbours::among(std::iter::empty()).nearest(&Vector::x(), 4).is_empty());
    }
}
