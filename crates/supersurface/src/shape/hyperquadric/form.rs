//! The sum of powers itself: value, gradient, second derivatives and rank (equation 24).

use nalgebra::{Matrix3, SymmetricEigen};

use crate::numeric::powers::{power, signed_power};
use crate::shape::InvalidShape;
use crate::{Point, Vector};

/// Most terms of a form.
const MOST_TERMS: usize = 64;

/// One term `|n·p + d|^ε`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Term {
    pub(super) normal: Vector,
    pub(super) offset: f64,
    pub(super) exponent: f64,
}

impl Term {
    /// `n·p + d`; ±∞ where it overflows, never NaN at a finite point.
    pub(super) fn height(&self, p: &Point) -> f64 {
        let size = p.coords.amax();
        if size < 1e150 {
            return self.normal.dot(&p.coords) + self.offset;
        }
        size * (self.normal.dot(&(p.coords / size)) + self.offset / size)
    }
}

/// `F(p) = Σ |A_i x + B_i y + C_i z + D_i|^{ε_i}`: a function that any terms have, also where `F <= 1`
/// holds nowhere.
///
/// ```
/// use supersurface::{Point, shape::HyperquadricForm};
/// let form = HyperquadricForm::new(
///     &[[1.0, 0.0, 0.0, 0.0], [0.0, 0.5, 0.0, 0.0], [0.0, 0.0, 2.0, 1.0]],
///     &[2.0, 2.0, 4.0],
/// )?;
/// assert_eq!(form.value(&Point::new(1.0, 2.0, 0.0)), 3.0);
/// assert_eq!(form.rank(), 3);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct HyperquadricForm {
    pub(super) terms: Vec<Term>,
}

impl HyperquadricForm {
    /// Rows `[A, B, C, D]` with `(A, B, C)` in 1/m and D without a unit, 3 to 64 of them; the length of
    /// `(A, B, C)` in [1e-9, 1e9], `|D|` at most 1e9. One exponent in [0.01, 1000] for each (the exponents
    /// themselves: 2 makes an ellipsoid).
    pub fn new(planes: &[[f64; 4]], exponents: &[f64]) -> Result<Self, InvalidShape> {
        let count = planes.len();
        let inside = (3..=MOST_TERMS).contains(&count);
        InvalidShape::check(inside, "number of terms", count as f64, "from 3 to 64")?;
        let given = exponents.len();
        InvalidShape::check(given == count, "number of exponents", given as f64, "one a term")?;
        let mut terms = Vec::with_capacity(count);
        for ([a, b, c, offset], exponent) in planes.iter().copied().zip(exponents.iter().copied()) {
            let normal = Vector::new(a, b, c);
            let length = normal.norm();
            let inside = (1e-9..=1e9).contains(&length);
            InvalidShape::check(inside, "length of (A, B, C)", length, "in [1e-9, 1e9] per metre")?;
            InvalidShape::check(offset.abs() <= 1e9, "offset D", offset, "in [-1e9, 1e9]")?;
            let inside = (0.01..=1e3).contains(&exponent);
            InvalidShape::check(inside, "exponent of a term", exponent, "in [0.01, 1000]")?;
            terms.push(Term { normal, offset, exponent });
        }
        Ok(Self { terms })
    }

    /// The rows `[A, B, C, D]` with their exponents.
    pub fn terms(&self) -> impl Iterator<Item = ([f64; 4], f64)> + '_ {
        self.terms.iter().map(|t| ([t.normal.x, t.normal.y, t.normal.z, t.offset], t.exponent))
    }

    /// `F(p)`; infinite where it overflows.
    pub fn value(&self, p: &Point) -> f64 {
        self.terms.iter().map(|t| power(t.height(p), t.exponent)).sum()
    }

    /// `∇F = Σ ε |h|^(ε-1) sgn(h) (A, B, C)` in 1/m; `None` where a term with `ε <= 1` vanishes (a crease)
    /// and where a component overflows.
    pub fn gradient(&self, p: &Point) -> Option<Vector> {
        let crease = self.terms.iter().any(|t| t.exponent <= 1.0 && t.height(p) == 0.0);
        let gradient = self.slope(p);
        (!crease && gradient.iter().all(|v| v.is_finite())).then_some(gradient)
    }

    /// `Σ ε (ε-1) |h|^(ε-2) A Aᵀ` in 1/m²; `None` where a term with `ε < 2` vanishes and where a component
    /// overflows.
    pub fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let mut sum = Matrix3::zeros();
        for t in &self.terms {
            let (h, e) = (t.height(p), t.exponent);
            let bend = match (h == 0.0, e - 2.0) {
                (true, rest) if rest < 0.0 => return None,
                (true, rest) => f64::from(rest == 0.0),
                (false, rest) => power(h, rest),
            };
            sum += t.normal * t.normal.transpose() * (e * (e - 1.0) * bend);
        }
        sum.iter().all(|v| v.is_finite()).then_some(sum)
    }

    /// Dimension that the normals span. Under 3 the set `F <= 1` goes on for ever; normals within about 1e-6
    /// of a plane or a line count as lying in it.
    pub fn rank(&self) -> usize {
        let directions = self.terms.iter().map(|t| t.normal.normalize());
        let gram: Matrix3<f64> = directions.map(|n| n * n.transpose()).sum();
        let values = SymmetricEigen::new(gram).eigenvalues;
        values.iter().filter(|v| **v > 1e-12 * values.max()).count()
    }

    /// True when all exponents are at least 1: then F and the set `F <= 1` are convex.
    pub fn is_convex(&self) -> bool {
        self.terms.iter().all(|t| t.exponent >= 1.0)
    }

    /// `∇F`, with the middle of all slopes (0) for a term on its crease.
    pub(super) fn slope(&self, p: &Point) -> Vector {
        let part = |t: &Term| t.normal * (t.exponent * signed_power(t.height(p), t.exponent - 1.0));
        self.terms.iter().map(part).sum()
    }

    /// `ln F` and the share of each term in F; -∞ and no shares where all terms vanish.
    pub(super) fn log_value(&self, p: &Point) -> (f64, Vec<f64>) {
        let logs: Vec<f64> =
            self.terms.iter().map(|t| t.exponent * t.height(p).abs().ln()).collect();
        let largest = logs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        if largest.is_infinite() {
            return (largest, vec![0.0; logs.len()]);
        }
        let parts: Vec<f64> = logs.iter().map(|l| (l - largest).exp()).collect();
        let sum: f64 = parts.iter().sum();
        (largest + sum.ln(), parts.iter().map(|p| p / sum).collect())
    }
}
