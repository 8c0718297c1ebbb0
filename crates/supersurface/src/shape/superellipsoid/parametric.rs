//! Parametric form and normal (equation 7 and FORMULAS §6).

use std::f64::consts::{FRAC_PI_2, PI};

use super::Superellipsoid;
use crate::numeric::powers::{quadrant_cos_sin, signed_power};
use crate::numeric::quarter_angle::QuarterAngle;
use crate::shape::Parametric;
use crate::{Direction, Point, Vector};

impl Parametric for Superellipsoid {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]]
    }

    /// `(a1 cos^ε1 η cos^ε2 ω, a2 cos^ε1 η sin^ε2 ω, a3 sin^ε1 η)` with signed powers;
    /// η in [-π/2, π/2], ω in [-π, π).
    fn point(&self, eta: f64, omega: f64) -> Point {
        self.place(quadrant_cos_sin(eta), quadrant_cos_sin(omega))
    }

    fn point_at(&self, eta: QuarterAngle, omega: QuarterAngle) -> Point {
        self.place(eta.cos_sin(), omega.cos_sin())
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        angular_tangents(self.semi_axes, 0.0, self.exponents, eta, omega)
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        angular_normal(self.semi_axes, self.exponents, eta, omega)
    }
}

impl Superellipsoid {
    /// The point for cosines and sines of the angles.
    fn place(&self, (ce, se): (f64, f64), (co, so): (f64, f64)) -> Point {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let c = signed_power(ce, e1);
        let (x, y) = (signed_power(co, e2), signed_power(so, e2));
        Point::new(a1 * c * x, a2 * c * y, a3 * signed_power(se, e1))
    }
}

/// `ν = (cos^(2-ε1) η cos^(2-ε2) ω / a1, cos^(2-ε1) η sin^(2-ε2) ω / a2, sin^(2-ε1) η / a3)`,
/// normalised. Superellipsoid and supertoroid share it. `None` on the seams and poles that exponents from 2
/// turn into edges and cusps.
pub(crate) fn angular_normal(
    [a1, a2, a3]: [f64; 3],
    [e1, e2]: [f64; 2],
    eta: f64,
    omega: f64,
) -> Option<Direction> {
    let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
    let smooth = |b: f64, e: f64| (b != 0.0 || e < 2.0).then(|| signed_power(b, 2.0 - e));
    let (c, s) = (smooth(ce, e1)?, smooth(se, e1)?);
    let (x, y) = if c == 0.0 { (0.0, 0.0) } else { (smooth(co, e2)?, smooth(so, e2)?) };
    let n = Vector::new(c * x / a1, c * y / a2, s / a3);
    // scaled first: 1/a overflows nothing but the sum of squares of 1e200 would
    let (largest, finite) = (n.amax(), n.iter().all(|v| v.is_finite()));
    (largest > 0.0 && finite).then(|| Direction::new_normalize(n / largest))
}

/// Derivatives of `(a1 r cos^ε2 ω, a2 r sin^ε2 ω, a3 sin^ε1 η)` with `r = a4 + cos^ε1 η` (a4 = 0 for a
/// superellipsoid), by `d cos^ε/dη = -ε |cos|^(ε-1) sin` and `d sin^ε/dη = ε |sin|^(ε-1) cos`.
pub(crate) fn angular_tangents(
    [a1, a2, a3]: [f64; 3],
    ring: f64,
    [e1, e2]: [f64; 2],
    eta: f64,
    omega: f64,
) -> Option<[Vector; 2]> {
    let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
    let slopes = |c: f64, s: f64, e: f64| {
        let steep = |b: f64| match (b == 0.0, e - 1.0) {
            (true, rest) if rest < 0.0 => None,
            (true, rest) => Some(f64::from(rest == 0.0)),
            (false, rest) => Some(signed_power(b.abs(), rest)),
        };
        Some([-e * steep(c)? * s, e * steep(s)? * c])
    };
    let ([dc, ds], [dx, dy]) = (slopes(ce, se, e1)?, slopes(co, so, e2)?);
    let r = ring + signed_power(ce, e1);
    let (x, y) = (signed_power(co, e2), signed_power(so, e2));
    let along = Vector::new(a1 * dc * x, a2 * dc * y, a3 * ds);
    let around = Vector::new(a1 * r * dx, a2 * r * dy, 0.0);
    let finite = along.iter().chain(around.iter()).all(|v| v.is_finite());
    finite.then_some([along, around])
}
