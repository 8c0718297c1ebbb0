//! The hyperquadric of Hanson: any number of plane pairs blended into one solid.
//!
//! `F(p) = Σ |A_i x + B_i y + C_i z + D_i|^{ε_i} <= 1` (equation 24; FORMULAS §5). Three terms make a sheared
//! superquadric, four and more can be lopsided. The solid lies between the planes `|h_i| = 1`; it is bounded
//! when the normals span space and convex when all exponents are at least 1.

mod bounds;
mod form;
mod hessian;
mod interior;
mod mass;
mod reach;

pub use form::HyperquadricForm;

use crate::numeric::powers::{power, signed_power};
use crate::shape::{Implicit, InvalidShape};
use crate::{Point, Vector};

/// A hyperquadric that holds at least one point inside.
///
/// Of a convex one the gauge is the Minkowski functional about [`Hyperquadric::interior`], found by Newton's
/// method along the ray from there. With an exponent under 1 rays may leave and enter again; then the gauge is
/// `F^{1/ε}` with the largest exponent.
///
/// ```
/// use supersurface::{Point, shape::{Hyperquadric, Implicit}};
/// // a tetrahedron with rounded edges
/// let faces = [[1.0, 1.0, 1.0, 0.0], [1.0, -1.0, -1.0, 0.0], [-1.0, 1.0, -1.0, 0.0], [-1.0, -1.0, 1.0, 0.0]];
/// let planes = faces.map(|[a, b, c, _]| [10.0 * a, 10.0 * b, 10.0 * c, 0.5]);
/// let pebble = Hyperquadric::new(&planes, &[8.0; 4])?;
/// assert!(pebble.is_bounded() && pebble.is_convex());
/// assert!(pebble.contains(&Point::origin()));
/// let [low, high] = pebble.bounds();
/// assert!(high.x < 0.2 && low.x > -0.2);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Hyperquadric {
    form: HyperquadricForm,
    interior: Point,
    bounded: bool,
    convex: bool,
    bounds: [Point; 2],
}

impl Hyperquadric {
    /// Rows `[A, B, C, D]` and exponents as [`HyperquadricForm::new`] takes them. Fails also when no point with
    /// `F < 1` is found: for convex forms there is none then (up to 1e-9), for others the search looked at
    /// all vertices of the planes.
    pub fn new(planes: &[[f64; 4]], exponents: &[f64]) -> Result<Self, InvalidShape> {
        Self::from_form(HyperquadricForm::new(planes, exponents)?)
    }

    /// The solid `F <= 1` of a form. Fails when it is empty.
    pub fn from_form(form: HyperquadricForm) -> Result<Self, InvalidShape> {
        let (interior, log) = interior::least(&form);
        let inside = log < -1e-9 && form.value(&interior) < 1.0;
        InvalidShape::check(
            inside,
            "least value of F",
            log.exp(),
            "under 1 (else the solid is empty)",
        )?;
        let (bounded, convex) = (form.rank() == 3, form.is_convex());
        let infinite = Vector::repeat(f64::INFINITY);
        let bounds = [Point::from(-infinite), Point::from(infinite)];
        let mut solid = Self { form, interior, bounded, convex, bounds };
        if bounded {
            solid.bounds = solid.bounding_box().unwrap_or(solid.bounds);
        }
        Ok(solid)
    }

    /// The sum of powers.
    pub const fn form(&self) -> &HyperquadricForm {
        &self.form
    }

    /// A point well inside (where F is least, for convex forms).
    pub const fn interior(&self) -> Point {
        self.interior
    }

    /// False when the solid goes on for ever in some direction.
    pub const fn is_bounded(&self) -> bool {
        self.bounded
    }

