//! Points spread evenly over a body, for what a likelihood at single points cannot say: how much of the surface was
//! seen, how the noise smears its corners.
//!
//! The surface is cut into cells by equal polar angles of both superellipses; a cell is drawn by its area, a place in it
//! by its angles. The point of the unit superellipse at polar angle `u` is `(cos u, sin u)/‖(cos u, sin u)‖` with
//! exponent `2/ε` (FORMULAS §0).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::parameters::Parameters;
use crate::Vector;
use crate::numeric::random::Stream;
use crate::numeric::superellipse::norm;

/// Cells around, and from pole to pole (twice as many around the tube of a toroid).
const AROUND: usize = 48;
const UPWARDS: usize = 24;
/// Cells of a quarter of a superellipse where an octant stands for all.
const FINE: usize = 20;

/// Appends `count` points of the surface to `out`, in strata of equal area.
pub(super) fn sample(s: &Parameters, count: usize, random: &mut Stream, out: &mut Vec<Vector>) {
    let (low, rows) = if s.family.is_ring() { (-PI, 2 * UPWARDS) } else { (-FRAC_PI_2, UPWARDS) };
    let step = [PI / UPWARDS as f64, TAU / AROUND as f64];
    let nodes = |n: usize, low: f64, step: f64, e: f64| -> Vec<[f64; 2]> {
        (0..=n).map(|i| on_curve(low + step * i as f64, e)).collect()
    };
    let upwards = nodes(rows, low, step[0], s.exponents[0]);
    let around = nodes(AROUND, 0.0, step[1], s.exponents[1]);
    let corner = |i: usize, j: usize| s.deformed(&place(s, upwards[i], around[j]));
    let mut sums = Vec::with_capacity(rows * AROUND);
    let mut sum = 0.0;
    let mut lower: Vec<Vector> = (0..=AROUND).map(|j| corner(0, j)).collect();
    for i in 0..rows {
        let upper: Vec<Vector> = (0..=AROUND).map(|j| corner(i + 1, j)).collect();
        for j in 0..AROUND {
            let across = (upper[j + 1] - lower[j]).cross(&(upper[j] - lower[j + 1]));
            sum += across.norm();
            sums.push(sum);
        }
        lower = upper;
    }
    if !(sum > 0.0 && sum.is_finite()) {
        return;
    }
    let mut cell = 0;
    for k in 0..count {
        let at = (k as f64 + random.uniform()) / count as f64 * sum;
        while cell + 1 < sums.len() && sums[cell] < at {
            cell += 1;
        }
        let (i, j) = (cell / AROUND, cell % AROUND);
        let u = low + step[0] * (i as f64 + random.uniform());
        let v = step[1] * (j as f64 + random.uniform());
        let p = place(s, on_curve(u, s.exponents[0]), on_curve(v, s.exponents[1]));
        out.push(s.position + s.rotation * s.deformed(&p));
    }
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
    let curve = |n: usize, low: f64, step: f64, e: f64| -> Vec<[f64; 2]> {
        (0..=2 * n).map(|i| on_curve(low + 0.5 * step * i as f64, e)).collect()
    };
    let upwards = curve(rows, low, step, s.exponents[0]);
    let turn = if s.family.is_deformed() { TAU } else { FRAC_PI_2 } / columns as f64;
    let around = curve(columns, 0.0, turn, s.exponents[1]);
    let at = |i: usize, j: usize| s.deformed(&place(s, upwards[i], around[j]));
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

/// The point of the unit superellipse at a polar angle.
fn on_curve(angle: f64, e: f64) -> [f64; 2] {
    let (sin, cos) = angle.sin_cos();
    let length = norm(cos.abs(), sin.abs(), 2.0 / e);
    [cos / length, sin / length]
}

fn place(s: &Parameters, [out, up]: [f64; 2], [x, y]: [f64; 2]) -> Vector {
    let [a, b, c] = s.log_axes.map(f64::exp);
    let radius = if s.family.is_ring() { s.ring + out } else { out };
    Vector::new(a * radius * x, b * radius * y, c * up)
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
            let mut all = Evaluation::default();
            all.fill_distances(&s, &Sample::new(points.iter().copied()));
            let worst = all.distances[..200].iter().fold(0.0f64, |m, d| m.max(d.abs()));
            assert!(worst < 1e-6, "case {case}: {worst}");
        }
    }
}
