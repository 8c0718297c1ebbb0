//! Distances from a function and its derivatives at the point alone (Taubin, FORMULAS §7).
//!
//! First order: the zero of the tangent plane, `|φ|/|∇φ|`. Second order: the radius of the ball in which
//! `|φ| - |∇φ| δ - ½ ‖φ''‖ δ²` cannot vanish, `δ = 2|φ|/(|∇φ| + √(|∇φ|² + 2 ‖φ''‖ |φ|))` with the Frobenius norm. Use them
//! with the gauge, `φ = g - 1`; with `φ = F - 1` they mean little for small exponents.

use nalgebra::Matrix3;

use crate::shape::SecondOrder;
use crate::{Point, Vector};

/// First-order distance of a value and its gradient; `None` where the gradient vanishes.
pub fn first_order(value: f64, gradient: &Vector) -> Option<f64> {
    let slope = gradient.norm();
    let distance = value.abs() / slope;
    (slope > 0.0 && distance.is_finite()).then_some(distance)
}

/// Second-order distance of a value, its gradient and its second derivatives; `None` where the gradient vanishes.
pub fn second_order(value: f64, gradient: &Vector, hessian: &Matrix3<f64>) -> Option<f64> {
    let (size, slope) = (value.abs(), gradient.norm());
    let bend = 2.0 * hessian.norm() * size;
    let distance = 2.0 * size / (slope + slope.hypot(bend.sqrt()));
    (slope > 0.0 && distance.is_finite()).then_some(distance)
}

/// The second-order distance of a point to a surface by its gauge, positive outside, in metres; `None` where the
/// gauge has no second derivatives.
///
/// ```
/// use supersurface::{Point, measure::second_order_distance, shape::Superellipsoid};
/// let ball = Superellipsoid::new([1.0; 3], [1.0, 1.0])?;
/// let d = second_order_distance(&ball, &Point::new(1.01, 0.0, 0.0)).unwrap();
/// assert!((d - 0.01).abs() < 2e-4);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn second_order_distance(shape: &(impl SecondOrder + ?Sized), p: &Point) -> Option<f64> {
    let value = shape.gauge(p) - 1.0;
    let distance = second_order(value, &shape.gradient(p), &shape.hessian(p)?)?;
    Some(distance.copysign(value))
}