    /// The factor that takes `p - interior` to the surface of a convex solid, and its gradient's direction:
    /// `(t, ∇F)` with `F(interior + t ray) = 1`; `None` along directions in which the solid goes on for
    /// ever.
    ///
    /// F is convex along the ray and under 1 at its start, so Newton's method from the first plane `|h_i| = 1`,
    /// where F is between 1 and the number of terms, runs down to the root.
    fn leave(&self, ray: &Vector) -> Option<(f64, Vector)> {
        let slabs = self.slab_gauge(ray);
        if !(slabs.0 > 0.0 && slabs.0.is_finite()) {
            return None;
        }
        let terms = self.form.terms.iter();
        let lines: Vec<[f64; 3]> =
            terms.map(|t| [t.height(&self.interior), t.normal.dot(ray), t.exponent]).collect();
        let mut t = 1.0 / slabs.0;
        for _ in 0..100 {
            let (mut value, mut slope) = (-1.0, 0.0);
            for [start, step, e] in &lines {
                let h = start + t * step;
                let steep = signed_power(h, e - 1.0);
                value += power(h, *e);
                slope += e * steep * step;
            }
            let next = t - value / slope;
            // rounding alone can bring it under the root
            if value <= 0.0 || next.is_nan() || next >= t || next <= 0.0 {
                break;
            }
            t = next;
        }
        Some((t, self.form.slope(&(self.interior + ray * t))))
    }

    /// Gauge of the polytope `|h_i| <= 1` about the inner point, and its plane that the ray leaves by.
    fn slab_gauge(&self, ray: &Vector) -> (f64, Vector) {
        let mut largest = (0.0, Vector::zeros());
        for t in &self.form.terms {
            let (start, step) = (t.height(&self.interior), t.normal.dot(ray));
            let room = 1.0 - start.copysign(start * step);
            let value = step.abs() / room;
            if value > largest.0 {
                largest = (value, t.normal * (step.signum() / room));
            }
        }
        largest
    }

    /// Gauge about the inner point and its gradient, for a convex solid.
    fn radial_gauge(&self, ray: &Vector) -> (f64, Vector) {
        let size = ray.amax();
        if size == 0.0 {
            return (0.0, Vector::zeros());
        }
        let unit = ray / size;
        let Some((t, slope)) = self.leave(&unit) else {
            return (0.0, Vector::zeros());
        };
        // implicit function theorem: F(c + (p - c)/g) = 1
        let gradient = slope / (slope.dot(&unit) * t);
        let finite = gradient.iter().all(|v| v.is_finite());
        (size / t, if finite { gradient } else { Vector::zeros() })
    }
}

impl Implicit for Hyperquadric {
    fn gauge(&self, p: &Point) -> f64 {
        if !p.iter().all(|v| v.is_finite()) {
            return f64::INFINITY;
        }
        if self.convex {
            return self.radial_gauge(&(p - self.interior)).0;
        }
        (self.form.log_value(p).0 / self.largest_exponent()).exp()
    }

    /// Zero at the inner point and where a component is infinite; on creases the middle of the slopes of both
    /// sides.
    fn gradient(&self, p: &Point) -> Vector {
        if self.convex {
            return self.radial_gauge(&(p - self.interior)).1;
        }
        let (log, shares) = self.form.log_value(p);
        let largest = self.largest_exponent();
        let part = |(t, share): (&form::Term, &f64)| {
            let h = t.height(p);
            if h == 0.0 { Vector::zeros() } else { t.normal * (t.exponent * share / h) }
        };
        let sum: Vector = self.form.terms.iter().zip(&shares).map(part).sum();
        let gradient = sum * ((log / largest).exp() / largest);
        if gradient.iter().all(|v| v.is_finite()) { gradient } else { Vector::zeros() }
    }

    fn bounds(&self) -> [Point; 2] {
        self.bounds
    }

    fn is_convex(&self) -> bool {
        self.convex
    }
}

