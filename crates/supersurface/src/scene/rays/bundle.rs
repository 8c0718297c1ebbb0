//! The rays of a tile of pixels, from one point.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use crate::numeric::lanes::{Job, Lane, dispatch};
use crate::{Pose, Vector};

/// Rays of a bundle at most: a tile of 16 by 16 pixels.
pub(in crate::scene) const MOST: usize = 256;

/// A number for each ray of a bundle.
pub(super) type Column = [f64; MOST];

/// Unit directions in the world, and the cone around them.
pub(super) struct Bundle {
    pub(super) count: usize,
    pub(super) directions: [Column; 3],
    /// Length of each ray's way to depth 1.
    pub(super) lengths: Column,
    /// Axis of the cone, and cosine and sine of the angle between it and its side.
    axis: Vector,
    opening: [f64; 2],
}

impl Bundle {
    /// Of rays that pass points at depth 1 in the optical frame, up to [`MOST`] of them.
    pub(super) fn new(along: &[Vector], pose: &Pose) -> Self {
        let count = along.len().min(MOST);
        let mut directions = [[0.0; MOST]; 3];
        for (i, to) in along.iter().take(MOST).enumerate() {
            for k in 0..3 {
                directions[k][i] = to[k];
            }
        }
        let mut lengths = [1.0; MOST];
        let turn = pose.rotation.to_rotation_matrix();
        let rows = std::array::from_fn(|k| turn.matrix().row(k).into_owned().into());
        dispatch(Aim { rows: &rows, directions: &mut directions, lengths: &mut lengths });
        let sum = |k: usize| directions[k][..count].iter().sum::<f64>();
        let axis = Vector::new(sum(0), sum(1), sum(2));
        let axis = axis.try_normalize(0.0).unwrap_or_else(Vector::z);
        let along = |i: usize| {
            axis.x * directions[0][i] + axis.y * directions[1][i] + axis.z * directions[2][i]
        };
        let cosine = (0..count).map(along).fold(1.0, f64::min).max(-1.0);
        let opening = [cosine, (1.0 - cosine * cosine).sqrt()];
        Self { count, directions, lengths, axis, opening }
    }

    /// False where no ray meets the ball with its middle at `to` from where the rays start.
    pub(super) fn may_meet(&self, to: &Vector, radius: f64) -> bool {
        let distance = to.norm();
        if distance <= radius {
            return true;
        }
        let sine = radius / distance;
        let cosine = (1.0 - sine * sine).sqrt();
        let [c, s] = self.opening;
        // the angle to the middle is at most those of the cone and of the ball
        let margin = 1e-9;
        let widest = c * cosine - s * sine;
        s * cosine + c * sine < 0.0 || self.axis.dot(to) >= (widest - margin) * distance
    }
}

/// Turns directions into the world and makes them unit ones.
struct Aim<'a> {
    rows: &'a [[f64; 3]; 3],
    directions: &'a mut [Column; 3],
    lengths: &'a mut Column,
}

impl Job for Aim<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [xs, ys, zs] = self.directions;
        for i in 0..MOST {
            let (x, y, z) = (xs[i], ys[i], zs[i]);
            let length = (x * x + y * y + z * z).sqrt();
            self.lengths[i] = length;
            let inverse = 1.0 / length.most(f64::TINY);
            let turned = |row: &[f64; 3]| {
                let sum = x.times_plus::<FUSED>(row[0], y * row[1]);
                z.times_plus::<FUSED>(row[2], sum) * inverse
            };
            (xs[i], ys[i], zs[i]) =
                (turned(&self.rows[0]), turned(&self.rows[1]), turned(&self.rows[2]));
        }
    }
}
