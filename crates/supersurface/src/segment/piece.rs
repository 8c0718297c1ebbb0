//! A piece of the cloud above the support: its heights, its outline, its distance to another.

use crate::Point;
use crate::cloud::{Places, VoxelGrid};
use crate::segment::footprint::{Ground, Outline};
use crate::shape::Plane;

/// Distance between the points by which gaps are measured, in metres, and how many at most.
const GRAIN: f64 = 0.005;
const MOST: usize = 3000;

/// Points that hang together, and what is asked of them.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    /// Indices in ascending order.
    pub(crate) points: Vec<u32>,
    /// Heights of its lowest and highest points over the support, without the last 2 %, in metres.
    pub(crate) bottom: f64,
    pub(crate) top: f64,
    /// Convex hull of its feet in the support plane.
    pub(crate) outline: Outline,
    /// Some of its points, one in a cube of `GRAIN`.
    pub(crate) sample: Vec<Point>,
    /// Share of its rows that curve away from the eye; 0 where the cloud is not organised.
    pub(crate) hollow: f64,
    low: Point,
    high: Point,
}

impl Piece {
    /// The piece of the points named.
    pub(crate) fn new(points: Vec<u32>, cloud: &[Point], plane: &Plane, ground: &Ground) -> Self {
        let step = (points.len() / MOST).max(1);
        let some = points.iter().copied().step_by(step);
        let sample: Vec<Point> = VoxelGrid::new(cloud, some, GRAIN)
            .map(|g| g.representatives().filter_map(|i| cloud.get(i as usize)).copied().collect())
            .unwrap_or_default();
        let mut heights: Vec<f64> = sample.iter().map(|p| plane.height(p)).collect();
        heights.sort_unstable_by(f64::total_cmp);
        let cut = heights.len() / 50;
        let bottom = heights.get(cut).copied().unwrap_or(0.0);
        let top = heights.iter().nth_back(cut).copied().unwrap_or(0.0);
        let outline = Outline::around(&mut sample.iter().map(|p| ground.spot(p)).collect());
        let first = sample.first().copied().unwrap_or(Point::origin());
        let low = sample.iter().fold(first, |a, b| a.inf(b));
        let high = sample.iter().fold(first, |a, b| a.sup(b));
        Self { points, bottom, top, outline, sample, hollow: 0.0, low, high }
    }

    /// Diagonal of its box, in metres.
    pub(crate) fn size(&self) -> f64 {
        (self.high - self.low).norm()
    }

    /// Smallest distance to another piece; `None` when it is over `most`.
    pub(crate) fn gap(&self, other: &Self, most: f64) -> Option<f64> {
        let apart = |a: &Self, b: &Self| (0..3).any(|k| a.low[k] > b.high[k] + most);
        if apart(self, other) || apart(other, self) {
            return None;
        }
        // Only points within `most` of the other's box can be that near.
        let facing = |a: &Self, b: &Self| -> Vec<Point> {
            let near =
                |p: &&Point| (0..3).all(|k| p[k] >= b.low[k] - most && p[k] <= b.high[k] + most);
            a.sample.iter().filter(near).copied().collect()
        };
        let mut places = Places::default();
        places.set(facing(other, self).into_iter());
        let least = places.nearest(&facing(self, other));
        (least <= most * most).then(|| least.sqrt())
    }

    /// True when it is far above the support for its size: nothing stands so.
    pub(crate) fn aloft(&self) -> bool {
        self.bottom > 0.03 + 0.3 * self.size()
    }

    /// Share of its own outline that it has in common with another's.
    pub(crate) fn within(&self, other: &Self) -> f64 {
        self.outline.common(&other.outline).area() / self.outline.area().max(1e-9)
    }
}
