//! The pieces that parametric forms share: signed powers of angles, their slopes, unit normals.

use crate::numeric::powers::{quadrant_cos_sin, signed_power, signed_power_slope};
use crate::{Direction, Vector};

/// `(cos^ε ω, sin^ε ω)` with signed powers: the unit superellipse.
pub(super) fn superellipse(omega: f64, e: f64) -> [f64; 2] {
    let (c, s) = quadrant_cos_sin(omega);
    [signed_power(c, e), signed_power(s, e)]
}

/// Its derivatives by ω; `None` where one is infinite.
pub(super) fn superellipse_slopes(omega: f64, e: f64) -> Option<[f64; 2]> {
    let (c, s) = quadrant_cos_sin(omega);
    Some([-signed_power_slope(c, e)? * s, signed_power_slope(s, e)? * c])
}

/// `(cos^(2-ε) ω, sin^(2-ε) ω)`, the direction of its normal; `None` on a corner or cusp (ε from 2).
pub(super) fn superellipse_normal(omega: f64, e: f64) -> Option<[f64; 2]> {
    let (c, s) = quadrant_cos_sin(omega);
    Some([normal_power(c, e)?, normal_power(s, e)?])
}

/// `b^(2-ε)` with its sign; `None` at 0 for ε from 2, where it has no limit.
pub(super) fn normal_power(b: f64, e: f64) -> Option<f64> {
    (b != 0.0 || e < 2.0).then(|| signed_power(b, 2.0 - e))
}

/// The unit vector along `n`; `None` for a vector that has no direction or overflows.
pub(super) fn unit(n: Vector) -> Option<Direction> {
    // scaled first, so that the squares do not overflow
    let (largest, finite) = (n.amax(), n.iter().all(|v| v.is_finite()));
    (largest > 0.0 && finite).then(|| Direction::new_normalize(n / largest))
}

/// Both tangents, where all their components are finite.
pub(super) fn finite(tangents: [Vector; 2]) -> Option<[Vector; 2]> {
    tangents.iter().flat_map(Vector::iter).all(|v| v.is_finite()).then_some(tangents)
}

/// `ν = (cos^(2-ε1) η cos^(2-ε2) ω / a1, cos^(2-ε1) η sin^(2-ε2) ω / a2, sin^(2-ε1) η / a3)`, normalised (FORMULAS §6).
/// Superellipsoid and supertoroid share it. `None` on the seams and poles that exponents from 2 turn into edges and
/// cusps.
pub(super) fn layered_normal(
    [a1, a2, a3]: [f64; 3],
    [e1, e2]: [f64; 2],
    eta: f64,
    omega: f64,
) -> Option<Direction> {
    let [c, s] = superellipse_normal(eta, e1)?;
    // at a pole all meridians meet
    let [x, y] = if c == 0.0 { [0.0; 2] } else { superellipse_normal(omega, e2)? };
    unit(Vector::new(c * x / a1, c * y / a2, s / a3))
}

/// Derivatives of `(a1 r cos^ε2 ω, a2 r sin^ε2 ω, a3 sin^ε1 η)` with `r = ring + cos^ε1 η` by both angles; the ring of a
/// superellipsoid is 0.
pub(super) fn layered_tangents(
    [a1, a2, a3]: [f64; 3],
    ring: f64,
    [e1, e2]: [f64; 2],
    eta: f64,
    omega: f64,
) -> Option<[Vector; 2]> {
    let ([c, _], [x, y]) = (superellipse(eta, e1), superellipse(omega, e2));
    let ([dc, ds], [dx, dy]) = (superellipse_slopes(eta, e1)?, superellipse_slopes(omega, e2)?);
    let r = ring + c;
    finite([
        Vector::new(a1 * dc * x, a2 * dc * y, a3 * ds),
        Vector::new(a1 * r * dx, a2 * r * dy, 0.0),
    ])
}
