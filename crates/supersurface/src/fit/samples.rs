//! Points spread evenly over a body, for what a likelihood at single points cannot say: how much of the surface was
//! seen, how the noise smears its corners.
//!
//! The surface is cut into cells by equal polar angles of both superellipses; a cell is drawn by its area, a place in it
//! by its angles. The point of the unit superellipse at polar angle `u` is `(cos u, sin u)/‖(cos u, sin u)‖` with
//! exponent `2/ε` (FORMULAS §0).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::parameters::Parameters;
use crate::Vector;
use crate::numeric::lanes::{Job, WIDTH, dispatch, exp, ln, sin_cos};
use crate::numeric::random::Stream;

/// Cells around, and from pole to pole (twice as many around the tube of a toroid).
const AROUND: usize = 48;
const UPWARDS: usize = 24;
/// Cells of a quarter of a superellipse where an octant stands for all.
const FINE: usize = 20;

/// Appends `count` points of the surface to `out`, in strata of equal area.
pub(super) fn sample(s: &Parameters, count: usize, random: &mut Stream, out: &mut Vec<Vector>) {
    let (low, rows) = if s.family.is_ring() { (-PI, 2 * UPWARDS) } else { (-FRAC_PI_2, UPWARDS) };
    let step = [PI / UPWARDS as f64, TAU / AROUND as f64];
    let nodes =
        |n: usize, low: f64, step: f64, e: f64| on_curve((0..=n).map(|i| low + step * i as f64), e);
    let upwards = nodes(rows, low, step[0], s.exponents[0]);
    let around = nodes(AROUND, 0.0, step[1], s.exponents[1]);
    let body = Body::new(s);
    let mut sums = Vec::with_capacity(rows * AROUND);
    let mut sum = 0.0;
    let row = |i: usize| {
        let up = upwards[i];
        around.iter().map(move |a| body.point(up, *a))
    };
    let (mut lower, mut upper): (Vec<Vector>, Vec<Vector>) = (row(0).collect(), Vec::new());
    for i in 0..rows {
        upper.clear();
        upper.extend(row(i + 1));
        for j in 0..AROUND {
            let across = (upper[j + 1] - lower[j]).cross(&(upper[j] - lower[j + 1]));
            sum += across.norm();
            sums.push(sum);
        }
        std::mem::swap(&mut lower, &mut upper);
    }
    if !(sum > 0.0 && sum.is_finite()) {
        return;
    }
    let mut cell = 0;
    let mut drawn = |k: usize| {
        let at = (k as f64 + random.uniform()) / count as f64 * sum;
        while cell + 1 < sums.len() && sums[cell] < at {
            cell += 1;
        }
        let (i, j) = (cell / AROUND, cell % AROUND);
        let u = low + step[0] * (i as f64 + random.uniform());
        (u, step[1] * (j as f64 + random.uniform()))
    };
    let (up, round): (Vec<f64>, Vec<f64>) = (0..count).map(&mut drawn).unzip();
    let up = on_curve(up.into_iter(), s.exponents[0]);
    let round = on_curve(round.into_iter(), s.exponents[1]);
    let places = up.into_iter().zip(round).map(|(up, round)| body.point(up, round));
    out.extend(places.map(|p| s.position + s.rotation * p));
}

/// Cells in a row of [`cells`].
pub(super) const fn columns(s: &Parameters) -> usize {
    if s.family.is_deformed() { AROUND } else { FINE }
}

