//! The supershape: two superformulas multiplied as longitude and latitude.
//!
//! `x = r1(θ) cosθ r2(φ) cosφ`, `y = r1(θ) sinθ r2(φ) cosφ`, `z = r2(φ) sinφ` (FORMULAS §5). With
//! `u = √(x² + y²) / r1(θ)` a half plane through z shows the latitude curve alone, so the ray through a point
//! meets the surface at the exact scale `β = r1 r2 / √(x² + y² + r1² z²) = r2(φ) / √(u² + z²)`, where
//! `θ = atan2(y, x)` and `φ = atan2(z, u)`; the gauge is `1/β`.

use std::f64::consts::{FRAC_PI_2, PI};

use super::Superformula;
use crate::numeric::powers::quadrant_cos_sin;
use crate::shape::{Implicit, InvalidShape, Parametric};
use crate::{Direction, Point, Vector};

/// A solid with the z axis through its poles. Where the longitude is not closed
/// ([`Superformula::is_closed`]) its surface has a step along `θ = π`.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, Superformula, Supershape}};
/// let star = Superformula::new(6.0, [0.5, 1.7, 1.7], [0.05, 0.05])?;
/// let round = Superformula::new(4.0, [2.0; 3], [1.0, 0.5])?;
/// let starfish = Supershape::new(star, round)?;
/// let tip = Point::new(star.radius(0.0), 0.0, 0.0);
/// assert!((starfish.gauge(&tip) - 1.0).abs() < 1e-14);
/// assert!((starfish.radial_scale(&(tip * 0.5)).unwrap() - 2.0).abs() < 1e-13);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supershape {
    longitude: Superformula,
    latitude: Superformula,
    bounds: [Point; 2],
}

impl Supershape {
    /// The longitude's radius is a factor of x and y, the latitude's is in metres. Fails when the product of
    /// both could leave [1e-30, 1e30].
    pub fn new(longitude: Superformula, latitude: Superformula) -> Result<Self, InvalidShape> {
        for (a, b) in longitude.log_radius_bounds().into_iter().zip(latitude.log_radius_bounds()) {
            let inside = (a + b).abs() <= super::LARGEST_LOG_RADIUS;
            InvalidShape::check(inside, "logarithm of a radius", a + b, "in [-69, 69]")?;
        }
        let around = |direction: f64| longitude.extent(direction, -PI, PI);
        let along = |direction: f64| latitude.extent(direction, -FRAC_PI_2, FRAC_PI_2);
        let out = along(0.0);
        let low = Point::new(-around(PI) * out, -around(-FRAC_PI_2) * out, -along(-FRAC_PI_2));
        let high = Point::new(around(0.0) * out, around(FRAC_PI_2) * out, along(FRAC_PI_2));
        Ok(Self { longitude, latitude, bounds: [low, high] })
    }

    /// The curve around z, r1(θ).
    pub const fn longitude(&self) -> &Superformula {
        &self.longitude
    }

    /// The curve from pole to pole, r2(φ).
    pub const fn latitude(&self) -> &Superformula {
        &self.latitude
    }

    /// The factor β that takes a point to the surface along the ray from the origin; `None` at the origin.
    pub fn radial_scale(&self, p: &Point) -> Option<f64> {
        let g = self.gauge(p);
        (g > 0.0).then(|| 1.0 / g)
    }

    /// Signed radial distance `|p| (1 - β)` in metres, positive outside; at the origin it is minus the
    /// distance to the equator at `θ = 0`.
    pub fn radial_distance(&self, p: &Point) -> f64 {
        let size = p.coords.amax();
        if size == 0.0 {
            return -self.longitude.radius(0.0) * self.latitude.radius(0.0);
        }
        // along a ray of about unit length, so that no tiny point loses its square
        let ray = p.coords / size;
        let length = ray.norm();
        size * length - length / self.gauge(&ray.into())
    }

