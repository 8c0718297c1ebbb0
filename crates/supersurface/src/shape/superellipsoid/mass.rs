//! Volume in closed form (FORMULAS §2.1).

use super::Superellipsoid;
use crate::numeric::powers::beta;

impl Superellipsoid {
    /// `V = 2 a1 a2 a3 ε1 ε2 B(ε1/2 + 1, ε1) B(ε2/2, ε2/2)`, in m³.
    ///
    /// ```
    /// use supersurface::shape::Superellipsoid;
    /// let ball = Superellipsoid::new([1.0; 3], [1.0, 1.0])?;
    /// assert!((ball.volume() - 4.0 / 3.0 * std::f64::consts::PI).abs() < 1e-12);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn volume(&self) -> f64 {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        2.0 * a1 * a2 * a3 * e1 * e2 * beta(0.5 * e1 + 1.0, e1) * beta(0.5 * e2, 0.5 * e2)
    }
}
