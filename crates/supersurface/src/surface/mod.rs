//! Floor 5: the family as one type, for files, programs and the pipeline: [`Surface`] is what the pipeline recovers,
//! [`Solid`] any closed member, deformed or not.

mod solid;

pub use solid::Solid;

use crate::deform::{Bend, Deformed, Taper, Twist};
use crate::shape::{
    Implicit, InvalidShape, Mass, MassProperties, Superellipsoid, Supertoroid, SupportMap,
};
use crate::{Point, Vector};

/// Any supersurface that the fit can recover.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum Surface {
    /// Box, cylinder, ellipsoid and what lies between.
    Superellipsoid(Superellipsoid),
    /// Ring, roll, rim.
    Supertoroid(Supertoroid),
    /// Cup, cone, wedge.
    Tapered(Deformed<Superellipsoid, Taper>),
    /// A superellipsoid whose sections turn.
    Twisted(Deformed<Superellipsoid, Twist>),
    /// Banana, handle.
    Bent(Deformed<Superellipsoid, Bend>),
    /// Horn.
    TaperedBent(Deformed<Deformed<Superellipsoid, Taper>, Bend>),
}

impl Surface {
    /// Tapered by the slopes `[Kx, Ky]` in [-1, 1], which are complete at `a3`.
    pub fn tapered(core: Superellipsoid, slopes: [f64; 2]) -> Result<Self, InvalidShape> {
        let taper = Taper::new(slopes, core.semi_axes()[2])?;
        Ok(Self::Tapered(Deformed::new(core, taper)?))
    }

    /// Twisted by a number of full turns from its lower to its upper end.
    pub fn twisted(core: Superellipsoid, turns: f64) -> Result<Self, InvalidShape> {
        let twist = Twist::new(turns, core.semi_axes()[2])?;
        Ok(Self::Twisted(Deformed::new(core, twist)?))
    }

    /// Bent to a circle of `curvature` 1/m in the plane at `angle` radians from the xz plane.
    pub fn bent(core: Superellipsoid, curvature: f64, angle: f64) -> Result<Self, InvalidShape> {
        Ok(Self::Bent(Deformed::new(core, Bend::new(curvature, angle)?)?))
    }

    /// Tapered, then bent.
    pub fn tapered_bent(
        core: Superellipsoid,
        slopes: [f64; 2],
        curvature: f64,
        angle: f64,
    ) -> Result<Self, InvalidShape> {
        let cone = Deformed::new(core, Taper::new(slopes, core.semi_axes()[2])?)?;
        Ok(Self::TaperedBent(Deformed::new(cone, Bend::new(curvature, angle)?)?))
    }

    /// The name used in files: of the undeformed member, `superellipsoid` or `supertoroid`.
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Supertoroid(_) => "supertoroid",
            _ => "superellipsoid",
        }
    }

    /// The superellipsoid before any deformation; `None` for a toroid.
    const fn core(&self) -> Option<&Superellipsoid> {
        match self {
            Self::Superellipsoid(s) => Some(s),
            Self::Supertoroid(_) => None,
            Self::Tapered(s) => Some(s.shape()),
            Self::Twisted(s) => Some(s.shape()),
            Self::Bent(s) => Some(s.shape()),
            Self::TaperedBent(s) => Some(s.shape().shape()),
        }
    }

    /// Semi-axes `[a1, a2, a3]` in metres before any deformation (of the tube, for a toroid).
    pub const fn semi_axes(&self) -> [f64; 3] {
        match (self.core(), self) {
            (Some(s), _) => s.semi_axes(),
            (None, Self::Supertoroid(s)) => s.semi_axes(),
            (None, _) => [0.0; 3],
        }
    }

    /// Exponents `[ε1, ε2]`.
    pub const fn exponents(&self) -> [f64; 2] {
        match (self.core(), self) {
            (Some(s), _) => s.exponents(),
            (None, Self::Supertoroid(s)) => s.exponents(),
            (None, _) => [1.0; 2],
        }
    }

    /// Ring ratio of a toroid.
    pub const fn ring_ratio(&self) -> Option<f64> {
        match self {
            Self::Supertoroid(s) => Some(s.ring_ratio()),
            _ => None,
        }
    }

    /// The taper, where there is one.
    pub const fn taper(&self) -> Option<&Taper> {
        match self {
            Self::Tapered(s) => Some(s.deformation()),
            Self::TaperedBent(s) => Some(s.shape().deformation()),
            _ => None,
        }
    }

    /// The twist, where there is one.
    pub const fn twist(&self) -> Option<&Twist> {
        match self {
            Self::Twisted(s) => Some(s.deformation()),
            _ => None,
        }
    }

    /// The bend, where there is one; it comes after the taper.
    pub const fn bend(&self) -> Option<&Bend> {
        match self {
            Self::Bent(s) => Some(s.deformation()),
            Self::TaperedBent(s) => Some(s.deformation()),
            _ => None,
        }
    }

    /// Half extents along the shape's own axes in metres, before any deformation.
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
            Self::Tapered(s) => s.volume(),
            // a twist keeps the volume, and so does a bend
            Self::Twisted(s) => s.shape().volume(),
            Self::Bent(s) => s.shape().volume(),
            Self::TaperedBent(s) => s.shape().volume(),
        }
    }

    fn implicit(&self) -> &dyn Implicit {
        match self {
            Self::Superellipsoid(s) => s,
            Self::Supertoroid(s) => s,
            Self::Tapered(s) => s,
            Self::Twisted(s) => s,
            Self::Bent(s) => s,
            Self::TaperedBent(s) => s,
        }
    }
}

impl MassProperties for Surface {
    fn mass_properties(&self, density: f64) -> Mass {
        match self {
            Self::Superellipsoid(s) => s.mass_properties(density),
            Self::Supertoroid(s) => s.mass_properties(density),
            Self::Tapered(s) => s.mass_properties(density),
            Self::Twisted(s) => s.mass_properties(density),
            Self::Bent(s) => s.mass_properties(density),
            Self::TaperedBent(s) => s.mass_properties(density),
        }
    }
}

impl Implicit for Surface {
    fn gauge(&self, p: &Point) -> f64 {
        self.implicit().gauge(p)
    }

    fn gradient(&self, p: &Point) -> Vector {
        self.implicit().gradient(p)
    }

    fn bounds(&self) -> [Point; 2] {
        self.implicit().bounds()
    }

    fn is_convex(&self) -> bool {
        self.implicit().is_convex()
    }
}

/// In closed form, but by search for what is deformed.
impl SupportMap for Surface {
    fn support_point(&self, n: &Vector) -> Point {
        match self {
            Self::Superellipsoid(s) => s.support_point(n),
            Self::Supertoroid(s) => s.support_point(n),
            Self::Tapered(s) => s.support_point(n),
            Self::Twisted(s) => s.support_point(n),
            Self::Bent(s) => s.support_point(n),
            Self::TaperedBent(s) => s.support_point(n),
        }
    }
}
