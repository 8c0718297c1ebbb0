//! Second derivatives of the supershape's gauge.
//!
//! In a plane `q = ρ h(θ)` has the second derivatives `(h + h'')/ρ t tᵀ` with the unit vector t across the ray; with
//! `h = 1/r` and `L = r'/r` this is `h (1 + L² - L')/ρ`. The gauge is such a q of `(u, z)`, and u one of `(x, y)`:
//! `∇∇g = g_u ∇∇u + h2 (1 + L2² - L2')/√(u² + z²) v vᵀ` with `v = -sinφ ∇u + cosφ e_z`.

use nalgebra::Matrix3;

use super::{Superformula, Supershape};
use crate::numeric::powers::quadrant_cos_sin;
use crate::shape::SecondOrder;
use crate::{Point, Vector};

/// Slope of the logarithm of a curve and `h (1 + L² - L')`.
fn bend(curve: &Superformula, angle: f64) -> Option<[f64; 2]> {
    let slope = curve.log_slope(angle)?;
    Some([slope, (1.0 + slope * slope - curve.log_bend(angle)?) / curve.radius(angle)])
}

impl SecondOrder for Supershape {
    /// `None` also on the whole z axis.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        // homogeneous of degree -1
        let size = p.coords.amax();
        let q = Point::from(p.coords / size);
        let (theta, phi, distance) = self.angles(&q);
        let radius = q.x.hypot(q.y);
        if !(radius > 0.0 && radius.is_finite()) {
            return None;
        }
        let ([turn, around], [tilt, along]) =
            (bend(self.longitude(), theta)?, bend(self.latitude(), phi)?);
        let ((ct, st), (cp, sp)) = (quadrant_cos_sin(theta), quadrant_cos_sin(phi));
        let by_u = (cp + tilt * sp) / self.latitude().radius(phi);
        let slope_u =
            Vector::new(ct + turn * st, st - turn * ct, 0.0) / self.longitude().radius(theta);
        let side = Vector::new(-st, ct, 0.0);
        let across = Vector::z() * cp - slope_u * sp;
        let hessian = side * side.transpose() * (by_u * around / radius)
            + across * across.transpose() * (along / distance);
        let hessian = hessian / size;
        hessian.iter().all(|v| v.is_finite()).then_some(hessian)
    }
}
