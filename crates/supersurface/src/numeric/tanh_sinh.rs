//! Integrals over an interval by the double exponential rule (Takahasi and Mori 1974).
//!
//! `x = centre + half tanh(π/2 sinh t)` turns `∫ f dx` into an integral over all `t` whose integrand
//! decays so fast that the plain trapezoid rule gains about as many digits again with each halving of
//! the step. Ends where `f` has an infinite slope (a power under 1) do no harm, kinks inside do: cut
//! the interval there.

/// An integral and how far the last two steps differ (an estimate of its error, no bound).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Integral<const N: usize> {
    /// The values, one for each integrand.
    pub value: [f64; N],
    /// Absolute difference from the value with twice the step.
    pub error: [f64; N],
}

/// Beyond this `t` the nodes coincide with the ends.
const LAST: f64 = 3.3;
/// Halvings of the step at most.
const LEVELS: u32 = 9;

/// Integrals from `from` to `to` of the `N` functions that `f` returns, until two steps agree to about
/// `relative` of the largest.
///
/// ```
/// use supersurface::numeric::tanh_sinh::integrate;
/// let root = integrate(|x| [x.sqrt()], 0.0, 1.0, 1e-13);
/// assert!((root.value[0] - 2.0 / 3.0).abs() < 1e-13);
/// ```
pub fn integrate<const N: usize>(
    f: impl Fn(f64) -> [f64; N],
    from: f64,
    to: f64,
    relative: f64,
) -> Integral<N> {
    let half = 0.5 * (to - from);
    // value of both nodes at ±t, times the weight dx/dt
    let pair = |t: f64| {
        let (sinh, cosh) = (t.sinh(), t.cosh());
        let u = std::f64::consts::FRAC_PI_2 * sinh;
        // 1 - tanh u, exact near the ends
        let gap = 2.0 / ((2.0 * u).exp() + 1.0);
        let weight = half * std::f64::consts::FRAC_PI_2 * cosh / u.cosh().powi(2);
        let (left, right) = (f(from + half * gap), f(to - half * gap));
        let both = if t == 0.0 { 0.5 } else { 1.0 };
        std::array::from_fn::<f64, N, _>(|i| both * weight * (left[i] + right[i]))
    };
    let mut sum = [0.0; N];
    let mut result = Integral { value: [0.0; N], error: [f64::INFINITY; N] };
    for level in 0..=LEVELS {
        let step = 0.5f64.powi(level as i32);
        let (first, stride) = if level == 0 { (0.0, 1.0) } else { (step, 2.0 * step) };
        let mut t = first;
        while t <= LAST {
            for (s, v) in sum.iter_mut().zip(pair(t)) {
                *s += v;
            }
            t += stride;
        }
        let value = sum.map(|s| s * step);
        let error = std::array::from_fn(|i| (value[i] - result.value[i]).abs());
        result = Integral { value, error };
        let largest = value.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if level > 2 && error.iter().all(|e| *e <= relative * largest) {
            break;
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_and_steep_ends_are_integrated() {
        let r = integrate(|x: f64| [x.sin(), x.exp()], 0.0, 2.0, 1e-14);
        assert!((r.value[0] - (1.0 - 2f64.cos())).abs() < 1e-13);
        assert!((r.value[1] - (2f64.exp() - 1.0)).abs() < 1e-12);
        assert!(r.error.iter().all(|e| *e < 1e-10));
        let steep = integrate(|x: f64| [x.cbrt()], -1.0, 0.0, 1e-13);
        assert!((steep.value[0] + 0.75).abs() < 1e-12, "{steep:?}");
    }
}
