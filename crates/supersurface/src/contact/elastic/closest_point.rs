//! Indentations by the exact closest point: the reference for equation (46).

use super::indentation::{Indentation, Indented};
use crate::measure::{Closest, ClosestFinder};
use crate::shape::{Implicit, Superellipsoid, Supertoroid};
use crate::{Direction, Point, Vector};

/// A solid whose indentations lead to the closest point of its surface. Making it costs as much as some queries.
///
/// ```
/// use supersurface::{Point, contact::{ByClosestPoint, Indented}, shape::Superellipsoid};
/// let egg = Superellipsoid::new([0.03, 0.03, 0.09], [1.0, 1.0])?;
/// let p = Point::new(0.02, 0.0, 0.06);
/// let [radial, exact] = [
///     egg.indentation(&p).unwrap().depth,
///     ByClosestPoint::superellipsoid(&egg).indentation(&p).unwrap().depth,
/// ];
/// assert!(exact < radial && radial < 1.1 * exact);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug)]
pub struct ByClosestPoint<S> {
    solid: S,
    finder: ClosestFinder,
    is_local: bool,
}

impl ByClosestPoint<Superellipsoid> {
    /// Of a superellipsoid.
    pub fn superellipsoid(solid: &Superellipsoid) -> Self {
        Self { solid: *solid, finder: ClosestFinder::superellipsoid(solid), is_local: false }
    }
}

impl ByClosestPoint<Supertoroid> {
    /// Of a supertoroid.
    pub fn supertoroid(solid: &Supertoroid) -> Self {
        Self { solid: *solid, finder: ClosestFinder::supertoroid(solid), is_local: false }
    }
}

impl<S> ByClosestPoint<S> {
    /// The solid itself.
    pub const fn solid(&self) -> &S {
        &self.solid
    }

    /// The same by a few steps of Newton's method from the radial foot alone: faster, and the closest point for points
    /// less deep than the surface's smallest radius of curvature ([`ClosestFinder::find_from_foot`]).
    pub fn from_foot(mut self) -> Self {
        self.is_local = true;
        self
    }

    fn find(&self, p: &Point) -> Option<Closest> {
        if self.is_local { self.finder.find_from_foot(p) } else { self.finder.find(p) }
    }
}

impl<S: Implicit> Implicit for ByClosestPoint<S> {
    fn gauge(&self, p: &Point) -> f64 {
        self.solid.gauge(p)
    }

    fn gradient(&self, p: &Point) -> Vector {
        self.solid.gradient(p)
    }

    fn bounds(&self) -> [Point; 2] {
        self.solid.bounds()
    }

    fn extent(&self, n: &Vector) -> f64 {
        self.solid.extent(n)
    }

    fn is_convex(&self) -> bool {
        self.solid.is_convex()
    }
}

impl<S: Implicit> Indented for ByClosestPoint<S> {
    /// The closest point, for points outside too.
    fn foot(&self, p: &Point) -> Option<Point> {
        Some(self.find(p)?.point)
    }

    fn indentation(&self, p: &Point) -> Option<Indentation> {
        if self.solid.gauge(p) >= 1.0 {
            return None;
        }
        let found = self.find(p)?;
        let (way, depth) = (found.point - p, -found.distance);
        let [low, high] = self.solid.bounds();
        // on the surface the way has no direction, the gradient has
        let on = depth <= 1e-9 * (high - low).amax();
        let along = if on { self.solid.gradient(&found.point) } else { way };
        let normal = Direction::try_new(along, 0.0)?;
        (depth > 0.0).then(|| Indentation::new(found.point, normal, depth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::Parametric;

    /// Shares of points under the surface of which the closest point is missed, and the largest excess of depth.
    fn missed<S: Implicit + Parametric + Clone>(
        exact: &ByClosestPoint<S>,
        share: f64,
        random: &mut Stream,
    ) -> [f64; 2] {
        let (local, solid) = (exact.clone().from_foot(), exact.solid());
        let [[e0, e1], [w0, w1]] = solid.domain();
        let (mut all, mut missed, mut largest) = (0.0, 0.0, 0.0f64);
        for _ in 0..200 {
            let (eta, omega) = (random.between(e0, e1), random.between(w0, w1));
            let Some(normal) = solid.normal(eta, omega) else { continue };
            let p = solid.point(eta, omega) - *normal * share;
            let (Some(a), Some(b)) = (local.indentation(&p), exact.indentation(&p)) else {
                continue;
            };
            let excess = a.depth / b.depth - 1.0;
            assert!(excess > -1e-9, "{p}");
            all += 1.0;
            missed += f64::from(u8::from(excess > 1e-6));
            largest = largest.max(excess);
        }
        [missed / all, largest]
    }

    #[test]
    fn newton_from_the_foot_finds_the_closest_point_where_it_is_shallow() {
        let mut random = Stream::new(5, 0);
        for share in [0.01, 0.05, 0.1] {
            let (mut worst, mut sum, mut count) = ([0.0f64; 2], 0.0, 0.0);
            for _ in 0..60 {
                let axes = [0; 3].map(|_| random.between(1.0, 3.0));
                let e = [0; 2].map(|_| random.between(0.2, 1.8));
                let tin = Superellipsoid::new(axes, e).unwrap();
                let ring = Supertoroid::new(axes, random.between(1.2, 3.0), e).unwrap();
                for found in [
                    missed(&ByClosestPoint::superellipsoid(&tin), share, &mut random),
                    missed(&ByClosestPoint::supertoroid(&ring), share, &mut random),
                ] {
                    worst = [worst[0].max(found[0]), worst[1].max(found[1])];
                    sum += found[0];
                    count += 1.0;
                }
            }
            // on most bodies none, on the worst some by their edges
            assert!(sum / count < 2e-3 && worst[0] < 0.05, "{share}: {} {worst:?}", sum / count);
        }
    }
}
