//! R-functions: Boolean operations on numbers whose signs say inside (> 0) and outside (< 0).
//!
//! `f1 ∨ f2 = (f1 + f2 + √(f1² + f2² - 2α f1 f2)) / (1 + α)` is positive where either is, `f1 ∧ f2` (with minus
//! the root) where both are; `-f` is the complement and `f1 ∧ -f2` the difference (Rvachev; FORMULAS §5.1).
//! `α = 1` gives maximum and minimum, `α = 0` is smooth everywhere except where both vanish. A blend adds
//! `a0 / (1 + (f1/a1)² + (f2/a2)²)` (Pasko and Savchenko): material for `a0 > 0`, a groove for `a0 < 0`.
//!
//! Where `f1 + f2 > 0` the difference from the root is computed as `2 f1 f2 / (f1 + f2 + root)`, without
//! cancellation; the union is the complement of the complements' intersection.

use crate::shape::InvalidShape;

/// The number α of an R-function.
///
/// ```
/// use supersurface::combine::{Alpha, rfunction::{intersection, union}};
/// assert_eq!(union(0.5, -0.25, Alpha::EXACT).0, 0.5);
/// assert_eq!(intersection(3.0, 4.0, Alpha::SMOOTH).0, 2.0);
/// assert!(Alpha::new(-1.0).is_err());
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alpha(f64);

impl Alpha {
    /// α = 0: smooth except where both values vanish.
    pub const SMOOTH: Self = Self(0.0);
    /// α = 1: maximum and minimum, with a crease where both values are equal.
    pub const EXACT: Self = Self(1.0);

    /// α in [-0.99, 1].
    pub fn new(alpha: f64) -> Result<Self, InvalidShape> {
        let inside = (-0.99..=1.0).contains(&alpha);
        InvalidShape::check(inside, "alpha of an R-function", alpha, "in [-0.99, 1]")?;
        Ok(Self(alpha))
    }

    /// The number.
    pub const fn value(self) -> f64 {
        self.0
    }
}

/// How much a blend adds, and how far it reaches, in the unit of the values (dimensionless for `f = 1 - g`).
///
/// ```
/// use supersurface::combine::Blend;
/// let fillet = Blend::new(0.1, [0.3, 0.3])?;
/// assert_eq!(fillet.displacement(0.0, 0.0).0, 0.1);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Blend {
    amount: f64,
    reach: [f64; 2],
}

impl Blend {
    /// `amount` is a0, in [-1e6, 1e6]; `reach` is `[a1, a2]`, in [1e-6, 1e6].
    pub fn new(amount: f64, reach: [f64; 2]) -> Result<Self, InvalidShape> {
        let inside = amount.abs() <= 1e6;
        InvalidShape::check(inside, "amount a0 of a blend", amount, "in [-1e6, 1e6]")?;
        for (v, what) in reach.iter().zip(["reach a1 of a blend", "reach a2 of a blend"]) {
            InvalidShape::check((1e-6..=1e6).contains(v), what, *v, "in [1e-6, 1e6]")?;
        }
        Ok(Self { amount, reach })
    }

    /// The most that it adds, a0.
    pub const fn amount(&self) -> f64 {
        self.amount
    }

    /// `a0 / (1 + (f1/a1)² + (f2/a2)²)` and its derivatives by f1 and f2.
    pub fn displacement(&self, f1: f64, f2: f64) -> (f64, [f64; 2]) {
        let [a1, a2] = self.reach;
        let (u, v) = (f1 / a1, f2 / a2);
        let below = 1.0 + u * u + v * v;
        let value = self.amount / below;
        // one division at a time: below² may overflow
        let slope = |w: f64, a: f64| -2.0 * value * (w / below) / a;
        (value, [slope(u, a1), slope(v, a2)])
    }
}

/// Values beyond this are treated as this: their squares stay finite.
const LARGEST: f64 = 1e140;