impl Hyperquadric {
    fn largest_exponent(&self) -> f64 {
        self.form.terms.iter().map(|t| t.exponent).fold(0.0, f64::max)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::Superellipsoid;

    fn random_solid(random: &mut Stream, choices: &[f64]) -> Option<Hyperquadric> {
        let count = 3 + random.index(5);
        let mut number = |size: f64| random.between(-size, size);
        let planes: Vec<[f64; 4]> =
            (0..count).map(|_| [number(1.0), number(1.0), number(1.0), number(0.4)]).collect();
        let exponents: Vec<f64> =
            (0..count).map(|_| choices[random.index(choices.len())]).collect();
        Hyperquadric::new(&planes, &exponents).ok()
    }

    #[test]
    fn a_moved_superellipsoid_is_the_same_solid() {
        let truth = Superellipsoid::new([0.2, 0.5, 0.1], [0.25; 2]).unwrap();
        let planes = [[5.0, 0.0, 0.0, -1.0], [0.0, 2.0, 0.0, 3.0], [0.0, 0.0, 10.0, 0.5]];
        let solid = Hyperquadric::new(&planes, &[8.0; 3]).unwrap();
        let centre = Point::new(0.2, -1.5, -0.05);
        assert!((solid.interior() - centre).norm() < 1e-6, "{}", solid.interior());
        for d in [[0.1, 0.2, 0.05], [0.3, -0.4, 0.2], [1e-3, 0.0, 5.0], [0.0, 0.499, 0.0]] {
            let d = Vector::from(d);
            assert!((solid.gauge(&(centre + d)) - truth.gauge(&d.into())).abs() < 1e-5);
            assert!((solid.gradient(&(centre + d)) - truth.gradient(&d.into())).norm() < 1e-3);
        }
        let [low, high] = solid.bounds();
        assert!((high - Point::new(0.4, -1.0, 0.05)).amax() < 1e-3, "{high}");
        assert!((low - Point::new(0.0, -2.0, -0.15)).amax() < 1e-3, "{low}");
    }

    #[test]
    fn gauge_gradient_and_bounds_hold_on_random_solids() {
        let mut random = Stream::new(11, 0);
        let (mut solids, mut sides, mut loose) = (0, 0, 0);
        for case in 0..120 {
            let choices: &[f64] =
                if case % 4 == 0 { &[1.0, 1.5] } else { &[1.0, 1.5, 2.0, 3.3, 8.0, 20.0, 300.0] };
            let Some(solid) = random_solid(&mut random, choices) else { continue };
            solids += 1;
            let [low, high] = solid.bounds();
            let mut surface = |near: Vector, spread: f64| {
                let ray = near + Vector::from_fn(|_, _| spread * random.normal());
                let p = solid.interior() + ray / solid.gauge(&(solid.interior() + ray));
                assert!((solid.form().value(&p) - 1.0).abs() < 1e-9);
                assert!((0..3).all(|k| p[k] >= low[k] && p[k] <= high[k]), "{case} {p}");
                p
            };
            // climbs to the farthest point along each axis by random steps
            for (k, side) in (0..3).flat_map(|k| [(k, 1.0), (k, -1.0)]) {
                let mut best = surface(Vector::zeros(), 1.0);
                for i in 0..1500 {
                    let near = best - solid.interior();
                    let spread = if i % 2 == 0 { near.norm() } else { 0.02 * near.norm() };
                    let p = surface(near, spread);
                    best = if side * p[k] > side * best[k] { p } else { best };
                }
                let bound = if side > 0.0 { high[k] } else { low[k] };
                sides += 1;
                loose += usize::from((bound - best[k]).abs() > 0.02 * (high[k] - low[k]));
            }
            let ray = Vector::from_fn(|_, _| random.normal());
            let p = solid.interior() + ray;
            let (gradient, h) = (solid.gradient(&p), 1e-6);
            assert!((gradient.dot(&ray) / solid.gauge(&p) - 1.0).abs() < 1e-9, "Euler");
            let smooth = solid.form().terms.iter().all(|t| t.height(&p).abs() > 1e-2);
            for k in 0..3 {
                let step = Vector::from_fn(|i, _| if i == k { h } else { 0.0 });
                let d = (solid.gauge(&(p + step)) - solid.gauge(&(p - step))) / (2.0 * h);
                let error = (gradient[k] - d).abs() / gradient.norm();
                assert!(error < if smooth { 1e-4 } else { 1e-1 }, "{case} {gradient} {d}");
            }
        }
        assert!(solids > 80, "{solids}");
        // where an exponent of 300 makes corners of 1e-3 the climb may end before the box does
        assert!(loose * 50 < sides, "{loose} of {sides} sides are loose");
    }

    #[test]
    fn exponents_under_one_are_told_inside_from_outside() {
        let mut random = Stream::new(5, 0);
        let mut solids = 0;
        for _ in 0..100 {
            let Some(solid) = random_solid(&mut random, &[0.4, 0.7, 1.0, 3.0]) else { continue };
            solids += 1;
            let [low, high] = solid.bounds();
            for _ in 0..500 {
                let p = Point::from(low.coords.zip_map(&high.coords, |a, b| random.between(a, b)));
                assert_eq!(solid.contains(&p), solid.form().value(&p) <= 1.0 + 1e-14);
            }
        }
        assert!(solids > 50, "{solids}");
    }

    #[test]
    fn empty_and_endless_ones_are_told() {
        // |x - 3| + |x + 3| >= 6
        let apart = [[1.0, 0.0, 0.0, -3.0], [1.0, 0.0, 0.0, 3.0], [0.0, 1.0, 0.0, 0.0]];
        for e in [0.5, 1.0, 2.0, 700.0] {
            assert!(Hyperquadric::new(&apart, &[e; 3]).is_err());
        }
        // a pipe without end: z does not matter
        let pipe = [[1.0, 0.0, 0.0, -0.2], [0.0, 1.0, 0.0, 0.0], [1.0, 1.0, 0.0, 0.0]];
        let pipe = Hyperquadric::new(&pipe, &[2.0; 3]).unwrap();
        assert!(!pipe.is_bounded() && pipe.form().rank() == 2);
        assert!(pipe.bounds()[1].z.is_infinite());
        assert!(
            (pipe.gauge(&Point::new(0.1, 0.0, 1e300)) - pipe.gauge(&Point::new(0.1, 0.0, 0.0)))
                .abs()
                < 1e-12
        );
        let line = pipe.interior() + Vector::z();
        assert_eq!((pipe.gauge(&line), pipe.gradient(&line)), (0.0, Vector::zeros()));
    }

    #[test]
    fn second_derivatives_agree_with_differences() {
        let planes = [
            [1.0, 0.3, 0.0, 0.1],
            [0.0, 1.0, -0.4, 0.2],
            [0.2, 0.0, 1.0, 0.0],
            [1.0, 1.0, 1.0, 0.3],
        ];
        let form = HyperquadricForm::new(&planes, &[1.5, 2.0, 4.0, 1.0]).unwrap();
        let (p, h) = (Point::new(0.3, 0.1, -0.2), 1e-6);
        let hessian = form.hessian(&p).unwrap();
        for k in 0..3 {
            let step = Vector::from_fn(|i, _| if i == k { h } else { 0.0 });
            let d = (form.gradient(&(p + step)).unwrap() - form.gradient(&(p - step)).unwrap())
                / (2.0 * h);
            assert!((hessian.column(k) - d).norm() < 1e-6);
        }
        let crease = Point::new(-0.1, 0.0, 0.0);
        assert!(form.gradient(&crease).is_some() && form.hessian(&crease).is_none());
    }

    #[test]
    fn wrong_numbers_are_refused_and_odd_points_answered() {
        let planes = [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.1], [0.0, 0.0, 1.0, 0.0]];
        for bad in [f64::NAN, f64::INFINITY, 0.0, 1e308, 5e-324] {
            assert!(Hyperquadric::new(&planes, &[2.0, bad, 2.0]).is_err());
            let mut wrong = planes;
            wrong[1][1] = bad;
            assert!(Hyperquadric::new(&wrong, &[2.0; 3]).is_err());
            wrong = planes;
            wrong[0][3] = bad;
            assert_eq!(Hyperquadric::new(&wrong, &[2.0; 3]).is_ok(), bad.abs() < 1.0);
        }
        assert!(Hyperquadric::new(&planes, &[2.0; 2]).is_err());
        assert!(Hyperquadric::new(&[], &[]).is_err());
        for e in [0.5, 1.0, 2.0, 1e3] {
            let tilted = [[1.0, -1.0, 0.0, 0.0], [0.0, 1e9, 0.0, 0.1], [1.0, 0.0, -1e-9, 0.1]];
            let solid = Hyperquadric::new(&tilted, &[e; 3]).unwrap();
            for v in [0.0, 5e-324, 1e-200, 1.0, 1e200, 1e308, -1e308] {
                for p in [[v, v, v], [v, 0.0, 0.0], [v, -v, 1.0], [0.0, 0.0, v]] {
                    let p = Point::from(p);
                    assert!(
                        !solid.gauge(&p).is_nan() && !solid.form().value(&p).is_nan(),
                        "{e} {p}"
                    );
                    assert!(solid.gradient(&p).iter().all(|v| v.is_finite()), "{e} {p}");
                }
            }
        }
    }
}
