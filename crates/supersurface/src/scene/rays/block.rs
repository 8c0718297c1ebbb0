//! Rays that are followed together, a number each in vector registers, and the gauge along them.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use crate::numeric::lanes::{Lane, WIDTH, exp, ln};
use crate::numeric::superellipse::norm_of_logs;

/// Coordinates nearer to a plane of symmetry count as this far from it, in semi-axes: their squares are numbers yet.
const LEAST: f64 = 1e-150;

/// Rays of a block: twice the lanes of other loops, as each step of Newton's method waits for the one before.
pub(in crate::scene) const RAYS: usize = 2 * WIDTH;

/// A number for each ray of a block.
pub(super) type Row = [f64; RAYS];

/// Rays from one point, in the frame of a solid, each with the stretch on which it may meet the solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Block {
    pub(super) origin: [f64; 3],
    /// How the points move as depth grows: directions have a length of 1 along the optical axis.
    pub(super) directions: [Row; 3],
    /// From this depth on, outside the solid.
    pub(super) near: Row,
    /// To here; a ray whose stretch is empty meets nothing.
    pub(super) far: Row,
}

impl Block {
    /// Without rays yet.
    #[inline(always)]
    pub(super) const fn from(origin: [f64; 3]) -> Self {
        let none = [0.0; RAYS];
        Self { origin, directions: [none; 3], near: none, far: none }
    }

    /// The points at depths along the rays.
    #[inline(always)]
    pub(super) fn at<const FUSED: bool>(&self, t: &Row) -> [Row; 3] {
        let mut p = [[0.0; RAYS]; 3];
        for k in 0..3 {
            for i in 0..RAYS {
                p[k][i] = t[i].times_plus::<FUSED>(self.directions[k][i], self.origin[k]);
            }
        }
        p
    }
}

/// Where the rays of a block meet a solid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hits {
    /// Along the optical axis in metres; infinite for a ray that misses.
    pub(super) depth: Row,
    /// Outward normal there, in the solid's frame and of any length.
    pub(super) normal: [Row; 3],
}

impl Hits {
    pub(super) const NONE: Self = Self { depth: [f64::INFINITY; RAYS], normal: [[0.0; RAYS]; 3] };
}

/// A solid whose first hits a block of rays is told at once.
pub(super) trait Solid {
    /// The first hits of the rays. Must be `#[inline(always)]`.
    fn hits<const FUSED: bool>(&mut self, block: &Block) -> Hits;
}

/// A superellipsoid's gauge at a point of each ray, and its derivatives by the coordinates.
pub(super) struct Gauge {
    pub(super) value: Row,
    pub(super) slopes: [Row; 3],
}

/// The gauge with semi-axes and exponents.
#[inline(always)]
pub(super) fn gauge<const FUSED: bool>(p: &[Row; 3], axes: [f64; 3], [e1, e2]: [f64; 2]) -> Gauge {
    let sizes: [Row; 3] = std::array::from_fn(|k| size(&p[k], axes[k]));
    let (planar, [s1, s2]) = norm::<FUSED>(&sizes[0], &sizes[1], e2);
    let mut height = [0.0; RAYS];
    for i in 0..RAYS {
        height[i] = ln::<FUSED>(sizes[2][i]);
    }
    let (whole, [s12, s3]) =
        norm_of_logs::<FUSED, f64, RAYS>(&planar, &height, &[2.0 / e1; RAYS], &[0.5 * e1; RAYS]);
    let (mut value, mut slopes) = ([0.0; RAYS], [[0.0; RAYS]; 3]);
    for i in 0..RAYS {
        value[i] = exp::<FUSED>(whole[i]);
        let shares = [s12[i] * s1[i], s12[i] * s2[i], s3[i]];
        for k in 0..3 {
            slopes[k][i] = value[i] * shares[k] / (sizes[k][i] * axes[k]).copysign(p[k][i]);
        }
    }
    Gauge { value, slopes }
}

/// Magnitudes of coordinates in semi-axes, not 0.
#[inline(always)]
pub(super) fn size(p: &Row, axis: f64) -> Row {
    let (mut size, inverse) = ([0.0; RAYS], 1.0 / axis);
    for i in 0..RAYS {
        size[i] = (p[i].abs() * inverse).most(LEAST);
    }
    size
}

/// Logarithm of `(x^q + y^q)^(1/q)` with `q = 2/ε` of positive numbers, and the share of each in the sum.
#[inline(always)]
pub(super) fn norm<const FUSED: bool>(x: &Row, y: &Row, exponent: f64) -> (Row, [Row; 2]) {
    let (mut a, mut b) = ([0.0; RAYS], [0.0; RAYS]);
    if exponent == 1.0 {
        let mut log = [0.0; RAYS];
        for i in 0..RAYS {
            let (xx, yy) = (x[i] * x[i], y[i] * y[i]);
            let sum = xx + yy;
            log[i] = 0.5 * ln::<FUSED>(sum);
            (a[i], b[i]) = (xx / sum, yy / sum);
        }
        return (log, [a, b]);
    }
    for i in 0..RAYS {
        (a[i], b[i]) = (ln::<FUSED>(x[i]), ln::<FUSED>(y[i]));
    }
    let (q, r) = ([2.0 / exponent; RAYS], [0.5 * exponent; RAYS]);
    norm_of_logs::<FUSED, f64, RAYS>(&a, &b, &q, &r)
}
