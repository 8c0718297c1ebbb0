//! The least of all minima of `φ`, with a proof: branch and bound over the cells of a cube of directions.
//!
//! A cell is a square on a face of the cube around A. `φ` is convex and 1-homogeneous, so with its gradient `v` at any
//! direction `φ(n) >= v·n` for all: over a cell at least the least `v·m/|m|` of its corners `m`, if that is not
//! negative (the directions with `v·m >= λ|m|` are a convex cone). Where a ball of radius `r` rolls inside along the
//! surface, `φ - r|n|` is such a function as well, and its bound is the better one. Two gradients are tried, that at the cell's middle
//! and that at the best minimum so far. A cell whose bound is near
//! enough to the best minimum is done with; others are split in four. As A and B are symmetric, `φ(n) < φ(-n)` where
//! `n·c > 0`: half of the sphere is enough.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::continuation::settle;
use super::descent::Minimum;
use super::difference::{Difference, Triple, Values, cross, difference, dot, scaled, unit};
use super::proven::Proven;
use crate::numeric::lanes::{Job, Lane, dispatch};
use std::ops::Range;
use std::slice;

/// Cells of the first level along an edge of the cube, and those of the second in all.
const FIRST: usize = 4;
pub(super) const PARTS: usize = 4 * 6 * FIRST * FIRST;
/// A minimum explains where `φ` falls to it within this, in radians, and by this cosine at least: less strict misses
/// minima next to each other, stricter doubles the descents.
const NEIGHBOURHOOD: f64 = 0.5;
const STRAIGHT: f64 = 0.65;
/// Half width of cells below which a descent says more than smaller cells.
const SMALLEST: f64 = 0.04;
/// Minima this near to the best are as good, in the pair's size, and this far away, in radians, others.
const ALIKE: f64 = 1e-9;
const DISTINCT: f64 = 1e-4;
/// Minima that are told apart.
const MINIMA: usize = 64;

/// A square on a face `[-1, 1]²` of the cube.
#[derive(Clone, Copy, Debug)]
struct Cell {
    middle: [f64; 2],
    half: f64,
    /// The cell of the second level that it is part of; the first of four for one of the first.
    part: usize,
}

impl Cell {
    fn first(number: usize) -> Self {
        let half = 1.0 / FIRST as f64;
        let place = |k: usize| (2 * (k % FIRST) + 1) as f64 * half - 1.0;
        Self { middle: [place(number / FIRST), place(number)], half, part: 4 * number }
    }

    fn quarters(&self) -> [Self; 4] {
        let half = 0.5 * self.half;
        let next = usize::from(self.is_first());
        [(-half, -half, 0), (-half, half, 1), (half, -half, 2), (half, half, 3)].map(
            |(dx, dy, k)| {
                let middle = [self.middle[0] + dx, self.middle[1] + dy];
                Self { middle, half, part: self.part + k * next }
            },
        )
    }

    fn is_first(&self) -> bool {
        self.half == 1.0 / FIRST as f64
    }

    /// The cells of the second level that it covers or is part of.
    fn parts(&self) -> Range<usize> {
        self.part..self.part + if self.is_first() { 4 } else { 1 }
    }

    fn face(&self) -> usize {
        self.part / (4 * FIRST * FIRST)
    }
}

/// A face of the cube: the axis that it stands across and the two along it.
#[derive(Clone, Copy)]
struct Face {
    axes: [usize; 3],
    side: f64,
}

impl Face {
    const ALL: [Self; 6] =
        [Self::new(0), Self::new(1), Self::new(2), Self::new(3), Self::new(4), Self::new(5)];

    const fn new(number: usize) -> Self {
        let axis = number % 3;
        let side = if number < 3 { 1.0 } else { -1.0 };
        Self { axes: [axis, (axis + 1) % 3, (axis + 2) % 3], side }
    }

