//! Parametric form and normal (equation 7 and FORMULAS §6).

use std::f64::consts::{FRAC_PI_2, PI};

use super::Superellipsoid;
use crate::numeric::powers::{quadrant_cos_sin, signed_power};
use crate::numeric::quarter_angle::QuarterAngle;
use crate::shape::Parametric;
use crate::shape::angular::{layered_normal, layered_tangents};
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
        layered_tangents(self.semi_axes, 0.0, self.exponents, eta, omega)
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        layered_normal(self.semi_axes, self.exponents, eta, omega)
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
