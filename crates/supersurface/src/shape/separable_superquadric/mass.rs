//! Volume and inertia in closed form, by Dirichlet's integral over an octant.

use nalgebra::Matrix3;

use super::SeparableSuperquadric;
use crate::numeric::dirichlet::dirichlet;
use crate::shape::{Mass, MassProperties};
use crate::{Point, Vector};

impl SeparableSuperquadric {
    /// `V = 8 a1 a2 a3 Γ(1+1/k1) Γ(1+1/k2) Γ(1+1/k3) / Γ(1+1/k1+1/k2+1/k3)`, in m³.
    ///
    /// ```
    /// use supersurface::shape::SeparableSuperquadric;
    /// let octahedron = SeparableSuperquadric::new([1.0; 3], [1.0; 3])?;
    /// assert!((octahedron.volume() - 4.0 / 3.0).abs() < 1e-14);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn volume(&self) -> f64 {
        self.moment([0.0; 3])
    }

    /// `∫ x^i y^j z^k` over the solid for even powers, in m³ and up.
    fn moment(&self, m: [f64; 3]) -> f64 {
        let [k1, k2, k3] = self.powers;
        let [a1, a2, a3] = self.semi_axes;
        let size =
            a1 * a2 * a3 * a1.powi(m[0] as i32) * a2.powi(m[1] as i32) * a3.powi(m[2] as i32);
        8.0 * size * dirichlet(&[(k1, m[0]), (k2, m[1]), (k3, m[2])])
    }
}

impl MassProperties for SeparableSuperquadric {
    fn mass_properties(&self, density: f64) -> Mass {
        let second = |m| density * self.moment(m);
        let (x, y, z) = (second([2.0, 0.0, 0.0]), second([0.0, 2.0, 0.0]), second([0.0, 0.0, 2.0]));
        Mass {
            mass: density * self.volume(),
            centre: Point::origin(),
            inertia: Matrix3::from_diagonal(&Vector::new(y + z, x + z, x + y)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Superellipsoid;

    #[test]
    fn with_equal_exponents_it_is_that_of_a_superellipsoid() {
        let same = Superellipsoid::new([0.3, 0.5, 0.2], [0.7; 2]).unwrap();
        let s = SeparableSuperquadric::new([0.3, 0.5, 0.2], [2.0 / 0.7; 3]).unwrap();
        assert!((s.volume() / same.volume() - 1.0).abs() < 1e-13);
    }
}