    /// The unit direction of a cell's middle.
    fn direction(&self, cell: &Cell) -> Triple {
        let mut m = [0.0; 3];
        m[self.axes[0]] = self.side;
        m[self.axes[1]] = cell.middle[0];
        m[self.axes[2]] = cell.middle[1];
        unit(&m)
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
    /// False where another direction is as good.
    pub(super) unique: bool,
}

/// Searches the sphere, given a minimum where the bodies overlap; cells are split until the bound is within
/// `tolerance` (in the pair's size) or `most` of them were looked at. What is proven of the pair already is left out, and
/// what is proven now is added.
pub(super) fn least(
    pair: &Difference,
    known: Minimum,
    proven: &mut Proven,
    tolerance: f64,
    most: usize,
) -> Least {
    if tolerance > 10.0 * <f32 as Precision>::SLACK {
        search::<f32, 16>(pair, known, proven, tolerance, most)
    } else {
        search::<f64, 8>(pair, known, proven, tolerance, most)
    }
}

/// What a bound loses to rounding in the pair's size: support points are taken as that much nearer to the centres.
trait Precision {
    const SLACK: f64;
}

impl Precision for f32 {
    const SLACK: f64 = 1e-5;
}

impl Precision for f64 {
    const SLACK: f64 = 1e-13;
}

fn search<T: Lane + Precision, const N: usize>(
    pair: &Difference,
    known: Minimum,
    proven: &mut Proven,
    tolerance: f64,
    most: usize,
) -> Least {
    let mut found = Least { minimum: known, bound: f64::INFINITY, unique: true };
    let mut minima = Vec::with_capacity(8);
    minima.push((known.expansion.value, known.normal[0]));
    let others = proven.minima.iter().filter(|m| m.0 > known.expansion.value + ALIKE);
    minima.extend(others);
    let mut looked_at = 0;
    let centres = Face::ALL.map(|face| face.local(&pair.centre));
    let mut open: Vec<Cell> = Vec::with_capacity(128);
    let mut start = |cell: Cell, bounds: &mut [f32]| {
        let seen = faces(&cell, &centres);
        bounds.fill(if seen { f32::INFINITY } else { f32::NEG_INFINITY });
        open.extend(seen.then_some(cell));
    };
    for (number, bounds) in proven.bounds.chunks_exact_mut(4).enumerate() {
        let cell = Cell::first(number);
        let due = |bound: f32| f64::from(bound) <= known.expansion.value + ALIKE;
        if bounds.iter().all(|bound| due(*bound)) {
            start(cell, bounds);
            continue;
        }
        for (quarter, bound) in cell.quarters().into_iter().zip(bounds) {
            if due(*bound) {
                start(quarter, slice::from_mut(bound));
            }
        }
    }
    while let Some(last) = open.last() {
        let mut cells = [*last; N];
        let taken = open.len().min(N);
        let from = open.len() - taken;
        cells[..taken].copy_from_slice(&open[from..]);
        open.truncate(from);
        let block = Block::<T, N>::new(pair, &cells, &found.minimum);
        looked_at += taken;
        for (i, cell) in cells[..taken].iter().enumerate() {
            let best = found.minimum.expansion.value;
            let own = block.own[i].wide() - T::SLACK;
            let bound = own.max(block.shared[i].wide() - T::SLACK);
            // might it hold a better minimum than those that are known?
            let hopeful = own < best && minima.len() < MINIMA && {
                let (middle, steep) = block.fall(i);
                !minima.iter().any(|(_, n)| falls_to(&middle, &steep, n))
            };
            let small = cell.half <= SMALLEST && bound >= best - tolerance;
            if block.values.value[i].wide() < best - T::SLACK || hopeful && small {
                let middle = Face::ALL[cell.face()].direction(cell);
                let other = settle(pair, &[middle, pair.to_b(&middle)], best + ALIKE);
                minima.push((other.expansion.value, other.normal[0]));
                if other.expansion.value < best {
                    found.minimum = other;
                }
            }
            let far = bound < found.minimum.expansion.value - tolerance;
            if looked_at < most && (far || hopeful && !small) {
                for quarter in cell.quarters() {
                    if faces(&quarter, &centres) {
                        open.push(quarter);
                    } else {
                        // not looked at, and may be wanted once B has moved
                        proven.bounds[quarter.part] = f32::NEG_INFINITY;
                    }
                }
            } else {
                found.bound = found.bound.min(bound);
                for proven in &mut proven.bounds[cell.parts()] {
                    *proven = proven.min(own as f32);
                }
            }
        }
    }
    let best = found.minimum.expansion.value;
    found.bound = found.bound.min(best);
    proven.remember(&minima);
    found.unique = !minima.iter().any(|(value, normal)| {
        let apart = difference(normal, &found.minimum.normal[0]);
        *value < best + ALIKE && dot(&apart, &apart) > DISTINCT * DISTINCT
    });
    found
}

/// What is known of some cells.
struct Block<T, const N: usize> {
    directions: [[T; N]; 3],
    values: Values<T, N>,
    /// Bounds of `φ` by the gradients at the middles, and by that at the best minimum.
    own: [T; N],
    shared: [T; N],
}

impl<T: Lane, const N: usize> Block<T, N> {
    fn new(pair: &Difference, cells: &[Cell; N], best: &Minimum) -> Self {
        let zero = [T::of(0.0); N];
        let mut block = Self {
            directions: [zero; 3],
            values: Values { value: zero, gradient: [zero; 3] },
            own: [T::of(f64::INFINITY); N],
            shared: [T::of(f64::INFINITY); N],
        };
        dispatch(Judgement { pair, cells, best: &best.expansion.gap, into: &mut block });
        block
    }

