//! The two-dimensional norm `(u^p + v^p)^(1/p)`, its weights and its dual.
//!
//! A superellipsoid is this norm applied twice: first to `(x/a1, y/a2)` with `p = 2/ε2`, then to the
//! result and `z/a3` with `p = 2/ε1` (FORMULAS §0.1). Evaluated through the larger of the two
//! arguments it neither overflows nor underflows for any exponent in (0, 2.5].

use super::lanes::Lane;
use super::powers::quick_power;

/// The norm of a pair together with the share that each argument has in it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Weighted {
    /// `(u^p + v^p)^(1/p)`.
    pub norm: f64,
    /// `u^p / (u^p + v^p)`: on a surface point this is `cos²` of the angle parameter.
    pub first: f64,
    /// `v^p / (u^p + v^p)`.
    pub second: f64,
}

impl Weighted {
    /// Binary entropy of the weights, `-w ln w - (1 - w) ln (1 - w)`, in [0, ln 2].
    pub fn entropy(&self) -> f64 {
        let part = |w: f64| if w > 0.0 { -w * w.ln() } else { 0.0 };
        part(self.first) + part(self.second)
    }
}

/// `(u^p + v^p)^(1/p)` for non-negative `u`, `v` and `p > 0`.
///
/// ```
/// use supersurface::numeric::superellipse::norm;
/// assert_eq!(norm(3.0, 4.0, 2.0), 5.0);
/// assert_eq!(norm(1e300, 1e300, 200.0).is_finite(), true);
/// ```
#[inline]
pub fn norm(u: f64, v: f64, p: f64) -> f64 {
    weighted(u, v, p).norm
}

/// The norm and both weights; at `u = v = 0` the norm is 0 and the weights are one half, also where both are
/// infinite.
#[inline]
pub fn weighted(u: f64, v: f64, p: f64) -> Weighted {
    let (large, small) = if u >= v { (u, v) } else { (v, u) };
    // both: beside a NaN neither is the larger
    if large == 0.0 && small == 0.0 {
        return Weighted { norm: 0.0, first: 0.5, second: 0.5 };
    }
    if large == f64::INFINITY {
        let first = if u == v { 0.5 } else { f64::from(u > v) };
        return Weighted { norm: large, first, second: 1.0 - first };
    }
    let t = ratio_power(small, large, p);
    let norm = large * (t.ln_1p() / p).exp();
    let (major, minor) = (1.0 / (1.0 + t), t / (1.0 + t));
    let (first, second) = if u >= v { (major, minor) } else { (minor, major) };
    Weighted { norm, first, second }
}

/// `(small/large)^p`, with the quotient taken before the power so that neither overflows.
#[inline]
fn ratio_power(small: f64, large: f64, p: f64) -> f64 {
    super::powers::power(small / large, p)
}

/// Logarithm of the q-norm of two numbers given by their logarithms, and the share of each in its q-th power, for a block
/// of pairs in a [`Job`](super::lanes::Job); `r` is `1/q`.
#[inline(always)]
pub(crate) fn norm_of_logs<const FUSED: bool, T: Lane, const N: usize>(
    x: &[T; N],
    y: &[T; N],
    q: &[T; N],
    r: &[T; N],
) -> ([T; N], [[T; N]; 2]) {
    let (mut norm, mut shares) = (*x, [*x, *y]);
    for i in 0..N {
        let (high, low) = (x[i].most(y[i]), x[i].least(y[i]));
        let ratio = (q[i] * (low - high)).exp::<FUSED>();
        let sum = T::of(1.0) + ratio;
        norm[i] = sum.ln::<FUSED>().times_plus::<FUSED>(r[i], high);
        let (large, small) = (T::of(1.0) / sum, ratio / sum);
        shares[0][i] = if x[i] > y[i] { large } else { small };
        shares[1][i] = if x[i] > y[i] { small } else { large };
    }
    (norm, shares)
}

/// The exponent of the dual norm: `1/p + 1/q = 1`, in terms of the shape exponent `ε = 2/p`
/// (`q = 2 / (2 - ε)`). Infinite for `ε >= 2`, where the dual is the maximum norm.
#[inline]
pub fn dual_exponent(epsilon: f64) -> f64 {
    if epsilon >= 2.0 { f64::INFINITY } else { 2.0 / (2.0 - epsilon) }
}

