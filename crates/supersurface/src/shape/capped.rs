//! Parametric forms of solids with flat ends: `(a1 ρ cos^ε ω, a2 ρ sin^ε ω, a3 z)` with a profile `(ρ, z)` of straight
//! pieces in η from the middle of the lower end (-π/2) to the upper end or apex (π/2).
//!
//! The rims of the ends are at η = ∓π/4, where meshes have vertices.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};

use super::angular::{finite, superellipse, superellipse_normal, superellipse_slopes, unit};
use super::{Parametric, Supercone, Supercylinder};
use crate::{Direction, Point, Vector};

/// A point of the profile, its derivatives by η, and its outward normal in `(ρ, z)`; neither of these at a rim or apex.
struct Profile {
    place: [f64; 2],
    slope: Option<[f64; 2]>,
    normal: Option<[f64; 2]>,
}

impl Profile {
    /// The straight piece between two points of the profile and two angles in units of π/4.
    fn piece(eta: f64, [from, to]: [f64; 2], [a, b]: [[f64; 2]; 2]) -> Self {
        // angles beyond the ends are the ends
        let share = ((eta / FRAC_PI_4 - from) / (to - from)).clamp(0.0, 1.0);
        let step = [b[0] - a[0], b[1] - a[1]];
        let inner = share > 0.0 && share < 1.0;
        let slope = step.map(|d| d / ((to - from) * FRAC_PI_4));
        // the middle of a flat end has its normal, an apex has none
        let flat = step[1] == 0.0 && (a[0] == 0.0 && share <= 0.0 || b[0] == 0.0 && share >= 1.0);
        Self {
            place: [a[0] + share * step[0], a[1] + share * step[1]],
            slope: inner.then_some(slope),
            normal: (inner || flat).then_some([step[1], -step[0]]),
        }
    }

    fn cylinder(eta: f64) -> Self {
        let corners = [[0.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, 1.0]];
        let [a, b, c, d] = corners;
        match eta / FRAC_PI_4 {
            s if s <= -1.0 => Self::piece(eta, [-2.0, -1.0], [a, b]),
            s if s < 1.0 => Self::piece(eta, [-1.0, 1.0], [b, c]),
            _ => Self::piece(eta, [1.0, 2.0], [c, d]),
        }
    }

    fn cone(eta: f64) -> Self {
        let [a, b, c] = [[0.0, -1.0], [1.0, -1.0], [0.0, 1.0]];
        match eta / FRAC_PI_4 <= -1.0 {
            true => Self::piece(eta, [-2.0, -1.0], [a, b]),
            false => Self::piece(eta, [-1.0, 2.0], [b, c]),
        }
    }

    fn point(&self, [a1, a2, a3]: [f64; 3], e: f64, omega: f64) -> Point {
        let ([x, y], [rho, z]) = (superellipse(omega, e), self.place);
        Point::new(a1 * rho * x, a2 * rho * y, a3 * z)
    }

    fn tangents(&self, [a1, a2, a3]: [f64; 3], e: f64, omega: f64) -> Option<[Vector; 2]> {
        let ([x, y], [dx, dy]) = (superellipse(omega, e), superellipse_slopes(omega, e)?);
        let (rho, [out, up]) = (self.place[0], self.slope?);
        finite([
            Vector::new(a1 * out * x, a2 * out * y, a3 * up),
            Vector::new(a1 * rho * dx, a2 * rho * dy, 0.0),
        ])
    }

    fn normal(&self, [a1, a2, a3]: [f64; 3], e: f64, omega: f64) -> Option<Direction> {
        let [out, up] = self.normal?;
        if out == 0.0 {
            return unit(Vector::new(0.0, 0.0, up));
        }
        let [x, y] = superellipse_normal(omega, e)?;
        unit(Vector::new(out * x / a1, out * y / a2, up / a3))
    }
}

impl Parametric for Supercylinder {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]]
    }

    /// Ends for `|η| > π/4`, the mantle between; η goes at even speed along each.
    fn point(&self, eta: f64, omega: f64) -> Point {
        Profile::cylinder(eta).point(self.semi_axes(), self.exponent(), omega)
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        Profile::cylinder(eta).tangents(self.semi_axes(), self.exponent(), omega)
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        Profile::cylinder(eta).normal(self.semi_axes(), self.exponent(), omega)
    }
}

impl Parametric for Supercone {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]]
    }

    /// The base for `η < -π/4`, the mantle from there to the apex; η goes at even speed along each.
    fn point(&self, eta: f64, omega: f64) -> Point {
        Profile::cone(eta).point(self.semi_axes(), self.exponent(), omega)
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        Profile::cone(eta).tangents(self.semi_axes(), self.exponent(), omega)
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        Profile::cone(eta).normal(self.semi_axes(), self.exponent(), omega)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rims_and_the_apex_have_no_normal() {
        let (tin, cone) =
            (Supercylinder::new([1.0; 3], 1.0).unwrap(), Supercone::new([1.0; 3], 1.0).unwrap());
        assert_eq!(tin.point(FRAC_PI_4, 0.0), Point::new(1.0, 0.0, 1.0));
        assert_eq!(tin.normal(FRAC_PI_2, 0.3), Some(Vector::z_axis()));
        assert_eq!(cone.normal(-FRAC_PI_2, 0.3), Some(-Vector::z_axis()));
        assert_eq!(cone.point(FRAC_PI_2, 0.3), Point::new(0.0, 0.0, 1.0));
        for none in
            [tin.normal(FRAC_PI_4, 0.0), tin.normal(-FRAC_PI_4, 0.0), cone.normal(-FRAC_PI_4, 0.0)]
        {
            assert!(none.is_none());
        }
        assert!(cone.normal(FRAC_PI_2, 0.0).is_none());
        for eta in [1e308, f64::INFINITY, f64::NAN] {
            let _ = (tin.point(eta, 0.0), cone.tangents(eta, 0.0), cone.normal(eta, 0.0));
        }
    }
}
