//! Where in an octant can the closest point be? Cells of the chart, each in a box.
//!
//! All three coordinates are monotone in both angles, so a cell's patch lies in the box that its corners span, and the
//! distance of a point to that box is a lower bound for its distance to the patch. Samples in the middle of the cells
//! give starts; bounds say which of them cannot lead to the closest point.

use super::chart::{Chart, Quarter};
use crate::Vector;

/// Cells along each angle.
pub(super) const CELLS: usize = 10;
const COUNT: usize = CELLS * CELLS;

/// The cells of an octant: even in the angles of the octant scaled to a ball.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Middle of each cell's patch.
    middles: [[f64; COUNT]; 3],
    lows: [[f64; COUNT]; 3],
    highs: [[f64; COUNT]; 3],
    /// Chart coordinate in the middle of a row or column.
    places: [f64; CELLS],
}

/// Squared distances of a point to the middles, and lower bounds of those to the patches.
#[derive(Clone, Debug)]
pub(super) struct Bounds {
    pub(super) samples: [f64; COUNT],
    pub(super) least: [f64; COUNT],
}

impl Grid {
    pub(super) fn new(chart: &Chart) -> Self {
        let place = |share: f64| (std::f64::consts::FRAC_PI_2 * share).tan().ln();
        let node = |k: usize| match k {
            0 => f64::NEG_INFINITY,
            CELLS => f64::INFINITY,
            _ => place(k as f64 / CELLS as f64),
        };
        let places: [f64; CELLS] = std::array::from_fn(|k| place((k as f64 + 0.5) / CELLS as f64));
        let quarters = |p: f64, at: &dyn Fn(usize) -> f64, count: usize| -> Vec<Quarter> {
            (0..count).map(|k| Quarter::new(at(k), p)).collect()
        };
        let [p1, p2] = chart.powers;
        let middle = |k: usize| places[k];
        let around = [quarters(p2, &node, CELLS + 1), quarters(p2, &middle, CELLS)];
        let along = [quarters(p1, &node, CELLS + 1), quarters(p1, &middle, CELLS)];
        let none = [[0.0; COUNT]; 3];
        let mut grid = Self { middles: none, lows: none, highs: none, places };
        for i in 0..CELLS {
            for j in 0..CELLS {
                let cell = i * CELLS + j;
                let middle = chart.assemble(&around[1][j], &along[1][i]);
                let corners = [(i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1)]
                    .map(|(i, j)| chart.assemble(&around[0][j], &along[0][i]));
                let (low, high) = corners
                    .iter()
                    .fold((middle, middle), |(low, high), c| (low.inf(c), high.sup(c)));
                for k in 0..3 {
                    grid.middles[k][cell] = middle[k];
                    grid.lows[k][cell] = low[k];
                    grid.highs[k][cell] = high[k];
                }
            }
        }
        grid
    }

    pub(super) fn bounds(&self, p: &Vector) -> Bounds {
        let mut out = Bounds { samples: [0.0; COUNT], least: [0.0; COUNT] };
        for k in 0..3 {
            for cell in 0..COUNT {
                let away = self.middles[k][cell] - p[k];
                out.samples[cell] += away * away;
                let below = self.lows[k][cell] - p[k];
                let above = p[k] - self.highs[k][cell];
                let outside = if below > above { below } else { above };
                let outside = if outside > 0.0 { outside } else { 0.0 };
                out.least[cell] += outside * outside;
            }
        }
        out
    }

    /// Chart coordinates of a cell's middle.
    pub(super) fn place(&self, cell: usize) -> [f64; 2] {
        [self.places[cell % CELLS], self.places[cell / CELLS]]
    }

    /// The cell of chart coordinates.
    pub(super) fn cell(&self, [t, u]: [f64; 2]) -> usize {
        let index = |v: f64| {
            let share = v.exp().atan() / std::f64::consts::FRAC_PI_2;
            ((share * CELLS as f64) as usize).min(CELLS - 1)
        };
        index(u) * CELLS + index(t)
    }
}

impl Bounds {
    /// The cells whose middle is nearer than those of their neighbours, nearest first.
    pub(super) fn valleys(&self) -> Vec<usize> {
        let mut found: Vec<usize> = (0..COUNT)
            .filter(|cell| {
                neighbours(*cell)
                    .all(|other| (self.samples[*cell], *cell) <= (self.samples[other], other))
            })
            .collect();
        found.sort_by(|a, b| self.samples[*a].total_cmp(&self.samples[*b]));
        found
    }

    /// The least bound of a cell and its neighbours.
    pub(super) fn around(&self, cell: usize) -> f64 {
        neighbours(cell).map(|c| self.least[c]).fold(self.least[cell], f64::min)
    }
}

/// The up to eight cells around a cell.
fn neighbours(cell: usize) -> impl Iterator<Item = usize> {
    let (i, j) = ((cell / CELLS) as isize, (cell % CELLS) as isize);
    let steps = (-1..=1).flat_map(|a| (-1..=1).map(move |b| (a, b))).filter(|s| *s != (0, 0));
    let side = CELLS as isize;
    steps.filter_map(move |(a, b)| {
        let (i, j) = (i + a, j + b);
        ((0..side).contains(&i) && (0..side).contains(&j)).then_some((i * side + j) as usize)
    })
}
