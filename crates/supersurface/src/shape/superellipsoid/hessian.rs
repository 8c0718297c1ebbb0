//! Second derivatives of the gauge, layer by layer.
//!
//! Both members are `N1(ρ̂ - a4, z/a3)` with `ρ̂ = N2(x/a1, y/a2)` and two-dimensional norms N (FORMULAS §0; a4 = 0
//! for a superellipsoid), so that with `τ = ρ̂ - a4`
//!
//! ```text
//! ∇G  = G_τ ∇ρ̂ + G_z ẑ/a3
//! G'' = G_τ ρ̂'' + G_ττ ∇ρ̂ ∇ρ̂ᵀ + G_τz (∇ρ̂ ẑᵀ + ẑ ∇ρ̂ᵀ)/a3 + G_zz ẑ ẑᵀ/a3²
//! ```

use nalgebra::Matrix3;

use super::Superellipsoid;
use crate::numeric::superellipse::derivatives;
use crate::shape::SecondOrder;
use crate::{Point, Vector};

impl SecondOrder for Superellipsoid {
    /// `None` at the centre, on the seams of exponents over 1 (there the curvature is infinite) and at the poles
    /// unless ε1 < 1, where it is 0, or both exponents are 1.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        if p.x == 0.0 && p.y == 0.0 {
            return at_pole(self.semi_axes, self.exponents, p.z);
        }
        layered(self.semi_axes, 0.0, self.exponents, p)
    }
}

/// The gauge grows from the pole as `ρ̂^(2/ε1)`.
fn at_pole([a1, a2, a3]: [f64; 3], [e1, e2]: [f64; 2], z: f64) -> Option<Matrix3<f64>> {
    let height = (z / a3).abs();
    if height == 0.0 {
        return None;
    }
    if e1 < 1.0 {
        return Some(Matrix3::zeros());
    }
    let round = e1 == 1.0 && e2 == 1.0;
    let diagonal = Vector::new(1.0 / (a1 * a1 * height), 1.0 / (a2 * a2 * height), 0.0);
    (round && diagonal.iter().all(|v| v.is_finite())).then(|| Matrix3::from_diagonal(&diagonal))
}

/// Second derivatives of `N1(ρ̂ - ring, z/a3)`.
pub(crate) fn layered(
    [a1, a2, a3]: [f64; 3],
    ring: f64,
    [e1, e2]: [f64; 2],
    p: &Point,
) -> Option<Matrix3<f64>> {
    let planar = derivatives(p.x / a1, p.y / a2, 2.0 / e2)?;
    let whole = derivatives(planar.norm - ring, p.z / a3, 2.0 / e1)?;
    let radial = Vector::new(planar.first[0] / a1, planar.first[1] / a2, 0.0);
    let up = Vector::z() / a3;
    let [xx, xy, yy] = planar.second;
    let bent = Matrix3::new(
        xx / a1 / a1,
        xy / a1 / a2,
        0.0,
        xy / a1 / a2,
        yy / a2 / a2,
        0.0,
        0.0,
        0.0,
        0.0,
    );
    let [tt, tz, zz] = whole.second;
    let mixed = radial * up.transpose();
    let hessian = bent * whole.first[0]
        + radial * radial.transpose() * tt
        + (mixed + mixed.transpose()) * tz
        + up * up.transpose() * zz;
    hessian.iter().all(|v| v.is_finite()).then_some(hessian)
}
