//! The superformula of Gielis: stars, polygons and rounded flowers as one plane curve.
//!
//! `r(φ) = (|cos(mφ/4)/a|^n2 + |sin(mφ/4)/b|^n3)^(-1/n1)` with the polar angle φ (FORMULAS §5). Both
//! terms are taken as logarithms, so no exponent overflows; `m = 4`, `n1 = n2 = n3 = 2/ε` is the superellipse
//! of semi-axes `a`, `b`.

mod extent;
mod hessian;
mod mass;
mod supershape;

pub use supershape::Supershape;

use crate::numeric::powers::quadrant_cos_sin;
use crate::shape::InvalidShape;

/// Radii must lie between `e^-69` and `e^69` (1e-30 to 1e30), so that moments of a solid stay finite.
const LARGEST_LOG_RADIUS: f64 = 69.0;

/// The six numbers of a plane curve. `radius` is dimensionless, or in metres: `a` and `b` set its scale
/// together with the exponents.
///
/// ```
/// use supersurface::shape::Superformula;
/// // an ellipse with semi-axes 2 and 1
/// let ellipse = Superformula::new(4.0, [2.0; 3], [2.0, 1.0])?;
/// assert!((ellipse.radius(0.0) - 2.0).abs() < 1e-15);
/// assert!((ellipse.radius(std::f64::consts::FRAC_PI_2) - 1.0).abs() < 1e-15);
/// assert!(ellipse.is_closed());
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superformula {
    m: f64,
    n: [f64; 3],
    scales: [f64; 2],
}

impl Superformula {
    /// Symmetry `m` in [0, 1000]; exponents `[n1, n2, n3]`, `n1` not 0 and all at most 1e4, `n2` and `n3`
    /// positive; scales `[a, b]` in [1e-6, 1e6]. Fails also when a radius could leave [1e-30, 1e30].
    pub fn new(m: f64, n: [f64; 3], scales: [f64; 2]) -> Result<Self, InvalidShape> {
        InvalidShape::check((0.0..=1e3).contains(&m), "symmetry m", m, "in [0, 1000]")?;
        let [n1, n2, n3] = n;
        let inside = n1.abs() >= 1e-3 && n1.abs() <= 1e4;
        InvalidShape::check(inside, "exponent n1", n1, "in [0.001, 1e4] or its negative")?;
        for (v, what) in [(n2, "exponent n2"), (n3, "exponent n3")] {
            InvalidShape::check(v > 0.0 && v <= 1e4, what, v, "in (0, 1e4]")?;
        }
        for (v, what) in scales.iter().zip(["scale a", "scale b"]) {
            InvalidShape::check((1e-6..=1e6).contains(v), what, *v, "in [1e-6, 1e6]")?;
        }
        let curve = Self { m, n, scales };
        for log in curve.log_radius_bounds() {
            let inside = log.abs() <= LARGEST_LOG_RADIUS;
            InvalidShape::check(inside, "logarithm of a radius", log, "in [-69, 69]")?;
        }
        Ok(curve)
    }

    /// The symmetry `m`: the curve repeats `m` times in a turn where `a = b` and `n2 = n3`.
    pub const fn m(&self) -> f64 {
        self.m
    }

    /// The exponents `[n1, n2, n3]`.
    pub const fn n(&self) -> [f64; 3] {
        self.n
    }

    /// The scales `[a, b]`.
    pub const fn scales(&self) -> [f64; 2] {
        self.scales
    }

    /// True when the curve meets itself after one turn: `m` even, or any whole `m` when both terms are
    /// alike. Otherwise it jumps at `φ = ±π`.
    pub fn is_closed(&self) -> bool {
        let [_, n2, n3] = self.n;
        let [a, b] = self.scales;
        self.m % 2.0 == 0.0 || self.m % 1.0 == 0.0 && n2 == n3 && a == b
    }

    /// Radius at the polar angle `phi` in radians; between 1e-30 and 1e30 for any finite angle, and at 0 for
    /// one that is not.
    pub fn radius(&self, phi: f64) -> f64 {
        self.log_radius(&self.terms(phi)).exp()
    }

    /// Derivative of the radius by the angle, per radian; `None` at a corner (a vanishing cosine with
    /// `n2 <= 1`, or sine with `n3 <= 1`).
    pub fn derivative(&self, phi: f64) -> Option<f64> {
        Some(self.radius(phi) * self.log_slope(phi)?)
    }

    /// `r'/r`, by `d ln r = -(1/n1) (w_s n3 cot ψ - w_c n2 tan ψ) m/4 dφ` with the shares `w` of both terms
    /// and `ψ = mφ/4`.
    pub(crate) fn log_slope(&self, phi: f64) -> Option<f64> {
        let terms = self.terms(phi);
        let [n1, n2, n3] = self.n;
        if self.m == 0.0 {
            return Some(0.0);
        }
        let smooth = (terms.cos != 0.0 || n2 > 1.0) && (terms.sin != 0.0 || n3 > 1.0);
        if !smooth {
            return None;
        }
        let [first, second] = terms.shares();
        let over = |weight: f64, up: f64, down: f64| {
            if weight == 0.0 || down == 0.0 { 0.0 } else { weight * up / down }
        };
        let turn = over(second, terms.cos, terms.sin) * n3 - over(first, terms.sin, terms.cos) * n2;
        Some(-0.25 * self.m / n1 * turn)
    }