    /// Longitude, latitude and `√(u² + z²)` of a point.
    pub(super) fn angles(&self, p: &Point) -> (f64, f64, f64) {
        let theta = p.y.atan2(p.x);
        let u = p.x.hypot(p.y) / self.longitude.radius(theta);
        (theta, p.z.atan2(u), u.hypot(p.z))
    }

    /// Gradient of the gauge at the angles of a ray; it is the same along the ray. `None` where a curve has a
    /// corner, and at a pole that is not level.
    fn slope(&self, theta: f64, phi: f64) -> Option<Vector> {
        let (cos, sin) = quadrant_cos_sin(phi);
        let bend = self.latitude.log_slope(phi)?;
        // g = √(u² + z²) / r2, so dg = ((cosφ + L2 sinφ) du + (sinφ - L2 cosφ) dz) / r2 with L = r'/r, and
        // du = ((cosθ + L1 sinθ) dx + (sinθ - L1 cosθ) dy) / r1
        let (du, dz) = (cos + bend * sin, sin - bend * cos);
        let scale = 1.0 / self.latitude.radius(phi);
        if cos == 0.0 {
            return (bend == 0.0).then(|| Vector::new(0.0, 0.0, dz * scale));
        }
        let (cos, sin) = quadrant_cos_sin(theta);
        let turn = self.longitude.log_slope(theta)?;
        let du = du / self.longitude.radius(theta);
        let slope = Vector::new(du * (cos + turn * sin), du * (sin - turn * cos), dz) * scale;
        slope.iter().all(|v| v.is_finite()).then_some(slope)
    }
}

impl Implicit for Supershape {
    /// `1/β`, homogeneous of degree 1.
    fn gauge(&self, p: &Point) -> f64 {
        let (_, phi, distance) = self.angles(p);
        distance / self.latitude.radius(phi)
    }

    /// Zero at the origin, at corners of the curves and at poles that are not level.
    fn gradient(&self, p: &Point) -> Vector {
        let (theta, phi, distance) = self.angles(p);
        if distance == 0.0 {
            return Vector::zeros();
        }
        self.slope(theta, phi).unwrap_or_else(Vector::zeros)
    }

    /// Certain, and at most about half a percent larger than needed.
    fn bounds(&self) -> [Point; 2] {
        self.bounds
    }
}

