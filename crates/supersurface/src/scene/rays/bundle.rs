//! The rays of a tile of pixels, from one point.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use crate::Pose;
use crate::numeric::lanes::{Job, Lane, dispatch};

/// Rays of a bundle at most: a tile of 16 by 8 pixels.
pub(in crate::scene) const MOST: usize = 128;

/// A number for each ray of a bundle.
pub(super) type Column = [f64; MOST];

/// Where the rays of a bundle pass the plane at depth 1, in the optical frame.
pub(in crate::scene) struct Along {
    pub(in crate::scene) count: usize,
    pub(in crate::scene) x: Column,
    pub(in crate::scene) y: Column,
}

/// Unit directions in the world, and the pyramid around them.
pub(super) struct Bundle {
    pub(super) count: usize,
    pub(super) directions: [Column; 3],
    /// Length of each ray's way to depth 1.
    pub(super) lengths: Column,
    /// Least and greatest x and y at depth 1 in the optical frame.
    sides: [[f64; 2]; 2],
}

/// A box in the optical frame of a camera.
pub(super) struct Boxed {
    pub(super) middle: [f64; 3],
    /// From the middle to the middles of three faces.
    pub(super) halves: [[f64; 3]; 3],
}

impl Bundle {
    pub(super) fn new(along: &Along, pose: &Pose) -> Self {
        let count = along.count.min(MOST);
        let ends = |column: &Column| {
            let ends = [f64::INFINITY, f64::NEG_INFINITY];
            column[..count].iter().fold(ends, |[low, high], v| [low.min(*v), high.max(*v)])
        };
        let sides = [ends(&along.x), ends(&along.y)];
        let mut bundle = Self { count, directions: [[0.0; MOST]; 3], lengths: [0.0; MOST], sides };
        let turn = pose.rotation.to_rotation_matrix();
        let rows = std::array::from_fn(|k| turn.matrix().row(k).into_owned().into());
        let Self { directions, lengths, .. } = &mut bundle;
        dispatch(Aim { along, rows: &rows, directions, lengths });
        bundle
    }

    /// False where a side of the pyramid, or the plane at depth 0, parts it from the box.
    #[inline]
    pub(super) fn may_meet(&self, boxed: &Boxed) -> bool {
        let Boxed { middle, halves } = boxed;
        let ahead = middle[2] + halves.iter().map(|half| half[2].abs()).sum::<f64>();
        ahead >= 0.0
            && (0..2).all(|k| {
                let [low, high] = self.sides[k].map(|side| {
                    // how far the box reaches beyond the side, both ways
                    let off = |v: &[f64; 3]| v[k] - side * v[2];
                    let reach = halves.iter().map(|half| off(half).abs()).sum::<f64>();
                    [off(middle) - reach, off(middle) + reach]
                });
                low[1] >= 0.0 && high[0] <= 0.0
            })
    }
}

/// Unit directions in the world.
struct Aim<'a> {
    along: &'a Along,
    rows: &'a [[f64; 3]; 3],
    directions: &'a mut [Column; 3],
    lengths: &'a mut Column,
}

impl Job for Aim<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [xs, ys, zs] = self.directions;
        for i in 0..MOST {
            let (x, y) = (self.along.x[i], self.along.y[i]);
            let length = x.times_plus::<FUSED>(x, y.times_plus::<FUSED>(y, 1.0)).sqrt();
            self.lengths[i] = length;
            let inverse = 1.0 / length;
            let turned = |row: &[f64; 3]| {
                let sum = x.times_plus::<FUSED>(row[0], row[2]);
                y.times_plus::<FUSED>(row[1], sum) * inverse
            };
            (xs[i], ys[i], zs[i]) =
                (turned(&self.rows[0]), turned(&self.rows[1]), turned(&self.rows[2]));
        }
    }
}
