//! Where a block of rays from one point first meets a solid that is not convex.
//!
//! A kind of solid says how fast its gauge can fall at most: `g(t + τ) >= g + rate τ - bend τ²/2` for `0 <= τ <= reach`. So
//! no surface lies before the place where that floor comes down to 1, and the ray steps there. No part of the solid, however
//! thin, is stepped over, and near the surface the steps are those of Newton's method.
//!
//! Floors rest on the convexity of the undeformed gauge: `g(u) >= ∇g(u₀)·u` (FORMULAS §0.1), so that only the way
//! of the undeformed point `u(t)` has to be bounded.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::block::{Block, Hits, RAYS, Row, Solid};
use crate::numeric::lanes::Lane;

/// Steps after which a ray that neither arrived nor missed is taken to miss.
const STEPS: usize = 250;
/// A gauge this close to 1 is on the surface.
const ON_SURFACE: f64 = 1e-13;
/// Steps that rounding swallows end on the surface when the gauge is this close to 1.
const NEARLY: f64 = 1e-10;
/// How much of its stretch a ray looks ahead at first.
const AHEAD: f64 = 0.25;

/// What the gauge of a solid does along the rays of a block from where they are.
pub(super) struct Floor {
    /// `g - 1`.
    pub(super) value: Row,
    /// Gradient of the gauge.
    pub(super) slopes: [Row; 3],
    /// The least that it can rise a metre at first.
    pub(super) rate: Row,
    /// The most by which that falls a metre; not negative.
    pub(super) bend: Row,
    /// How far that holds, in metres; positive.
    pub(super) reach: Row,
}

/// A kind of solid.
pub(super) trait Marched {
    /// What holds at distances `t`; `ahead` is how far it should hold, for kinds that can choose. Must be
    /// `#[inline(always)]`.
    fn floor<const FUSED: bool>(&self, block: &Block, t: &Row, ahead: &Row) -> Floor;
}

/// A solid with its way of marching.
pub(super) struct March<S>(pub(super) S);

impl<S: Marched> Solid for March<S> {
    #[inline(always)]
    fn hits<const FUSED: bool>(&mut self, block: &Block) -> Hits {
        let far = &block.far;
        let mut t = block.near;
        let (mut live, mut ahead) = ([0.0; RAYS], [0.0; RAYS]);
        let mut hits = Hits::NONE;
        for i in 0..RAYS {
            live[i] = f64::from(u8::from(t[i] <= far[i]));
            t[i] = t[i].least(far[i]);
            ahead[i] = AHEAD * (far[i] - t[i]) + f64::TINY;
        }
        for _ in 0..STEPS {
            let Floor { value, slopes, rate, bend, reach } =
                self.0.floor::<FUSED>(block, &t, &ahead);
            let mut any = 0;
            for i in 0..RAYS {
                let root = (rate[i] * rate[i] + 2.0 * bend[i] * value[i]).sqrt();
                let falling = 2.0 * value[i] / (root - rate[i]);
                let rising = (root + rate[i]) / bend[i];
                let step = if rate[i] > 0.0 { rising } else { falling };
                let within = step < reach[i];
                let step = if within { step } else { reach[i] };
                let next = t[i] + step;
                let arrived = value[i] <= ON_SURFACE || next <= t[i] && value[i] <= NEARLY;
                let missed = next > far[i];
                if live[i] > 0.0 && arrived {
                    hits.depth[i] = t[i];
                    for k in 0..3 {
                        hits.normal[k][i] = slopes[k][i];
                    }
                }
                live[i] = if arrived || missed { 0.0 } else { live[i] };
                ahead[i] = if live[i] > 0.0 { 2.0 * step } else { ahead[i] };
                t[i] = if live[i] > 0.0 { next } else { t[i] };
                any |= live[i].to_bits();
            }
            if any == 0 {
                break;
            }
        }
        hits
    }
}
