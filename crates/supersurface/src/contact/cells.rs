//! The least of all minima of `φ`, with a proof: branch and bound over the cells of a cube of directions.
//!
//! A cell is a square on a face of the cube around A. `φ` is convex and 1-homogeneous, so with its gradient `v` at any
//! direction `φ(n) >= v·n` for all: over a cell at least the least `v·m/|m|` of its corners `m`, if that is not
//! negative (the directions with `v·m >= λ|m|` are a convex cone). Where a ball of radius `r` rolls inside along the
//! surface, `φ - r|n|` is such a function as well, and its bound is the better one. Two gradients are tried, that at the cell's middle
//! and that at the best minimum so far. A cell whose bound is near
//! enough to the best minimum is done with; others are split in four. As A and B are symmetric, `φ(n) < φ(-n)` where
//! `n·c > 0`: half of the sphere is enough.

use super::continuation::settle;
use super::descent::Minimum;
use super::difference::{
    BLOCK, Difference, Triple, Values, cross, difference, dot, scaled, unit,
};
use crate::numeric::lanes::{Job, dispatch};

/// Cells of the first level along an edge of the cube.
const FIRST: usize = 4;
/// Half width of cells below which a descent says more than smaller cells.
const SMALLEST: f64 = 0.04;
/// Minima that are told apart.
const MINIMA: usize = 24;

/// A square on the face `[-1, 1]²`.
#[derive(Clone, Copy, Debug)]
struct Cell {
    middle: [f64; 2],
    half: f64,
}

impl Cell {
    fn quarters(&self) -> [Self; 4] {
        let half = 0.5 * self.half;
        [(-half, -half), (-half, half), (half, -half), (half, half)].map(|(dx, dy)| Self {
            middle: [self.middle[0] + dx, self.middle[1] + dy],
            half,
        })
    }
}

/// A face of the cube: the axis that it stands across and the two along it.
#[derive(Clone, Copy)]
struct Face {
    axes: [usize; 3],
    side: f64,
}

impl Face {
    fn new(number: usize) -> Self {
        let axis = number % 3;
        let side = if number < 3 { 1.0 } else { -1.0 };
        Self { axes: [axis, (axis + 1) % 3, (axis + 2) % 3], side }
    }

    /// The components of a vector across and along the face.
    #[inline(always)]
    fn local(&self, v: &Triple) -> Triple {
        [self.side * v[self.axes[0]], v[self.axes[1]], v[self.axes[2]]]
    }
}

/// The least minimum that was found, and a bound from below of all.
pub(super) struct Least {
    pub(super) minimum: Minimum,
    pub(super) bound: f64,
    pub(super) cells: usize,
    pub(super) descents: usize,
}

/// Searches the sphere, given a minimum where the bodies overlap; cells are split until the bound is within
/// `tolerance` (in the pair's size) or `most` of them were looked at.
pub(super) fn least(pair: &Difference, known: Minimum, tolerance: f64, most: usize) -> Least {
    let mut found = Least { minimum: known, bound: f64::INFINITY, cells: 0, descents: 0 };
    let mut minima = vec![known.normal[0]];
    let mut open: Vec<Cell> = Vec::with_capacity(64);
    for number in 0..6 {
        let face = Face::new(number);
        let centre = face.local(&pair.centre);
        let step = 1.0 / FIRST as f64;
        for i in 0..FIRST * FIRST {
            let place = |k: usize| (2 * k + 1) as f64 * step - 1.0;
            let cell = Cell { middle: [place(i / FIRST), place(i % FIRST)], half: step };
            if faces(&cell, &centre) {
                open.push(cell);
            }
        }
        while !open.is_empty() {
            let taken = &open[open.len().saturating_sub(BLOCK)..];
            let block = Block::new(pair, face, taken, &found.minimum);
            let taken = taken.len();
            let from = open.len() - taken;
            let cells: [Cell; BLOCK] = std::array::from_fn(|i| open[from + i.min(taken - 1)]);
            open.truncate(from);
            found.cells += taken;
            for (i, cell) in cells[..taken].iter().enumerate() {
                let bound = block.own[i].max(block.shared[i]);
                let (middle, steep) = block.fall(i);
                let best = found.minimum.expansion.value;
                // might it hold a better minimum than those that are known?
                let hopeful = block.own[i] < best
                    && minima.len() < MINIMA
                    && !minima.iter().any(|m| falls_to(&middle, &steep, m));
                let small = cell.half <= SMALLEST && bound >= best - tolerance;
                if block.values.value[i] < best || hopeful && small {
                    let other = settle(pair, &[middle, pair.to_b(&middle)]);
                    found.descents += 1;
                    minima.push(other.normal[0]);
                    if other.expansion.value < best {
                        found.minimum = other;
                    }
                }
                let far = bound < found.minimum.expansion.value - tolerance;
                if found.cells < most && (far || hopeful && !small) {
                    open.extend(cell.quarters().iter().filter(|c| faces(c, &centre)));
                } else {
                    found.bound = found.bound.min(bound);
                }
            }
        }
    }
    found.bound = found.bound.min(found.minimum.expansion.value);
    found
}

/// What is known of some cells of a face.
struct Block {
    directions: [[f64; BLOCK]; 3],
    values: Values,
    /// Bounds of `φ` by the gradients at the middles, and by the best minimum.
    own: [f64; BLOCK],
    shared: [f64; BLOCK],
}

