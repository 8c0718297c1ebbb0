//! Volume, moments and inertia in closed form (FORMULAS §2.1).
//!
//! `M(i,j,k) = ∫ x^i y^j z^k dV = 8 a1^(i+1) a2^(j+1) a3^(k+1) D2(ε2; i, j) ε1/2 B((k+1) ε1/2, (i+j+2) ε1/2 + 1)` for
//! even i, j, k (0 otherwise), with the section's moment
//! `D2(ε; i, j) = ε²/4 Γ((i+1) ε/2) Γ((j+1) ε/2) / Γ((i+j+2) ε/2 + 1)`. It holds for all exponents.

use nalgebra::Matrix3;

use super::Superellipsoid;
use crate::numeric::powers::beta;
use crate::shape::{Mass, MassProperties};
use crate::{Point, Vector};

impl Superellipsoid {
    /// `V = M(0,0,0) = 2 a1 a2 a3 ε1 ε2 B(ε1/2 + 1, ε1) B(ε2/2, ε2/2)`, in m³.
    ///
    /// ```
    /// use supersurface::shape::Superellipsoid;
    /// let ball = Superellipsoid::new([1.0; 3], [1.0, 1.0])?;
    /// assert!((ball.volume() - 4.0 / 3.0 * std::f64::consts::PI).abs() < 1e-12);
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
        let size = raised(a1, i + 1) * raised(a2, j + 1) * raised(a3, k + 1);
        let planar = f64::from(i + j + 2);
        let profile = 0.5 * e1 * beta(0.5 * f64::from(k + 1) * e1, 0.5 * planar * e1 + 1.0);
        8.0 * size * section_moment(e2, [i, j]) * profile
    }
}

/// `D2(ε; i, j)`: the moment of a quarter of the unit superellipse, `∫ x^i y^j dA`.
pub(crate) fn section_moment(e: f64, [i, j]: [u32; 2]) -> f64 {
    let (u, v) = (0.5 * f64::from(i + 1) * e, 0.5 * f64::from(j + 1) * e);
    // Γ(u + v + 1) = (u + v) Γ(u + v)
    0.25 * e * e * beta(u, v) / (u + v)
}

/// `a^n` by multiplication.
pub(crate) fn raised(a: f64, n: u32) -> f64 {
    (0..n).fold(1.0, |product, _| product * a)
}

impl MassProperties for Superellipsoid {
    fn mass_properties(&self, density: f64) -> Mass {
        let second = [[2, 0, 0], [0, 2, 0], [0, 0, 2]].map(|powers| self.moment(powers));
        central(density, self.volume(), second)
    }
}

/// A body about its centre from its volume and second moments along its axes.
pub(crate) fn central(density: f64, volume: f64, [xx, yy, zz]: [f64; 3]) -> Mass {
    let inertia = Vector::new(yy + zz, xx + zz, xx + yy) * density;
    Mass {
        mass: density * volume,
        centre: Point::origin(),
        inertia: Matrix3::from_diagonal(&inertia),
    }
}
