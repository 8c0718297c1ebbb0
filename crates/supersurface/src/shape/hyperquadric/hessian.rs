//! Second derivatives of the hyperquadric's gauge.
//!
//! About the inner point c of a convex solid the gauge is homogeneous, `F(c + d/g(d)) = 1`. With `y = c + d/g`,
//! `v = y - c`, `s = v·∇F(y)` and `q = ∇g = ∇F/s`: `∇∇g = (I - q vᵀ) ∇∇F(y) (I - v qᵀ)/(s g)`. Otherwise the gauge is
//! `F^(1/E)` with the largest exponent E.

use nalgebra::Matrix3;

use super::Hyperquadric;
use crate::Point;
use crate::shape::{Implicit, SecondOrder};

impl SecondOrder for Hyperquadric {
    /// `None` at the inner point, on a term's plane where its exponent is under 2, and where a number overflows.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let gauge = self.gauge(p);
        let hessian = if self.convex {
            let v = (p - self.interior) / gauge;
            let y = self.interior + v;
            let (slope, second) = (self.form.gradient(&y)?, self.form.hessian(&y)?);
            let s = slope.dot(&v);
            let side = Matrix3::identity() - v * (slope / s).transpose();
            side.transpose() * second * side / (s * gauge)
        } else {
            let (value, share) = (self.form.value(p), 1.0 / self.largest_exponent());
            let relative = self.form.gradient(p)? / value;
            let bend = relative * relative.transpose() * (share - 1.0);
            (self.form.hessian(p)? / value + bend) * (share * gauge)
        };
        hessian.iter().all(|v| v.is_finite()).then_some(hessian)
    }
}
