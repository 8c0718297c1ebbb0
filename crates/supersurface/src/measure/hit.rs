//! Where a ray first meets a solid.
//!
//! Along the ray the gauge is a function `g(t)` of one number, and the first hit is the first change
//! of sign of `g - 1` inside the solid's bounding box. A convex gauge lies above its tangents, so
//! Newton's method from the box towards the solid cannot step over the root: `t ← t - (g - 1)/g'`
//! runs monotonically to it, or finds `g' >= 0` first, which proves a miss. Any other gauge is
//! sampled; dips between samples are found by the sign of `g'` and searched for their minimum.
//!
//! What is not guaranteed: of a solid that is not convex, a piece thinner than 1/40 of the way
//! through the box with a second dip in the same interval may be missed.

use crate::shape::{Implicit, Ray};
use crate::{Direction, Point};

/// Number of intervals in which a gauge that is not convex is sampled.
const INTERVALS: usize = 40;
/// A gauge this close to 1 is on the surface.
const ON_SURFACE: f64 = 4.0 * f64::EPSILON;

/// Where a ray meets a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin in metres, not negative.
    pub distance: f64,
    /// The point of the surface.
    pub point: Point,
    /// Outward unit normal there (against the ray where an edge or a cusp has none).
    pub normal: Direction,
}

/// The first point of the surface along the ray, at most `max` metres from its origin; `None` when
/// there is none, or when a number of the ray is not finite. A ray that starts inside meets the
/// surface where it leaves. A solid without bounds needs a finite `max`.
///
/// ```
/// use supersurface::{Direction, Point, Vector, measure::first_hit, shape::{Ray, Superellipsoid}};
/// let ball = Superellipsoid::new([1.0; 3], [1.0; 2])?;
/// let ray = Ray { origin: Point::new(0.0, 0.0, -3.0), direction: Vector::z_axis() };
/// let hit = first_hit(&ball, &ray, f64::INFINITY).unwrap();
/// assert!((hit.distance - 2.0).abs() < 1e-12);
/// assert!((hit.normal.z + 1.0).abs() < 1e-12);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn first_hit(shape: &(impl Implicit + ?Sized), ray: &Ray, max: f64) -> Option<Hit> {
    let [near, far] = clip(&shape.bounds(), ray, max)?;
    if near > max || max.is_nan() {
        return None;
    }
    let along = Along { shape, ray };
    let distance = if shape.is_convex() {
        along.convex(near, far)
    } else {
        along.sampled(near, far, INTERVALS)
    }?;
    (distance <= max).then(|| along.hit(distance))
}

/// The part of the ray inside a box, a little widened so that its ends lie outside the solid; in a box without
/// end the part up to `max`.
pub(super) fn clip([low, high]: &[Point; 2], ray: &Ray, max: f64) -> Option<[f64; 2]> {
    let margin = 1e-9 * (high - low).amax();
    let (mut near, mut far) = (0.0f64, f64::INFINITY);
    for axis in 0..3 {
        let (origin, step) = (ray.origin[axis], ray.direction[axis]);
        let (low, high) = (low[axis] - margin - origin, high[axis] + margin - origin);
        if step == 0.0 {
            if !(low <= 0.0 && high >= 0.0) {
                return None;
            }
            continue;
        }
        let (a, b) = (low / step, high / step);
        if a.is_nan() || b.is_nan() {
            return None;
        }
        near = near.max(a.min(b));
        far = far.min(a.max(b));
    }
    if far == f64::INFINITY {
        far = max;
    }
    (near <= far && far.is_finite()).then_some([near, far])
}

/// The gauge of a shape as a function of the distance along a ray.
pub(super) struct Along<'a, S: ?Sized> {
    pub(super) shape: &'a S,
    pub(super) ray: &'a Ray,
}