impl Parametric for Supershape {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]]
    }

    /// The point at latitude `eta` (φ) and longitude `omega` (θ).
    fn point(&self, eta: f64, omega: f64) -> Point {
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        let (r1, r2) = (self.longitude.radius(omega), self.latitude.radius(eta));
        Point::new(r1 * co * r2 * ce, r1 * so * r2 * ce, r2 * se)
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        let (r1, r2) = (self.longitude.radius(omega), self.latitude.radius(eta));
        let (turn, bend) = (self.longitude.log_slope(omega)?, self.latitude.log_slope(eta)?);
        let out = r1 * r2 * (bend * ce - se);
        let along = Vector::new(out * co, out * so, r2 * (bend * se + ce));
        let ring = r1 * r2 * ce;
        let around = Vector::new(ring * (turn * co - so), ring * (turn * so + co), 0.0);
        let finite = along.iter().chain(around.iter()).all(|v| v.is_finite());
        finite.then_some([along, around])
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        let slope = self.slope(omega, eta)?;
        // scaled first: the gradient of a body of 1e-30 m would lose its squares
        let largest = slope.amax();
        (largest > 0.0).then(|| Direction::new_normalize(slope / largest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Superellipsoid;

    fn shapes() -> Vec<Supershape> {
        let curve = |m, n, s| Superformula::new(m, n, s).unwrap();
        vec![
            Supershape::new(
                curve(6.0, [1.5, 1.7, 2.3], [1.1, 0.9]),
                curve(4.0, [2.0; 3], [1.0; 2]),
            ),
            Supershape::new(
                curve(4.0, [9.0; 3], [1.0; 2]),
                curve(6.0, [3.0, 2.2, 4.0], [0.3, 0.2]),
            ),
            Supershape::new(
                curve(3.0, [2.0, 1.4, 3.1], [0.8, 1.3]),
                curve(2.0, [4.0; 3], [2.0, 1.0]),
            ),
        ]
        .into_iter()
        .map(Result::unwrap)
        .collect()
    }

    #[test]
    fn points_tangents_and_normals_agree_with_the_gauge() {
        for shape in shapes() {
            for (i, j) in (-9..=9).flat_map(|i| (-9..=9).map(move |j| (i, j))) {
                let (eta, omega) = (f64::from(i) * 0.171 + 0.003, f64::from(j) * 0.34 + 0.005);
                let p = shape.point(eta, omega);
                assert!((shape.gauge(&p) - 1.0).abs() < 1e-12);
                let gradient = shape.gradient(&p);
                assert!((gradient.dot(&p.coords) - 1.0).abs() < 1e-11, "Euler");
                let normal = shape.normal(eta, omega).unwrap();
                assert!((normal.cross(&gradient)).norm() < 1e-11 * gradient.norm());
                let h = 1e-6;
                let tangents = shape.tangents(eta, omega).unwrap();
                let steps = [
                    shape.point(eta + h, omega) - shape.point(eta - h, omega),
                    shape.point(eta, omega + h) - shape.point(eta, omega - h),
                ];
                for (t, d) in tangents.iter().zip(steps) {
                    assert!((t - d / (2.0 * h)).norm() < 1e-7 * (1.0 + t.norm()));
                    assert!(t.dot(&normal).abs() < 1e-11 * (1.0 + t.norm()));
                }
                let [low, high] = shape.bounds();
                assert!((0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]));
                let q = p + Vector::new(0.02, -0.03, 0.01);
                let slope = shape.gradient(&q);
                for k in 0..3 {
                    let mut step = Vector::zeros();
                    step[k] = h;
                    let d = (shape.gauge(&(q + step)) - shape.gauge(&(q - step))) / (2.0 * h);
                    assert!((slope[k] - d).abs() < 2e-5 * (1.0 + slope.norm()), "{slope} {d}");
                }
            }
        }
    }

    #[test]
    fn a_superellipsoid_of_equal_exponents_is_the_same_solid() {
        let e = 0.4;
        let same = Superformula::new(4.0, [2.0 / e; 3], [1.0; 2]).unwrap();
        let shape = Supershape::new(same, same).unwrap();
        let truth = Superellipsoid::new([1.0; 3], [e; 2]).unwrap();
        for p in [[0.3, 0.2, -0.5], [2.0, -1.0, 1e-3], [0.0, 0.0, 0.7], [0.0, -1.0, 0.0]] {
            let p = Point::from(p);
            assert!((shape.gauge(&p) - truth.gauge(&p)).abs() < 1e-14);
            assert!((shape.gradient(&p) - truth.gradient(&p)).norm() < 1e-12, "{p}");
        }
        assert!((shape.volume() / truth.volume() - 1.0).abs() < 1e-11);
    }

    #[test]
    fn odd_points_are_answered() {
        for shape in shapes() {
            for v in [0.0, 5e-324, 1e-300, 1.0, 1e308, -1e308] {
                for p in [[v, 0.0, 0.0], [0.0, v, v], [v, -v, v], [0.0, 0.0, v]] {
                    let p = Point::from(p);
                    assert!(!shape.gauge(&p).is_nan() && !shape.radial_distance(&p).is_nan());
                    assert!(shape.gradient(&p).iter().all(|v| v.is_finite()));
                }
            }
            assert!(shape.normal(f64::NAN, 0.0).is_none());
            assert!(shape.normal(0.0, f64::INFINITY).is_none());
        }
    }
}
