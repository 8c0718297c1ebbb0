//! Differential geometry in closed form (FORMULAS §6, in the place of equations 39 to 41 and Table 1).
//!
//! With `c = |cos η|`, `s = |sin η|`, `C = |cos ω|`, `S = |sin ω|`, `r = a4 + cos^ε1 η` (a4 = 0 for a superellipsoid)
//! and the normal's form ν (see [`crate::shape::angular`]):
//!
//! ```text
//! E = ε1² (c^(2ε1-2) s² A² + a3² s^(2ε1-2) c²),   A² = a1² C^(2ε2) + a2² S^(2ε2)
//! F = -r ε1 c^(ε1-1) sin η · ε2 sgn(cos ω sin ω) (a2² S^(2ε2-1) C - a1² C^(2ε2-1) S)
//! G = r² ε2² (a1² C^(2ε2-2) S² + a2² S^(2ε2-2) C²)
//! L = ε1 (2 - ε1)/|ν|,   M = 0,   N = ε2 (2 - ε2) r sgn(cos η) c^(2-ε1)/|ν|
//! ```
//!
//! On the seams (a symmetry plane of the body) the angles are no chart, but the coordinate curves are principal
//! and their normal curvatures `L/E`, `N/G` have limits: 0 for exponents under 1, infinite over 1.

use super::Superellipsoid;
use crate::Vector;
use crate::numeric::powers::{power, quadrant_cos_sin, signed_power};
use crate::shape::{Curvature, FundamentalForms};

impl Superellipsoid {
    /// Both fundamental forms at two angles; `None` where a number is infinite or there is no normal.
    pub fn fundamental_forms(&self, eta: f64, omega: f64) -> Option<FundamentalForms> {
        let [first, second] =
            Angular::new(self.semi_axes, 0.0, self.exponents, eta, omega).forms()?;
        let finite = first.iter().chain(&second).all(|v| v.is_finite());
        finite.then_some(FundamentalForms { first, second })
    }

    /// Normal curvatures along the meridian (growing η) and the parallel (growing ω), in 1/m; `None` for one
    /// that is infinite or undefined.
    pub fn normal_curvatures(&self, eta: f64, omega: f64) -> [Option<f64>; 2] {
        Angular::new(self.semi_axes, 0.0, self.exponents, eta, omega).normal_curvatures()
    }

    /// Curvatures at two angles, exact on seams and poles; `None` where one is infinite or undefined: on seams
    /// for exponents over 1, at poles unless ε1 < 1 or the body is an ellipsoid there, at edges and cusps.
    ///
    /// ```
    /// use supersurface::shape::Superellipsoid;
    /// let ball = Superellipsoid::new([0.5; 3], [1.0, 1.0])?;
    /// assert!((ball.curvature(0.3, 1.0).unwrap().gaussian() - 4.0).abs() < 1e-12);
    /// let tin = Superellipsoid::new([0.5, 0.5, 1.0], [0.1, 1.0])?;
    /// assert_eq!(tin.curvature(0.0, 0.0).unwrap().principal, [2.0, 0.0]);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn curvature(&self, eta: f64, omega: f64) -> Option<Curvature> {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes, self.exponents);
        if quadrant_cos_sin(eta).0 == 0.0 {
            return match (e1 < 1.0, e1 == 1.0 && e2 == 1.0) {
                (true, _) => Curvature::of_principal(0.0, 0.0),
                (_, true) => Curvature::of_principal(a3 / a1 / a1, a3 / a2 / a2),
                _ => None,
            };
        }
        Angular::new(self.semi_axes, 0.0, self.exponents, eta, omega).curvature()
    }
}

/// What the formulas share. Both members use it.
pub(crate) struct Angular {
    axes: [f64; 3],
    exponents: [f64; 2],
    meridian: [f64; 2],
    around: [f64; 2],
    /// `a4 + cos^ε1 η`.
    radius: f64,
}

