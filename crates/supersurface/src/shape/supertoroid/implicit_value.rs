//! The inside-outside function `F` of the literature (equation 12), `F = G^(2/ε1)`.

use super::Supertoroid;
use crate::numeric::powers::power;
use crate::numeric::superellipse::norm;
use crate::shape::Implicit;
use crate::{Point, Vector};

impl Supertoroid {
    /// `ρ̂ = (|x/a1|^(2/ε2) + |y/a2|^(2/ε2))^(ε2/2)`: a4 on the mean superellipse (equation 13).
    pub fn planar_radius(&self, p: &Point) -> f64 {
        let [a1, a2, _] = self.semi_axes;
        norm((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / self.exponents[1])
    }

    /// `ln G`, the logarithm of the gauge; minus infinity on the centre line.
    pub fn log_gauge(&self, p: &Point) -> f64 {
        self.gauge(p).ln()
    }

    /// `F(p) = |ρ̂ - a4|^(2/ε1) + |z/a3|^(2/ε1)`: below 1 in the tube, 1 on the surface. Infinite where it
    /// exceeds the range of numbers; [`Self::log_implicit_value`] does not.
    pub fn implicit_value(&self, p: &Point) -> f64 {
        power(self.gauge(p), 2.0 / self.exponents[0])
    }

    /// `ln F = 2/ε1 ln G`.
    pub fn log_implicit_value(&self, p: &Point) -> f64 {
        2.0 / self.exponents[0] * self.log_gauge(p)
    }

    /// `∇F = 2/ε1 F/G ∇G`, in 1/m, with zeros where [`Implicit::gradient`] has them; `None` where it is not finite.
    pub fn implicit_gradient(&self, p: &Point) -> Option<Vector> {
        let g = self.gauge(p);
        let p1 = 2.0 / self.exponents[0];
        let gradient = self.gradient(p) * (p1 * power(g, p1 - 1.0));
        gradient.iter().all(|v| v.is_finite()).then_some(gradient)
    }
}
