//! Where a ray first meets a supertoroid.
//!
//! Along a ray the section's radius `ρ̂(t)` is convex, so it crosses the middle line of the tube, `ρ̂ = a4`, at most
//! twice: at `t1` on the way in and at `t2` on the way out. Before `t1` and after `t2` the gauge
//! `‖(ρ̂ - a4, z/a3)‖` is convex for exponents up to 2, and Newton's method runs monotonically to the first hit or to the
//! proof that there is none; between, across the hole, it is sampled.

use super::hit::{Along, Hit, clip};
use crate::numeric::superellipse::weighted;
use crate::shape::{Ray, Supertoroid};

/// Intervals across the hole.
const ACROSS: usize = 16;

/// What [`first_hit`](super::first_hit) answers, with fewer questions to the gauge: the first point of the ring along the ray, at
/// most `max` metres from its origin.
pub(crate) fn ring_hit(ring: &Supertoroid, ray: &Ray, max: f64) -> Option<Hit> {
    use crate::shape::Implicit;
    let along = Along { shape: ring, ray };
    let [near, far] = clip(&ring.bounds(), ray, max)?;
    let convex = ring.exponents().iter().all(|e| *e <= 2.0);
    if !convex || along.value(near) <= 0.0 {
        return super::first_hit(ring, ray, max);
    }
    let radius = Radius { ring, ray };
    let distance = match radius.crossings(near, far) {
        None => along.convex(near, far),
        Some([first, last]) => {
            let before = if first > near { along.convex(near, first) } else { None };
            before
                .or_else(|| along.sampled(first, last, ACROSS))
                .or_else(|| if last < far { along.convex(last, far) } else { None })
        }
    }?;
    (distance <= max).then(|| along.hit(distance))
}

/// The radius of the section along a ray.
struct Radius<'a> {
    ring: &'a Supertoroid,
    ray: &'a Ray,
}

impl Radius<'_> {
    /// `ρ̂ - a4` and its derivative.
    fn at(&self, t: f64) -> (f64, f64) {
        let [a1, a2, _] = self.ring.semi_axes();
        let (p, d) = (self.ray.at(t), &self.ray.direction);
        let planar = weighted((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / self.ring.exponents()[1]);
        let rate = |share: f64, x: f64, dx: f64| if x == 0.0 { 0.0 } else { share * dx / x };
        let slope = rate(planar.first, p.x, d.x) + rate(planar.second, p.y, d.y);
        (planar.norm - self.ring.ring_ratio(), planar.norm * slope)
    }

    /// Where the radius is a4 in an interval; its ends where it is less there already.
    fn crossings(&self, near: f64, far: f64) -> Option<[f64; 2]> {
        let from = |mut t: f64, side: f64| {
            for _ in 0..100 {
                let (value, slope) = self.at(t);
                // on either side of the middle line: so near that the next piece holds the rest
                if value <= 1e-12 * self.ring.ring_ratio() {
                    return Some(t);
                }
                let next = t - value / slope;
                if slope * side >= 0.0 || !(near..=far).contains(&next) {
                    return None;
                }
                t = next;
            }
            Some(t)
        };
        let first = from(near, 1.0)?;
        let last = from(far, -1.0)?;
        (first < last).then_some([first, last])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::measure::first_hit;
    use crate::numeric::random::Stream;
    use crate::{Direction, Point, Vector};

    #[test]
    fn rings_are_met_where_samples_say() {
        let (mut met, mut other) = (0, 0);
        for k in 0..4000 {
            let mut stream = Stream::new(8, k);
            let mut draw = |low, high| stream.between(low, high);
            let axes = [draw(0.1, 0.3), draw(0.1, 0.3), draw(0.1, 0.5)];
            let exponents = [draw(0.1, 2.0), draw(0.1, 2.0)];
            let ring = Supertoroid::new(axes, draw(1.0, 5.0), exponents).unwrap();
            let origin = Point::new(draw(-2.0, 2.0), draw(-2.0, 2.0), draw(-2.0, 2.0));
            let at = Vector::new(draw(-0.8, 0.8), draw(-0.8, 0.8), draw(-0.3, 0.3));
            let ray = Ray { origin, direction: Direction::new_normalize(at - origin.coords) };
            let quick = ring_hit(&ring, &ray, 9.0).map(|h| h.distance);
            let slow = first_hit(&ring, &ray, 9.0).map(|h| h.distance);
            met += usize::from(slow.is_some());
            // samples miss thin pieces now and then, on either side
            let same = match (quick, slow) {
                (Some(a), Some(b)) => (a - b).abs() < 1e-7,
                (a, b) => a == b,
            };
            other += usize::from(!same);
        }
        assert!(met > 1000 && other <= 4, "{met} {other}");
    }
}
