//! Volume, moments and inertia in closed form (FORMULAS §3), for `a4 >= 1`.
//!
//! With m = i + j + 1: `M(i,j,k) = 8 a1^(i+1) a2^(j+1) a3^(k+1) D2(ε2; i, j) (i+j+2)
//! Σ_{l even <= m} C(m, l) a4^(m-l) ε1/(k+1) B((l+1) ε1/2, (k+1) ε1/2 + 1)` for even i, j, k.

use super::Supertoroid;
use crate::numeric::powers::beta;
use crate::shape::superellipsoid::{central, raised, section_moment};
use crate::shape::{Mass, MassProperties};

impl Supertoroid {
    /// Volume in m³.
    ///
    /// ```
    /// use supersurface::shape::Supertoroid;
    /// let ring = Supertoroid::new([0.01; 3], 4.0, [1.0, 1.0])?;
    /// let exact = 2.0 * std::f64::consts::PI.powi(2) * 0.04 * 0.01f64.powi(2);
    /// assert!((ring.volume() / exact - 1.0).abs() < 1e-12);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn volume(&self) -> f64 {
        self.moment([0; 3])
    }

    /// The moment `∫ x^i y^j z^k dV` of the solid about its centre, in m^(3+i+j+k).
    pub fn moment(&self, [i, j, k]: [u32; 3]) -> f64 {
        if i % 2 + j % 2 + k % 2 > 0 {
            return 0.0;
        }
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let m = i + j + 1;
        let size = raised(a1, i + 1) * raised(a2, j + 1) * raised(a3, k + 1);
        let height = f64::from(k + 1);
        let mut binomial = 1.0;
        let mut sum = 0.0;
        for l in 0..=m {
            if l % 2 == 0 {
                let section = beta(0.5 * f64::from(l + 1) * e1, 0.5 * height * e1 + 1.0);
                sum += binomial * raised(self.ring_ratio, m - l) * e1 / height * section;
            }
            binomial *= f64::from(m - l) / f64::from(l + 1);
        }
        8.0 * size * section_moment(e2, [i, j]) * f64::from(i + j + 2) * sum
    }
}

impl MassProperties for Supertoroid {
    fn mass_properties(&self, density: f64) -> Mass {
        let second = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|powers| self.moment(powers));
        central(density, self.volume(), second)
    }
}
