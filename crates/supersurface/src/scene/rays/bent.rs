//! A bent superellipsoid along a block of rays.
//!
//! About the axis of the bend, with `A = kZ`, `B = 1 - kR` and `h = √(A² + B²)`, a point comes from `r = (1 - h)/k`,
//! `z = atan2(A, B)/k`. Along a ray of speed `s` across the axis, `L = B dZ + A dR` is constant and
//! `r'' = -k L²/h³`, `z' = L/h²`, `z'' = -2 L h'/h³` with `|h'| <= |k| s`.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::block::{Block, Gauge, RAYS, Row, gauge};
use super::march::{Floor, Marched};
use crate::Vector;
use crate::deform::{Bend, Deformed};
use crate::numeric::lanes::{Lane, arc_tangent_ratio};
use crate::shape::{Implicit, Superellipsoid};

/// How far a step leads behind the half plane at which angles jump, in radii of the bend.
const BEHIND: f64 = 1e-9;

/// A superellipsoid whose axis is a circle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bent {
    axes: [f64; 3],
    exponents: [f64; 2],
    curvature: f64,
    inwards: [f64; 2],
    /// The solid is nowhere nearer to the axis of the bend, in radii of the bend.
    core: f64,
}

impl Bent {
    pub(super) fn new(solid: &Deformed<Superellipsoid, Bend>) -> Option<Self> {
        let (shape, bend) = (solid.shape(), solid.deformation());
        let (sin, cos) = bend.angle().sin_cos();
        let k = bend.curvature();
        let core = 1.0 - k.abs() * shape.extent(&(Vector::new(cos, sin, 0.0) * k.signum()));
        shape.is_convex().then_some(Self {
            axes: shape.semi_axes(),
            exponents: shape.exponents(),
            curvature: k,
            inwards: [cos, sin],
            core,
        })
    }
}

impl Marched for Bent {
    #[inline(always)]
    fn floor<const FUSED: bool>(&self, block: &Block, t: &Row, _ahead: &Row) -> Floor {
        let (k, [nx, ny]) = (self.curvature, self.inwards);
        let d = &block.directions;
        let p = block.at::<FUSED>(t);
        let (mut u, mut h) = (p, [0.0; RAYS]);
        let (mut turn, mut fall) = ([0.0; RAYS], [0.0; RAYS]);
        for i in 0..RAYS {
            let across = nx * p[0][i] + ny * p[1][i];
            let a = k * p[2][i];
            let b = 1.0 - k * across;
            h[i] = (a * a + b * b).sqrt().most(f64::TINY);
            let r = (across * (1.0 + b) - p[2][i] * a) / (1.0 + h[i]);
            let inner = h[i] + b.abs();
            let a = a.abs().most(f64::TINY).copysign(a);
            // the tangent of half the angle, which is a/(h + b)
            let half = if b >= 0.0 { a / inner } else { inner / a };
            let per = 2.0 * arc_tangent_ratio::<FUSED, f64>(half * half);
            u[2][i] = if b >= 0.0 { p[2][i] * per / inner } else { half * per / k };
            u[0][i] += nx * (r - across);
            u[1][i] += ny * (r - across);
            let rise = nx * d[0][i] + ny * d[1][i];
            turn[i] = b * d[2][i] + k * p[2][i] * rise;
            fall[i] = (b * rise - k * p[2][i] * d[2][i]) / h[i];
        }
        let Gauge { mut value, slopes } = gauge::<FUSED>(&u, self.axes, self.exponents);
        let mut floor = Floor {
            value,
            slopes,
            rate: [0.0; RAYS],
            bend: [0.0; RAYS],
            reach: [f64::INFINITY; RAYS],
        };
        for i in 0..RAYS {
            let across = nx * p[0][i] + ny * p[1][i];
            let b = 1.0 - k * across;
            let rise = nx * d[0][i] + ny * d[1][i];
            let speed = (rise * rise + d[2][i] * d[2][i]).sqrt().most(f64::TINY);
            let (gx, gy, gz) = (slopes[0][i], slopes[1][i], slopes[2][i]);
            let inwards = nx * gx + ny * gy;
            let aside = inwards * (fall[i] - rise);
            let height = turn[i] / (h[i] * h[i]);
            value[i] -= 1.0;
            floor.rate[i] = gx * d[0][i] + gy * d[1][i] + aside + gz * height;
            // the least distance from the axis ahead: now, where the ray passes it, or half of now on a part of the way
            let passes = turn[i].abs() / speed;
            let nearing = k * fall[i] > 0.0;
            let part = nearing && passes < 0.5 * h[i];
            let least = if nearing { passes.most(0.5 * h[i]) } else { h[i] };
            let mut reach = if part { 0.5 * h[i] / (k.abs() * speed) } else { f64::INFINITY };
            let cube = 1.0 / (least * least * least);
            let bend = (inwards * k).most(0.0) * turn[i] * turn[i]
                + 2.0 * (gz * turn[i] * k).abs() * speed;
            floor.bend[i] = bend * cube;
            // behind the axis the angle jumps
            let to_jump = -p[2][i] / d[2][i];
            if to_jump > 0.0 && b - k * rise * to_jump < 0.0 {
                reach = reach.least(to_jump + BEHIND / k.abs());
            }
            // next to the axis there is no solid: the way out
            let pace = k * speed;
            let before = -k * fall[i] * h[i];
            let out =
                (before * before + pace * pace * (self.core * self.core - h[i] * h[i])).most(0.0);
            if h[i] < 0.999 * self.core && value[i] > 0.0 {
                reach = (out.sqrt() - before) / (pace * pace);
                (floor.rate[i], floor.bend[i]) = (0.0, 0.0);
            }
            floor.reach[i] = reach;
            // J^{-T} ∇g
            let (up, sin, cos) = (gz / h[i], k * p[2][i] / h[i], b / h[i]);
            let radial = inwards * cos + up * sin - inwards;
            floor.slopes[0][i] += nx * radial;
            floor.slopes[1][i] += ny * radial;
            floor.slopes[2][i] = up * cos - inwards * sin;
        }
        floor.value = value;
        floor
    }
}
