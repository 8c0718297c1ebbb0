//! What a shape can answer. Each trait is implemented only where the mathematics allows.

use std::cmp::Ordering;

use nalgebra::Matrix3;

use crate::numeric::quarter_angle::QuarterAngle;
use crate::shape::{Mass, MassEstimate};
use crate::{Direction, Point, Vector};

/// A solid given by a gauge: below 1 inside, 1 on the surface, above 1 outside.
pub trait Implicit {
    /// The gauge at a point (FORMULAS §0.1). For a superellipsoid it is 1-homogeneous; for a
    /// supertoroid it is the gauge of the cross-section. Never NaN for finite points; infinite where a
    /// point is outside of everything that the form can say.
    fn gauge(&self, p: &Point) -> f64;

    /// Gradient of the gauge, in 1/m. Zero where it is not defined (centre, axis of a toroid)
    /// or overflows.
    fn gradient(&self, p: &Point) -> Vector;

    /// Corners of an axis-aligned box (lowest, highest) that contains the solid, in metres; infinite where
    /// the solid is not bounded.
    fn bounds(&self) -> [Point; 2];

    /// An upper bound of `n·x` over the solid, in metres times `|n|`: the support function where the shape knows
    /// it, otherwise that of the box of [`bounds`](Self::bounds).
    fn extent(&self, n: &Vector) -> f64 {
        box_extent(&self.bounds(), n)
    }

    /// True when the gauge is a convex function of the point, so that a ray meets the solid in one
    /// interval. `false` promises nothing.
    fn is_convex(&self) -> bool {
        false
    }

    /// True inside or on the surface; a point that is not finite is not inside.
    fn contains(&self, p: &Point) -> bool {
        self.gauge(p) <= 1.0 && p.iter().all(|v| v.is_finite())
    }

    /// First-order (Taubin) signed distance `(g - 1)/|∇g|` in metres, positive outside. Infinite with the
    /// sign of `g - 1` where there is no gradient.
    fn first_order_distance(&self, p: &Point) -> f64 {
        let (excess, gradient) = (self.gauge(p) - 1.0, self.gradient(p));
        let largest = gradient.amax();
        match largest > 0.0 {
            // in this order no square overflows
            true => excess / largest / (gradient / largest).norm(),
            false if excess == 0.0 => 0.0,
            false => f64::INFINITY.copysign(excess),
        }
    }
}

/// A gradient; zero where one of its components overflows.
#[inline]
pub(crate) fn finite_or_zero(gradient: Vector) -> Vector {
    if gradient.iter().all(|v| v.is_finite()) { gradient } else { Vector::zeros() }
}

/// The support function of a box (lowest, highest corner), which may be infinite.
pub(crate) fn box_extent([low, high]: &[Point; 2], n: &Vector) -> f64 {
    let along = |n: f64, low: f64, high: f64| match n.partial_cmp(&0.0) {
        Some(Ordering::Greater) => n * high,
        Some(Ordering::Less) => n * low,
        // also where the box is infinite
        _ => 0.0,
    };
    along(n.x, low.x, high.x) + along(n.y, low.y, high.y) + along(n.z, low.z, high.z)
}

impl<S: Implicit + ?Sized> Implicit for Box<S> {
    fn gauge(&self, p: &Point) -> f64 {
        (**self).gauge(p)
    }

    fn gradient(&self, p: &Point) -> Vector {
        (**self).gradient(p)
    }

    fn bounds(&self) -> [Point; 2] {
        (**self).bounds()
    }

    fn extent(&self, n: &Vector) -> f64 {
        (**self).extent(n)
    }

    fn is_convex(&self) -> bool {
        (**self).is_convex()
    }
}

impl<S: Implicit + ?Sized> Implicit for &S {
    fn gauge(&self, p: &Point) -> f64 {
        (**self).gauge(p)
    }

    fn gradient(&self, p: &Point) -> Vector {
        (**self).gradient(p)
    }

    fn bounds(&self) -> [Point; 2] {
        (**self).bounds()
    }

    fn extent(&self, n: &Vector) -> f64 {
        (**self).extent(n)
    }

    fn is_convex(&self) -> bool {
        (**self).is_convex()
    }
}

/// A gauge with second derivatives.
pub trait SecondOrder: Implicit {
    /// Second derivatives of the gauge, in 1/m², symmetric; `None` where they do not exist or are infinite.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>>;
}

impl<S: SecondOrder + ?Sized> SecondOrder for &S {
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        (**self).hessian(p)
    }
}

/// A surface given by two angles: `eta` along the meridian, `omega` around z, in radians.
pub trait Parametric {
    /// Ranges `[[η from, η to], [ω from, ω to]]` in which the angles cover the surface once.
    fn domain(&self) -> [[f64; 2]; 2];

    /// Surface point at the two angles.
    fn point(&self, eta: f64, omega: f64) -> Point;

    /// Surface point at angles that may lie nearer to a seam than numbers in radians can; that of
    /// [`point`](Self::point) where the shape has no need of it.
    fn point_at(&self, eta: QuarterAngle, omega: QuarterAngle) -> Point {
        self.point(eta.radians(), omega.radians())
    }

    /// Derivatives of the point by `eta` and by `omega`, in metres per radian; `None` where one is infinite or
    /// does not exist (seams, for exponents under 1).
    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]>;

    /// Outward unit normal; `None` where there is none (edges and cusps, exponents from 2).
    fn normal(&self, eta: f64, omega: f64) -> Option<Direction>;
}

/// The support point of a body (of its convex hull, where it is not convex itself).
pub trait SupportMap {
    /// A point of the body that lies farthest along `n` (any length; the zero vector gives any
    /// point). Metres.
    fn support_point(&self, n: &Vector) -> Point;

    /// The support function `h(n) = max n·x`: the distance of the tangent plane times `|n|`.
    fn support(&self, n: &Vector) -> f64 {
        n.dot(&self.support_point(n).coords)
    }
}

/// A solid whose volume and moments are known, in closed form or by integration.
pub trait MassProperties {
    /// Mass, centre of mass and inertia for a uniform density in kg/m³.
    fn mass_properties(&self, density: f64) -> Mass;

    /// The same with an estimate of the error, which is that of an integration; 0 for closed forms, up to rounding.
    fn mass_estimate(&self, density: f64) -> MassEstimate {
        MassEstimate::exact(self.mass_properties(density))
    }
}
