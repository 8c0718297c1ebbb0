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
use super::difference::{Difference, Triple, Values, cross, difference, dot, narrow, scaled, unit};
use crate::numeric::lanes::{Job, Lane, dispatch};

/// Cells of the first level along an edge of the cube.
const FIRST: usize = 4;
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

/// A square on the face `[-1, 1]²`.
#[derive(Clone, Copy, Debug)]
struct Cell {
    middle: [f64; 2],
    half: f64,
}

impl Cell {
    fn quarters(&self) -> [Self; 4] {
        let half = 0.5 * self.half;
        [(-half, -half), (-half, half), (half, -half), (half, half)]
            .map(|(dx, dy)| Self { middle: [self.middle[0] + dx, self.middle[1] + dy], half })
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
/// `tolerance` (in the pair's size) or `most` of them were looked at.
pub(super) fn least(pair: &Difference, known: Minimum, tolerance: f64, most: usize) -> Least {
    if tolerance > 10.0 * <f32 as Precision>::SLACK {
        search::<f32, 16>(pair, known, tolerance, most)
    } else {
        search::<f64, 8>(pair, known, tolerance, most)
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
    tolerance: f64,
    most: usize,
) -> Least {
    let mut found = Least { minimum: known, bound: f64::INFINITY, unique: true };
    let mut minima = vec![known];
    let mut looked_at = 0;
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
        while let Some(last) = open.last() {
            let mut cells = [*last; N];
            let taken = open.len().min(N);
            let from = open.len() - taken;
            cells[..taken].copy_from_slice(&open[from..]);
            open.truncate(from);
            let block = Block::<T, N>::new(pair, face, &cells, &found.minimum);
            looked_at += taken;
            for (i, cell) in cells[..taken].iter().enumerate() {
                let best = found.minimum.expansion.value;
                let own = block.own[i].wide() - T::SLACK;
                let bound = own.max(block.shared[i].wide() - T::SLACK);
                // might it hold a better minimum than those that are known?
                let hopeful = own < best && minima.len() < MINIMA && {
                    let (middle, steep) = block.fall(i);
                    !minima.iter().any(|m| falls_to(&middle, &steep, &m.normal[0]))
                };
                let small = cell.half <= SMALLEST && bound >= best - tolerance;
                if block.values.value[i].wide() < best - T::SLACK || hopeful && small {
                    let middle = face.direction(cell);
                    let other = settle(pair, &[middle, pair.to_b(&middle)]);
                    minima.push(other);
                    if other.expansion.value < best {
                        found.minimum = other;
                    }
                }
                let far = bound < found.minimum.expansion.value - tolerance;
                if looked_at < most && (far || hopeful && !small) {
                    open.extend(cell.quarters().iter().filter(|c| faces(c, &centre)));
                } else {
                    found.bound = found.bound.min(bound);
                }
            }
        }
    }
    let best = found.minimum.expansion.value;
    found.bound = found.bound.min(best);
    found.unique = !minima.iter().any(|m| {
        let apart = difference(&m.normal[0], &found.minimum.normal[0]);
        m.expansion.value < best + ALIKE && dot(&apart, &apart) > DISTINCT * DISTINCT
    });
    found
}

/// What is known of some cells of a face.
struct Block<T, const N: usize> {
    directions: [[T; N]; 3],
    values: Values<T, N>,
    /// Bounds of `φ` by the gradients at the middles, and by that at the best minimum.
    own: [T; N],
    shared: [T; N],
}

impl<T: Lane, const N: usize> Block<T, N> {
    fn new(pair: &Difference, face: Face, cells: &[Cell; N], best: &Minimum) -> Self {
        let zero = [T::of(0.0); N];
        let mut block = Self {
            directions: [zero; 3],
            values: Values { value: zero, gradient: [zero; 3] },
            own: [T::of(f64::INFINITY); N],
            shared: [T::of(f64::INFINITY); N],
        };
        let best = narrow(&face.local(&best.expansion.gap));
        dispatch(Judgement { pair, face, cells, best, into: &mut block });
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
    face: Face,
    cells: &'a [Cell; N],
    best: [T; 3],
    into: &'a mut Block<T, N>,
}

impl<T: Lane, const N: usize> Job for Judgement<'_, T, N> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let zero = [T::of(0.0); N];
        let (mut x, mut y, mut half) = (zero, zero, zero);
        for (i, cell) in self.cells.iter().enumerate() {
            x[i] = T::of(cell.middle[0]);
            y[i] = T::of(cell.middle[1]);
            half[i] = T::of(cell.half);
        }
        let [across, along, up] = self.face.axes;
        let (one, side, ball) = (T::of(1.0), T::of(self.face.side), T::of(self.pair.rolling));
        // in the face's order of axes, and in arrays of their own, as only those become vectors
        let mut n = [zero; 3];
        for i in 0..N {
            n[0][i] = one / (one + x[i] * x[i] + y[i] * y[i]).sqrt();
            n[1][i] = x[i] * n[0][i];
            n[2][i] = y[i] * n[0][i];
        }
        let mut directions = [n[0]; 3];
        directions[along] = n[1];
        directions[up] = n[2];
        for i in 0..N {
            directions[across][i] = side * n[0][i];
        }
        let values = self.pair.values::<FUSED, T, N>(&directions);
        let mut v = [values.gradient[across], values.gradient[along], values.gradient[up]];
        for i in 0..N {
            v[0][i] = side * v[0][i];
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
                let by_best = (self.best[0] + p * self.best[1] + q * self.best[2]) * shorter;
                own[i] = own[i].least(least - ball * middle);
                shared[i] = shared[i].least(by_best);
                widest[i] = widest[i].least(middle);
            }
        }
        let zero = T::of(0.0);
        let [p, q, r] = self.best;
        let best_everywhere = zero - (p * p + q * q + r * r).sqrt();
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
