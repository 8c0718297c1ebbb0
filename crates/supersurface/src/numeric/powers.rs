//! Signed powers and the beta function, evaluated so that nothing overflows or turns into NaN.
//!
//! This is the one place where `f64::powf` is called; everything else goes through the norms of
//! [`super::superellipse`] or these helpers.

use super::lanes::{exp, ln};

/// `sgn(b) |b|^s` with `0^s = 0` (FORMULAS §0, `spow`).
///
/// ```
/// use supersurface::numeric::powers::signed_power;
/// assert_eq!(signed_power(-4.0, 0.5), -2.0);
/// assert_eq!(signed_power(0.0, 0.0), 0.0);
/// ```
#[inline]
#[allow(clippy::disallowed_methods)]
pub fn signed_power(b: f64, s: f64) -> f64 {
    if b == 0.0 { 0.0 } else { b.abs().powf(s).copysign(b) }
}

/// `|b|^s` with `0^s = 0`.
#[inline]
pub fn power(b: f64, s: f64) -> f64 {
    signed_power(b.abs(), s)
}

/// `b^s` of a positive `b`, within `3e-16 (1 + |s ln b|)` of it: several times as fast as [`power`]. Powers beyond
/// `e^±700` are `e^±700`.
///
/// ```
/// use supersurface::numeric::powers::quick_power;
/// assert!((quick_power(0.3, 1.7) - 0.3f64.powf(1.7)).abs() < 1e-15);
/// ```
#[inline]
pub fn quick_power(b: f64, s: f64) -> f64 {
    let log = if b >= f64::MIN_POSITIVE { ln::<false>(b) } else { b.ln() };
    exp::<false>(s * log)
}

/// Derivative of [`signed_power`] by `b`: `s |b|^(s-1)`; `None` where it is infinite (`b = 0`, `s < 1`).
///
/// ```
/// use supersurface::numeric::powers::signed_power_slope;
/// assert_eq!(signed_power_slope(-4.0, 0.5), Some(0.25));
/// assert_eq!(signed_power_slope(0.0, 0.5), None);
/// ```
#[inline]
pub fn signed_power_slope(b: f64, s: f64) -> Option<f64> {
    match (b == 0.0, s - 1.0) {
        (true, rest) if rest < 0.0 => None,
        (true, rest) => Some(f64::from(rest == 0.0)),
        (false, rest) => Some(s * power(b, rest)),
    }
}

/// `u^p - v^p` for non-negative `u`, `v` and `p > 0`, without the loss of digits where both are close; where
/// both powers overflow it is infinite with the right sign.
///
/// ```
/// use supersurface::numeric::powers::power_difference;
/// assert_eq!(power_difference(1e300, 2e300, 3.0), f64::NEG_INFINITY);
/// ```
pub fn power_difference(u: f64, v: f64, p: f64) -> f64 {
    let (large, small) = if u >= v { (u, v) } else { (v, u) };
    if large == small {
        return 0.0;
    }
    // 1 - (small/large)^p, never 0 here unless the quotient rounds to 1
    let rest = -(p * (small / large).ln()).exp_m1();
    let size = if rest > 0.0 { power(large, p) * rest } else { 0.0 };
    if u >= v { size } else { -size }
}

/// Cosine and sine of an angle in radians, exact (0 or ±1) at multiples of π/2.
///
/// `cos(π/2)` in f64 is 6e-17, and its power 0.1 is 0.024: without this snap a pole of a box would
/// be wrong by percents (FORMULAS §0.2).
#[inline]
pub fn quadrant_cos_sin(angle: f64) -> (f64, f64) {
    let snap = |v: f64| if v.abs() < 1e-15 { 0.0 } else { v };
    let (s, c) = angle.sin_cos();
    (snap(c), snap(s))
}

/// The larger of both; NaN where one is (`f64::max` would pass over it).
#[inline]
pub fn larger(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

/// Beta function `B(x, y)` for positive arguments, by the logarithm of the gamma function.
pub fn beta(x: f64, y: f64) -> f64 {
    (libm::lgamma(x) + libm::lgamma(y) - libm::lgamma(x + y)).exp()
}