    /// Derivative of [`log_slope`](Self::log_slope): with `T = d ln B/dψ` of the bracket B,
    /// `T' = w_c n2 ((n2-1) sec²ψ - n2) + w_s n3 ((n3-1) csc²ψ - n3) - T²`. `None` where it is infinite (a vanishing
    /// cosine with `n2 < 2`, or sine with `n3 < 2`).
    pub(crate) fn log_curvature(&self, phi: f64) -> Option<f64> {
        let terms = self.terms(phi);
        let ([n1, n2, n3], quarter) = (self.n, 0.25 * self.m);
        if self.m == 0.0 {
            return Some(0.0);
        }
        let turn = -self.log_slope(phi)? * n1 / quarter;
        let sum = terms.log_sum();
        // w/c² of a term that may vanish together with the function
        let steep = |log: f64, log_scale: f64, c: f64, n: f64| match c == 0.0 {
            false => Some((log - sum).exp() / (c * c)),
            true if n > 2.0 => Some(0.0),
            true => (n == 2.0).then(|| (-n * log_scale - sum).exp()),
        };
        let [a, b] = self.scales.map(f64::ln);
        let [first, second] = terms.shares();
        let bend = n2 * ((n2 - 1.0) * steep(terms.log_first, a, terms.cos, n2)? - n2 * first)
            + n3 * ((n3 - 1.0) * steep(terms.log_second, b, terms.sin, n3)? - n3 * second);
        let curvature = -quarter * quarter / n1 * (bend - turn * turn);
        curvature.is_finite().then_some(curvature)
    }

    fn terms(&self, phi: f64) -> Terms {
        let psi = 0.25 * self.m * phi;
        let (cos, sin) = if psi.is_finite() { quadrant_cos_sin(psi) } else { (1.0, 0.0) };
        let [a, b] = self.scales;
        let [_, n2, n3] = self.n;
        let log_first = n2 * (cos.abs().ln() - a.ln());
        let log_second = n3 * (sin.abs().ln() - b.ln());
        Terms { cos, sin, log_first, log_second }
    }

    fn log_radius(&self, terms: &Terms) -> f64 {
        let [n1, ..] = self.n;
        -terms.log_sum() / n1
    }

    /// Bounds of `ln r` over all angles: the larger of cosine and sine is at least `1/√2`, neither exceeds 1.
    fn log_radius_bounds(&self) -> [f64; 2] {
        let [n1, n2, n3] = self.n;
        let [a, b] = self.scales.map(f64::ln);
        let half = 0.5 * std::f64::consts::LN_2;
        let least = (-n2 * (half + a)).min(-n3 * (half + b));
        let most = (-n2 * a).max(-n3 * b) + std::f64::consts::LN_2;
        [-least / n1, -most / n1]
    }
}

/// Both terms of the bracket at one angle, as logarithms (of which at most one is -∞).
struct Terms {
    cos: f64,
    sin: f64,
    log_first: f64,
    log_second: f64,
}

impl Terms {
    /// `ln (e^first + e^second)`.
    fn log_sum(&self) -> f64 {
        let (large, small) = self.ordered();
        large + (small - large).exp().ln_1p()
    }

    /// Share of each term in the sum.
    fn shares(&self) -> [f64; 2] {
        let (large, small) = self.ordered();
        let t = (small - large).exp();
        let (major, minor) = (1.0 / (1.0 + t), t / (1.0 + t));
        if self.log_first >= self.log_second { [major, minor] } else { [minor, major] }
    }

    fn ordered(&self) -> (f64, f64) {
        if self.log_first >= self.log_second {
            (self.log_first, self.log_second)
        } else {
            (self.log_second, self.log_first)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_derivative_agrees_with_differences() {
        let curves = [
            Superformula::new(6.0, [0.5, 1.7, 2.3], [1.1, 0.9]),
            Superformula::new(5.0, [20.0, 80.0, 40.0], [1.0, 1.0]),
            Superformula::new(3.0, [-2.0, 0.6, 0.4], [0.7, 1.4]),
        ];
        for curve in curves.map(Result::unwrap) {
            for i in -31..=31 {
                let (phi, h) = (f64::from(i) * 0.1 + 0.013, 1e-6);
                let difference = (curve.radius(phi + h) - curve.radius(phi - h)) / (2.0 * h);
                let slope = curve.derivative(phi).unwrap();
                assert!((slope - difference).abs() < 1e-6 * (1.0 + slope.abs()), "{phi}");
            }
        }
    }

    #[test]
    fn corners_have_no_slope_and_a_circle_has_none_but_zero() {
        let square = Superformula::new(4.0, [1.0; 3], [1.0; 2]).unwrap();
        assert!(square.derivative(0.0).is_none() && square.derivative(0.3).is_some());
        let circle = Superformula::new(0.0, [0.3, 0.5, 0.5], [2.0, 1.0]).unwrap();
        assert_eq!(circle.derivative(1.0), Some(0.0));
        assert!((circle.radius(1.0) - circle.radius(-2.0)).abs() == 0.0);
    }

    #[test]
    fn wrong_numbers_are_refused_and_odd_angles_answered() {
        for bad in [f64::NAN, f64::INFINITY, -1.0, 1e308] {
            assert!(Superformula::new(bad, [1.0; 3], [1.0; 2]).is_err());
            assert!(Superformula::new(4.0, [1.0, bad, 1.0], [1.0; 2]).is_err());
            assert!(Superformula::new(4.0, [1.0; 3], [1.0, bad]).is_err());
        }
        assert!(Superformula::new(4.0, [0.0, 1.0, 1.0], [1.0; 2]).is_err());
        assert!(Superformula::new(4.0, [0.01, 1e3, 1e3], [3.0; 2]).is_err());
        let steep = Superformula::new(4.0, [1e4; 3], [1.0; 2]).unwrap();
        for phi in [0.0, 1.0, 1e308, f64::NAN, f64::INFINITY, 5e-324] {
            assert!(steep.radius(phi) > 0.0 && steep.radius(phi) < 2.0);
            assert!(steep.derivative(phi).is_none_or(f64::is_finite));
        }
    }
}
