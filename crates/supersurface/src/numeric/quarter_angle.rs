//! Angles told apart next to the seams of a superellipse.
//!
//! With a small exponent ε nearly all of a face lies next to a seam: at `δ` from π/2 the point is `δ^ε` of the half-width
//! away from the face's middle, 3 % at the last number under π/2 for ε = 0.1. An angle kept as a multiple of π/2 and a
//! rest has its middle too.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

/// Steps of the [even parameter](QuarterAngle::from_parameter) next to a seam are powers of this degree.
const DEGREE: i32 = 9;

/// `quarter π/2 + rest`, with the rest in [-π/4, π/4] radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuarterAngle {
    quarter: i32,
    rest: f64,
}

impl QuarterAngle {
    /// The angle for a parameter that agrees with it at multiples of π/4 and grows with the ninth root of the distance
    /// from the nearest multiple of π/2, so that halving it comes as near to a seam as 1e-136 rad.
    pub fn from_parameter(t: f64) -> Self {
        let quarter = (t / FRAC_PI_2).round();
        let share = ((t - quarter * FRAC_PI_2) / FRAC_PI_4).clamp(-1.0, 1.0);
        Self { quarter: quarter as i32, rest: FRAC_PI_4 * share.powi(DEGREE) }
    }

    /// The parameter of an angle in radians.
    pub fn parameter(angle: f64) -> f64 {
        let quarter = (angle / FRAC_PI_2).round();
        let rest = (angle - quarter * FRAC_PI_2) / FRAC_PI_4;
        let share = super::powers::power(rest.abs(), 1.0 / f64::from(DEGREE)).copysign(rest);
        quarter * FRAC_PI_2 + FRAC_PI_4 * share
    }

    /// In radians; what is nearer to a seam than numbers are to each other lies on it.
    pub fn radians(self) -> f64 {
        f64::from(self.quarter) * FRAC_PI_2 + self.rest
    }

    /// Cosine and sine, both with all their digits.
    pub fn cos_sin(self) -> (f64, f64) {
        let (s, c) = self.rest.sin_cos();
        match self.quarter.rem_euclid(4) {
            0 => (c, s),
            1 => (-s, c),
            2 => (-c, -s),
            _ => (s, -c),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parameters_and_angles_belong_together() {
        for k in -40..=40 {
            let angle = f64::from(k) * 0.17;
            let back = QuarterAngle::from_parameter(QuarterAngle::parameter(angle));
            assert!((back.radians() - angle).abs() < 1e-14, "{angle} {back:?}");
            let (c, s) = back.cos_sin();
            assert!((c - angle.cos()).abs() < 1e-14 && (s - angle.sin()).abs() < 1e-14);
        }
        for k in -8..=8 {
            let seam = f64::from(k) * FRAC_PI_4;
            assert_eq!(QuarterAngle::from_parameter(seam).radians(), seam);
            assert_eq!(QuarterAngle::parameter(seam), seam);
        }
        let near = QuarterAngle::from_parameter(FRAC_PI_2 * (1.0 - f64::EPSILON));
        let (c, s) = near.cos_sin();
        assert!(c > 0.0 && c < 1e-135 && s == 1.0, "{c}");
    }
}
