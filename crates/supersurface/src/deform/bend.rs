//! Circular bend of the z axis (FORMULAS §4; Solina and Bajcsy's, in place of equation 21).
//!
//! With `r = x cos α + y sin α` and `γ = k z`: `R = 1/k - cos γ (1/k - r)`, `X = x + cos α (R - r)`,
//! `Y = y + sin α (R - r)`, `Z = sin γ (1/k - r)`. Evaluated without `1/k`, so that `k → 0` is no special case.
//! One to one where `1 - k r > 0` and `|γ| < π`; volume is kept for solids that are even in `r`.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Matrix3;

use super::{Deformation, Sections, range, sinc};
use crate::shape::{Implicit, InvalidShape};
use crate::{Point, Vector};

/// The z axis becomes a circle of curvature `k` in the plane at angle `α` from the xz plane.
///
/// ```
/// use supersurface::{Point, deform::{Bend, Deformation}};
/// let bend = Bend::new(2.0, 0.0)?;
/// let tip = bend.forward(&Point::new(0.0, 0.0, std::f64::consts::FRAC_PI_4)); // a quarter of a circle
/// assert!((tip - Point::new(0.5, 0.0, 0.5)).norm() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bend {
    curvature: f64,
    angle: f64,
    cos_sin: [f64; 2],
}

impl Bend {
    /// Curvature `k` in 1/m (0: no bend; a positive one bends towards `α`) and the angle `α` of the plane of the bend
    /// in radians; both finite.
    pub fn new(curvature: f64, angle: f64) -> Result<Self, InvalidShape> {
        InvalidShape::check(curvature.is_finite(), "curvature of a bend", curvature, "finite")?;
        InvalidShape::check(angle.is_finite(), "angle of a bend", angle, "finite")?;
        let (sin, cos) = angle.sin_cos();
        Ok(Self { curvature, angle, cos_sin: [cos, sin] })
    }

    /// Curvature `k` in 1/m.
    pub const fn curvature(&self) -> f64 {
        self.curvature
    }

    /// Angle `α` of the plane of the bend from the xz plane, in radians.
    pub const fn angle(&self) -> f64 {
        self.angle
    }

    /// Into the bend: `(cos α, sin α, 0)`.
    fn inwards(&self) -> Vector {
        let [c, s] = self.cos_sin;
        Vector::new(c, s, 0.0)
    }

    /// `[R, Z]` of `[r, z]`: `R = r cos γ + ½ k z² sinc²(γ/2)`, `Z = z sinc γ - r sin γ`.
    fn section(&self, r: f64, z: f64) -> [f64; 2] {
        let gamma = self.curvature * z;
        let half = sinc(0.5 * gamma);
        let (sin, cos) = gamma.sin_cos();
        [r * cos + 0.5 * gamma * z * half * half, z * sinc(gamma) - r * sin]
    }
}

impl Deformation for Bend {
    fn forward(&self, p: &Point) -> Point {
        let n = self.inwards();
        let r = n.dot(&p.coords);
        let [across, along] = self.section(r, p.z);
        let shift = across - r;
        Point::new(p.x + n.x * shift, p.y + n.y * shift, along)
    }

    /// With `A = kZ`, `B = 1 - kR`, `h = √(A² + B²) = 1 - k r`: `r = (R(1 + B) - ZA)/(1 + h)`,
    /// `z = Z atan2(A, B)/A`. `None` on the axis of the circle.
    fn inverse(&self, p: &Point) -> Option<Point> {
        let (k, n) = (self.curvature, self.inwards());
        let across = n.dot(&p.coords);
        let (a, b) = (k * p.z, 1.0 - k * across);
        let h = a.hypot(b);
        if h == 0.0 {
            return None;
        }
        let r = (across * (1.0 + b) - p.z * a) / (1.0 + h);
        let z = match a != 0.0 {
            true => p.z * (a.atan2(b) / a),
            false if b > 0.0 => p.z / b,
            false => PI / k,
        };
        let shift = across - r;
        Some(Point::new(p.x - n.x * shift, p.y - n.y * shift, z))
    }

    fn jacobian(&self, p: &Point) -> Matrix3<f64> {
        let n = self.inwards();
        let (sin, cos) = (self.curvature * p.z).sin_cos();
        let h = 1.0 - self.curvature * n.dot(&p.coords);
        let z = Vector::z();
        // R_r = cos γ, R_z = h sin γ, Z_r = -sin γ, Z_z = h cos γ
        Matrix3::identity()
            + n * (n * (cos - 1.0) + z * (h * sin)).transpose()
            + z * (n * -sin + z * (h * cos - 1.0)).transpose()
    }

    fn sections(&self) -> Sections {
        Sections::Moved
    }

