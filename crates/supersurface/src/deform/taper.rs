//! Linear taper along z (equation 20, FORMULAS §4).
//!
//! `X = fx x`, `Y = fy y`, `Z = z` with `f = 1 + K z/h`. One to one while both factors are positive.

use nalgebra::Matrix3;

use super::{Deformation, Sections, range};
use crate::shape::{Implicit, InvalidShape};
use crate::{Point, Vector};

/// Sections across z grow by the shares `[Kx, Ky]` from the middle to the height `h`.
///
/// ```
/// use supersurface::{Point, deform::{Deformation, Taper}};
/// let taper = Taper::new([0.5, -0.5], 0.1)?;
/// assert_eq!(taper.forward(&Point::new(1.0, 1.0, 0.1)), Point::new(1.5, 0.5, 0.1));
/// // nothing comes from where a factor would be negative
/// assert!(taper.inverse(&Point::new(1.0, 1.0, 0.3)).is_none());
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Taper {
    slopes: [f64; 2],
    half_height: f64,
}

impl Taper {
    /// Slopes `[Kx, Ky]` in [-1, 1], without unit, and the height `h` in metres at which they count (a3 of the
    /// shape to deform), positive. A slope of ±1 fits no solid that reaches `∓h`.
    pub fn new(slopes: [f64; 2], half_height: f64) -> Result<Self, InvalidShape> {
        for (k, what) in slopes.iter().zip(["taper Kx", "taper Ky"]) {
            InvalidShape::check(k.abs() <= 1.0, what, *k, "in [-1, 1]")?;
        }
        check_height(half_height)?;
        Ok(Self { slopes, half_height })
    }

    /// Slopes `[Kx, Ky]`, without unit.
    pub const fn slopes(&self) -> [f64; 2] {
        self.slopes
    }

    /// The height above the middle, in metres, at which the factors are `1 + K`.
    pub const fn half_height(&self) -> f64 {
        self.half_height
    }

    /// The factors of x and y at height z.
    pub(super) fn factors(&self, z: f64) -> [f64; 2] {
        self.slopes.map(|k| 1.0 + k * (z / self.half_height))
    }
}

/// The height at which tapers and twists count.
pub(super) fn check_height(half_height: f64) -> Result<(), InvalidShape> {
    let fits = half_height > 0.0 && half_height.is_finite();
    InvalidShape::check(fits, "half height", half_height, "positive and finite")
}

impl Deformation for Taper {
    fn forward(&self, p: &Point) -> Point {
        let [fx, fy] = self.factors(p.z);
        Point::new(fx * p.x, fy * p.y, p.z)
    }

    fn inverse(&self, p: &Point) -> Option<Point> {
        let [fx, fy] = self.factors(p.z);
        (fx > 0.0 && fy > 0.0).then(|| Point::new(p.x / fx, p.y / fy, p.z))
    }

    fn jacobian(&self, p: &Point) -> Matrix3<f64> {
        let ([kx, ky], [fx, fy]) = (self.slopes, self.factors(p.z));
        let h = self.half_height;
        Matrix3::new(fx, 0.0, kx * (p.x / h), 0.0, fy, ky * (p.y / h), 0.0, 0.0, 1.0)
    }

    fn sections(&self) -> Sections {
        Sections::Kept
    }

    fn check_over(&self, solid: &dyn Implicit) -> Result<(), InvalidShape> {
        for z in range(solid, &Vector::z()) {
            for f in self.factors(z) {
                InvalidShape::check(f > 0.0, "taper factor at an end", f, "positive")?;
            }
        }
        Ok(())
    }

    fn bounds_over(&self, solid: &dyn Implicit) -> [Point; 2] {
        let side = |n: Vector| self.extent_over(solid, &n);
        let (x, y, z) = (Vector::x(), Vector::y(), Vector::z());
        [Point::new(-side(-x), -side(-y), -side(-z)), Point::new(side(x), side(y), side(z))]
    }

    /// `n·T(p) = (fx n_x, fy n_y, n_z)·p`: a convex function of the factors, so that its maximum lies at an end of
    /// the range of z.
    fn extent_over(&self, solid: &dyn Implicit, n: &Vector) -> f64 {
        let at = |z: f64| {
            let [fx, fy] = self.factors(z);
            solid.extent(&Vector::new(fx * n.x, fy * n.y, n.z))
        };
        let [low, high] = range(solid, &Vector::z());
        at(low).max(at(high))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::Deformed;
    use crate::deform::tests::{is_a_map, is_a_solid};
    use crate::shape::Superellipsoid;

    #[test]
    fn tapered_solids_keep_their_closed_volume() {
        for (k, e) in [([0.7, -0.4], [0.6, 1.3]), ([0.9, 0.8], [1.0, 1.0])] {
            let shape = Superellipsoid::new([0.4, 0.7, 1.1], e).unwrap();
            let taper = Taper::new(k, 1.1).unwrap();
            is_a_map(&taper, shape.semi_axes());
            let solid = Deformed::new(shape, taper).unwrap();
            is_a_solid(shape, &solid, solid.volume() / shape.volume());
        }
    }

    #[test]
    fn a_cone_that_ends_in_a_line_is_refused() {
        let shape = Superellipsoid::new([0.4, 0.7, 1.1], [0.5, 1.0]).unwrap();
        for h in [1.1, 1.0] {
            assert!(Deformed::new(shape, Taper::new([1.0, 0.0], h).unwrap()).is_err());
        }
        assert!(Taper::new([0.0, f64::NAN], 1.0).is_err() && Taper::new([0.0; 2], 0.0).is_err());
    }

    #[test]
    fn far_outside_there_is_no_gauge() {
        let shape = Superellipsoid::new([0.4, 0.7, 1.1], [0.5, 1.0]).unwrap();
        let solid = Deformed::new(shape, Taper::new([0.5, 0.5], 1.1).unwrap()).unwrap();
        for z in [-2.2, -1e308, f64::NEG_INFINITY] {
            let p = Point::new(0.1, 0.0, z);
            assert_eq!(solid.gauge(&p), f64::INFINITY);
            assert_eq!(solid.gradient(&p), Vector::zeros());
            assert_eq!(solid.first_order_distance(&p), f64::INFINITY);
        }
    }
}
