//! The extended superellipsoid of Zhou and Kambhamettu: exponents that change with the angles.
//!
//! `f(η, ω) = (a1 cos^f1(η) η cos^f2(ω) ω, a2 cos^f1 η sin^f2 ω, a3 sin^f1 η)` with signed powers (equation 23,
//! with the arguments of f1 and f2 as FORMULAS §5 has them). `f1` is a natural cubic spline over [-π/2, π/2],
//! `f2` a periodic one over [-π, π], both clamped to [0.05, 2.5].
//!
//! Two solids go by this name, and they are equal only for constant exponents:
//!
//! * [`ExtendedSuperellipsoid`], equation 23: the exponents follow the *parameters* η and ω. It has points,
//!   tangents and normals, but no explicit gauge.
//! * [`RadialExtended`]: the exponents follow the *geometric* angles of a point. Its gauge is explicit and exact.

mod hessian;
mod mass;
mod radial;
mod radial_mass;

pub use radial::RadialExtended;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::numeric::powers::{power, quadrant_cos_sin, signed_power};
use crate::numeric::spline::Spline;
use crate::shape::{InvalidShape, Parametric};
use crate::{Direction, Point, Vector};

/// Exponents are clamped to this range.
const EXPONENTS: [f64; 2] = [0.05, 2.5];

/// The parametric extended superellipsoid (equation 23).
///
/// ```
/// use supersurface::shape::{ExtendedSuperellipsoid, Parametric};
/// // a flat bottom and a round top, square on one side and round on the other
/// let vase = ExtendedSuperellipsoid::new([0.05, 0.05, 0.1], &[0.2, 0.9, 1.0], &[1.0, 0.3, 1.0, 1.0])?;
/// assert_eq!(vase.point(std::f64::consts::FRAC_PI_2, 0.0).z, 0.1);
/// assert!(vase.normal(0.4, 0.3).is_some());
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ExtendedSuperellipsoid {
    semi_axes: [f64; 3],
    profile: Spline,
    section: Spline,
}

impl ExtendedSuperellipsoid {
    /// Semi-axes in metres, in [1e-100, 1e100]. `profile`: values of f1 at equal distances from η = -π/2 to
    /// π/2; `section`: values of f2 at `ω = -π + 2πj/n`. 1 to 1000 values each, in [0.05, 2.5]; one value is a
    /// constant exponent.
    pub fn new(
        semi_axes: [f64; 3],
        profile: &[f64],
        section: &[f64],
    ) -> Result<Self, InvalidShape> {
        for (a, what) in semi_axes.iter().zip(["semi-axis a1", "semi-axis a2", "semi-axis a3"]) {
            let inside = (1e-100..=1e100).contains(a);
            InvalidShape::check(inside, what, *a, "in [1e-100, 1e100]")?;
        }
        for (values, what) in
            [(profile, "value of the exponent ε1"), (section, "value of the exponent ε2")]
        {
            let count = values.len();
            let inside = (1..=1000).contains(&count);
            InvalidShape::check(inside, "number of exponents", count as f64, "from 1 to 1000")?;
            for v in values {
                let inside = (EXPONENTS[0]..=EXPONENTS[1]).contains(v);
                InvalidShape::check(inside, what, *v, "in [0.05, 2.5]")?;
            }
        }
        let profile = Spline::natural(profile, -FRAC_PI_2, FRAC_PI_2);
        let section = Spline::periodic(section, -PI, TAU);
        Ok(Self { semi_axes, profile, section })
    }

    /// Semi-axes `[a1, a2, a3]` in metres.
    pub const fn semi_axes(&self) -> [f64; 3] {
        self.semi_axes
    }

    /// Exponents `[f1(η), f2(ω)]`.
    pub fn exponents(&self, eta: f64, omega: f64) -> [f64; 2] {
        let [[f1, _], [f2, _]] = self.exponents_and_slopes(eta, omega);
        [f1, f2]
    }

    /// The solid with the same numbers whose exponents follow the geometric angles: another surface, unless
    /// the exponents are constant.
    pub const fn radial(self) -> RadialExtended {
        RadialExtended::from_numbers(self)
    }