impl<S: Implicit + ?Sized> Along<'_, S> {
    /// `g(t) - 1`.
    #[inline]
    pub(super) fn value(&self, t: f64) -> f64 {
        self.shape.gauge(&self.ray.at(t)) - 1.0
    }

    /// `g'(t)`.
    #[inline]
    fn slope(&self, t: f64) -> f64 {
        self.shape.gradient(&self.ray.at(t)).dot(&self.ray.direction)
    }

    pub(super) fn hit(&self, distance: f64) -> Hit {
        let point = self.ray.at(distance);
        let gradient = self.shape.gradient(&point);
        // scaled first: the gradient of a body of 1e-200 m would overflow when squared
        let largest = gradient.amax();
        let normal = if largest > 0.0 && largest.is_finite() {
            Direction::new_normalize(gradient / largest)
        } else {
            -self.ray.direction
        };
        Hit { distance, point, normal }
    }

    /// Newton's method from outside: from the near end, or, when the ray starts inside, back from
    /// the far end.
    pub(super) fn convex(&self, near: f64, far: f64) -> Option<f64> {
        let inside = self.value(near) <= 0.0;
        // sign of the slope on the side from which the root is approached
        let (mut t, side) = if inside { (far, 1.0) } else { (near, -1.0) };
        for _ in 0..100 {
            let value = self.value(t);
            if value <= ON_SURFACE {
                break;
            }
            let slope = self.slope(t);
            let passed = slope * side <= 0.0 || slope.is_nan();
            let next = t - value / slope;
            if passed || next < near || next > far {
                // inside, the root exists: rounding alone can bring us here, next to it
                return inside.then_some(near);
            }
            if next == t {
                break;
            }
            t = next;
        }
        Some(t)
    }

    /// The first change of sign between samples, or inside a dip between two of them.
    pub(super) fn sampled(&self, near: f64, far: f64, intervals: usize) -> Option<f64> {
        let step = (far - near) / intervals as f64;
        let (mut a, mut value_a) = (near, self.value(near));
        let inside = value_a <= 0.0;
        let mut slope_a = if inside { 0.0 } else { self.slope(near) };
        for i in 1..=intervals {
            let b = near + step * i as f64;
            let value_b = self.value(b);
            if (value_b <= 0.0) != inside {
                return Some(self.root(a, b, inside));
            }
            let mut slope_b = 0.0;
            if inside {
                // a gap thinner than an interval is not looked for
            } else {
                slope_b = self.slope(b);
                if slope_a < 0.0 && slope_b > 0.0 {
                    let ends = [(a, value_a, slope_a), (b, value_b, slope_b)];
                    if let Some(bottom) = self.dip(ends, step) {
                        return Some(self.root(a, bottom, false));
                    }
                }
            }
            (a, value_a, slope_a) = (b, value_b, slope_b);
        }
        None
    }

    /// A point of a dip where the gauge is at most 1. Ends are (t, value, slope).
    fn dip(&self, [mut a, mut b]: [(f64, f64, f64); 2], step: f64) -> Option<f64> {
        for _ in 0..60 {
            let width = b.0 - a.0;
            // where the tangents of the ends cross lies the lowest that a convex dip can reach
            let cross = (b.1 - a.1 - b.2 * width) / (a.2 - b.2);
            let floor = a.1 + a.2 * cross;
            if width < 0.15 * step && floor > 0.0 || width <= 1e-14 * b.0.abs() {
                return None;
            }
            let inner = (0.1 * width)..=(0.9 * width);
            let t = a.0 + if inner.contains(&cross) { cross } else { 0.5 * width };
            let (value, slope) = (self.value(t), self.slope(t));
            if value <= 0.0 {
                return Some(t);
            }
            if slope < 0.0 {
                a = (t, value, slope);
            } else {
                b = (t, value, slope);
            }
        }
        None
    }

    /// The root in `[a, b]`: Newton's steps kept inside the shrinking interval. `leaving` says that
    /// `a` is the end inside the solid.
    fn root(&self, mut a: f64, mut b: f64, leaving: bool) -> f64 {
        let mut t = 0.5 * (a + b);
        for round in 0..100 {
            let value = self.value(t);
            if value.abs() <= ON_SURFACE {
                return t;
            }
            if (value <= 0.0) == leaving {
                a = t;
            } else {
                b = t;
            }
            let newton = t - value / self.slope(t);
            let middle = 0.5 * (a + b);
            let trusted = newton > a && newton < b && (round < 12 || round % 2 == 0);
            let next = if trusted { newton } else { middle };
            if next == t || b - a <= f64::EPSILON * b.abs() {
                return next;
            }
            t = next;
        }
        t
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;
    use crate::shape::{Superellipsoid, SuperhyperboloidOneSheet, Superparaboloid, Supertoroid};

    fn ray(origin: [f64; 3], direction: [f64; 3]) -> Ray {
        Ray {
            origin: Point::from(origin),
            direction: Direction::new_normalize(Vector::from(direction)),
        }
    }

    #[test]
    fn a_ray_from_inside_leaves_at_the_far_side() {
        let ball = Superellipsoid::new([2.0; 3], [1.0; 2]).unwrap();
        let hit = first_hit(&ball, &ray([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), 9.0).unwrap();
        assert!((hit.distance - 1.0).abs() < 1e-12 && hit.normal.x > 0.999);
        assert!(first_hit(&ball, &ray([1.0, 0.0, 0.0], [1.0, 0.0, 0.0]), 0.9).is_none());
    }

    #[test]
    fn solids_without_bounds_are_met_up_to_a_finite_length() {
        let bowl = Superparaboloid::new([1.0; 3], [1.0; 2]).unwrap();
        let up = ray([0.5, 0.0, -2.0], [0.0, 0.0, 1.0]);
        assert!((first_hit(&bowl, &up, 10.0).unwrap().distance - 2.25).abs() < 1e-12);
        assert!(first_hit(&bowl, &up, 2.0).is_none());
        let waist = SuperhyperboloidOneSheet::new([1.0; 3], [1.0; 2]).unwrap();
        let hit = first_hit(&waist, &ray([-5.0, 0.0, 0.0], [1.0, 0.0, 0.0]), 20.0).unwrap();
        assert!((hit.distance - 4.0).abs() < 1e-12 && hit.normal.x < -0.999);
    }

    #[test]
    fn the_four_crossings_of_a_torus_come_in_order() {
        let ring = Supertoroid::new([1.0; 3], 4.0, [1.0; 2]).unwrap();
        for (x, expected) in [(-10.0, 5.0), (-4.0, 1.0), (0.0, 3.0), (4.5, 0.5)] {
            let hit = first_hit(&ring, &ray([x, 0.0, 0.0], [1.0, 0.0, 0.0]), 99.0).unwrap();
            assert!((hit.distance - expected).abs() < 1e-11, "from {x}: {}", hit.distance);
        }
        assert!(first_hit(&ring, &ray([0.0, 0.0, 9.0], [0.0, 0.0, -1.0]), 99.0).is_none());
    }

    #[test]
    fn grazing_rays_of_a_ring_are_told_apart() {
        let ring = Supertoroid::new([1.0; 3], 4.0, [1.0; 2]).unwrap();
        for (height, meets) in [(1.0 - 1e-9, true), (1.0 + 1e-9, false)] {
            let hit = first_hit(&ring, &ray([-9.0, 0.3, height], [1.0, 0.0, 0.0]), 99.0);
            assert_eq!(hit.is_some(), meets, "{height}");
        }
    }

    #[test]
    fn numbers_that_are_not_finite_hit_nothing() {
        let ball = Superellipsoid::new([2.0; 3], [1.0; 2]).unwrap();
        for bad in [f64::NAN, f64::INFINITY] {
            assert!(first_hit(&ball, &ray([bad, 0.0, 0.0], [1.0, 0.0, 0.0]), 9.0).is_none());
        }
        assert!(first_hit(&ball, &ray([0.0; 3], [1.0, 0.0, 0.0]), f64::NAN).is_none());
    }
}
