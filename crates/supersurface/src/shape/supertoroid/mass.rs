//! Volume in closed form (FORMULAS §3, moments of the supertoroid).

use super::Supertoroid;
use crate::numeric::powers::beta;

impl Supertoroid {
    /// Volume in m³: the area of the mean superellipse's family times the section's, for `a4 >= 1`.
    ///
    /// ```
    /// use supersurface::shape::Supertoroid;
    /// let ring = Supertoroid::new([0.01; 3], 4.0, [1.0, 1.0])?;
    /// let exact = 2.0 * std::f64::consts::PI.powi(2) * 0.04 * 0.01f64.powi(2);
    /// assert!((ring.volume() / exact - 1.0).abs() < 1e-12);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn volume(&self) -> f64 {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        // M(0,0,0) = 8 a1 a2 a3 D2(ε2; 0, 0) 2 a4 ε1 B(ε1/2, ε1/2 + 1)
        let section = e2 * e2 / 4.0 * beta(0.5 * e2, 0.5 * e2) / e2;
        let tube = e1 * beta(0.5 * e1, 0.5 * e1 + 1.0);
        16.0 * a1 * a2 * a3 * section * self.ring_ratio * tube
    }
}
