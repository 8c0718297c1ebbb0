//! The bend of equation (21), read as FORMULAS §4 reconstructs it: a shear along a hyperbola.
//!
//! `X = x - sgn(k) (√(k² + z²) - |k|)`, `Y = y`, `Z = z`, where `k` is the radius of curvature at z = 0, not a
//! curvature. It bends towards -x for `k > 0`, keeps volumes and not lengths, and has an inverse everywhere.

use nalgebra::Matrix3;

use super::{Deformation, Sections, range};
use crate::shape::{Implicit, InvalidShape};
use crate::{Point, Vector};

/// Sections across z are pushed along x by a hyperbola.
///
/// ```
/// use supersurface::{Point, deform::{Deformation, ShearBend}};
/// let bend = ShearBend::new(3.0)?;
/// assert_eq!(bend.forward(&Point::new(1.0, 0.5, 4.0)), Point::new(-1.0, 0.5, 4.0));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShearBend {
    radius: f64,
}

impl ShearBend {
    /// Radius of curvature at z = 0 in metres, finite and not 0; its sign is the side.
    pub fn new(radius: f64) -> Result<Self, InvalidShape> {
        let fits = radius != 0.0 && radius.is_finite();
        InvalidShape::check(fits, "radius of a shear bend", radius, "finite and not 0")?;
        Ok(Self { radius })
    }

    /// Radius of curvature at z = 0, in metres.
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// `sgn(k) (√(k² + z²) - |k|)`, without the difference.
    fn shift(&self, z: f64) -> f64 {
        let k = self.radius;
        (z * (z / (k.abs() + k.hypot(z)))).copysign(k)
    }
}

impl Deformation for ShearBend {
    fn forward(&self, p: &Point) -> Point {
        Point::new(p.x - self.shift(p.z), p.y, p.z)
    }

    fn inverse(&self, p: &Point) -> Option<Point> {
        Some(Point::new(p.x + self.shift(p.z), p.y, p.z))
    }

    fn jacobian(&self, p: &Point) -> Matrix3<f64> {
        let slope = (p.z / self.radius.hypot(p.z)).copysign(p.z * self.radius);
        Matrix3::new(1.0, 0.0, -slope, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)
    }

    fn sections(&self) -> Sections {
        Sections::Kept
    }

    fn check_over(&self, _solid: &dyn Implicit) -> Result<(), InvalidShape> {
        Ok(())
    }

    fn bounds_over(&self, solid: &dyn Implicit) -> [Point; 2] {
        let [mut low, mut high] = solid.bounds();
        let [bottom, top] = range(solid, &Vector::z());
        let most = if -bottom > top { self.shift(bottom) } else { self.shift(top) };
        low.x -= most.max(0.0);
        high.x -= most.min(0.0);
        [low, high]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::Deformed;
    use crate::deform::tests::{is_a_map, is_a_solid};
    use crate::shape::Superellipsoid;

    #[test]
    fn sheared_solids_keep_their_volume() {
        let shape = Superellipsoid::new([0.2, 0.3, 1.1], [0.6, 1.3]).unwrap();
        for radius in [0.4, -0.4, 30.0] {
            let bend = ShearBend::new(radius).unwrap();
            is_a_map(&bend, shape.semi_axes());
            is_a_solid(shape, &Deformed::new(shape, bend).unwrap(), 1.0);
        }
        assert!(ShearBend::new(0.0).is_err() && ShearBend::new(f64::NAN).is_err());
    }
}
