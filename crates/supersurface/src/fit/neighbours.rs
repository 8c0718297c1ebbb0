//! Which points are near a place: points sorted into the cells of a grid over two sides of their box.
//!
//! The grid lies across the thinnest side, as a surface has few points above each other there, and its cells are so large
//! that one holds some points; rows of cells lie side by side in columns, so that a neighbourhood is a few stretches of
//! them. What is found does not depend on the cells.

use std::f64::consts::PI;
use std::ops::Range;

use crate::Vector;
use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, Lane, dispatch};

/// Points in a cell, were they spread over the grid.
const POINTS: f64 = 3.0;
/// How many more than are wanted are looked for at first, as a ratio, and the ratio of the squared distances from one
/// trial to the next.
const AHEAD: f64 = 3.4;
const FARTHER: f64 = 2.0;
/// Most cells along an axis.
const MOST: usize = 64;
/// Points that are looked at together.
const BLOCK: usize = <f32 as Lane>::WIDTH;
/// Where padding stands: far from all points.
const PADDING: f32 = 1e9;

/// A neighbour: the square of its distance, and its place in the cloud. Sorted by distance, then by place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Neighbour(u64);

impl Neighbour {
    #[inline(always)]
    const fn new(square: f32, place: u32) -> Self {
        // the bits of positive numbers are in their order
        Self((square.to_bits() as u64) << 32 | place as u64)
    }

    /// Squared distance.
    pub(super) fn square(self) -> f64 {
        f64::from(f32::from_bits((self.0 >> 32) as u32))
    }

    /// Place in the cloud.
    pub(super) const fn place(self) -> usize {
        (self.0 & 0xFFFF_FFFF) as usize
    }
}

/// Points among which neighbours are sought.
#[derive(Debug)]
pub(super) struct Neighbours {
    /// Coordinates cell after cell, and padding.
    columns: [Column<f32>; 3],
    /// Places in the cloud.
    places: Vec<u32>,
    /// First point of each cell, and the number of points at the end.
    starts: Vec<u32>,
    /// The axes of the grid.
    axes: [usize; 2],
    low: [f64; 2],
    /// Cells a unit of length.
    fineness: f64,
    counts: [usize; 2],
    near: Vec<Neighbour>,
}

impl Neighbours {
    pub(super) fn among(points: &[Vector]) -> Self {
        let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(-f64::INFINITY));
        for p in points {
            (low, high) = (low.inf(p), high.sup(p));
        }
        let side = high - low;
        let thinnest = side.imin();
        let axes = [(thinnest + 1) % 3, (thinnest + 2) % 3];
        let [a, b] = axes.map(|k| side[k]);
        let cell = (a * b * POINTS / points.len() as f64).sqrt().max(a.max(b) / MOST as f64);
        let fineness = if cell > 0.0 { cell.recip() } else { 0.0 };
        let counts = [a, b].map(|side| (side * fineness) as usize + 1);
        let padded = points.len() + BLOCK;
        let mut out = Self {
            columns: Default::default(),
            places: vec![0; padded],
            starts: vec![0; counts[0] * counts[1] + 1],
            axes,
            low: axes.map(|k| low[k]),
            fineness,
            counts,
            near: vec![Neighbour(0); padded],
        };
        out.columns.iter_mut().for_each(|column| column.resize(padded, PADDING));
        // counted, then laid down from the end of each cell to its beginning
        let cells: Vec<usize> = points.iter().map(|p| out.cell_of(p)).collect();
        cells.iter().for_each(|cell| out.starts[*cell] += 1);
        let mut sum = 0;
        for start in &mut out.starts {
            sum += *start;
            *start = sum;
        }
        for (i, (p, cell)) in points.iter().zip(cells).enumerate().rev() {
            out.starts[cell] -= 1;
            let at = out.starts[cell] as usize;
            out.places[at] = i as u32;
            (0..3).for_each(|k| out.columns[k][at] = p[k] as f32);
        }
        out
    }

    fn cell_of(&self, p: &Vector) -> usize {
        let [a, b] = [0, 1].map(|k| self.along(k, p[self.axes[k]]));
        b * self.counts[0] + a
    }

    /// The cell along an axis of the grid, the nearest one for places outside.
    fn along(&self, k: usize, x: f64) -> usize {
        (((x - self.low[k]) * self.fineness) as usize).min(self.counts[k] - 1)
    }

    /// The nearest to a place, `count` of them or all there are, the last of them the farthest, the others in no order.
    pub(super) fn nearest(&mut self, p: &Vector, count: usize) -> &[Neighbour] {
        let count = count.min(self.places.len() - BLOCK);
        let mut reach = self.expected(p, AHEAD * count as f64);
        let found = loop {
            let found = self.within(p, reach).len();
            if found >= count || reach.is_infinite() {
                break found;
            }
            reach = if reach > 0.0 { FARTHER * reach } else { f64::INFINITY };
        };
        let Some(last) = count.min(found).checked_sub(1) else { return &[] };
        self.near[..found].select_nth_unstable(last);
        &self.near[..=last]
    }

    /// Squared distance within which about `count` points are expected, by the cell of a place and its neighbours.
    fn expected(&self, p: &Vector, count: f64) -> f64 {
        let [a, b] = [0, 1].map(|k| self.along(k, p[self.axes[k]]));
        let row = b * self.counts[0];
        let many =
            |from: usize, to: usize| f64::from(self.starts[row + to] - self.starts[row + from]);
        let beside = many(a.saturating_sub(1), (a + 2).min(self.counts[0])) / 3.0;
        let density = many(a, a + 1).max(beside).max(0.5) * self.fineness * self.fineness;
        count / (PI * density)
    }

    /// Those that are nearer to a place than the root of `reach`.
    pub(super) fn within(&mut self, p: &Vector, reach: f64) -> &[Neighbour] {
        let radius = reach.sqrt();
        let [a, b]: [Range<usize>; 2] = [0, 1].map(|k| {
            let x = p[self.axes[k]];
            self.along(k, x - radius)..self.along(k, x + radius) + 1
        });
        let mut found = 0;
        dispatch(Within {
            columns: self.columns.each_ref().map(|column| &**column),
            places: &self.places,
            starts: &self.starts,
            row: self.counts[0],
            cells: [a, b],
            at: [0, 1, 2].map(|k| p[k] as f32),
            reach: reach as f32,
            near: &mut self.near,
            found: &mut found,
        });
        &self.near[..found]
    }
}

