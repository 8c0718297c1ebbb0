//! Any closed solid of the family as one type: what files and the command line hold.
//!
//! Deformations nest: a deformed solid is a solid again.

use crate::deform::{Bend, Cavity, Deformed, ShearBend, Taper, Twist};
use crate::numeric::quarter_angle::QuarterAngle;
use crate::shape::{
    Filled, Implicit, InvalidShape, Mass, MassEstimate, MassProperties, Parametric, RadialExtended,
    SecondOrder, SeparableSuperquadric, Supercone, Supercylinder, Superellipsoid, Supershape,
    Supertoroid, SupportMap,
};
use crate::surface::Surface;
use crate::{Direction, Point, Vector};

/// A closed solid with an implicit and a parametric form.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, Superellipsoid}, surface::Solid};
/// let tin = Solid::from(Superellipsoid::new([0.03, 0.03, 0.05], [0.1, 1.0])?);
/// let cup = tin.tapered([0.2, 0.2])?;
/// assert_eq!(cup.name(), "superellipsoid, tapered");
/// assert!(cup.contains(&Point::new(0.033, 0.0, 0.045)));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum Solid {
    /// Box, cylinder, ellipsoid and what lies between.
    Superellipsoid(Superellipsoid),
    /// Ring, roll, rim.
    Supertoroid(Supertoroid),
    /// Equation 6: an exponent for each axis.
    Separable(SeparableSuperquadric),
    /// Straight sides on a superelliptic base.
    Supercylinder(Supercylinder),
    /// A superelliptic base and an apex.
    Supercone(Supercone),
    /// The product of two superformulas.
    Supershape(Box<Supershape>),
    /// Exponents that follow the geometric angles.
    RadialExtended(Box<RadialExtended>),
    /// Sections across z grow or shrink.
    Tapered(Box<Deformed<Self, Taper>>),
    /// Sections across z turn.
    Twisted(Box<Deformed<Self, Twist>>),
    /// The z axis becomes a circle.
    Bent(Box<Deformed<Self, Bend>>),
    /// The z axis becomes a hyperbola.
    ShearBent(Box<Deformed<Self, ShearBend>>),
    /// The upper side sinks in the middle.
    Hollowed(Box<Deformed<Self, Cavity>>),
}

impl From<Superellipsoid> for Solid {
    fn from(shape: Superellipsoid) -> Self {
        Self::Superellipsoid(shape)
    }
}

impl From<Supertoroid> for Solid {
    fn from(shape: Supertoroid) -> Self {
        Self::Supertoroid(shape)
    }
}

impl From<Surface> for Solid {
    fn from(surface: Surface) -> Self {
        match surface {
            Surface::Superellipsoid(s) => Self::Superellipsoid(s),
            Surface::Supertoroid(s) => Self::Supertoroid(s),
            Surface::Tapered(s) => Self::Tapered(Box::new(s.mapped(Self::from))),
            Surface::Twisted(s) => Self::Twisted(Box::new(s.mapped(Self::from))),
            Surface::Bent(s) => Self::Bent(Box::new(s.mapped(Self::from))),
            Surface::TaperedBent(s) => {
                let cone = |s: Deformed<Superellipsoid, Taper>| {
                    Self::Tapered(Box::new(s.mapped(Self::from)))
                };
                Self::Bent(Box::new(s.mapped(cone)))
            }
        }
    }
}

/// What every variant answers, as one object.
macro_rules! views {
    ($($name:ident: $answer:ident,)+) => {
        $(
            fn $name(&self) -> &dyn $answer {
                match self {
                    Self::Superellipsoid(s) => s,
                    Self::Supertoroid(s) => s,
                    Self::Separable(s) => s,
                    Self::Supercylinder(s) => s,
                    Self::Supercone(s) => s,
                    Self::Supershape(s) => &**s,
                    Self::RadialExtended(s) => &**s,
                    Self::Tapered(s) => &**s,
                    Self::Twisted(s) => &**s,
                    Self::Bent(s) => &**s,
                    Self::ShearBent(s) => &**s,
                    Self::Hollowed(s) => &**s,
                }
            }
        )+
    };
}

impl Solid {
    /// What it is, in words: the member of the family and what was done to it, in order.
    pub fn name(&self) -> String {
        let deformed = |inner: &Self, how: &str| format!("{}, {how}", inner.name());
        match self {
            Self::Superellipsoid(_) => "superellipsoid".into(),
            Self::Supertoroid(_) => "supertoroid".into(),
            Self::Separable(_) => "separable superquadric".into(),
            Self::Supercylinder(_) => "supercylinder".into(),
            Self::Supercone(_) => "supercone".into(),
            Self::Supershape(_) => "supershape".into(),
            Self::RadialExtended(_) => "radial extended superellipsoid".into(),
            Self::Tapered(s) => deformed(s.shape(), "tapered"),
            Self::Twisted(s) => deformed(s.shape(), "twisted"),
            Self::Bent(s) => deformed(s.shape(), "bent"),
            Self::ShearBent(s) => deformed(s.shape(), "shear-bent"),
            Self::Hollowed(s) => deformed(s.shape(), "hollowed"),
        }
    }

