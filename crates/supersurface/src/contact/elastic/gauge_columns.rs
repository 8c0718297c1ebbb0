//! Gauge and gradient of a block of points in stages without a branch, for what is computed of them.
//!
//! Superellipsoid and supertoroid have one gauge, two norms one in the other with `τ = ρ̂ - a4` between them, where a
//! superellipsoid has `a4 = 0`. The norms are taken in logarithms: `s = p ln(u/v)`, `t = e^-|s|`, norm
//! `max(u, v) (1 + t)^(1/p)`, weights `1/(1 + t)` and `t/(1 + t)`.

use super::indentation::BLOCK;
use crate::numeric::lanes::{exp, ln};
use crate::shape::{Superellipsoid, Supertoroid};

pub(super) type Lanes = [f64; BLOCK];

/// The numbers of the solid.
pub(super) struct Layers {
    axes: [f64; 3],
    inverse: [f64; 3],
    ring: f64,
    /// `2/ε`, and `ε/2`.
    pub(super) powers: [f64; 2],
    half: [f64; 2],
}

impl Layers {
    pub(super) fn of_superellipsoid(solid: &Superellipsoid) -> Option<Self> {
        Self::new(solid.semi_axes(), 0.0, solid.exponents())
    }

    pub(super) fn of_supertoroid(solid: &Supertoroid) -> Option<Self> {
        Self::new(solid.semi_axes(), solid.ring_ratio(), solid.exponents())
    }

    /// `None` for numbers that logarithms of quotients cannot carry.
    fn new(axes: [f64; 3], ring: f64, exponents: [f64; 2]) -> Option<Self> {
        let ordinary =
            axes.iter().all(|a| (1e-50..=1e50).contains(a)) && exponents.iter().all(|e| *e >= 1e-3);
        ordinary.then(|| Self {
            axes,
            inverse: axes.map(|a| 1.0 / a),
            ring,
            powers: exponents.map(|e| 2.0 / e),
            half: exponents.map(|e| 0.5 * e),
        })
    }
}

/// The norm of positive pairs with both weights.
pub(super) struct Norm {
    pub(super) norm: Lanes,
    pub(super) first: Lanes,
    pub(super) second: Lanes,
}

impl Norm {
    /// Of `(u, v)`, given with `1/v`.
    #[inline(always)]
    fn new<const FUSED: bool>(u: &Lanes, v: &Lanes, inverse: &Lanes, p: f64, half: f64) -> Self {
        let mut out = Self { norm: [0.0; BLOCK], first: [0.0; BLOCK], second: [0.0; BLOCK] };
        let mut spread = [0.0; BLOCK];
        for i in 0..BLOCK {
            spread[i] = p * ln::<FUSED>(u[i] * inverse[i]);
        }
        let mut t = [0.0; BLOCK];
        for i in 0..BLOCK {
            t[i] = exp::<FUSED>(-spread[i].abs());
        }
        for i in 0..BLOCK {
            let major = 1.0 / (1.0 + t[i]);
            let minor = t[i] * major;
            let larger = if u[i] > v[i] { u[i] } else { v[i] };
            out.first[i] = if spread[i] > 0.0 { major } else { minor };
            out.second[i] = if spread[i] > 0.0 { minor } else { major };
            out.norm[i] = larger * exp::<FUSED>(half * ln::<FUSED>(1.0 + t[i]));
        }
        out
    }
}

/// What the gauge and its derivatives are made of.
pub(super) struct Stages {
    /// `1/x`, `1/y`, `1/z`.
    pub(super) inverse: [Lanes; 3],
    /// `ρ̂` with its weights `w2`, `1 - w2`.
    pub(super) planar: Norm,
    /// `τ`, not nearer to 0 than [`NEAR`].
    pub(super) offset: Lanes,
    /// The gauge with its weights `w1`, `1 - w1`.
    pub(super) whole: Norm,
    pub(super) gradient: [Lanes; 3],
}

/// How near to a symmetry plane, or to the middle of the tube, points are told apart: nearer the limits are the same, and
/// no quotient is 0/0.
pub(super) const NEAR: f64 = 1e-100;

impl Stages {
    #[inline(always)]
    pub(super) fn new<const FUSED: bool>(layers: &Layers, points: &[Lanes; 3]) -> Self {
        let none = [[0.0; BLOCK]; 3];
        let (mut inverse, mut scaled, mut unscaled) = (none, none, none);
        for j in 0..3 {
            for i in 0..BLOCK {
                let c = off_zero(points[j][i]);
                inverse[j][i] = 1.0 / c;
                scaled[j][i] = c.abs() * layers.inverse[j];
                unscaled[j][i] = inverse[j][i].abs() * layers.axes[j];
            }
        }
        let ([u, v, w], [_, iv, iw]) = (&scaled, &unscaled);
        let planar = Norm::new::<FUSED>(u, v, iv, layers.powers[1], layers.half[1]);
        let (mut offset, mut size) = ([0.0; BLOCK], [0.0; BLOCK]);
        for i in 0..BLOCK {
            offset[i] = off_zero(planar.norm[i] - layers.ring);
            size[i] = offset[i].abs();
        }
        let whole = Norm::new::<FUSED>(&size, w, iw, layers.powers[0], layers.half[0]);
        let mut gradient = none;
        for i in 0..BLOCK {
            let g = whole.norm[i];
            // in the middle of the tube there is no gradient across
            let across = if size[i] > NEAR { g * whole.first[i] / offset[i] } else { 0.0 };
            let across = across * planar.norm[i];
            let shares = [across * planar.first[i], across * planar.second[i], g * whole.second[i]];
            for j in 0..3 {
                // the limit on a symmetry plane
                let share = shares[j] * inverse[j][i];
                gradient[j][i] = if points[j][i] == 0.0 { 0.0 } else { share };
            }
        }
        Self { inverse, planar, offset, whole, gradient }
    }
}

#[inline(always)]
fn off_zero(v: f64) -> f64 {
    let floor = NEAR.copysign(v);
    if v.abs() < NEAR { floor } else { v }
}
