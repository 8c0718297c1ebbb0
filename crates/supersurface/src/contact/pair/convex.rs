//! A convex superellipsoid with the constants that every query of it needs.

use crate::shape::{InvalidShape, Superellipsoid, SupportMap};
use crate::{Point, Vector};

/// Exponents below this are queried as this, and those above 2 less this as that: the support function differs by
/// 4e-11 of itself.
const LEAST: f64 = 1e-10;
/// By what the support function of a sharper body is wrong, relatively.
const SHARP_ERROR: f64 = 4e-11;

/// A superellipsoid with both exponents at most 2, ready for [`pair`](super::pair).
///
/// ```
/// use supersurface::{contact::Convex, shape::Superellipsoid};
/// assert!(Convex::new(Superellipsoid::new([0.1; 3], [0.1, 2.0])?).is_ok());
/// assert!(Convex::new(Superellipsoid::new([0.1; 3], [0.1, 2.5])?).is_err());
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convex {
    shape: Superellipsoid,
    /// Dual exponents `q = 2/(2 - ε)` of the profile and the section, as the support function is
    /// `h(n) = ‖(‖(a1 n1, a2 n2)‖_q2, a3 n3)‖_q1` (FORMULAS §9).
    pub(super) dual: [f64; 2],
    pub(super) inverse_dual: [f64; 2],
    /// Radius of a ball that rolls inside along the whole surface; 0 where none is known.
    pub(super) rolling: f64,
}

impl Convex {
    /// Fails for an exponent above 2: the body is not convex.
    pub fn new(shape: Superellipsoid) -> Result<Self, InvalidShape> {
        let exponents = shape.exponents();
        for (e, what) in exponents.iter().zip(["exponent ε1", "exponent ε2"]) {
            InvalidShape::check(*e <= 2.0, what, *e, "at most 2 for a convex body")?;
        }
        let dual = exponents.map(|e| 2.0 / (2.0 - e.clamp(LEAST, 2.0 - LEAST)));
        let [a, b, c] = shape.semi_axes();
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        let rolling = if exponents == [1.0; 2] { least * (least / most) } else { 0.0 };
        Ok(Self { shape, dual, inverse_dual: dual.map(f64::recip), rolling })
    }

    /// By what the support function may be wrong, relatively, because the exponents are queried as others.
    pub(super) fn error(&self) -> f64 {
        let sharp = self.shape.exponents().iter().any(|e| *e < LEAST || *e > 2.0 - LEAST);
        if sharp { SHARP_ERROR } else { 0.0 }
    }

    /// The shape itself.
    pub const fn shape(&self) -> &Superellipsoid {
        &self.shape
    }
}

impl SupportMap for Convex {
    fn support_point(&self, n: &Vector) -> Point {
        self.shape.support_point(n)
    }
}