    /// Tapered by the slopes `[Kx, Ky]` in [-1, 1], which are complete at its upper end.
    pub fn tapered(self, slopes: [f64; 2]) -> Result<Self, InvalidShape> {
        let taper = Taper::new(slopes, self.half_height())?;
        Ok(Self::Tapered(Box::new(Deformed::new(self, taper)?)))
    }

    /// Twisted by a number of full turns from its lower to its upper end.
    pub fn twisted(self, turns: f64) -> Result<Self, InvalidShape> {
        let twist = Twist::new(turns, self.half_height())?;
        Ok(Self::Twisted(Box::new(Deformed::new(self, twist)?)))
    }

    /// Bent to a circle of `curvature` 1/m in the plane at `angle` radians from the xz plane.
    pub fn bent(self, curvature: f64, angle: f64) -> Result<Self, InvalidShape> {
        let bend = Bend::new(curvature, angle)?;
        Ok(Self::Bent(Box::new(Deformed::new(self, bend)?)))
    }

    /// Bent by the shear of equation 21 with a radius in metres.
    pub fn shear_bent(self, radius: f64) -> Result<Self, InvalidShape> {
        let bend = ShearBend::new(radius)?;
        Ok(Self::ShearBent(Box::new(Deformed::new(self, bend)?)))
    }

    /// With a dish of depth `c` in [0, 2) half heights in its upper side; `None` unless it is a superellipsoid.
    pub fn hollowed(self, depth: f64) -> Option<Result<Self, InvalidShape>> {
        let Self::Superellipsoid(shape) = self else { return None };
        let hollow = |cavity| Deformed::new(self, cavity).map(|s| Self::Hollowed(Box::new(s)));
        Some(Cavity::new(depth, &shape).and_then(hollow))
    }

    /// Half its extent along z in metres, before any pose.
    fn half_height(&self) -> f64 {
        let [low, high] = self.bounds();
        0.5 * (high.z - low.z)
    }

    views! {
        implicit: Implicit,
        parametric: Parametric,
        filled: Filled,
        weighed: MassProperties,
    }

    /// Its support points, where they have a closed form.
    pub fn as_support_map(&self) -> Option<&dyn SupportMap> {
        match self {
            Self::Superellipsoid(s) => Some(s),
            Self::Supertoroid(s) => Some(s),
            Self::Separable(s) => Some(s),
            Self::Supercylinder(s) => Some(s),
            Self::Supercone(s) => Some(s),
            _ => None,
        }
    }

    /// Its second derivatives, where there are formulas for them.
    pub fn as_second_order(&self) -> Option<&dyn SecondOrder> {
        match self {
            Self::Superellipsoid(s) => Some(s),
            Self::Supertoroid(s) => Some(s),
            Self::Separable(s) => Some(s),
            Self::Supercylinder(s) => Some(s),
            Self::Supercone(s) => Some(s),
            Self::Supershape(s) => Some(&**s),
            Self::RadialExtended(s) => Some(&**s),
            _ => None,
        }
    }
}

impl Filled for Solid {
    fn pieces(&self) -> usize {
        self.filled().pieces()
    }

    fn along(&self, piece: usize, at: [f64; 2], shares: &[f64], each: &mut dyn FnMut(Point, f64)) {
        self.filled().along(piece, at, shares, each);
    }

    fn sections(&self, rule: &[[f64; 2]], each: &mut dyn FnMut(Point, f64)) -> bool {
        self.filled().sections(rule, each)
    }
}

/// In closed form for the members but the last two, by integration for these and for what is deformed.
impl MassProperties for Solid {
    fn mass_properties(&self, density: f64) -> Mass {
        self.weighed().mass_properties(density)
    }

    fn mass_estimate(&self, density: f64) -> MassEstimate {
        self.weighed().mass_estimate(density)
    }
}

impl Implicit for Solid {
    fn gauge(&self, p: &Point) -> f64 {
        self.implicit().gauge(p)
    }

    fn gradient(&self, p: &Point) -> Vector {
        self.implicit().gradient(p)
    }

    fn bounds(&self) -> [Point; 2] {
        self.implicit().bounds()
    }

    fn extent(&self, n: &Vector) -> f64 {
        self.implicit().extent(n)
    }

    fn is_convex(&self) -> bool {
        self.implicit().is_convex()
    }
}

impl Parametric for Solid {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.parametric().domain()
    }

    fn point(&self, eta: f64, omega: f64) -> Point {
        self.parametric().point(eta, omega)
    }

    fn point_at(&self, eta: QuarterAngle, omega: QuarterAngle) -> Point {
        self.parametric().point_at(eta, omega)
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        self.parametric().tangents(eta, omega)
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        self.parametric().normal(eta, omega)
    }
}
