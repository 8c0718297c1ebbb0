//! Second derivatives of the gauge, two norms one in the other.

use nalgebra::Matrix3;

use super::Superellipsoid;
use crate::Point;
use crate::shape::SecondOrder;
use crate::shape::jet::Jet;

impl SecondOrder for Superellipsoid {
    /// `None` at the centre, on the seams of exponents over 1 (there the curvature is infinite) and at the poles
    /// unless ε1 < 1, where it is 0, or both exponents are 1.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes, self.exponents);
        let planar = Jet::axis(0, p.x, a1).norm(&Jet::axis(1, p.y, a2), 2.0 / e2);
        planar.norm(&Jet::axis(2, p.z, a3), 2.0 / e1).hessian()
    }
}
