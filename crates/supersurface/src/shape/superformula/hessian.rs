//! Second derivatives of the supershape's gauge.
//!
//! A function `f = ρ k(θ)` of polar coordinates has the second derivatives `(k + k'')/ρ t tᵀ` with the direction t around.
//! The gauge is two of them, one in the other: `u = ρ/r1(θ)` and `g = s/r2(φ)` with `s = √(u² + z²)`, `φ = atan2(z, u)`.
//! With `k = 1/r` and `L = r'/r`: `k + k'' = (1 + L² - L')/r`.

use nalgebra::{Matrix2, Matrix3, Vector2};

use super::{Superformula, Supershape};
use crate::numeric::powers::quadrant_cos_sin;
use crate::shape::SecondOrder;
use crate::{Point, Vector};

/// `ρ/r(θ)` at `ρ = 1`: gradient and second derivatives.
fn polar(curve: &Superformula, angle: f64) -> Option<(Vector2<f64>, Matrix2<f64>)> {
    let (cos, sin) = quadrant_cos_sin(angle);
    let (slope, bend) = (curve.log_slope(angle)?, curve.log_curvature(angle)?);
    let (out, around) = (Vector2::new(cos, sin), Vector2::new(-sin, cos));
    let k = 1.0 / curve.radius(angle);
    let second = around * around.transpose() * (k * (1.0 + slope * slope - bend));
    Some(((out - around * slope) * k, second))
}

impl SecondOrder for Supershape {
    /// `None` at the origin, on the z axis, and where a curve has no second derivative.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let (theta, phi, distance) = self.angles(p);
        let radius = p.x.hypot(p.y);
        if radius == 0.0 || distance == 0.0 {
            return None;
        }
        let (around, around_second) = polar(self.longitude(), theta)?;
        let (along, along_second) = polar(self.latitude(), phi)?;
        let du = Vector::new(around.x, around.y, 0.0);
        let mut second_u = Matrix3::zeros();
        second_u.fixed_view_mut::<2, 2>(0, 0).copy_from(&(around_second / radius));
        let dz = Vector::z();
        let m = along_second / distance;
        let mixed = du * dz.transpose() * m[(0, 1)];
        let hessian = second_u * along.x
            + du * du.transpose() * m[(0, 0)]
            + mixed
            + mixed.transpose()
            + dz * dz.transpose() * m[(1, 1)];
        hessian.iter().all(|v| v.is_finite()).then_some(hessian)
    }
}
