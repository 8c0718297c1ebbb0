//! Indentations by the exact closest point: the reference for equation (46).

use super::indentation::{Indentation, Indented};
use crate::measure::ClosestFinder;
use crate::shape::{Implicit, Superellipsoid, Supertoroid};
use crate::{Direction, Point, Vector};

/// A solid whose indentations lead to the closest point of its surface, some ten times slower than those of
/// equation (46). Making it costs as much as some queries.
///
/// ```
/// use supersurface::{Point, contact::{ByClosestPoint, Indented}, shape::Superellipsoid};
/// let egg = Superellipsoid::new([0.03, 0.03, 0.09], [1.0, 1.0])?;
/// let p = Point::new(0.005, 0.0, 0.085);
/// let [radial, exact] = [
///     egg.indentation(&p).unwrap().depth,
///     ByClosestPoint::superellipsoid(&egg).indentation(&p).unwrap().depth,
/// ];
/// assert!(exact < radial && radial < 1.02 * exact);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug)]
pub struct ByClosestPoint<S> {
    solid: S,
    finder: ClosestFinder,
}

impl ByClosestPoint<Superellipsoid> {
    /// Of a superellipsoid.
    pub fn superellipsoid(solid: &Superellipsoid) -> Self {
        Self { solid: *solid, finder: ClosestFinder::superellipsoid(solid) }
    }
}

impl ByClosestPoint<Supertoroid> {
    /// Of a supertoroid.
    pub fn supertoroid(solid: &Supertoroid) -> Self {
        Self { solid: *solid, finder: ClosestFinder::supertoroid(solid) }
    }
}

impl<S> ByClosestPoint<S> {
    /// The solid itself.
    pub const fn solid(&self) -> &S {
        &self.solid
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
        Some(self.finder.find(p)?.point)
    }

    fn indentation(&self, p: &Point) -> Option<Indentation> {
        if self.solid.gauge(p) >= 1.0 {
            return None;
        }
        let found = self.finder.find(p)?;
        let (way, depth) = (found.point - p, -found.distance);
        let [low, high] = self.solid.bounds();
        // on the surface the way has no direction, the gradient has
        let on = depth <= 1e-9 * (high - low).amax();
        let along = if on { self.solid.gradient(&found.point) } else { way };
        let normal = Direction::try_new(along, 0.0)?;
        (depth > 0.0).then(|| Indentation::new(found.point, normal, depth))
    }
}