    /// `[[f1, f1'], [f2, f2']]`; the slope is 0 where the exponent is clamped.
    fn exponents_and_slopes(&self, eta: f64, omega: f64) -> [[f64; 2]; 2] {
        self.exponent_derivatives(eta, omega).map(|[f, slope, _]| [f, slope])
    }

    /// `[[f1, f1', f1''], [f2, f2', f2'']]`; a constant where the exponent is clamped.
    fn exponent_derivatives(&self, eta: f64, omega: f64) -> [[f64; 3]; 2] {
        let clamped = |[f, slope, bend]: [f64; 3]| {
            let [low, high] = EXPONENTS;
            if f < low {
                [low, 0.0, 0.0]
            } else if f > high {
                [high, 0.0, 0.0]
            } else {
                [f, slope, bend]
            }
        };
        [clamped(self.profile.derivatives(eta)), clamped(self.section.derivatives(omega))]
    }
}

/// `D` in `d/dt sgn(b)|b|^f = |b|^(f-1) D`: `D = f b' + b ln|b| f'`.
fn drift(b: f64, db: f64, [f, df]: [f64; 2]) -> f64 {
    f * db + if b == 0.0 { 0.0 } else { b * b.abs().ln() * df }
}

/// `d/dt sgn(b)|b|^f`; `None` where it is infinite.
fn slope(b: f64, db: f64, f: [f64; 2]) -> Option<f64> {
    let [exponent, _] = f;
    let steep = match (b == 0.0, exponent - 1.0) {
        (true, rest) if rest < 0.0 => return None,
        (true, rest) => f64::from(rest == 0.0),
        (false, rest) => power(b, rest),
    };
    Some(steep * drift(b, db, f))
}

