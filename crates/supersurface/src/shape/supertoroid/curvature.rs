//! Differential geometry in closed form: the superellipsoid's formulas with `r = a4 + cos^ε1 η`.

use super::Supertoroid;
use crate::shape::superellipsoid::Angular;
use crate::shape::{Curvature, FundamentalForms};

impl Supertoroid {
    /// Both fundamental forms at two angles; `None` where a number is infinite or there is no normal.
    pub fn fundamental_forms(&self, eta: f64, omega: f64) -> Option<FundamentalForms> {
        let [first, second] = self.angular(eta, omega).forms()?;
        let finite = first.iter().chain(&second).all(|v| v.is_finite());
        finite.then_some(FundamentalForms { first, second })
    }

    /// Normal curvatures around the tube (growing η) and along the ring (growing ω), in 1/m; `None` for one
    /// that is infinite or undefined.
    pub fn normal_curvatures(&self, eta: f64, omega: f64) -> [Option<f64>; 2] {
        self.angular(eta, omega).normal_curvatures()
    }

    /// Curvatures at two angles, exact on seams; `None` where one is infinite or undefined. The Gaussian
    /// curvature is negative on the inner half (cos η < 0) when both exponents are below 2.
    ///
    /// ```
    /// use supersurface::shape::Supertoroid;
    /// let ring = Supertoroid::new([0.5; 3], 4.0, [1.0, 1.0])?;
    /// let [tube, inner] = ring.curvature(std::f64::consts::PI, 0.3).unwrap().principal;
    /// assert!((tube - 2.0).abs() < 1e-12 && (inner + 1.0 / 1.5).abs() < 1e-12);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn curvature(&self, eta: f64, omega: f64) -> Option<Curvature> {
        self.angular(eta, omega).curvature()
    }

    fn angular(&self, eta: f64, omega: f64) -> Angular {
        Angular::new(self.semi_axes, self.ring_ratio, self.exponents, eta, omega)
    }
}
