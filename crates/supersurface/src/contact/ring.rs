//! A supertoroid and a convex body that are apart, or one through the other's hole.
//!
//! A supertoroid is the union of its slices: at each angle around z a flat disc, bounded by the superellipse of its section
//! and convex for ε1 up to 2. The distance is the least over the slices of a convex pair's. Slices next to each
//! other differ by at most the way of their outer edge, so that intervals of angles are bounded from below and only those
//! that could hold something nearer are halved; the best is then refined.

use super::{Contact, Convex, WarmStart, pair};
use crate::numeric::superellipse::norm;
use crate::shape::{InvalidShape, Posed, Superellipsoid, Supertoroid};
use crate::{Pose, Vector};
use nalgebra::{Translation3, UnitQuaternion};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Intervals at first.
const FIRST: usize = 16;
/// Bounds of the distance are at most this far apart, relative to the ring's size.
const CONTENT: f64 = 1e-3;
/// Slices after which the bounds are what they are.
const MOST: usize = 4_000;
/// Thickness of a slice relative to its smaller half width: no slice has none in the pair's query.
const THIN: f64 = 1e-10;
/// Steps of the refinement, each of which leaves 0.618 of the interval.
const GOLDEN_STEPS: usize = 60;

/// The contact of a ring with a convex body; `None` where they overlap. The ring is A.
///
/// Fails for a section that is not convex (ε1 above 2).
///
/// ```
/// use supersurface::contact::{Convex, ring};
/// use supersurface::{Pose, shape::{Posed, Superellipsoid, Supertoroid}};
/// let torus = Posed::new(Supertoroid::new([0.01; 3], 3.0, [1.0; 2])?, Pose::identity())?;
/// let rod = Convex::new(Superellipsoid::new([0.005, 0.005, 0.2], [0.1, 1.0])?)?;
/// let found = ring(&torus, &Posed::new(rod, Pose::translation(0.002, 0.0, 0.0))?)?.unwrap();
/// assert!((found.distance - 0.013).abs() < 1e-6);
/// assert!(ring(&torus, &Posed::new(rod, Pose::translation(0.02, 0.0, 0.0))?)?.is_none());
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn ring(
    torus: &Posed<Supertoroid>,
    body: &Posed<Convex>,
) -> Result<Option<Contact>, InvalidShape> {
    let shape = torus.shape();
    let [section, _] = shape.exponents();
    InvalidShape::check(section <= 2.0, "exponent ε1", section, "at most 2 for convex slices")?;
    let search = Search { torus, body };
    let [a, b, c] = shape.semi_axes();
    let size = a.max(b).max(c) * (1.0 + shape.ring_ratio());
    let mut start = WarmStart::default();
    let width = TAU / FIRST as f64;
    let mut best = (f64::INFINITY, 0.0, width);
    let mut low = f64::INFINITY;
    // off the seams, where the slice is that of a corner for small ε2
    let mut open: Vec<(f64, f64)> =
        (0..FIRST).map(|k| ((k as f64 + 0.5) * width, 0.5 * width)).collect();
    let mut slices = 0;
    while let Some((middle, half)) = open.pop() {
        let found = search.slice(middle, &mut start)?;
        slices += 1;
        if found.distance <= 0.0 {
            return Ok(None);
        }
        if found.distance < best.0 {
            best = (found.distance, middle, half);
        }
        let bound = found.distance - search.way(middle, half);
        if bound >= best.0 - CONTENT * size || slices >= MOST {
            low = low.min(bound);
        } else {
            open.extend([(middle - 0.5 * half, 0.5 * half), (middle + 0.5 * half, 0.5 * half)]);
        }
    }
    let (_, middle, half) = best;
    let mut found = search.refine(middle, half, &mut start)?;
    if found.distance <= 0.0 {
        return Ok(None);
    }
    found.bounds[0] = low.min(found.bounds[0]).max(0.0);
    Ok(Some(found))
}

struct Search<'a> {
    torus: &'a Posed<Supertoroid>,
    body: &'a Posed<Convex>,
}

impl Search<'_> {
    /// Where the middle line of the tube would be for a ring ratio of 1, at a polar angle.
    fn spoke(&self, angle: f64) -> [f64; 2] {
        let [a, b, _] = self.torus.shape().semi_axes();
        let (sin, cos) = angle.sin_cos();
        let power = 2.0 / self.torus.shape().exponents()[1];
        let gauge = norm((cos / a).abs(), (sin / b).abs(), power);
        [cos / gauge, sin / gauge]
    }

    /// The contact with the slice at a polar angle.
    fn slice(&self, angle: f64, start: &mut WarmStart) -> Result<Contact, InvalidShape> {
        let shape = self.torus.shape();
        let [x, y] = self.spoke(angle);
        let (length, height) = (x.hypot(y), shape.semi_axes()[2]);
        let thin = THIN * length.min(height);
        let disc = Superellipsoid::new([length, thin, height], [shape.exponents()[0], 1.0])?;
        let middle = Vector::new(x, y, 0.0) * shape.ring_ratio();
        let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), angle);
        let place = Pose::from_parts(Translation3::from(middle), turn);
        let disc = Posed::new(Convex::new(disc)?, self.torus.pose() * place)?;
        Ok(pair(&disc, self.body, start))
    }

    /// The longest way from a slice to one within an angle of it: that of the tube's outer edge.
    fn way(&self, middle: f64, half: f64) -> f64 {
        let outer = 1.0 + self.torus.shape().ring_ratio();
        let [x, y] = self.spoke(middle);
        let to = |angle: f64| {
            let [p, q] = self.spoke(angle);
            (p - x).hypot(q - y)
        };
        let [a, b, _] = self.torus.shape().semi_axes();
        let corner = b.atan2(a);
        // corners that may lie between, and farther out than both ends
        let places = [0.0, corner, FRAC_PI_2, PI - corner];
        let between = places.iter().map(|place| {
            let nearest = place + ((middle - place) / PI).round() * PI;
            if (nearest - middle).abs() < half { to(nearest) } else { 0.0 }
        });
        outer * between.fold(to(middle - half).max(to(middle + half)), f64::max)
    }

    /// The golden section search for the least distance around an angle.
    fn refine(
        &self,
        middle: f64,
        half: f64,
        start: &mut WarmStart,
    ) -> Result<Contact, InvalidShape> {
        const GOLDEN: f64 = 0.618_033_988_749_894_9;
        let (mut from, mut to) = (middle - 2.0 * half, middle + 2.0 * half);
        let mut best = self.slice(middle, start)?;
        let mut inner = [to - GOLDEN * (to - from), from + GOLDEN * (to - from)];
        let mut found = [self.slice(inner[0], start)?, self.slice(inner[1], start)?];
        for _ in 0..GOLDEN_STEPS {
            let left = found[0].distance < found[1].distance;
            let nearer = found[usize::from(!left)];
            if nearer.distance < best.distance {
                best = nearer;
            }
            if left {
                to = inner[1];
                inner = [to - GOLDEN * (to - from), inner[0]];
                found = [self.slice(inner[0], start)?, found[0]];
            } else {
                from = inner[0];
                inner = [inner[1], from + GOLDEN * (to - from)];
                found = [found[1], self.slice(inner[1], start)?];
            }
        }
        Ok(best)
    }
}
