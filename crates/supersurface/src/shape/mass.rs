//! Mass, centre of mass and inertia of a solid.

use nalgebra::Matrix3;

use crate::{Point, Pose};

/// How heavy a solid is, and how its mass is spread.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// Mass in kg (volume in m³ for density 1).
    pub mass: f64,
    /// Centre of mass, in metres.
    pub centre: Point,
    /// Inertia tensor about the centre of mass, in kg m², along the axes of the same frame.
    pub inertia: Matrix3<f64>,
}

impl Mass {
    /// The same solid seen from a frame in which its own stands at `pose`.
    pub fn moved(&self, pose: &Pose) -> Self {
        let r = pose.rotation.to_rotation_matrix().into_inner();
        Self {
            mass: self.mass,
            centre: pose * self.centre,
            inertia: r * self.inertia * r.transpose(),
        }
    }

    /// Both solids as one (Steiner's theorem); solids that overlap count twice where they do.
    pub fn joined(&self, other: &Self) -> Self {
        let mass = self.mass + other.mass;
        if mass == 0.0 {
            return *self;
        }
        let centre =
            Point::from((self.centre.coords * self.mass + other.centre.coords * other.mass) / mass);
        let about = |m: &Self| {
            let d = m.centre - centre;
            m.inertia + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * m.mass
        };
        Self { mass, centre, inertia: about(self) + about(other) }
    }

    /// Inertia tensor about the frame's origin, in kg m².
    pub fn inertia_about_origin(&self) -> Matrix3<f64> {
        let d = self.centre.coords;
        self.inertia + (Matrix3::identity() * d.norm_squared() - d * d.transpose()) * self.mass
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;

    #[test]
    fn two_halves_of_a_rod_are_the_rod() {
        // thin rods of length 1 along x: m l²/12 about y and z
        let half = |x: f64| {
            let i = 0.5 * 0.25 / 12.0;
            let inertia = Matrix3::from_diagonal(&Vector::new(0.0, i, i));
            Mass { mass: 0.5, centre: Point::new(x, 0.0, 0.0), inertia }
        };
        let rod = half(-0.25).joined(&half(0.25));
        assert!((rod.mass - 1.0).abs() < 1e-15 && rod.centre.coords.norm() < 1e-15);
        assert!((rod.inertia[(1, 1)] - 1.0 / 12.0).abs() < 1e-15);
        let turned = rod.moved(&Pose::rotation(Vector::z() * std::f64::consts::FRAC_PI_2));
        assert!((turned.inertia[(0, 0)] - 1.0 / 12.0).abs() < 1e-15);
        let about = half(0.25).inertia_about_origin();
        assert!((about[(2, 2)] - 0.5 / 3.0 * 0.25).abs() < 1e-15);
    }
}
