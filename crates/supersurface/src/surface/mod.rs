//! Floor 5: the family as one type, for files, programs and the pipeline: [`Surface`] is what the pipeline recovers,
//! [`Solid`] any closed member, deformed or not.

mod solid;

pub use solid::Solid;

use crate::shape::{Implicit, Superellipsoid, Supertoroid, SupportMap};
use crate::{Point, Vector};

/// Any supersurface that the pipeline can recover.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Surface {
    /// Box, cylinder, ellipsoid and what lies between.
    Superellipsoid(Superellipsoid),
    /// Ring, roll, rim.
    Supertoroid(Supertoroid),
}

impl Surface {
    /// The name used in files: `superellipsoid` or `supertoroid`.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Superellipsoid(_) => "superellipsoid",
            Self::Supertoroid(_) => "supertoroid",
        }
    }

    /// Semi-axes `[a1, a2, a3]` in metres (of the tube, for a toroid).
    pub const fn semi_axes(&self) -> [f64; 3] {
        match self {
            Self::Superellipsoid(s) => s.semi_axes(),
            Self::Supertoroid(s) => s.semi_axes(),
        }
    }

    /// Exponents `[ε1, ε2]`.
    pub const fn exponents(&self) -> [f64; 2] {
        match self {
            Self::Superellipsoid(s) => s.exponents(),
            Self::Supertoroid(s) => s.exponents(),
        }
    }

    /// Ring ratio of a toroid.
    pub const fn ring_ratio(&self) -> Option<f64> {
        match self {
            Self::Superellipsoid(_) => None,
            Self::Supertoroid(s) => Some(s.ring_ratio()),
        }
    }

    /// Half extents along the shape's own axes, in metres.
    pub fn half_extents(&self) -> [f64; 3] {
        let [a1, a2, a3] = self.semi_axes();
        let outer = self.ring_ratio().map_or(1.0, |r| r + 1.0);
        [a1 * outer, a2 * outer, a3]
    }

    /// Volume in m³.
    pub fn volume(&self) -> f64 {
        match self {
            Self::Superellipsoid(s) => s.volume(),
            Self::Supertoroid(s) => s.volume(),
        }
    }
}

impl Implicit for Surface {
    fn gauge(&self, p: &Point) -> f64 {
        match self {
            Self::Superellipsoid(s) => s.gauge(p),
            Self::Supertoroid(s) => s.gauge(p),
        }
    }

    fn gradient(&self, p: &Point) -> Vector {
        match self {
            Self::Superellipsoid(s) => s.gradient(p),
            Self::Supertoroid(s) => s.gradient(p),
        }
    }

    fn bounds(&self) -> [Point; 2] {
        match self {
            Self::Superellipsoid(s) => s.bounds(),
            Self::Supertoroid(s) => s.bounds(),
        }
    }

    fn is_convex(&self) -> bool {
        match self {
            Self::Superellipsoid(s) => s.is_convex(),
            Self::Supertoroid(s) => s.is_convex(),
        }
    }
}

impl SupportMap for Surface {
    fn support_point(&self, n: &Vector) -> Point {
        match self {
            Self::Superellipsoid(s) => s.support_point(n),
            Self::Supertoroid(s) => s.support_point(n),
        }
    }
}
