//! A tapered superellipsoid along a block of rays, convex or not.
//!
//! With the factor `f = 1 + K z/h`, `x` comes from `x/f`. Along a ray `c = x' f - x f'` is constant, `(x/f)' = c/f²` and
//! `(x/f)'' = -2 c f'/f³`.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::block::{Block, Gauge, RAYS, Row, gauge};
use super::march::{Floor, Marched};
use crate::deform::{Deformed, Taper};
use crate::numeric::lanes::Lane;
use crate::shape::{Implicit, Superellipsoid};

/// A superellipsoid whose sections grow with height.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tapered {
    axes: [f64; 3],
    exponents: [f64; 2],
    /// By how much a metre of height widens the section along x and y.
    slopes: [f64; 2],
}

impl Tapered {
    pub(super) fn new(solid: &Deformed<Superellipsoid, Taper>) -> Option<Self> {
        let (shape, taper) = (solid.shape(), solid.deformation());
        shape.is_convex().then_some(Self {
            axes: shape.semi_axes(),
            exponents: shape.exponents(),
            slopes: taper.slopes().map(|k| k / taper.half_height()),
        })
    }
}

impl Marched for Tapered {
    #[inline(always)]
    fn floor<const FUSED: bool>(&self, block: &Block, t: &Row, _ahead: &Row) -> Floor {
        let d = &block.directions;
        let p = block.at::<FUSED>(t);
        let (mut u, mut factors) = (p, [[0.0; RAYS]; 2]);
        for k in 0..2 {
            for i in 0..RAYS {
                factors[k][i] = self.slopes[k].times_plus::<FUSED>(p[2][i], 1.0);
                u[k][i] = p[k][i] / factors[k][i];
            }
        }
        let Gauge { mut value, mut slopes } = gauge::<FUSED>(&u, self.axes, self.exponents);
        let (mut rate, mut bend) = ([0.0; RAYS], [0.0; RAYS]);
        for k in 0..2 {
            for i in 0..RAYS {
                let (f, widens) = (factors[k][i], self.slopes[k] * d[2][i]);
                let least = f.least(f + widens * (block.far[i] - t[i]));
                let g = slopes[k][i];
                let falls = 2.0 * g * (d[k][i] * f - p[k][i] * widens) * widens;
                bend[i] += falls.most(0.0) / (least * least * least);
                slopes[k][i] = g / f;
                slopes[2][i] -= self.slopes[k] * u[k][i] * slopes[k][i];
            }
        }
        for i in 0..RAYS {
            rate[i] = slopes[0][i] * d[0][i] + slopes[1][i] * d[1][i] + slopes[2][i] * d[2][i];
            value[i] -= 1.0;
        }
        Floor { value, slopes, rate, bend, reach: [f64::INFINITY; RAYS] }
    }
}
