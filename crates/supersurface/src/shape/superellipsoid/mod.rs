//! The superellipsoid: box, cylinder, ellipsoid, octahedron and everything between.
//!
//! `F(x, y, z) = (|x/a1|^(2/ε2) + |y/a2|^(2/ε2))^(ε2/ε1) + |z/a3|^(2/ε1) = 1` (equation 9).
//! Everything is evaluated through the gauge `g = F^(ε1/2)`, which is 1-homogeneous and does not
//! overflow (FORMULAS §0.1).

mod curvature;
mod filled;
mod gauge;
mod hessian;
mod implicit_value;
mod mass;
mod parametric;
mod radial;
mod radial_columns;
mod support;

pub use radial::PARAMETERS;
pub use radial_columns::{Columns, Jacobians};

pub(crate) use curvature::Angular;
pub(crate) use mass::{central, raised, section_moment};

use crate::shape::InvalidShape;

/// A superellipsoid about its own origin, z along the profile of ε1.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, Superellipsoid}};
/// let tin = Superellipsoid::new([0.033, 0.033, 0.05], [0.1, 1.0])?;
/// assert!(tin.gauge(&Point::new(0.0, 0.0, 0.049)) < 1.0);
/// assert!((tin.radial_distance(&Point::new(0.0, 0.0, 0.06)) - 0.01).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superellipsoid {
    semi_axes: [f64; 3],
    exponents: [f64; 2],
}

impl Superellipsoid {
    /// Semi-axes `[a1, a2, a3]` in metres, positive; exponents `[ε1, ε2]` (profile along z first,
    /// then the section across z), in (0, 10].
    pub fn new(semi_axes: [f64; 3], exponents: [f64; 2]) -> Result<Self, InvalidShape> {
        check_axes(&semi_axes)?;
        check_exponents(&exponents)?;
        Ok(Self { semi_axes, exponents })
    }

    /// The same for numbers that another shape has checked already.
    pub(super) const fn from_checked(semi_axes: [f64; 3], exponents: [f64; 2]) -> Self {
        Self { semi_axes, exponents }
    }

    /// Semi-axes `[a1, a2, a3]` in metres.
    pub const fn semi_axes(&self) -> [f64; 3] {
        self.semi_axes
    }

    /// Exponents `[ε1, ε2]`.
    pub const fn exponents(&self) -> [f64; 2] {
        self.exponents
    }
}

pub(super) fn check_axes(semi_axes: &[f64; 3]) -> Result<(), InvalidShape> {
    for (a, what) in semi_axes.iter().zip(["semi-axis a1", "semi-axis a2", "semi-axis a3"]) {
        InvalidShape::check(*a > 0.0 && a.is_finite(), what, *a, "positive and finite")?;
    }
    Ok(())
}

pub(super) fn check_exponents(exponents: &[f64; 2]) -> Result<(), InvalidShape> {
    for (e, what) in exponents.iter().zip(["exponent ε1", "exponent ε2"]) {
        InvalidShape::check(*e > 0.0 && *e <= 10.0, what, *e, "in (0, 10]")?;
    }
    Ok(())
}
