//! Twist about z (equation 22, FORMULAS §4).
//!
//! `X = x cos θ - y sin θ`, `Y = x sin θ + y cos θ`, `Z = z` with `θ = n π (1 + z/h)`: the end at `-h` stands still,
//! the end at `h` makes `n` turns. Its determinant is 1 and its inverse exists everywhere.

use std::f64::consts::PI;

use nalgebra::Matrix3;

use super::taper::check_height;
use super::{Deformation, Sections, range};
use crate::shape::{Implicit, InvalidShape};
use crate::{Point, Vector};

/// Directions in which the reach of a solid across z is taken.
const DIRECTIONS: usize = 16;

/// Sections across z turn by `n` full turns over the height `2h`.
///
/// ```
/// use supersurface::{Point, deform::{Deformation, Twist}};
/// let twist = Twist::new(0.25, 0.1)?;
/// assert!((twist.forward(&Point::new(1.0, 0.0, 0.1)) - Point::new(0.0, 1.0, 0.1)).norm() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Twist {
    turns: f64,
    half_height: f64,
}

impl Twist {
    /// Number of turns `n` (any sign, of magnitude up to 1000) over the height `2h`, and `h` in metres, positive
    /// (a3 of the shape to deform).
    pub fn new(turns: f64, half_height: f64) -> Result<Self, InvalidShape> {
        InvalidShape::check(turns.abs() <= 1000.0, "turns of a twist", turns, "in [-1000, 1000]")?;
        check_height(half_height)?;
        Ok(Self { turns, half_height })
    }

    /// Number of turns over the height `2h`.
    pub const fn turns(&self) -> f64 {
        self.turns
    }

    /// The height `h` above the middle, in metres, at which the turns are complete.
    pub const fn half_height(&self) -> f64 {
        self.half_height
    }

    /// Cosine and sine of θ at height z.
    fn turn(&self, z: f64) -> (f64, f64) {
        let (sin, cos) = (self.turns * PI * (1.0 + z / self.half_height)).sin_cos();
        (cos, sin)
    }
}

impl Deformation for Twist {
    fn forward(&self, p: &Point) -> Point {
        let (c, s) = self.turn(p.z);
        Point::new(c * p.x - s * p.y, s * p.x + c * p.y, p.z)
    }

    fn inverse(&self, p: &Point) -> Option<Point> {
        let (c, s) = self.turn(p.z);
        // too high for an angle
        c.is_finite().then(|| Point::new(c * p.x + s * p.y, c * p.y - s * p.x, p.z))
    }

    fn jacobian(&self, p: &Point) -> Matrix3<f64> {
        let (c, s) = self.turn(p.z);
        let rate = self.turns * PI / self.half_height;
        let moved = self.forward(p);
        Matrix3::new(c, -s, -rate * moved.y, s, c, rate * moved.x, 0.0, 0.0, 1.0)
    }

    fn sections(&self) -> Sections {
        Sections::Kept
    }

    fn check_over(&self, _solid: &dyn Implicit) -> Result<(), InvalidShape> {
        Ok(())
    }

    fn bounds_over(&self, solid: &dyn Implicit) -> [Point; 2] {
        if self.turns == 0.0 {
            return solid.bounds();
        }
        let (r, [low, high]) = (reach(solid), range(solid, &Vector::z()));
        [Point::new(-r, -r, low), Point::new(r, r, high)]
    }

    fn extent_over(&self, solid: &dyn Implicit, n: &Vector) -> f64 {
        if self.turns == 0.0 {
            return solid.extent(n);
        }
        reach(solid) * n.x.hypot(n.y) + solid.extent(&Vector::new(0.0, 0.0, n.z))
    }
}

/// Upper bound of the distance of a solid from the z axis: no point is more than half a step of angle away from one
/// of the directions in which the extent is taken.
fn reach(solid: &dyn Implicit) -> f64 {
    let step = 2.0 * PI / DIRECTIONS as f64;
    let along = |i: usize| {
        let (sin, cos) = (step * i as f64).sin_cos();
        solid.extent(&Vector::new(cos, sin, 0.0))
    };
    let polygon = (0..DIRECTIONS).map(along).fold(0.0, f64::max) / (0.5 * step).cos();
    let [low, high] = solid.bounds();
    let corner = low.x.abs().max(high.x.abs()).hypot(low.y.abs().max(high.y.abs()));
    polygon.min(corner)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::Deformed;
    use crate::deform::tests::{is_a_map, is_a_solid};
    use crate::shape::Superellipsoid;

    #[test]
    fn twisted_solids_keep_their_volume() {
        let shape = Superellipsoid::new([0.2, 0.3, 1.1], [0.6, 1.3]).unwrap();
        for turns in [0.3, -1.2, 0.0] {
            let twist = Twist::new(turns, 1.1).unwrap();
            is_a_map(&twist, shape.semi_axes());
            is_a_solid(shape, &Deformed::new(shape, twist).unwrap(), 1.0);
        }
        assert!(Twist::new(f64::NAN, 1.0).is_err() && Twist::new(1.0, -1.0).is_err());
    }

    #[test]
    fn too_high_for_an_angle_is_outside() {
        let shape = Superellipsoid::new([0.2, 0.3, 1e-9], [0.6, 1.3]).unwrap();
        let solid = Deformed::new(shape, Twist::new(3.0, 1e-9).unwrap()).unwrap();
        assert_eq!(solid.gauge(&Point::new(0.0, 0.0, 1e308)), f64::INFINITY);
    }
}
