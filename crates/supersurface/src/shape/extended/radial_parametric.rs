//! The radial extended superellipsoid by its geometric angles, and its mass.
//!
//! A direction `d` with the angles `η_g` and `ω_g` of the scaled point meets the surface at `d/g(d)`; the tangents are
//! `∂d/g - d (∇g·∂d)/g²`, and the normal is the gradient's.

use std::f64::consts::{FRAC_PI_2, PI};

use super::RadialExtended;
use crate::numeric::powers::quadrant_cos_sin;
use crate::shape::angular::{finite, unit};
use crate::shape::filled::{STAR_PIECES, filled_mass, star};
use crate::shape::{Filled, Implicit, Mass, MassEstimate, MassProperties, Parametric};
use crate::{Direction, Point, Vector};

impl RadialExtended {
    /// `d` and its derivatives by both angles.
    fn direction(&self, eta: f64, omega: f64) -> [Vector; 3] {
        let axes = Vector::from(self.numbers().semi_axes());
        let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
        let d = Vector::new(ce * co, ce * so, se);
        let along = Vector::new(-se * co, -se * so, ce);
        let around = Vector::new(-ce * so, ce * co, 0.0);
        [d, along, around].map(|v| v.component_mul(&axes))
    }

    /// The gradient; `None` where it does not exist (coordinate planes and poles, for exponents from 2).
    fn slope(&self, p: &Point) -> Option<Vector> {
        let [f1, f2] = self.exponents_at(p);
        let pole = p.x == 0.0 && p.y == 0.0;
        let profile = f1 < 2.0 || !(pole || p.z == 0.0);
        let section = f2 < 2.0 || pole || !(p.x == 0.0 || p.y == 0.0);
        (profile && section).then(|| self.gradient(p))
    }
}

impl Parametric for RadialExtended {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]]
    }

    fn point(&self, eta: f64, omega: f64) -> Point {
        let [d, ..] = self.direction(eta, omega);
        Point::from(d / self.gauge(&d.into()))
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        let [d, along, around] = self.direction(eta, omega);
        let (g, slope) = (self.gauge(&d.into()), self.slope(&d.into())?);
        finite([along, around].map(|t| (t - d * (slope.dot(&t) / g)) / g))
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        let [d, ..] = self.direction(eta, omega);
        unit(self.slope(&d.into())?)
    }
}

impl Filled for RadialExtended {
    fn pieces(&self) -> usize {
        STAR_PIECES
    }

    fn along(&self, piece: usize, at: [f64; 2], shares: &[f64], each: &mut dyn FnMut(Point, f64)) {
        let frame = [Vector::zeros(), Vector::from(self.numbers().semi_axes())];
        star(frame, (piece, at), |d| self.gauge(&Point::from(*d)), shares, each);
    }
}

impl MassProperties for RadialExtended {
    fn mass_properties(&self, density: f64) -> Mass {
        self.mass_estimate(density).mass
    }

    fn mass_estimate(&self, density: f64) -> MassEstimate {
        filled_mass(self, density)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{ExtendedSuperellipsoid, Superellipsoid};

    #[test]
    fn constant_exponents_make_a_superellipsoid() {
        let (axes, e) = ([0.4, 0.3, 0.5], [0.6, 1.3]);
        let truth = Superellipsoid::new(axes, e).unwrap();
        let same = ExtendedSuperellipsoid::new(axes, &[e[0]; 3], &[e[1]]).unwrap().radial();
        for (eta, omega) in [(0.2, 0.7), (-1.2, 2.0), (0.0, 0.0), (FRAC_PI_2, 1.0), (0.3, PI)] {
            let p = same.point(eta, omega);
            assert!((truth.gauge(&p) - 1.0).abs() < 1e-14);
            let (n, g) = (same.normal(eta, omega).unwrap(), truth.gradient(&p).normalize());
            assert!((n.into_inner() - g).norm() < 1e-13);
        }
        let found = same.mass_estimate(2.0);
        let off = MassEstimate::refined(&truth.mass_properties(2.0), found.mass).error;
        assert!(off < 1e-6 && off < 10.0 * found.error, "{off} {}", found.error);
    }

    #[test]
    fn seams_of_large_exponents_have_no_normals() {
        let spiky =
            ExtendedSuperellipsoid::new([0.4, 0.3, 0.5], &[2.2; 2], &[2.0]).unwrap().radial();
        for (eta, omega) in [(0.0, 0.4), (0.3, 0.0), (FRAC_PI_2, 0.1)] {
            assert!(spiky.normal(eta, omega).is_none() && spiky.tangents(eta, omega).is_none());
        }
        assert!(spiky.normal(0.3, 0.4).is_some());
    }
}
