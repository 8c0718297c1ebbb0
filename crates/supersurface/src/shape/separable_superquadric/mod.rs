//! The separable superquadric: one exponent for each axis (equation 6).
//!
//! `F(x, y, z) = |x/a1|^k1 + |y/a2|^k2 + |z/a3|^k3 = 1`. The exponents are those of the equation itself (an
//! ellipsoid has 2, 2, 2), not the ε of the superellipsoid, whose family it does not belong to: three
//! exponents instead of two layers, and no homogeneity, so that the gauge is a root (FORMULAS §1.1).

mod filled;
mod gauge;
mod mass;
mod parametric;
mod support;

use crate::shape::InvalidShape;
use crate::shape::superellipsoid::check_axes;

/// A separable superquadric about its own origin.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, SeparableSuperquadric}};
/// // a loaf: square along x and y, pointed along z
/// let loaf = SeparableSuperquadric::new([0.1, 0.05, 0.04], [8.0, 8.0, 1.0])?;
/// assert!((loaf.gauge(&Point::new(0.0, 0.0, 0.02)) - 0.5).abs() < 1e-15);
/// assert!(loaf.contains(&Point::new(0.08, 0.04, 0.02)));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeparableSuperquadric {
    semi_axes: [f64; 3],
    powers: [f64; 3],
}

impl SeparableSuperquadric {
    /// Semi-axes `[a1, a2, a3]` in metres, positive; exponents `[k1, k2, k3]` in [0.2, 1e6] (2 for an ellipsoid,
    /// 1 for an octahedron, large for a box).
    pub fn new(semi_axes: [f64; 3], powers: [f64; 3]) -> Result<Self, InvalidShape> {
        check_axes(&semi_axes)?;
        for (k, what) in powers.iter().zip(["exponent k1", "exponent k2", "exponent k3"]) {
            InvalidShape::check((0.2..=1e6).contains(k), what, *k, "in [0.2, 1e6]")?;
        }
        Ok(Self { semi_axes, powers })
    }

    /// Semi-axes `[a1, a2, a3]` in metres.
    pub const fn semi_axes(&self) -> [f64; 3] {
        self.semi_axes
    }

    /// Exponents `[k1, k2, k3]` of the equation.
    pub const fn powers(&self) -> [f64; 3] {
        self.powers
    }
}
