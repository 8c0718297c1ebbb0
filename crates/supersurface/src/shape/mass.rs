//! Mass, centre of mass and inertia of a solid.

use nalgebra::Matrix3;

use crate::{Point, Pose, Vector};

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

/// Mass properties with how far off they may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassEstimate {
    /// The mass properties.
    pub mass: Mass,
    /// Estimated relative error, no bound: the largest of those of the mass, of the centre (in units of the radius of
    /// gyration) and of the inertia (in units of its trace). 0 for closed forms.
    pub error: f64,
}

impl MassEstimate {
    /// Of a closed form.
    pub const fn exact(mass: Mass) -> Self {
        Self { mass, error: 0.0 }
    }

    /// The finer of two estimates, with what they differ by as its error.
    pub fn refined(coarse: &Mass, fine: Mass) -> Self {
        let (mass, trace) = (fine.mass.abs(), fine.inertia.trace().abs());
        let mut error = 0.0;
        let mut add = |difference: f64, size: f64| {
            let share = if difference == 0.0 { 0.0 } else { difference / size };
            // NaN counts as the largest
            error = crate::numeric::powers::larger(share, error);
        };
        add((fine.mass - coarse.mass).abs(), mass);
        // tr I = 2 m k²
        add((fine.centre - coarse.centre).norm(), (0.5 * trace / mass).sqrt());
        add((fine.inertia - coarse.inertia).amax(), trace);
        Self { mass: fine, error }
    }
}

/// Volume with its first and second moments about the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moments {
    pub(crate) volume: f64,
    pub(crate) first: Vector,
    pub(crate) second: Matrix3<f64>,
}

impl Moments {
    pub(crate) fn nothing() -> Self {
        Self { volume: 0.0, first: Vector::zeros(), second: Matrix3::zeros() }
    }

    /// Adds a small volume at a place.
    pub(crate) fn add(&mut self, volume: f64, at: &Vector) {
        let first = at * volume;
        self.volume += volume;
        self.first += first;
        self.second += first * at.transpose();
    }

    /// All of it so many times.
    pub(crate) fn scaled(&self, by: f64) -> Self {
        Self { volume: self.volume * by, first: self.first * by, second: self.second * by }
    }

    /// As a mass, with a density; at the origin where there is no volume.
    pub(crate) fn mass(&self, density: f64) -> Mass {
        if self.volume == 0.0 {
            return Mass { mass: 0.0, centre: Point::origin(), inertia: Matrix3::zeros() };
        }
        let centre = self.first / self.volume;
        let central = self.second - centre * centre.transpose() * self.volume;
        let inertia = Matrix3::identity() * central.trace() - central;
        Mass { mass: self.volume * density, centre: centre.into(), inertia: inertia * density }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
