//! Superhyperboloids of one and two sheets: waists of vases, hourglasses, horns, pairs of bowls (Barr 1981,
//! FORMULAS §2.3).
//!
//! The trigonometric functions of the meridian are the secant and the tangent, `sec² - tan² = 1`, so both
//! surfaces go on for ever; their parametric domain stops at [`ANGLE_LIMIT`].

mod one_sheet;
mod two_sheets;

pub use one_sheet::SuperhyperboloidOneSheet;
pub use two_sheets::{Sheet, SuperhyperboloidTwoSheets};

use crate::numeric::powers::{power, signed_power, signed_power_slope};
use crate::shape::angular::normal_power;

/// Where the angles of a secant end, in radians: 0.05 short of π/2, where the secant is 20. Angles beyond are
/// taken as the limit.
pub const ANGLE_LIMIT: f64 = std::f64::consts::FRAC_PI_2 - 0.05;

/// Secant and tangent of an angle within the limit.
fn secant_tangent(angle: f64) -> (f64, f64) {
    let (s, c) = angle.clamp(-ANGLE_LIMIT, ANGLE_LIMIT).sin_cos();
    (1.0 / c, s / c)
}

/// `(sec^ε, tan^ε)` with the sign of the tangent: the unit superhyperbola.
fn superhyperbola(angle: f64, e: f64) -> [f64; 2] {
    let (sec, tan) = secant_tangent(angle);
    [power(sec, e), signed_power(tan, e)]
}

/// Its derivatives by the angle, `ε sec^ε tan` and `ε |tan|^(ε-1) sec²`; `None` where one is infinite.
fn superhyperbola_slopes(angle: f64, e: f64) -> Option<[f64; 2]> {
    let (sec, tan) = secant_tangent(angle);
    Some([e * power(sec, e) * tan, signed_power_slope(tan, e)? * sec * sec])
}

/// `(sec^(2-ε), tan^(2-ε))`, up to signs the direction of its normal; `None` at the vertex for ε from 2.
fn superhyperbola_normal(angle: f64, e: f64) -> Option<[f64; 2]> {
    let (sec, tan) = secant_tangent(angle);
    Some([power(sec, 2.0 - e), normal_power(tan, e)?])
}
