//! What a shape can answer. Each trait is implemented only where the mathematics allows.

use crate::{Direction, Point, Vector};

/// A solid given by a gauge: below 1 inside, 1 on the surface, above 1 outside.
pub trait Implicit {
    /// The gauge at a point (FORMULAS §0.1). For a superellipsoid it is 1-homogeneous; for a
    /// supertoroid it is the gauge of the cross-section. Never NaN for finite points.
    fn gauge(&self, p: &Point) -> f64;

    /// Gradient of the gauge, in 1/m. Zero where it is not defined (centre, axis of a toroid).
    fn gradient(&self, p: &Point) -> Vector;

    /// Corners of an axis-aligned box (lowest, highest) that contains the solid, in metres.
    fn bounds(&self) -> [Point; 2];

    /// True when the gauge is a convex function of the point, so that a ray meets the solid in one
    /// interval. `false` promises nothing.
    fn is_convex(&self) -> bool {
        false
    }

    /// True inside or on the surface.
    fn contains(&self, p: &Point) -> bool {
        self.gauge(p) <= 1.0
    }

    /// First-order (Taubin) signed distance `(g - 1)/|∇g|` in metres, positive outside.
    fn first_order_distance(&self, p: &Point) -> f64 {
        let gradient = self.gradient(p).norm();
        if gradient > 0.0 { (self.gauge(p) - 1.0) / gradient } else { f64::NEG_INFINITY }
    }
}

/// A surface given by two angles: `eta` along the meridian, `omega` around z, in radians.
pub trait Parametric {
    /// Surface point at the two angles.
    fn point(&self, eta: f64, omega: f64) -> Point;

    /// Outward unit normal; `None` where there is none (edges and cusps, exponents from 2).
    fn normal(&self, eta: f64, omega: f64) -> Option<Direction>;
}

/// The support point of a body (of its convex hull, where it is not convex itself).
pub trait SupportMap {
    /// A point of the body that lies farthest along `n` (any length; the zero vector gives any
    /// point). Metres.
    fn support_point(&self, n: &Vector) -> Point;
}