impl Block {
    fn new(pair: &Difference, face: Face, cells: &[Cell], best: &Minimum) -> Self {
        let mut block = Self {
            directions: [[0.0; BLOCK]; 3],
            values: Values { value: [0.0; BLOCK], gradient: [[0.0; BLOCK]; 3] },
            own: [f64::INFINITY; BLOCK],
            shared: [f64::INFINITY; BLOCK],
        };
        let best = face.local(&best.expansion.gap);
        dispatch(Judgement { pair, face, cells, best, into: &mut block });
        block
    }

    /// The middle of a cell, and the gradient of `φ` there along the sphere.
    fn fall(&self, i: usize) -> (Triple, Triple) {
        let middle = self.directions.map(|v| v[i]);
        let gradient = self.values.gradient.map(|v| v[i]);
        (middle, difference(&gradient, &scaled(&middle, self.values.value[i])))
    }
}

struct Judgement<'a> {
    pair: &'a Difference,
    face: Face,
    cells: &'a [Cell],
    best: Triple,
    into: &'a mut Block,
}

impl Job for Judgement<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let (mut x, mut y, mut half) = ([0.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
        for (i, cell) in self.cells.iter().enumerate() {
            x[i] = cell.middle[0];
            y[i] = cell.middle[1];
            half[i] = cell.half;
        }
        let (block, [across, along, up]) = (self.into, self.face.axes);
        for i in 0..BLOCK {
            let shorter = 1.0 / (1.0 + x[i] * x[i] + y[i] * y[i]).sqrt();
            block.directions[across][i] = self.face.side * shorter;
            block.directions[along][i] = x[i] * shorter;
            block.directions[up][i] = y[i] * shorter;
        }
        block.values = self.pair.values::<FUSED>(&block.directions);
        let (v, n, ball) = (&block.values.gradient, &block.directions, self.pair.rolling);
        let side = self.face.side;
        // the corner that is farthest from the middle, as the cosine of the angle
        let mut widest = [1.0; BLOCK];
        for (dx, dy) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            for i in 0..BLOCK {
                let (p, q) = (x[i] + dx * half[i], y[i] + dy * half[i]);
                let shorter = 1.0 / (1.0 + p * p + q * q).sqrt();
                let middle = (side * n[across][i] + p * n[along][i] + q * n[up][i]) * shorter;
                let own = (side * v[across][i] + p * v[along][i] + q * v[up][i]) * shorter;
                let own = own - ball * middle;
                let shared = (self.best[0] + p * self.best[1] + q * self.best[2]) * shorter;
                block.own[i] = if own < block.own[i] { own } else { block.own[i] };
                block.shared[i] = if shared < block.shared[i] { shared } else { block.shared[i] };
                widest[i] = if middle < widest[i] { middle } else { widest[i] };
            }
        }
        for i in 0..BLOCK {
            // below 0 the least is not at a corner: that of the cone around the cell
            let radial = block.values.value[i] - ball;
            let square = v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i];
            let square = square - 2.0 * ball * block.values.value[i] + ball * ball;
            let tangential = (square - radial * radial).max(0.0).sqrt();
            let sine = (1.0 - widest[i] * widest[i]).max(0.0).sqrt();
            let inside = tangential * widest[i] < -radial * sine;
            let cone = radial * widest[i] - tangential * sine;
            let cone = if inside { -square.max(0.0).sqrt() } else { cone };
            block.own[i] = ball + if block.own[i] < 0.0 { cone } else { block.own[i] };
        }
    }
}

/// True where `φ`, of gradient `steep` along the sphere, falls towards a minimum near by.
#[inline(always)]
fn falls_to(from: &Triple, steep: &Triple, minimum: &Triple) -> bool {
    let to = difference(minimum, from);
    let distance = dot(&to, &to).sqrt();
    distance < 1e-3
        || distance < 0.5 && -dot(steep, &to) > 0.5 * distance * dot(steep, steep).sqrt()
}

/// False where every direction of the cell looks away from B.
#[inline(always)]
fn faces(cell: &Cell, centre: &Triple) -> bool {
    let [x, y] = cell.middle;
    centre[0] + x * centre[1] + y * centre[2] + cell.half * (centre[1].abs() + centre[2].abs())
        >= 0.0
}

/// A start for the descent: the normal at `c` of the ellipsoid of the bodies' moments, or `c` itself.
pub(super) fn first_guess(pair: &Difference) -> [Triple; 2] {
    let [a, b] = pair.semi_axes;
    let mut m = [[0.0; 3]; 3];
    for i in 0..3 {
        m[i][i] = a[i] * a[i];
        for j in 0..3 {
            for k in 0..3 {
                m[i][j] += pair.turn[i][k] * b[k] * b[k] * pair.turn[j][k];
            }
        }
    }
    let c = pair.centre;
    let inverse = [cross(&m[1], &m[2]), cross(&m[2], &m[0]), cross(&m[0], &m[1])];
    let x: Triple = [dot(&inverse[0], &c), dot(&inverse[1], &c), dot(&inverse[2], &c)];
    let length = dot(&x, &x).sqrt();
    let guess = if length > 1e-300 { unit(&x) } else { [0.0, 0.0, 1.0] };
    [guess, pair.to_b(&guess)]
}
