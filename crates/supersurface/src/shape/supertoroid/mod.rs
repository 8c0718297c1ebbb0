//! The supertoroid: rings, rolls, gears, rims of bowls and mugs.
//!
//! `F = |ρ̂ - a4|^(2/ε1) + |z/a3|^(2/ε1) = 1` with `ρ̂ = (|x/a1|^(2/ε2) + |y/a2|^(2/ε2))^(ε2/2)`
//! (equation 12). `a4 >= 1` is the dimensionless ring ratio: a torus of radii R and r has
//! `a1 = a2 = a3 = r` and `a4 = R/r`.

mod curvature;
mod filled;
mod gauge;
mod hessian;
mod implicit_value;
mod mass;
mod meridian;
mod parametric;
mod support;

pub use meridian::{MeridianFoot, PARAMETERS};

use super::superellipsoid::{check_axes, check_exponents};
use crate::shape::InvalidShape;

/// A supertoroid about its own origin with the hole along z.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, Supertoroid}};
/// let ring = Supertoroid::new([0.01; 3], 4.0, [1.0, 1.0])?;
/// assert!(ring.gauge(&Point::origin()) > 1.0);
/// assert!(ring.gauge(&Point::new(0.04, 0.0, 0.0)) < 1.0);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supertoroid {
    semi_axes: [f64; 3],
    ring_ratio: f64,
    exponents: [f64; 2],
}

impl Supertoroid {
    /// Semi-axes `[a1, a2, a3]` of the tube in metres, positive; ring ratio `a4` in [1, 1e6];
    /// exponents `[ε1, ε2]` (tube first, then the ring) in (0, 10].
    pub fn new(
        semi_axes: [f64; 3],
        ring_ratio: f64,
        exponents: [f64; 2],
    ) -> Result<Self, InvalidShape> {
        check_axes(&semi_axes)?;
        let inside = (1.0..=1e6).contains(&ring_ratio);
        InvalidShape::check(inside, "ring ratio a4", ring_ratio, "in [1, 1e6]")?;
        check_exponents(&exponents)?;
        Ok(Self { semi_axes, ring_ratio, exponents })
    }

    /// Semi-axes `[a1, a2, a3]` of the tube in metres.
    pub const fn semi_axes(&self) -> [f64; 3] {
        self.semi_axes
    }

    /// Ring ratio `a4`, dimensionless.
    pub const fn ring_ratio(&self) -> f64 {
        self.ring_ratio
    }

    /// Exponents `[ε1, ε2]`.
    pub const fn exponents(&self) -> [f64; 2] {
        self.exponents
    }
}
