//! A supertoroid along a block of rays.
//!
//! The gauge is the norm of `h = |ρ̂ - a4|` and of `|z/a3|`, and `ρ̂(t)` is convex. Outside of the tube's middle line `h` lies
//! above the tangent of `ρ̂ - a4`; within it, in the hole, `a4 - ρ̂` is concave and lies above its chords.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::block::{Block, RAYS, Row, norm, size};
use super::march::{Floor, Marched};
use crate::numeric::lanes::{Lane, exp};
use crate::shape::Supertoroid;

/// A toroid whose sections are convex.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ring(Supertoroid);

impl Ring {
    pub(super) fn new(ring: &Supertoroid) -> Option<Self> {
        ring.exponents().iter().all(|e| *e <= 2.0).then_some(Self(*ring))
    }

    /// Logarithm of the section's radius, and the shares of x and y.
    #[inline(always)]
    fn radius<const FUSED: bool>(&self, p: &[Row; 3]) -> (Row, [Row; 2]) {
        let [a1, a2, _] = self.0.semi_axes();
        norm::<FUSED>(&size(&p[0], a1), &size(&p[1], a2), self.0.exponents()[1])
    }
}

impl Marched for Ring {
    #[inline(always)]
    fn floor<const FUSED: bool>(&self, block: &Block, t: &Row, ahead: &Row) -> Floor {
        let ([_, _, a3], a4) = (self.0.semi_axes(), self.0.ring_ratio());
        let d = &block.directions;
        let p = block.at::<FUSED>(t);
        let (log, shares) = self.radius::<FUSED>(&p);
        let (mut radius, mut slopes) = ([0.0; RAYS], [[0.0; RAYS]; 3]);
        let (mut offset, mut rise) = ([0.0; RAYS], [0.0; RAYS]);
        let mut within = 0u64;
        for i in 0..RAYS {
            radius[i] = exp::<FUSED>(log[i]);
            offset[i] = radius[i] - a4;
            let [x, y] = [p[0][i].abs().most(f64::TINY), p[1][i].abs().most(f64::TINY)];
            slopes[0][i] = radius[i] * shares[0][i] / x.copysign(p[0][i]);
            slopes[1][i] = radius[i] * shares[1][i] / y.copysign(p[1][i]);
            rise[i] = slopes[0][i] * d[0][i] + slopes[1][i] * d[1][i];
            within |= u64::from(offset[i] < 0.0);
        }
        let mut reach = [f64::INFINITY; RAYS];
        if within > 0 {
            let mut end = *t;
            for i in 0..RAYS {
                end[i] += ahead[i];
            }
            let (log, _) = self.radius::<FUSED>(&block.at::<FUSED>(&end));
            for i in 0..RAYS {
                let chord = (exp::<FUSED>(log[i]) - radius[i]) / ahead[i];
                rise[i] = if offset[i] < 0.0 { -chord } else { rise[i] };
                reach[i] = if offset[i] < 0.0 { ahead[i] } else { reach[i] };
            }
        }
        let mut distance = [0.0; RAYS];
        for i in 0..RAYS {
            distance[i] = offset[i].abs();
        }
        let distance = size(&distance, 1.0);
        let height = size(&p[2], a3);
        let (whole, [across, along]) = norm::<FUSED>(&distance, &height, self.0.exponents()[0]);
        let (mut value, mut rate) = ([0.0; RAYS], [0.0; RAYS]);
        for i in 0..RAYS {
            let g = exp::<FUSED>(whole[i]);
            value[i] = g - 1.0;
            let out = g * across[i] / distance[i];
            let up = g * along[i] / (height[i] * a3).copysign(p[2][i]);
            rate[i] = out * rise[i] + up * d[2][i];
            let out = out.copysign(offset[i]);
            slopes[0][i] *= out;
            slopes[1][i] *= out;
            slopes[2][i] = up;
        }
        Floor { value, slopes, rate, bend: [0.0; RAYS], reach }
    }
}
