//! Second derivatives of a hyperquadric's gauge.
//!
//! Of a convex one by differentiating `F(c + b) = 1`, `b = (p - c)/g`, twice: with `n = ∇F(c + b)`, `∇g = n/(n·b)` and
//! `P = I - b ∇gᵀ` it is `Pᵀ ∇∇F P/(g n·b)`. Of another one those of `F^{1/ε}` with the largest exponent:
//! `g/ε (∇∇F/F + (1/ε - 1) ∇F ∇Fᵀ/F²)`.

use nalgebra::Matrix3;

use super::Hyperquadric;
use crate::Point;
use crate::shape::{Implicit, SecondOrder};

impl SecondOrder for Hyperquadric {
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let hessian = if self.convex { self.about_interior(p) } else { self.of_power(p) }?;
        hessian.iter().all(|v| v.is_finite()).then_some(hessian)
    }
}

impl Hyperquadric {
    fn about_interior(&self, p: &Point) -> Option<Matrix3<f64>> {
        let ray = p - self.interior;
        let (g, gradient) = self.radial_gauge(&ray);
        if !(g > 0.0 && g.is_finite()) {
            return None;
        }
        let b = ray / g;
        let foot = self.interior + b;
        let across = Matrix3::identity() - b * gradient.transpose();
        let bend = self.form.hessian(&foot)? / self.form.slope(&foot).dot(&b);
        let hessian = across.transpose() * bend * across / g;
        Some((hessian + hessian.transpose()) * 0.5)
    }

    fn of_power(&self, p: &Point) -> Option<Matrix3<f64>> {
        let (value, rest) = (self.form.value(p), 1.0 / self.largest_exponent());
        let (slope, bend) = (self.form.gradient(p)? / value, self.form.hessian(p)? / value);
        let log = bend + slope * slope.transpose() * (rest - 1.0);
        Some(log * (self.gauge(p) * rest))
    }
}
