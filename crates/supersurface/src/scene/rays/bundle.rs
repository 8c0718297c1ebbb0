//! The rays of a tile of pixels, from one point.
//!
//! Places along them are told by depth along the optical axis, so that directions need not be of unit length.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::block::RAYS;
use crate::Pose;
use crate::numeric::lanes::{Job, Lane, dispatch};

/// Rays of a bundle: a tile of 16 by 8 pixels.
pub(in crate::scene) const MOST: usize = 128;

/// A number for each ray of a bundle.
pub(in crate::scene) type Column = [f64; MOST];

/// Where the rays of a bundle pass the plane at depth 1, in the optical frame.
pub(in crate::scene) struct Along {
    pub(in crate::scene) x: Column,
    pub(in crate::scene) y: Column,
}

impl Along {
    /// The optical axis.
    pub(in crate::scene) const fn ahead() -> Self {
        Self { x: [0.0; MOST], y: [0.0; MOST] }
    }
}

/// The rays in the world.
pub(super) struct Bundle {
    /// How points move as depth grows by a metre.
    pub(super) directions: [Column; 3],
    /// Least and greatest x and y at depth 1 in the optical frame.
    sides: [[f64; 2]; 2],
}

/// The rectangle at depth 1 in the optical frame in which something is seen: least and greatest x and y.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window([[f64; 2]; 2]);

impl Bundle {
    pub(super) fn new(along: &Along, pose: &Pose) -> Self {
        let mut bundle = Self { directions: [[0.0; MOST]; 3], sides: [[0.0; 2]; 2] };
        let turn = pose.rotation.to_rotation_matrix();
        let rows = std::array::from_fn(|k| turn.matrix().row(k).into_owned().into());
        dispatch(Aim { along, rows: &rows, bundle: &mut bundle });
        bundle
    }

    /// False where no ray passes the window.
    #[inline]
    pub(super) fn may_meet(&self, window: &Window) -> bool {
        let ([x, y], [wx, wy]) = (self.sides, window.0);
        x[1] >= wx[0] && x[0] <= wx[1] && y[1] >= wy[0] && y[0] <= wy[1]
    }
}

impl Window {
    /// Around corners; nothing where all are behind the camera, and everything where some are.
    pub(super) fn around(corners: &[[f64; 3]]) -> Self {
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        if corners.iter().any(|corner| corner[2] <= 0.0) {
            let behind = corners.iter().all(|corner| corner[2] < 0.0);
            return Self(if behind { [ends; 2] } else { [[ends[1], ends[0]]; 2] });
        }
        let mut window = [ends; 2];
        for [x, y, z] in corners {
            for (side, place) in window.iter_mut().zip([x / z, y / z]) {
                *side = [side[0].min(place), side[1].max(place)];
            }
        }
        Self(window)
    }
}

/// Directions in the world, and the ends of the bundle.
struct Aim<'a> {
    along: &'a Along,
    rows: &'a [[f64; 3]; 3],
    bundle: &'a mut Bundle,
}

impl Job for Aim<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Along { x, y } = self.along;
        for (column, row) in self.bundle.directions.iter_mut().zip(self.rows) {
            for i in 0..MOST {
                let sum = x[i].times_plus::<FUSED>(row[0], row[2]);
                column[i] = y[i].times_plus::<FUSED>(row[1], sum);
            }
        }
        self.bundle.sides = [ends(x), ends(y)];
    }
}

/// The least and the greatest.
#[inline(always)]
fn ends(column: &Column) -> [f64; 2] {
    let (mut low, mut high) = ([f64::INFINITY; RAYS], [f64::NEG_INFINITY; RAYS]);
    for block in column.as_chunks::<RAYS>().0 {
        for i in 0..RAYS {
            low[i] = block[i].least(low[i]);
            high[i] = block[i].most(high[i]);
        }
    }
    low.iter()
        .zip(high)
        .fold([low[0], high[0]], |[a, b], (low, high)| [a.least(*low), b.most(high)])
}