/// The points of some cells of the grid that are near a place.
struct Within<'a> {
    columns: [&'a [f32]; 3],
    places: &'a [u32],
    starts: &'a [u32],
    /// Cells in a row of the grid.
    row: usize,
    cells: [Range<usize>; 2],
    at: [f32; 3],
    reach: f32,
    near: &'a mut [Neighbour],
    found: &'a mut usize,
}

impl Job for Within<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let ([x, y, z], [a, b]) = (self.columns, self.cells);
        let [px, py, pz] = self.at;
        let mut found = 0;
        for row in b.map(|b| b * self.row) {
            let [from, to] = [row + a.start, row + a.end].map(|c| self.starts[c] as usize);
            for at in (from..to).step_by(BLOCK) {
                let block = at..at + BLOCK;
                let (x, y, z) = (&x[block.clone()], &y[block.clone()], &z[block.clone()]);
                let (mut squares, mut bits) = ([0.0f32; BLOCK], [0u32; BLOCK]);
                for i in 0..BLOCK {
                    let [dx, dy, dz] = [x[i] - px, y[i] - py, z[i] - pz];
                    squares[i] = dx * dx + dy * dy + dz * dz;
                    bits[i] = if squares[i] < self.reach { 1 << i } else { 0 };
                }
                // few are near: by their bits no others are looked at one by one
                let own = if to - at < BLOCK { (1 << (to - at)) - 1 } else { u32::MAX };
                let mut bits = bits.iter().sum::<u32>() & own;
                while bits != 0 {
                    let i = bits.trailing_zeros() as usize;
                    bits &= bits - 1;
                    self.near[found] = Neighbour::new(squares[i % BLOCK], self.places[at + i]);
                    found += 1;
                }
            }
        }
        *self.found = found;
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
        let mut neighbours = Neighbours::among(&points);
        for p in &points {
            let mut squares: Vec<f64> = points.iter().map(|q| (q - p).norm_squared()).collect();
            squares.sort_by(f64::total_cmp);
            let near = neighbours.nearest(p, 5);
            assert!(near.iter().any(|n| points[n.place()] == *p));
            let off = near[4].square() / squares[4] - 1.0;
            assert!(near.len() == 5 && off.abs() < 1e-5, "{off}");
            let between = 0.5 * (squares[8] + squares[9]);
            assert_eq!(neighbours.within(p, between).len(), 9);
        }
        assert_eq!(neighbours.nearest(&points[0], 999).len(), 301);
        let mut same = Neighbours::among(&[Vector::zeros(); 9]);
        assert_eq!(same.nearest(&Vector::zeros(), 4).len(), 4);
        assert_eq!(same.nearest(&Vector::x(), 4).len(), 4);
        assert!(Neighbours::among(&[]).nearest(&Vector::x(), 4).is_empty());
    }
}
