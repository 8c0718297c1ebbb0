//! Second derivatives of the gauge: those of the superellipsoid with `ρ̂ - a4` in the place of `ρ̂`.

use nalgebra::Matrix3;

use super::Supertoroid;
use crate::Point;
use crate::shape::SecondOrder;
use crate::shape::jet::Jet;

impl SecondOrder for Supertoroid {
    /// `None` on the z axis, on the centre line of the tube and on the seams of exponents over 1.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes, self.exponents);
        let planar = Jet::axis(0, p.x, a1).norm(&Jet::axis(1, p.y, a2), 2.0 / e2);
        let offset = planar.away_from(self.ring_ratio);
        offset.norm(&Jet::axis(2, p.z, a3), 2.0 / e1).hessian()
    }
}
