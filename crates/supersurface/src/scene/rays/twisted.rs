//! A twisted superellipsoid along a block of rays.
//!
//! In the turning section `ζ = x + iy` comes from `e^{-iθ} ζ`, where both `θ` and `ζ` change evenly along a ray: the second
//! derivative is at most `2 |θ'| |ζ'| + θ'² |ζ|`.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use std::f64::consts::PI;

use super::block::{Block, Gauge, RAYS, Row, gauge};
use super::march::{Floor, Marched};
use crate::deform::{Deformed, Twist};
use crate::numeric::lanes::{Lane, sin_cos};
use crate::shape::{Implicit, Superellipsoid};

/// A superellipsoid whose sections turn.
#[derive(Clone, Copy, Debug)]
pub(super) struct Twisted {
    axes: [f64; 3],
    exponents: [f64; 2],
    /// Of the section in the middle, in radians.
    angle: f64,
    /// Radians a metre.
    rate: f64,
}

impl Twisted {
    pub(super) fn new(solid: &Deformed<Superellipsoid, Twist>) -> Option<Self> {
        let (shape, twist) = (solid.shape(), solid.deformation());
        let angle = PI * twist.turns();
        shape.is_convex().then_some(Self {
            axes: shape.semi_axes(),
            exponents: shape.exponents(),
            angle,
            rate: angle / twist.half_height(),
        })
    }
}

impl Marched for Twisted {
    #[inline(always)]
    fn floor<const FUSED: bool>(&self, block: &Block, t: &Row, _ahead: &Row) -> Floor {
        let d = &block.directions;
        let p = block.at::<FUSED>(t);
        let (mut u, mut sin, mut cos) = (p, [0.0; RAYS], [0.0; RAYS]);
        for i in 0..RAYS {
            (sin[i], cos[i]) = sin_cos::<FUSED>(self.rate.times_plus::<FUSED>(p[2][i], self.angle));
            u[0][i] = cos[i] * p[0][i] + sin[i] * p[1][i];
            u[1][i] = cos[i] * p[1][i] - sin[i] * p[0][i];
        }
        let Gauge { mut value, mut slopes } = gauge::<FUSED>(&u, self.axes, self.exponents);
        let (mut rate, mut bend) = ([0.0; RAYS], [0.0; RAYS]);
        for i in 0..RAYS {
            let [gx, gy] = [slopes[0][i], slopes[1][i]];
            // turned with the section
            slopes[0][i] = cos[i] * gx - sin[i] * gy;
            slopes[1][i] = sin[i] * gx + cos[i] * gy;
            slopes[2][i] += self.rate * (gx * u[1][i] - gy * u[0][i]);
            rate[i] = slopes[0][i] * d[0][i] + slopes[1][i] * d[1][i] + slopes[2][i] * d[2][i];
            let turn = (self.rate * d[2][i]).abs();
            let aside = (d[0][i] * d[0][i] + d[1][i] * d[1][i]).sqrt();
            let left = block.far[i] - t[i];
            let (ex, ey) = (p[0][i] + left * d[0][i], p[1][i] + left * d[1][i]);
            let farthest = (p[0][i] * p[0][i] + p[1][i] * p[1][i]).most(ex * ex + ey * ey).sqrt();
            let size = (gx * gx + gy * gy).sqrt();
            bend[i] = size * turn * (2.0 * aside + turn * farthest);
            value[i] -= 1.0;
        }
        Floor { value, slopes, rate, bend, reach: [f64::INFINITY; RAYS] }
    }
}