    /// The middle of a cell, and the gradient of `φ` there along the sphere.
    fn fall(&self, i: usize) -> (Triple, Triple) {
        let middle = self.directions.map(|v| v[i].wide());
        let gradient = self.values.gradient.map(|v| v[i].wide());
        (middle, difference(&gradient, &scaled(&middle, self.values.value[i].wide())))
    }
}

struct Judgement<'a, T, const N: usize> {
    pair: &'a Difference,
    cells: &'a [Cell; N],
    best: &'a Triple,
    into: &'a mut Block<T, N>,
}

impl<T: Lane, const N: usize> Job for Judgement<'_, T, N> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let zero = [T::of(0.0); N];
        let (mut x, mut y, mut half, mut side) = (zero, zero, zero, zero);
        // in each cell's own order of axes, and in arrays of their own, as only those become vectors
        let mut best = [zero; 3];
        for (i, cell) in self.cells.iter().enumerate() {
            x[i] = T::of(cell.middle[0]);
            y[i] = T::of(cell.middle[1]);
            half[i] = T::of(cell.half);
            let face = Face::ALL[cell.face()];
            side[i] = T::of(face.side);
            let [across, along, up] = face.local(self.best);
            best[0][i] = T::of(across);
            best[1][i] = T::of(along);
            best[2][i] = T::of(up);
        }
        let (one, ball) = (T::of(1.0), T::of(self.pair.rolling));
        let mut n = [zero; 3];
        for i in 0..N {
            n[0][i] = one / (one + x[i] * x[i] + y[i] * y[i]).sqrt();
            n[1][i] = x[i] * n[0][i];
            n[2][i] = y[i] * n[0][i];
        }
        let mut directions = [zero; 3];
        for (i, cell) in self.cells.iter().enumerate() {
            let [across, along, up] = Face::ALL[cell.face()].axes;
            directions[across][i] = side[i] * n[0][i];
            directions[along][i] = n[1][i];
            directions[up][i] = n[2][i];
        }
        let values = self.pair.values::<FUSED, T, N>(&directions);
        let mut v = [zero; 3];
        for (i, cell) in self.cells.iter().enumerate() {
            let [across, along, up] = Face::ALL[cell.face()].axes;
            v[0][i] = side[i] * values.gradient[across][i];
            v[1][i] = values.gradient[along][i];
            v[2][i] = values.gradient[up][i];
        }
        let mut own = [T::of(f64::INFINITY); N];
        let mut shared = own;
        // the corner that is farthest from the middle, as the cosine of the angle
        let mut widest = [one; N];
        for (dx, dy) in [(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)] {
            for i in 0..N {
                let (p, q) = (x[i] + T::of(dx) * half[i], y[i] + T::of(dy) * half[i]);
                let shorter = one / (one + p * p + q * q).sqrt();
                let middle = (n[0][i] + p * n[1][i] + q * n[2][i]) * shorter;
                let least = (v[0][i] + p * v[1][i] + q * v[2][i]) * shorter;
                let by_best = (best[0][i] + p * best[1][i] + q * best[2][i]) * shorter;
                own[i] = own[i].least(least - ball * middle);
                shared[i] = shared[i].least(by_best);
                widest[i] = widest[i].least(middle);
            }
        }
        let zero = T::of(0.0);
        let best_everywhere = T::of(-dot(self.best, self.best).sqrt());
        for i in 0..N {
            shared[i] = if shared[i] < zero { best_everywhere } else { shared[i] };
            // below 0 the least is not at a corner: that of the cone around the cell
            let radial = values.value[i] - ball;
            let square = v[0][i] * v[0][i] + v[1][i] * v[1][i] + v[2][i] * v[2][i];
            let square = square - ball * (values.value[i] + radial);
            let tangential = (square - radial * radial).most(zero).sqrt();
            let sine = (one - widest[i] * widest[i]).most(zero).sqrt();
            let inside = tangential * widest[i] < zero - radial * sine;
            let cone = radial * widest[i] - tangential * sine;
            let cone = if inside { zero - square.most(zero).sqrt() } else { cone };
            own[i] = ball + if own[i] < zero { cone } else { own[i] };
        }
        *self.into = Block { directions, values, own, shared };
    }
}

/// True where `φ`, of gradient `steep` along the sphere, falls towards a minimum near by.
fn falls_to(from: &Triple, steep: &Triple, minimum: &Triple) -> bool {
    let to = difference(minimum, from);
    let distance = dot(&to, &to).sqrt();
    let fall = -dot(steep, &to);
    distance < DISTINCT
        || distance < NEIGHBOURHOOD && fall > STRAIGHT * distance * dot(steep, steep).sqrt()
}

/// False where every direction of the cell looks away from B, whose centre is given in the order of axes of each face.
#[inline(always)]
fn faces(cell: &Cell, centres: &[Triple; 6]) -> bool {
    let ([x, y], centre) = (cell.middle, &centres[cell.face()]);
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
