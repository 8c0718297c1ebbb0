//! The hot loop: first-order distance `(g - 1)/|∇g|` of a point with its complete derivative.
//!
//! It is the radial distance times the cosine between ray and normal, within second order of the
//! Euclidean distance. The derivative includes that of `|∇g|`: with that factor frozen the solver stops
//! far from the optimum. In the weights of FORMULAS §0 the gradient's components are
//! `v_x = g w1 w2 / x` (toroid: times `ρ̂/τ`, `τ = ρ̂ - a4`), `v_y = g w1 (1 - w2) / y`,
//! `v_z = g (1 - w1) / z`, so that all differentials are linear in those of `ln|x/a1|`, `ln|y/a2|`,
//! `ln|z/a3|`, `a4`, `ε1`, `ε2`:
//!
//! ```text
//! dρ    = w2 dlx + (1 - w2) dly + S(w2)/2 dε2           (of ln ρ̂)
//! dτ    = (ρ̂ dρ - da4)/τ                                (of ln|τ|; the superellipsoid has dτ = dρ)
//! dg    = w1 dτ + (1 - w1) dlz + S(w1)/2 dε1            (of ln g)
//! ds2   = p2 (dlx - dly) - s2/ε2 dε2,   ds1 = p1 (dτ - dlz) - s1/ε1 dε1
//! d ln w2 = (1 - w2) ds2,  d ln (1 - w2) = -w2 ds2,  likewise w1
//! d dist  = dg/|v| - dist Σ b_i (d ln v_i - dg),        b_i = v_i²/|v|²
//! ```

use super::parameters::{COUNT, EXPONENT, Family, Parameters, RING, Row};
use crate::Vector;
use crate::numeric::superellipse::log_layer;

/// Coordinates nearer to a symmetry plane than this are pushed off it: the limits are the same.
const FLOOR: f64 = 1e-7;

/// Distance of one point and, with `JACOBIAN`, its derivatives by all parameters.
#[inline]
pub(super) fn distance<const JACOBIAN: bool>(s: &Parameters, x: &Vector, row: &mut Row) -> f64 {
    let q = s.rotation.inverse_transform_vector(&(x - s.position)).map(off_plane);
    let [e1, e2] = s.exponents;
    let (p1, p2) = (2.0 / e1, 2.0 / e2);
    let log = |i: usize| q[i].abs().ln() - s.log_axes[i];
    let planar = log_layer(log(0), log(1), p2);
    let toroid = s.family == Family::Supertoroid;
    let (radius, offset, log_offset) = if toroid {
        let radius = planar.log_norm.exp();
        let offset = off_plane(radius - s.ring);
        (radius, offset, offset.abs().ln())
    } else {
        (1.0, 1.0, planar.log_norm)
    };
    let whole = log_layer(log_offset, log(2), p1);
    let g = whole.log_norm.exp();
    let across = g * whole.first * radius / offset;
    let v = Vector::new(
        across * planar.first / q.x,
        across * planar.second / q.y,
        g * whole.second / q.z,
    );
    let steepness = v.norm().max(1e-9);
    let dist = (g - 1.0) / steepness;
    if !JACOBIAN {
        return dist;
    }

    let b = v.component_mul(&v) / (steepness * steepness);
    let by_gauge = 1.0 / steepness;
    let by_s1 = -dist * ((b.x + b.y) * whole.second - b.z * whole.first);
    let by_s2 = -dist * (b.x * planar.second - b.y * planar.first);
    let by_ring = if toroid { -dist * (b.x + b.y) } else { 0.0 };
    // chain rule backwards: g and s1 through τ, τ through ρ
    let by_offset = by_gauge * whole.first + by_s1 * p1 - by_ring;
    let by_radius = by_ring + if toroid { by_offset * radius / offset } else { by_offset };
    let by_log = Vector::new(
        by_radius * planar.first + by_s2 * p2,
        by_radius * planar.second - by_s2 * p2,
        by_gauge * whole.second - by_s1 * p1,
    );
    for i in 0..3 {
        row[i] = -by_log[i];
    }
    row[RING] = if toroid { -by_offset / offset } else { 0.0 };
    row[EXPONENT] = 0.5 * by_gauge * whole.entropy - by_s1 * whole.spread / e1;
    row[EXPONENT + 1] = 0.5 * by_radius * planar.entropy - by_s2 * planar.spread / e2;
    let by_q = (by_log + dist * b).component_div(&q);
    let by_position = -(s.rotation * by_q);
    let by_rotation = by_q.cross(&q);
    for i in 0..3 {
        row[6 + i] = by_position[i];
        row[9 + i] = by_rotation[i];
    }
    for value in row.iter_mut().take(COUNT) {
        if !value.is_finite() {
            *value = 0.0;
        }
    }
    dist
}

#[inline]
fn off_plane(v: f64) -> f64 {
    if v.abs() < FLOOR { FLOOR.copysign(v) } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use nalgebra::Rotation3;

    #[test]
    fn the_derivative_is_complete() {
        let mut random = Stream::new(3, 0);
        let mut worst = 0.0f64;
        for case in 0..400 {
            let family = if case % 2 == 0 { Family::Superellipsoid } else { Family::Supertoroid };
            let s = Parameters {
                family,
                log_axes: std::array::from_fn(|_| random.between(-0.8, 0.3)),
                ring: random.between(1.3, 4.0),
                exponents: std::array::from_fn(|_| random.between(0.25, 1.8)),
                position: Vector::from_fn(|_, _| random.between(-0.2, 0.2)),
                rotation: Rotation3::new(Vector::from_fn(|_, _| random.normal())),
            };
            let x = Vector::from_fn(|_, _| random.between(-2.5, 2.5));
            let mut row = [0.0; COUNT];
            let d = distance::<true>(&s, &x, &mut row);
            if d.is_nan() || d.abs() >= 1.0 {
                continue;
            }
            for (k, analytic) in row.iter().enumerate().filter(|(k, _)| s.is_active(*k)) {
                let h = 1e-6;
                let at = |sign: f64| {
                    let mut step = [0.0; COUNT];
                    step[k] = sign * h;
                    distance::<false>(&s.stepped(&step), &x, &mut [0.0; COUNT])
                };
                let numeric = (at(1.0) - at(-1.0)) / (2.0 * h);
                let error = (numeric - analytic).abs() / (1.0 + analytic.abs());
                worst = worst.max(error);
                assert!(error < 1e-4, "case {case} parameter {k}: {numeric} against {analytic}");
            }
        }
        assert!(worst > 0.0);
    }
}
