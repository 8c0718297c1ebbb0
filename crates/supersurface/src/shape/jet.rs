//! A gauge with its gradient and second derivatives, carried together through norms and quotients.
//!
//! For `n = (u^p + v^p)^(1/p)` with the weights `w = u^p/n^p`, `1 - w` (FORMULAS §0.1):
//! `∇n = n (w ∇u/u + (1-w) ∇v/v)` and, with `d = ∇u/u - ∇v/v`,
//! `∇∇n = n (w ∇∇u/u + (1-w) ∇∇v/v) + (p-1) n w (1-w) d dᵀ`.
//! The members whose gauge is made of such layers get both derivatives from the line that says the gauge.

use nalgebra::Matrix3;

use crate::Vector;
use crate::numeric::powers::power;
use crate::numeric::superellipse::weighted;

/// Value and derivatives of a non-negative function of the point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Jet {
    value: f64,
    /// Zero where the function is: there it has a kink.
    gradient: Vector,
    /// `None` where it does not exist, as at the function's zeros.
    hessian: Option<Matrix3<f64>>,
    /// Where the function is zero: second derivatives of half its square, which may exist all the same.
    half_square: Option<Matrix3<f64>>,
}

impl Jet {
    /// `|c|/a` for the coordinate `c` number `axis`.
    pub(super) fn axis(axis: usize, c: f64, a: f64) -> Self {
        let slope = Vector::from_fn(|i, _| if i == axis { 1.0 / a } else { 0.0 });
        let gradient = if c == 0.0 { Vector::zeros() } else { slope * c.signum() };
        Self {
            value: (c / a).abs(),
            gradient,
            hessian: (c != 0.0).then(Matrix3::zeros),
            half_square: Some(slope * slope.transpose()),
        }
    }

    /// A function that does not depend on the point.
    pub(super) fn constant(value: f64) -> Self {
        Self {
            value,
            gradient: Vector::zeros(),
            hessian: Some(Matrix3::zeros()),
            half_square: Some(Matrix3::zeros()),
        }
    }

    /// The norm of both with exponent `p`.
    pub(super) fn norm(&self, other: &Self, p: f64) -> Self {
        let w = weighted(self.value, other.value, p);
        let (u, v) = (self.value, other.value);
        if u == 0.0 && v == 0.0 {
            let both = self.half_square.zip(other.half_square).map(|(a, b)| a + b);
            let half_square = if p == 2.0 { both } else { None };
            return Self { value: 0.0, gradient: Vector::zeros(), hessian: None, half_square };
        }
        if u == 0.0 || v == 0.0 {
            let (rest, gone) = if u == 0.0 { (other, self) } else { (self, other) };
            let added = match p {
                _ if p > 2.0 => Some(Matrix3::zeros()),
                _ if p == 2.0 => gone.half_square.map(|h| h / rest.value),
                _ => None,
            };
            let hessian = rest.hessian.zip(added).map(|(a, b)| a + b);
            return Self { value: w.norm, gradient: rest.gradient, hessian, half_square: None };
        }
        let (first, second) = (w.norm * w.first / u, w.norm * w.second / v);
        // roots first: w/u² may exist where w is too small to be held
        let across = self.gradient * ((w.first * w.second).sqrt() / u)
            - other.gradient * ((w.first * w.second).sqrt() / v);
        let hessian = self.hessian.zip(other.hessian).map(|(a, b)| {
            a * first + b * second + across * across.transpose() * ((p - 1.0) * w.norm)
        });
        Self {
            value: w.norm,
            gradient: self.gradient * first + other.gradient * second,
            hessian,
            half_square: None,
        }
    }

    /// This over a function that is not zero.
    pub(super) fn over(&self, below: &Self) -> Self {
        let (v, value) = (below.value, self.value / below.value);
        let (up, down) = (self.gradient / v, below.gradient / v);
        let gradient = if self.value == 0.0 { Vector::zeros() } else { up - down * value };
        let hessian = self.hessian.zip(below.hessian).map(|(a, b)| {
            let mixed = up * down.transpose();
            (a - b * value) / v - mixed - mixed.transpose()
                + down * down.transpose() * (2.0 * value)
        });
        Self { value, gradient, hessian, half_square: None }
    }

    /// How far this is from a number, `|f - c|`.
    pub(super) fn away_from(&self, c: f64) -> Self {
        let off = self.value - c;
        let square = self.gradient * self.gradient.transpose();
        if off == 0.0 {
            let gradient = Vector::zeros();
            return Self { value: 0.0, gradient, hessian: None, half_square: Some(square) };
        }
        Self {
            value: off.abs(),
            gradient: self.gradient * off.signum(),
            hessian: self.hessian.map(|h| h * off.signum()),
            half_square: None,
        }
    }

    /// The power `s` of a function that is not zero.
    pub(super) fn raised(&self, s: f64) -> Self {
        let value = power(self.value, s);
        let relative = self.gradient / self.value;
        let hessian = self
            .hessian
            .map(|h| (h / self.value + relative * relative.transpose() * (s - 1.0)) * (s * value));
        Self { value, gradient: relative * (s * value), hessian, half_square: None }
    }

    /// `factor` times this plus the linear function `slope · p`, whose value is `at`.
    pub(super) fn scaled_plus(&self, factor: f64, slope: Vector, at: f64) -> Self {
        Self {
            value: factor * self.value + at,
            gradient: self.gradient * factor + slope,
            hessian: self.hessian.map(|h| h * factor),
            half_square: None,
        }
    }

    /// The larger of both; where they are equal there is an edge without second derivatives.
    pub(super) fn max(&self, other: &Self) -> Self {
        let mut larger = if self.value >= other.value { *self } else { *other };
        if self.value == other.value {
            larger.hessian = None;
        }
        larger
    }

    /// The gradient; zero where it does not exist or overflows.
    pub(super) fn gradient(&self) -> Vector {
        let finite = self.gradient.iter().all(|v| v.is_finite());
        if finite { self.gradient } else { Vector::zeros() }
    }

    /// Second derivatives; `None` where they do not exist or overflow.
    pub(super) fn hessian(&self) -> Option<Matrix3<f64>> {
        self.hessian.filter(|h| h.iter().all(|v| v.is_finite()))
    }
}
