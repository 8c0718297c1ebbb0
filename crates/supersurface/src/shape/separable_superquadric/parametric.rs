//! Parametric form: `Σ c_i² = 1` for the coordinates `c` of a unit sphere, so `x_i = a_i sgn(c_i) |c_i|^(2/k_i)`
//! lies on equation (6).

use std::f64::consts::{FRAC_PI_2, PI};

use super::SeparableSuperquadric;
use crate::numeric::powers::{quadrant_cos_sin, signed_power, signed_power_slope};
use crate::numeric::quarter_angle::QuarterAngle;
use crate::shape::Parametric;
use crate::shape::angular::{finite, unit};
use crate::{Direction, Point, Vector};

/// The point of the unit sphere at the angles, and its derivatives by both.
fn sphere(eta: f64, omega: f64) -> [Vector; 3] {
    let ((ce, se), (co, so)) = (quadrant_cos_sin(eta), quadrant_cos_sin(omega));
    [
        Vector::new(ce * co, ce * so, se),
        Vector::new(-se * co, -se * so, ce),
        Vector::new(-ce * so, ce * co, 0.0),
    ]
}

impl SeparableSuperquadric {
    /// The point for one of the unit sphere.
    fn place(&self, c: &Vector) -> Point {
        let coordinate = |i, _| self.semi_axes[i] * signed_power(c[i], 2.0 / self.powers[i]);
        Point::from(Vector::from_fn(coordinate))
    }
}

impl Parametric for SeparableSuperquadric {
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-FRAC_PI_2, FRAC_PI_2], [-PI, PI]]
    }

    fn point(&self, eta: f64, omega: f64) -> Point {
        let [c, _, _] = sphere(eta, omega);
        self.place(&c)
    }

    fn point_at(&self, eta: QuarterAngle, omega: QuarterAngle) -> Point {
        let ((ce, se), (co, so)) = (eta.cos_sin(), omega.cos_sin());
        self.place(&Vector::new(ce * co, ce * so, se))
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        let [c, along, around] = sphere(eta, omega);
        let mut slopes = Vector::zeros();
        for i in 0..3 {
            slopes[i] = self.semi_axes[i] * signed_power_slope(c[i], 2.0 / self.powers[i])?;
        }
        finite([slopes.component_mul(&along), slopes.component_mul(&around)])
    }

    /// `k_i sgn(c_i) |c_i|^(2 - 2/k_i) / a_i`, normalised; `None` where a coordinate with an exponent up to 1
    /// is zero.
    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        let [c, _, _] = sphere(eta, omega);
        let mut n = Vector::zeros();
        for i in 0..3 {
            let k = self.powers[i];
            if c[i] == 0.0 && k <= 1.0 {
                return None;
            }
            n[i] = k * signed_power(c[i], 2.0 - 2.0 / k) / self.semi_axes[i];
        }
        unit(n)
    }
}