/// Places of the undeformed body's first octant, or of a deformed body's whole surface, in the body's frame, with their
/// areas: sums over them change smoothly with the body.
pub(super) fn cells(s: &Parameters) -> Vec<(Vector, f64)> {
    let columns = columns(s);
    let (low, rows, step) = match (s.family.is_deformed(), s.family.is_ring()) {
        (true, _) => (-FRAC_PI_2, UPWARDS, PI / UPWARDS as f64),
        (false, true) => (0.0, 2 * FINE, FRAC_PI_2 / FINE as f64),
        (false, false) => (0.0, FINE, FRAC_PI_2 / FINE as f64),
    };
    // nodes and middles take turns
    let curve = |n: usize, low: f64, step: f64, e: f64| {
        on_curve((0..=2 * n).map(|i| low + 0.5 * step * i as f64), e)
    };
    let upwards = curve(rows, low, step, s.exponents[0]);
    let turn = if s.family.is_deformed() { TAU } else { FRAC_PI_2 } / columns as f64;
    let around = curve(columns, 0.0, turn, s.exponents[1]);
    let body = Body::new(s);
    let at = |i: usize, j: usize| body.point(upwards[i], around[j]);
    let mut out = Vec::with_capacity(rows * columns);
    for i in (1..2 * rows).step_by(2) {
        for j in (1..2 * columns).step_by(2) {
            let rising = at(i + 1, j + 1) - at(i - 1, j - 1);
            let falling = at(i - 1, j + 1) - at(i + 1, j - 1);
            out.push((at(i, j), 0.5 * rising.cross(&falling).norm()));
        }
    }
    out
}

/// The points of the unit superellipse at polar angles.
fn on_curve(angles: impl Iterator<Item = f64>, exponent: f64) -> Vec<[f64; 2]> {
    let mut points: Vec<[f64; 2]> = angles.map(|a| [a, 0.0]).collect();
    dispatch(OnCurve { points: &mut points, power: 2.0 / exponent });
    points
}

/// Angles become points.
struct OnCurve<'a> {
    points: &'a mut [[f64; 2]],
    power: f64,
}

impl Job for OnCurve<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        for block in self.points.chunks_mut(WIDTH) {
            let mut angles = [0.0; WIDTH];
            angles.iter_mut().zip(&*block).for_each(|(a, p)| *a = p[0]);
            // a loop, as closures are not compiled for wider registers
            let mut places = [[0.0; 2]; WIDTH];
            for i in 0..WIDTH {
                let (sin, cos) = sin_cos::<FUSED>(angles[i]);
                let (u, v) = (cos.abs(), sin.abs());
                let (large, small) = if u > v { (u, v) } else { (v, u) };
                let ratio = small / large;
                let ratio = if ratio > 1e-300 { ratio } else { 1e-300 };
                let t = exp::<FUSED>(self.power * ln::<FUSED>(ratio));
                let length = large * exp::<FUSED>(ln::<FUSED>(1.0 + t) / self.power);
                places[i] = [cos / length, sin / length];
            }
            block.copy_from_slice(&places[..block.len()]);
        }
    }
}

/// A body and its semi-axes.
#[derive(Clone, Copy)]
struct Body<'a> {
    s: &'a Parameters,
    axes: [f64; 3],
    ring: f64,
}

impl<'a> Body<'a> {
    fn new(s: &'a Parameters) -> Self {
        let ring = if s.family.is_ring() { s.ring } else { 0.0 };
        Self { s, axes: s.log_axes.map(f64::exp), ring }
    }

    /// The point of the surface, in the body's frame, that is made of points of the two superellipses.
    fn point(&self, [out, up]: [f64; 2], [x, y]: [f64; 2]) -> Vector {
        let [a, b, c] = self.axes;
        let radius = self.ring + out;
        self.s.deformed(&Vector::new(a * radius * x, b * radius * y, c * up))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::columns::tests::some_body;
    use crate::fit::columns::{Evaluation, Sample};
    use crate::fit::parameters::Family;

    #[test]
    fn samples_lie_on_the_body() {
        let mut random = Stream::new(9, 0);
        for case in 0..60 {
            let s = some_body(Family::ALL[case % 6], &mut random);
            let mut points = Vec::new();
            sample(&s, 200, &mut random, &mut points);
            let mut all = Evaluation::<f64>::default();
            all.fill_distances(&s, &Sample::new(points.iter().copied()));
            let worst = all.distances[..200].iter().fold(0.0f64, |m, d| m.max(d.abs()));
            assert!(worst < 1e-6, "case {case}: {worst}");
        }
    }
}