/// `f1 ∧ f2` and its derivatives by f1 and f2; at `f1 = f2 = 0`, and on the crease `f1 = f2` for α = 1, the
/// derivatives are those of the mean. Values are clamped to ±1e140; NaN counts as outside.
pub fn intersection(f1: f64, f2: f64, alpha: Alpha) -> (f64, [f64; 2]) {
    let (f1, f2, a) = (clamped(f1), clamped(f2), alpha.0);
    let (sum, product) = (f1 + f2, f1 * f2);
    // f1² + f2² - 2α f1 f2, as a sum of squares
    let root = if product > 0.0 {
        (f1 - f2).hypot((2.0 * (1.0 - a) * product).sqrt())
    } else {
        sum.hypot((-2.0 * (1.0 + a) * product).sqrt())
    };
    let value = if sum > 0.0 { 2.0 * f1 * (f2 / (sum + root)) } else { (sum - root) / (1.0 + a) };
    if root == 0.0 {
        return (value, [0.5; 2]);
    }
    // ∂/∂f1 = (root - (f1 - α f2)) / ((1 + α) root), and root² - (f1 - α f2)² = (1 - α²) f2²
    let slope = |own: f64, other: f64| {
        let part = own - a * other;
        if part > 0.0 {
            (1.0 - a) * (other / root) * (other / (root + part))
        } else {
            (root - part) / root / (1.0 + a)
        }
    };
    (value, [slope(f1, f2), slope(f2, f1)])
}

/// `f1 ∨ f2 = -(-f1 ∧ -f2)` and its derivatives.
pub fn union(f1: f64, f2: f64, alpha: Alpha) -> (f64, [f64; 2]) {
    let (value, slopes) = intersection(-clamped(f1), -clamped(f2), alpha);
    (-value, slopes)
}

/// `f1 ∧ -f2` and its derivatives.
pub fn difference(f1: f64, f2: f64, alpha: Alpha) -> (f64, [f64; 2]) {
    let (value, [first, second]) = intersection(f1, -clamped(f2), alpha);
    (value, [first, -second])
}

/// A value whose square is finite.
pub(super) fn clamped(f: f64) -> f64 {
    if f.is_nan() { -LARGEST } else { f.clamp(-LARGEST, LARGEST) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    type Operation = fn(f64, f64, Alpha) -> (f64, [f64; 2]);

    #[test]
    fn signs_are_boolean_and_slopes_agree_with_differences() {
        let mut random = Stream::new(9, 0);
        for alpha in [-0.6, 0.0, 0.5, 1.0].map(|a| Alpha::new(a).unwrap()) {
            for _ in 0..2000 {
                let (f, g) = (random.between(-1.0, 1.0), random.between(-1.0, 1.0));
                let h = 1e-7;
                let operations: [(Operation, bool); 3] = [
                    (intersection, f > 0.0 && g > 0.0),
                    (union, f > 0.0 || g > 0.0),
                    (difference, f > 0.0 && g <= 0.0),
                ];
                for (operation, inside) in operations {
                    let (value, [a, b]) = operation(f, g, alpha);
                    assert_eq!(value > 0.0, inside);
                    if (f.abs() - g.abs()).abs() < 1e-3 || f.abs().min(g.abs()) < 1e-3 {
                        continue;
                    }
                    let at = |f, g| operation(f, g, alpha).0;
                    let (x, y) = (at(f + h, g) - at(f - h, g), at(f, g + h) - at(f, g - h));
                    assert!((a - x / (2.0 * h)).abs() < 1e-5, "{f} {g} {alpha:?}");
                    assert!((b - y / (2.0 * h)).abs() < 1e-5, "{f} {g} {alpha:?}");
                }
            }
        }
    }

    #[test]
    fn extremes_stay_numbers() {
        let values = [0.0, 5e-324, 1e-200, 1.0, 1e308, f64::INFINITY, f64::NAN];
        let both = values.iter().flat_map(|v| [*v, -v]);
        let fillet = Blend::new(1e6, [1e-6, 1e6]).unwrap();
        for f in both.clone() {
            for g in both.clone() {
                for alpha in [-0.99, 0.0, 1.0].map(|a| Alpha::new(a).unwrap()) {
                    for (v, slopes) in [intersection(f, g, alpha), union(f, g, alpha)] {
                        assert!(v.is_finite() && slopes.iter().all(|s| s.is_finite()), "{f} {g}");
                    }
                }
                let (d, slopes) = fillet.displacement(clamped(f), clamped(g));
                assert!(d.is_finite() && slopes.iter().all(|s| s.is_finite()), "{f} {g}");
            }
        }
    }

    #[test]
    fn a_thin_value_keeps_its_digits() {
        let (value, _) = intersection(1e-20, 1.0, Alpha::SMOOTH);
        assert!((value / 1e-20 - 1.0).abs() < 1e-15);
    }
}
