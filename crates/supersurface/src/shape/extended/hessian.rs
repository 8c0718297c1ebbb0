//! Second derivatives of the radial gauge, by those of logarithms.
//!
//! `G = ln (e^{2a/f} + e^{2b/f})^{f/2}` of two logarithms a, b and an exponent f, all functions of the point, has with the
//! weights `w`, `v = 1 - w`, their entropy S and `d = a - b`
//! `∇G = w ∇a + v ∇b + ½ S ∇f` and `∇∇G = w ∇∇a + v ∇∇b + ½ S ∇∇f + (2/f) w v k kᵀ` with `k = ∇d - (d/f) ∇f`.

use nalgebra::Matrix3;

use super::RadialExtended;
use super::radial::angles;
use crate::numeric::superellipse::log_layer;
use crate::shape::SecondOrder;
use crate::{Point, Vector};

/// A function of the point with both derivatives.
struct Jet {
    value: f64,
    gradient: Vector,
    hessian: Matrix3<f64>,
}

impl Jet {
    /// `ln |c|` of the coordinate c number `axis`, which is not 0.
    fn log_axis(axis: usize, c: f64) -> Self {
        let gradient = Vector::ith(axis, 1.0 / c);
        Self { value: c.abs().ln(), gradient, hessian: -gradient * gradient.transpose() }
    }

    /// A function of an angle, from its value and two derivatives.
    fn of_angle([value, slope, bend]: [f64; 3], [gradient, hessian]: &Turn) -> Self {
        let gradient: Vector = gradient.column(0).into();
        Self {
            value,
            gradient: gradient * slope,
            hessian: hessian * slope + gradient * gradient.transpose() * bend,
        }
    }

    fn norm(&self, other: &Self, exponent: &Self) -> Self {
        let (f, d) = (exponent.value, self.value - other.value);
        let layer = log_layer(self.value, other.value, 2.0 / f);
        let (w, v, half) = (layer.first, layer.second, 0.5 * layer.entropy);
        let k = self.gradient - other.gradient - exponent.gradient * (d / f);
        Self {
            value: layer.log_norm,
            gradient: self.gradient * w + other.gradient * v + exponent.gradient * half,
            hessian: self.hessian * w
                + other.hessian * v
                + exponent.hessian * half
                + k * k.transpose() * (2.0 / f * w * v),
        }
    }
}

/// Gradient (in the first column) and second derivatives of an angle.
type Turn = [Matrix3<f64>; 2];

/// Of `η_g` and `ω_g` at a scaled point off the coordinate planes.
fn turns(s: &Vector) -> [Turn; 2] {
    let (rho, size) = (s.x.hypot(s.y), s.norm());
    let (out, side) = (Vector::new(s.x, s.y, 0.0) / rho, Vector::new(-s.y, s.x, 0.0) / rho);
    let up = Vector::z();
    let mixed = |a: Vector, b: Vector| a * b.transpose() + b * a.transpose();
    let first = |v: Vector| Matrix3::from_columns(&[v, Vector::zeros(), Vector::zeros()]);
    // an angle in a plane has the second derivatives (2 s c, s² - c², -2 s c)/radius²
    let (c, t) = (rho / size, s.z / size);
    let both = out * out.transpose() - up * up.transpose();
    let bend = (both * (2.0 * t * c) + mixed(out, up) * (t * t - c * c)) / (size * size);
    let eta = [first((up * c - out * t) / size), bend - side * side.transpose() * (t / size / rho)];
    // along the ring and across it
    let omega = [first(side / rho), -mixed(out, side) / (rho * rho)];
    [eta, omega]
}

impl SecondOrder for RadialExtended {
    /// `None` also everywhere on the coordinate planes of the solid.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let size = p.coords.amax();
        let axes = Vector::from(self.numbers().semi_axes());
        let s = (p.coords / size).component_div(&axes);
        // as large as 1, so that no square overflows
        let unit = s.amax();
        let s = s / unit;
        if !s.iter().all(|v| *v != 0.0 && v.is_finite()) {
            return None;
        }
        let (eta, omega) = angles(&s);
        let [f1, f2] = self.numbers().exponent_derivatives(eta, omega);
        let [by_eta, by_omega] = turns(&s);
        let [x, y, z] = [Jet::log_axis(0, s.x), Jet::log_axis(1, s.y), Jet::log_axis(2, s.z)];
        let planar = x.norm(&y, &Jet::of_angle(f2, &by_omega));
        let whole = planar.norm(&z, &Jet::of_angle(f1, &by_eta));
        let log = whole.hessian + whole.gradient * whole.gradient.transpose();
        let hessian = log * (whole.value.exp() / unit / size);
        let hessian = hessian.component_div(&(axes * Vector::repeat(1.0).transpose()));
        let hessian = hessian.component_div(&(Vector::repeat(1.0) * axes.transpose()));
        hessian.iter().all(|v| v.is_finite()).then_some(hessian)
    }
}
