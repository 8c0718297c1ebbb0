//! Second derivatives of the gauge: those of the superellipsoid with `ρ̂ - a4` in the place of `ρ̂`.

use nalgebra::Matrix3;

use super::Supertoroid;
use crate::Point;
use crate::shape::SecondOrder;
use crate::shape::superellipsoid::layered;

impl SecondOrder for Supertoroid {
    /// `None` on the z axis, on the centre line of the tube and on the seams of exponents over 1.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        layered(self.semi_axes, self.ring_ratio, self.exponents, p)
    }
}