/// The dual norm of a non-negative pair for the shape exponent `ε` (the maximum for `ε >= 2`).
#[inline]
pub fn dual_norm(u: f64, v: f64, epsilon: f64) -> f64 {
    let q = dual_exponent(epsilon);
    if q.is_infinite() { u.max(v) } else { norm(u, v, q) }
}

/// The dual norm of a non-negative pair, and the point of the unit curve `x^(2/ε) + y^(2/ε) = 1` that is touched by the
/// line with this pair as its normal: `(part/norm)^(q-1)` of both parts.
///
/// With `r = small/large` and `q = 2/(2-ε)` the larger part has `(1 + r^q)^(-ε/2)`, which times `1 + r^q` is the norm, too.
/// For ε >= 2 the larger takes all, of equal ones the first.
///
/// ```
/// use supersurface::numeric::superellipse::touched;
/// assert_eq!(touched(3.0, 4.0, 1.0), (5.0, [0.6, 0.8]));
/// ```
pub fn touched(first: f64, second: f64, epsilon: f64) -> (f64, [f64; 2]) {
    let in_order = |large: f64, small: f64| match first >= second {
        true => [large, small],
        false => [small, large],
    };
    let [large, small] = in_order(first, second);
    let ratio = small / large;
    if epsilon >= 2.0 || small == 0.0 || ratio == 0.0 || large == f64::INFINITY {
        return (large, in_order(1.0, 0.0));
    }
    if epsilon == 1.0 {
        let m = (1.0 + ratio * ratio).sqrt();
        return (large * m, in_order(1.0 / m, ratio / m));
    }
    let q = dual_exponent(epsilon);
    let other = quick_power(ratio, q - 1.0);
    let t = ratio * other;
    let share = quick_power(1.0 + t, -0.5 * epsilon);
    (large * (1.0 + t) * share, in_order(share, other * share))
}

/// One layer of a gauge in logarithms, as the fitting kernels use it.
#[derive(Clone, Copy, Debug)]
pub struct LogLayer {
    /// `ln (u^p + v^p)^(1/p)`.
    pub log_norm: f64,
    /// Weight of the first argument.
    pub first: f64,
    /// Weight of the second argument.
    pub second: f64,
    /// Binary entropy of the weights, `-w ln w - (1-w) ln (1-w)`, in [0, ln 2].
    pub entropy: f64,
    /// `p (ln u - ln v)`.
    pub spread: f64,
}

/// The norm of `(e^u, e^v)` with its weights and entropy (FORMULAS §0, `w` and `S`).
#[inline]
pub fn log_layer(u: f64, v: f64, p: f64) -> LogLayer {
    let spread = p * (u - v);
    let t = (-spread.abs()).exp();
    let l = t.ln_1p();
    let minor = t / (1.0 + t);
    let log_norm = u.max(v) + l / p;
    let entropy = l + spread.abs() * minor;
    let (first, second) = if spread > 0.0 { (1.0 - minor, minor) } else { (minor, 1.0 - minor) };
    LogLayer { log_norm, first, second, entropy, spread }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_add_up_and_match_the_logarithmic_layer() {
        for (u, v, p) in [(0.3, 0.7, 2.0), (1e-9, 5.0, 20.0), (2.0, 2.0, 1.05), (4.0, 0.1, 0.9)] {
            let w = weighted(u, v, p);
            let l = log_layer(f64::ln(u), f64::ln(v), p);
            assert!((w.first + w.second - 1.0).abs() < 1e-15);
            assert!((w.first - l.first).abs() < 1e-12);
            assert!((w.norm.ln() - l.log_norm).abs() < 1e-12);
            assert!(l.entropy >= 0.0 && l.entropy <= std::f64::consts::LN_2 + 1e-15);
        }
    }

    #[test]
    fn the_dual_norm_bounds_the_product() {
        let (x, y, n, m) = (0.8, 0.4, 0.3, 0.9);
        for epsilon in [0.2, 1.0, 1.7, 2.0] {
            let product = x * n + y * m;
            assert!(product <= norm(x, y, 2.0 / epsilon) * dual_norm(n, m, epsilon) + 1e-12);
        }
    }
}
