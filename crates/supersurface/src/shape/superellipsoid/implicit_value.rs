//! The inside-outside function `F` of the literature and what derives from it.
//!
//! `F = g^(2/ε1)` spans hundreds of powers of ten for small exponents and loses its meaning there (FORMULAS
//! §0.1): everything else in this library works with the gauge `g`. F is here for those who compare.

use nalgebra::Matrix3;

use super::Superellipsoid;
use crate::numeric::powers::power;
use crate::shape::{Implicit, SecondOrder};
use crate::{Point, Vector};

impl Superellipsoid {
    /// `ln g`, the logarithm of the gauge; minus infinity at the centre.
    pub fn log_gauge(&self, p: &Point) -> f64 {
        self.gauge(p).ln()
    }

    /// `F(p) = (|x/a1|^(2/ε2) + |y/a2|^(2/ε2))^(ε2/ε1) + |z/a3|^(2/ε1)` (equation 9): below 1 inside, 1 on
    /// the surface. Infinite where it exceeds the range of numbers; [`Self::log_implicit_value`] does not.
    ///
    /// ```
    /// use supersurface::{Point, shape::Superellipsoid};
    /// let ball = Superellipsoid::new([2.0; 3], [1.0, 1.0])?;
    /// assert!((ball.implicit_value(&Point::new(4.0, 0.0, 0.0)) - 4.0).abs() < 1e-14);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn implicit_value(&self, p: &Point) -> f64 {
        power(self.gauge(p), 2.0 / self.exponents[0])
    }

    /// `ln F = 2/ε1 ln g`.
    pub fn log_implicit_value(&self, p: &Point) -> f64 {
        2.0 / self.exponents[0] * self.log_gauge(p)
    }

    /// `∇F = 2/ε1 F/g ∇g`, in 1/m, with zeros where [`Implicit::gradient`] has them; `None` where it is not finite.
    pub fn implicit_gradient(&self, p: &Point) -> Option<Vector> {
        let g = self.gauge(p);
        let p1 = 2.0 / self.exponents[0];
        let gradient = self.gradient(p) * (p1 * power(g, p1 - 1.0));
        gradient.iter().all(|v| v.is_finite()).then_some(gradient)
    }

    /// `F'' = p1 g^(p1-1) g'' + p1 (p1-1) g^(p1-2) ∇g ∇gᵀ` with `p1 = 2/ε1`, in 1/m²; `None` where the
    /// gauge has none or a component is not finite.
    pub fn implicit_hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let (g, gradient) = (self.gauge(p), self.gradient(p));
        let p1 = 2.0 / self.exponents[0];
        let bend = gradient * gradient.transpose() * (p1 * (p1 - 1.0) * power(g, p1 - 2.0));
        let hessian = self.hessian(p)? * (p1 * power(g, p1 - 1.0)) + bend;
        hessian.iter().all(|v| v.is_finite()).then_some(hessian)
    }
}
