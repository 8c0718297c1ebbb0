//! The radial extended superellipsoid: exponents that follow the geometric angles of a point.
//!
//! Of the point scaled by the semi-axes, `ω_g = atan2(y/a2, x/a1)` and `η_g = atan2(z/a3, √((x/a1)² +
//! (y/a2)²))`. Both are constant along a ray from the origin, so along it the solid is a superellipsoid with
//! the exponents `f1(η_g)`, `f2(ω_g)`, and `β = F^{-f1/2}` is the exact scale to its surface (FORMULAS §5, form
//! b). This is not the surface of equation 23 ([`ExtendedSuperellipsoid`]).

use super::ExtendedSuperellipsoid;
use crate::numeric::powers::quadrant_cos_sin;
use crate::numeric::superellipse::{Weighted, weighted};
use crate::shape::{Implicit, Parametric};
use crate::{Direction, Point, Vector};

/// The solid that [`ExtendedSuperellipsoid::radial`] makes.
///
/// ```
/// use supersurface::{Point, shape::{ExtendedSuperellipsoid, Implicit}};
/// let (profile, section) = ([0.2, 0.9, 1.0], [1.0, 0.3, 1.0, 1.0]);
/// let vase = ExtendedSuperellipsoid::new([0.05, 0.05, 0.1], &profile, &section)?.radial();
/// let p = Point::new(0.02, 0.01, 0.03);
/// let surface = p * vase.radial_scale(&p).unwrap();
/// assert!((vase.gauge(&surface) - 1.0).abs() < 1e-14);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct RadialExtended {
    numbers: ExtendedSuperellipsoid,
}

/// What the gauge is made of, at a point scaled to about unit size.
struct Layers {
    size: f64,
    scaled: Vector,
    slopes: [f64; 2],
    planar: Weighted,
    whole: Weighted,
}

impl RadialExtended {
    pub(super) const fn from_numbers(numbers: ExtendedSuperellipsoid) -> Self {
        Self { numbers }
    }

    /// The semi-axes and exponents, as the parametric surface that they also make.
    pub const fn numbers(&self) -> &ExtendedSuperellipsoid {
        &self.numbers
    }

    /// The exponents `[f1(η_g), f2(ω_g)]` on the ray through a point.
    pub fn exponents_at(&self, p: &Point) -> [f64; 2] {
        let size = p.coords.amax();
        let scale = if size > 0.0 { size } else { 1.0 };
        let (eta, omega) = angles(&self.scaled(&(p.coords / scale)));
        self.numbers.exponents(eta, omega)
    }

    /// The factor β that takes a point to the surface along the ray from the origin; `None` at the origin.
    pub fn radial_scale(&self, p: &Point) -> Option<f64> {
        let g = self.gauge(p);
        (g > 0.0).then(|| 1.0 / g)
    }

    fn scaled(&self, p: &Vector) -> Vector {
        p.component_div(&Vector::from(self.numbers.semi_axes))
    }

    fn layers(&self, p: &Point) -> Option<Layers> {
        let size = p.coords.amax();
        if size == 0.0 {
            return None;
        }
        let scaled = self.scaled(&(p.coords / size));
        let (eta, omega) = angles(&scaled);
        let [[f1, df1], [f2, df2]] = self.numbers.exponents_and_slopes(eta, omega);
        let planar = weighted(scaled.x.abs(), scaled.y.abs(), 2.0 / f2);
        let whole = weighted(planar.norm, scaled.z.abs(), 2.0 / f1);
        Some(Layers { size, scaled, slopes: [df1, df2], planar, whole })
    }
}

/// `η_g` and `ω_g` of a scaled point.
pub(super) fn angles(scaled: &Vector) -> (f64, f64) {
    (scaled.z.atan2(scaled.x.hypot(scaled.y)), scaled.y.atan2(scaled.x))
}

impl Implicit for RadialExtended {
    /// `g = F^{f1/2} = 1/β`, homogeneous of degree 1.
    fn gauge(&self, p: &Point) -> f64 {
        if !p.iter().all(|v| v.is_finite()) {
            return f64::INFINITY;
        }
        self.layers(p).map_or(0.0, |l| l.size * l.whole.norm)
    }

    /// The superellipsoid's gradient plus what the exponents change with the angles:
    /// `d ln g = ½ S(w1) df1 + ½ w1 S(w2) df2` with the entropy S of the weights. A component is 0 where its
    /// coordinate is, for the first part; on the z axis the second part is 0.
    fn gradient(&self, p: &Point) -> Vector {
        let Some(Layers { scaled: s, slopes: [df1, df2], planar, whole, .. }) = self.layers(p)
        else {
            return Vector::zeros();
        };
        let share = |weight: f64, c: f64| if c == 0.0 { 0.0 } else { weight / c };
        let mut log = Vector::new(
            share(whole.first * planar.first, s.x),
            share(whole.first * planar.second, s.y),
            share(whole.second, s.z),
        );
        let radius = s.x.hypot(s.y);
        if radius > 0.0 {
            let along = 0.5 * whole.entropy() * df1;
            let around = 0.5 * whole.first * planar.entropy() * df2;
            let (c, o) = (s.x / radius, s.y / radius);
            let whole_radius = radius.hypot(s.z);
            let (sine, cosine) = (s.z / whole_radius, radius / whole_radius);
            let tilt = Vector::new(-sine * c, -sine * o, cosine) * (along / whole_radius);
            log += tilt + Vector::new(-o, c, 0.0) * (around / radius);
        }
        let gradient = self.scaled(&(log * whole.norm));
        if gradient.iter().all(|v| v.is_finite()) { gradient } else { Vector::zeros() }
    }