impl Parametric for ExtendedSuperellipsoid {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]]
    }

    fn point(&self, eta: f64, omega: f64) -> Point {
        let [a1, a2, a3] = self.semi_axes;
        let [f1, f2] = self.exponents(eta, omega);
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        let c = signed_power(ce, f1);
        let (x, y) = (signed_power(co, f2), signed_power(so, f2));
        Point::new(a1 * c * x, a2 * c * y, a3 * signed_power(se, f1))
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        let [a1, a2, a3] = self.semi_axes;
        let [f1, f2] = self.exponents_and_slopes(eta, omega);
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        let (c, dc, ds) = (signed_power(ce, f1[0]), slope(ce, -se, f1)?, slope(se, ce, f1)?);
        let (x, y) = (signed_power(co, f2[0]), signed_power(so, f2[0]));
        let (dx, dy) = (slope(co, -so, f2)?, slope(so, co, f2)?);
        let along = Vector::new(a1 * dc * x, a2 * dc * y, a3 * ds);
        let around = Vector::new(a1 * c * dx, a2 * c * dy, 0.0);
        let finite = along.iter().chain(around.iter()).all(|v| v.is_finite());
        finite.then_some([along, around])
    }

    /// The product of both tangents, `(S'Y'/a1, -S'X'/a2, -C'(XY' - X'Y)/a3)` up to a factor, with the powers
    /// that vanish or grow without bound on seams divided out. `None` on seams with an exponent from 2.
    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        let [a1, a2, a3] = self.semi_axes;
        let [f1, f2] = self.exponents_and_slopes(eta, omega);
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        // |b|^(1-f) D, where D vanishes with b
        let smooth = |b: f64, d: f64, f: f64| {
            if b == 0.0 { (f < 2.0).then_some(0.0) } else { Some(power(b, 1.0 - f) * d) }
        };
        let out = smooth(ce, drift(se, ce, f1), f1[0])?;
        let up = smooth(se, -drift(ce, -se, f1), f1[0])?;
        let (dx, dy) = (drift(co, -so, f2), drift(so, co, f2));
        let (x, y) =
            if out == 0.0 { (0.0, 0.0) } else { (smooth(co, dy, f2[0])?, smooth(so, -dx, f2[0])?) };
        let n = Vector::new(out * x / a1, out * y / a2, up * (co * dy - so * dx) / a3);
        // scaled first: 1/a of 1e-100 m would overflow when squared
        let largest = n.amax();
        (largest > 0.0 && largest.is_finite()).then(|| Direction::new_normalize(n / largest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Superellipsoid;

    fn vase() -> ExtendedSuperellipsoid {
        let (profile, section) = ([0.5, 1.4, 0.8, 1.7], [0.6, 1.2, 0.9, 1.6, 0.7, 1.1]);
        ExtendedSuperellipsoid::new([0.4, 0.3, 0.5], &profile, &section).unwrap()
    }

    #[test]
    fn tangents_and_normals_agree_with_differences() {
        let (vase, h) = (vase(), 1e-6);
        for (i, j) in (-9..=9).flat_map(|i| (-9..=9).map(move |j| (i, j))) {
            let (eta, omega) = (f64::from(i) * 0.165 + 0.01, f64::from(j) * 0.34 + 0.02);
            let [along, around] = vase.tangents(eta, omega).unwrap();
            let d = (vase.point(eta + h, omega) - vase.point(eta - h, omega)) / (2.0 * h);
            assert!((along - d).norm() < 1e-6 * (1.0 + d.norm()), "{eta} {omega}");
            let d = (vase.point(eta, omega + h) - vase.point(eta, omega - h)) / (2.0 * h);
            assert!((around - d).norm() < 1e-6 * (1.0 + d.norm()), "{eta} {omega}");
            let n = vase.normal(eta, omega).unwrap();
            let cross = around.cross(&along).normalize();
            assert!((n.into_inner() - cross).norm() < 1e-9, "{eta} {omega} {n:?} {cross}");
        }
        // poles are level, seams have normals though no tangents
        for (eta, sign) in [(FRAC_PI_2, 1.0), (-FRAC_PI_2, -1.0)] {
            assert!((vase.normal(eta, 0.3).unwrap().z - sign).abs() < 1e-15);
        }
        assert!((vase.normal(0.0, 0.0).unwrap().x - 1.0).abs() < 1e-15);
    }

    #[test]
    fn constant_exponents_make_a_superellipsoid() {
        let (axes, e) = ([0.4, 0.3, 0.5], [0.6, 1.3]);
        let truth = Superellipsoid::new(axes, e).unwrap();
        let same = ExtendedSuperellipsoid::new(axes, &[e[0]; 3], &[e[1]]).unwrap();
        for (eta, omega) in [(0.2, 0.7), (-1.2, 2.0), (0.0, 0.0), (FRAC_PI_2, 1.0), (0.3, PI)] {
            assert!((same.point(eta, omega) - truth.point(eta, omega)).norm() < 1e-14);
            assert_eq!(same.tangents(eta, omega).is_some(), truth.tangents(eta, omega).is_some());
            let (n, t) = (same.normal(eta, omega).unwrap(), truth.normal(eta, omega).unwrap());
            assert!((n.into_inner() - t.into_inner()).norm() < 1e-13);
        }
    }

    #[test]
    fn wrong_numbers_are_refused() {
        for bad in [f64::NAN, f64::INFINITY, 0.0, -1.0, 1e308, 5e-324] {
            assert!(ExtendedSuperellipsoid::new([1.0, bad, 1.0], &[1.0], &[1.0]).is_err());
            assert!(ExtendedSuperellipsoid::new([1.0; 3], &[1.0, bad], &[1.0]).is_err());
            assert!(ExtendedSuperellipsoid::new([1.0; 3], &[1.0], &[bad, 1.0]).is_err());
        }
        assert!(ExtendedSuperellipsoid::new([1.0; 3], &[], &[1.0]).is_err());
        let vase = vase();
        for angle in [f64::NAN, f64::INFINITY, 1e308] {
            assert!(vase.normal(angle, angle).is_none_or(|n| n.iter().all(|v| v.is_finite())));
            assert!(vase.tangents(angle, 0.1).is_none_or(|t| t[0].iter().all(|v| v.is_finite())));
        }
    }
}