impl Angular {
    pub(crate) fn new(
        axes: [f64; 3],
        ring: f64,
        exponents: [f64; 2],
        eta: f64,
        omega: f64,
    ) -> Self {
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        let radius = ring + signed_power(ce, exponents[0]);
        Self { axes, exponents, meridian: [ce, se], around: [co, so], radius }
    }

    fn on_seam(&self) -> bool {
        self.meridian.iter().chain(&self.around).any(|v| *v == 0.0)
    }

    /// `|ν|`; `None` where there is no normal.
    fn slope(&self) -> Option<f64> {
        let ([ce, se], [co, so]) = (self.meridian, self.around);
        let [e1, e2] = self.exponents;
        let smooth = |b: f64, e: f64| (b != 0.0 || e < 2.0).then(|| power(b, 2.0 - e));
        let (c, s) = (smooth(ce, e1)?, smooth(se, e1)?);
        let (x, y) = if c == 0.0 { (0.0, 0.0) } else { (smooth(co, e2)?, smooth(so, e2)?) };
        let [a1, a2, a3] = self.axes;
        Some(Vector::new(c * x / a1, c * y / a2, s / a3).norm())
    }

    /// `[[E, F, G], [L, M, N]]`, with infinite entries on seams.
    pub(crate) fn forms(&self) -> Option<[[f64; 3]; 2]> {
        let slope = self.slope()?;
        let [a1, a2, a3] = self.axes;
        let [e1, e2] = self.exponents;
        let [c, s] = self.meridian.map(f64::abs);
        let [co, so] = self.around.map(f64::abs);
        let width = a1 * a1 * raised(co, 2.0 * e2) + a2 * a2 * raised(so, 2.0 * e2);
        let e = e1
            * e1
            * (raised(c, 2.0 * e1 - 2.0) * s * s * width
                + a3 * a3 * raised(s, 2.0 * e1 - 2.0) * c * c);
        let turn = self.around[0] * self.around[1];
        let shear =
            -a1 * a1 * raised(co, 2.0 * e2 - 1.0) * so + a2 * a2 * raised(so, 2.0 * e2 - 1.0) * co;
        let f = if turn == 0.0 || s == 0.0 {
            0.0
        } else {
            -self.radius * e1 * raised(c, e1 - 1.0) * self.meridian[1] * e2 * turn.signum() * shear
        };
        let g = self.radius
            * self.radius
            * (e2 * e2)
            * (a1 * a1 * raised(co, 2.0 * e2 - 2.0) * so * so
                + a2 * a2 * raised(so, 2.0 * e2 - 2.0) * co * co);
        let l = e1 * (2.0 - e1) / slope;
        let side = if self.meridian[0] < 0.0 { -1.0 } else { 1.0 };
        let n = e2 * (2.0 - e2) * self.radius * side * raised(c, 2.0 - e1) / slope;
        Some([[e, f, g], [l, 0.0, n]])
    }

    /// `[L/E, N/G]`.
    pub(crate) fn normal_curvatures(&self) -> [Option<f64>; 2] {
        let Some([[e, _, g], [l, _, n]]) = self.forms() else { return [None; 2] };
        [l / e, n / g].map(|k| k.is_finite().then_some(k))
    }

    pub(crate) fn curvature(&self) -> Option<Curvature> {
        if self.on_seam() {
            let [a, b] = self.normal_curvatures();
            return Curvature::of_principal(a?, b?);
        }
        let [[e, f, g], [l, _, n]] = self.forms()?;
        let area = e * g - f * f;
        Curvature::of_mean_and_gaussian(0.5 * (e * n + g * l) / area, l * n / area)
    }
}

/// `b^s` for `b >= 0`, with `0^0 = 1` and an infinite power of 0 for `s < 0`.
fn raised(b: f64, s: f64) -> f64 {
    match (b == 0.0, s == 0.0) {
        (_, true) => 1.0,
        (true, _) if s < 0.0 => f64::INFINITY,
        _ => power(b, s),
    }
}