    /// The box of the semi-axes: no exponent makes the gauge less than `max |x_i / a_i|`, and the axes reach it.
    fn bounds(&self) -> [Point; 2] {
        let a = Vector::from(self.numbers.semi_axes);
        [Point::from(-a), Point::from(a)]
    }
}

impl Parametric for RadialExtended {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.numbers.domain()
    }

    /// The surface point on the ray along `d = (a1 cos η cos ω, a2 cos η sin ω, a3 sin η)`: `d/g(d)`.
    fn point(&self, eta: f64, omega: f64) -> Point {
        let [d, ..] = self.ray(eta, omega);
        Point::from(d / self.gauge(&d.into()))
    }

    /// `d'/g - d (∇g·d')/g²`; `None` where the gauge has no gradient.
    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        let [d, along, around] = self.ray(eta, omega);
        let (g, slope) = (self.gauge(&d.into()), self.gradient(&d.into()));
        let smooth = slope.amax() > 0.0 && !self.has_edge(eta, omega);
        let tangent = |by: Vector| by / g - d * (slope.dot(&by) / (g * g));
        smooth.then(|| [tangent(along), tangent(around)])
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        let [d, ..] = self.ray(eta, omega);
        let slope = self.gradient(&d.into());
        let smooth = slope.amax() > 0.0 && !self.has_edge(eta, omega);
        smooth.then(|| Direction::new_normalize(slope / slope.amax()))
    }
}

impl RadialExtended {
    /// A direction and its derivatives by both angles.
    fn ray(&self, eta: f64, omega: f64) -> [Vector; 3] {
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        let a = Vector::from(self.numbers.semi_axes);
        let scaled = |x: f64, y: f64, z: f64| Vector::new(x, y, z).component_mul(&a);
        [
            scaled(ce * co, ce * so, se),
            scaled(-se * co, -se * so, ce),
            scaled(-ce * so, ce * co, 0.0),
        ]
    }

    /// True on a plane of symmetry where the exponent is 2 or more.
    fn has_edge(&self, eta: f64, omega: f64) -> bool {
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        let [f1, f2] = self.numbers.exponents(eta, omega);
        let along = f1 >= 2.0 && (ce == 0.0 || se == 0.0);
        // at a pole all meridians meet
        along || f2 >= 2.0 && ce != 0.0 && (co == 0.0 || so == 0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::Superellipsoid;

    fn vase() -> RadialExtended {
        let (profile, section) = ([0.5, 1.4, 0.8, 1.7], [0.6, 1.2, 0.9, 1.6, 0.7, 1.1]);
        ExtendedSuperellipsoid::new([0.4, 0.3, 0.5], &profile, &section).unwrap().radial()
    }

    #[test]
    fn the_gradient_agrees_with_differences() {
        let (vase, mut random) = (vase(), Stream::new(2, 0));
        for _ in 0..300 {
            let p = Point::from(Vector::from_fn(|_, _| random.between(-0.8, 0.8)));
            let (gradient, g, h) = (vase.gradient(&p), vase.gauge(&p), 1e-7);
            assert!((gradient.dot(&p.coords) / g - 1.0).abs() < 1e-12, "Euler");
            for k in 0..3 {
                let step = Vector::from_fn(|i, _| if i == k { h } else { 0.0 });
                let d = (vase.gauge(&(p + step)) - vase.gauge(&(p - step))) / (2.0 * h);
                assert!((gradient[k] - d).abs() < 1e-5 * gradient.norm(), "{p} {gradient} {d}");
            }
        }
    }

    #[test]
    fn it_is_the_superellipsoid_of_each_ray_and_not_equation_23() {
        let (vase, mut random) = (vase(), Stream::new(4, 0));
        for _ in 0..100 {
            let p = Point::from(Vector::from_fn(|_, _| random.between(-0.8, 0.8)));
            let same = Superellipsoid::new([0.4, 0.3, 0.5], vase.exponents_at(&p)).unwrap();
            assert!((vase.gauge(&p) - same.gauge(&p)).abs() < 1e-14);
        }
        assert!((vase.gauge(&vase.numbers().point(0.5, 0.6)) - 1.0).abs() > 1e-3);
    }

    #[test]
    fn odd_points_are_answered() {
        let vase = vase();
        for v in [0.0, 5e-324, 1e-300, 1.0, 1e308, -1e308] {
            for p in [[v, 0.0, 0.0], [0.0, v, v], [v, -v, v], [0.0, 0.0, v]] {
                let p = Point::from(p);
                assert!(
                    !vase.gauge(&p).is_nan() && vase.gradient(&p).iter().all(|v| v.is_finite())
                );
            }
        }
        assert_eq!(vase.radial_scale(&Point::origin()), None);
    }
}
