//! How deep bodies overlap by the exact query, and the pushes that end it.

use parry3d_f64::bounding_volume::{Aabb, BoundingVolume};
use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::QueryDispatcher;
use parry3d_f64::shape::SharedShape;

use crate::dispatch::Dispatcher;

/// Rounds of pushes, after which what is left is left.
const ROUNDS: usize = 300;

/// A part of a body, or of the ground.
pub(super) struct Item {
    /// The body that it moves with; `None` for the ground.
    pub(super) body: Option<usize>,
    /// Its pose in the body, or in the world.
    pub(super) local: ParryPose,
    pub(super) shape: SharedShape,
}

/// Everything where it lies.
pub(super) struct Layout {
    pub(super) items: Vec<Item>,
    poses: Vec<ParryPose>,
    masses: Vec<f64>,
}

impl Layout {
    pub(super) fn new(items: Vec<Item>, poses: Vec<ParryPose>, masses: Vec<f64>) -> Self {
        Self { items, poses, masses }
    }

    /// The bodies' poses.
    pub(super) fn poses(&self) -> &[ParryPose] {
        &self.poses
    }

    pub(super) fn pose(&self, item: &Item) -> ParryPose {
        item.body.map_or(item.local, |body| self.poses[body] * item.local)
    }

    /// Pairs of items of different bodies whose boxes, wider by a margin, meet.
    pub(super) fn near(&self, margin: f64) -> Vec<[usize; 2]> {
        let boxes: Vec<Aabb> = self
            .items
            .iter()
            .map(|item| item.shape.compute_aabb(&self.pose(item)).loosened(margin))
            .collect();
        let mut pairs = Vec::new();
        for (i, first) in self.items.iter().enumerate() {
            for (j, second) in self.items.iter().enumerate().skip(i + 1) {
                if first.body != second.body && boxes[i].intersects(&boxes[j]) {
                    pairs.push([i, j]);
                }
            }
        }
        pairs
    }

    /// Depth of the deepest overlap of a pair in metres, and the world's normal from the first to the second.
    fn overlap(&self, [i, j]: [usize; 2]) -> Option<(f64, ParryVector)> {
        let [a, b] = [&self.items[i], &self.items[j]];
        let [at_a, at_b] = [self.pose(a), self.pose(b)];
        let found = Dispatcher.contact(&at_a.inv_mul(&at_b), &*a.shape, &*b.shape, 0.0);
        let contact = found.ok().flatten()?;
        (contact.dist < 0.0).then(|| (-contact.dist, at_a.rotation * contact.normal1))
    }

    /// Puts a body somewhere else if it overlaps nothing there by more than `tolerance` metres.
    pub(super) fn put(&mut self, body: usize, pose: ParryPose, tolerance: f64) {
        let before = std::mem::replace(&mut self.poses[body], pose);
        let own = |pair: &[usize; 2]| pair.iter().any(|i| self.items[*i].body == Some(body));
        let mut depths = self.near(0.0).into_iter().filter(own).filter_map(|p| self.overlap(p));
        if depths.any(|(depth, _)| depth > tolerance) {
            self.poses[body] = before;
        }
    }

    /// The deepest overlap in metres, 0 for none.
    pub(super) fn deepest(&self) -> f64 {
        let depths = self.near(0.0).into_iter().filter_map(|pair| self.overlap(pair));
        depths.map(|(depth, _)| depth).fold(0.0, f64::max)
    }

    /// Pushes bodies apart until no overlap is deeper than `tolerance` metres, or rounds are over; returns the deepest that
    /// is left.
    pub(super) fn separate(&mut self, tolerance: f64) -> f64 {
        for _ in 0..ROUNDS {
            let mut pushed = false;
            for pair in self.near(0.0) {
                let Some((depth, normal)) = self.overlap(pair) else { continue };
                if depth <= tolerance {
                    continue;
                }
                pushed = true;
                self.push(pair, normal * (depth - 0.5 * tolerance));
            }
            if !pushed {
                break;
            }
        }
        self.deepest()
    }

    /// Moves the two apart by a way, each by the other's share of the mass.
    fn push(&mut self, [i, j]: [usize; 2], way: ParryVector) {
        let [first, second] = [self.items[i].body, self.items[j].body];
        let ease = |body: Option<usize>| body.map_or(0.0, |b| 1.0 / self.masses[b]);
        let [a, b] = [ease(first), ease(second)];
        let sum = a + b;
        if let Some(body) = first {
            self.poses[body].translation -= way * (a / sum);
        }
        if let Some(body) = second {
            self.poses[body].translation += way * (b / sum);
        }
    }
}