    fn check_over(&self, solid: &dyn Implicit) -> Result<(), InvalidShape> {
        let k = self.curvature;
        if k == 0.0 {
            return Ok(());
        }
        let reach = k.abs() * solid.extent(&(self.inwards() * k.signum()));
        InvalidShape::check(reach < 1.0, "reach into the bend, k r", reach, "below 1")?;
        for z in range(solid, &Vector::z()) {
            let gamma = k * z;
            InvalidShape::check(gamma.abs() < PI, "angle of the bend, k z", gamma, "in (-π, π)")?;
        }
        Ok(())
    }

    /// `R` and `Z` take their extremes at the ends of `r` and at the ends of `z`, at γ = 0 or at γ = ±π/2.
    fn bounds_over(&self, solid: &dyn Implicit) -> [Point; 2] {
        let (k, n) = (self.curvature, self.inwards());
        if k == 0.0 {
            return solid.bounds();
        }
        let (r, z) = (range(solid, &n), range(solid, &Vector::z()));
        let turns = [0.0, FRAC_PI_2 / k, -FRAC_PI_2 / k].into_iter();
        let turns = turns.filter(|t| (z[0]..=z[1]).contains(t)).chain(z);
        let mut across = [f64::INFINITY, f64::NEG_INFINITY];
        let (mut along, mut shift) = (across, across);
        for z in turns {
            for r in r {
                let [high, far] = self.section(r, z);
                widen(&mut across, high);
                widen(&mut along, far);
                widen(&mut shift, high - r);
            }
        }
        // X = cos α R - sin α t = x + cos α (R - r): the tighter of both; t = y cos α - x sin α stays
        let t = range(solid, &Vector::new(-n.y, n.x, 0.0));
        let [low, high] = solid.bounds();
        let axis = |c: f64, s: f64, low: f64, high: f64| {
            let (a, b) = (sum(scaled(across, c), scaled(t, s)), sum(scaled(shift, c), [low, high]));
            [a[0].max(b[0]), a[1].min(b[1])]
        };
        let (x, y) = (axis(n.x, -n.y, low.x, high.x), axis(n.y, n.x, low.y, high.y));
        [Point::new(x[0], y[0], along[0]), Point::new(x[1], y[1], along[1])]
    }
}

fn widen(range: &mut [f64; 2], v: f64) {
    *range = [range[0].min(v), range[1].max(v)];
}

fn scaled([low, high]: [f64; 2], by: f64) -> [f64; 2] {
    if by < 0.0 { [by * high, by * low] } else { [by * low, by * high] }
}

fn sum(a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    [a[0] + b[0], a[1] + b[1]]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::Deformed;
    use crate::deform::tests::{is_a_map, is_a_solid};
    use crate::shape::Superellipsoid;

    #[test]
    fn bent_solids_keep_their_volume() {
        let shape = Superellipsoid::new([0.2, 0.3, 1.1], [0.6, 1.3]).unwrap();
        for (k, angle) in [(2.2, 0.0), (-2.4, 0.7), (1e-9, 2.0), (0.0, 1.0), (2.7, -2.5)] {
            let bend = Bend::new(k, angle).unwrap();
            is_a_map(&bend, shape.semi_axes());
            is_a_solid(shape, &Deformed::new(shape, bend).unwrap(), 1.0);
        }
    }

    #[test]
    fn bends_that_fold_are_refused() {
        let shape = Superellipsoid::new([0.2, 0.2, 0.3], [1.0, 1.0]).unwrap();
        for angle in [0.0, 0.8, 2.0] {
            // a round section is as wide in every direction
            assert!(Deformed::new(shape, Bend::new(4.999, angle).unwrap()).is_ok());
            assert!(Deformed::new(shape, Bend::new(5.001, angle).unwrap()).is_err());
        }
        let long = Superellipsoid::new([0.02, 0.02, 0.3], [1.0, 1.0]).unwrap();
        assert!(Deformed::new(long, Bend::new(10.4, 0.0).unwrap()).is_ok());
        assert!(Deformed::new(long, Bend::new(10.5, 0.0).unwrap()).is_err());
        assert!(Bend::new(f64::INFINITY, 0.0).is_err());
    }

    #[test]
    fn the_centre_of_the_circle_and_what_lies_behind_it_are_outside() {
        let shape = Superellipsoid::new([0.02, 0.02, 0.3], [1.0, 1.0]).unwrap();
        let solid = Deformed::new(shape, Bend::new(4.0, 0.0).unwrap()).unwrap();
        assert_eq!(solid.gauge(&Point::new(0.25, 0.0, 0.0)), f64::INFINITY);
        for p in [[0.5, 0.0, 0.0], [0.3, 0.0, 1e-300], [1e308, 1e308, -1e308]] {
            assert!(solid.gauge(&Point::from(p)) > 1.0, "{p:?}");
        }
    }
}
