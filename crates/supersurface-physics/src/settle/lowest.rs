//! A body that lies alone on a level place, turned to the pose near by in which its centre of mass is lowest.
//!
//! What is almost a ball rolls so slowly near its stable pose that it counts as still long before it is there. On a level
//! plane its potential energy is that of the height of its centre over its lowest point, `h(d) - c·d` with the support
//! function `h` for the direction `d` that points down; rest is a local minimum over the sphere of directions.

use parry3d_f64::math::{Rotation, Vector as ParryVector};
use parry3d_f64::query::QueryDispatcher;
use parry3d_f64::shape::Shape;

use super::overlap::Layout;
use crate::dispatch::Dispatcher;
use crate::pieces::Pieces;

/// A body touches what is nearer than this share of its half size, or this many metres.
const NEAR: [f64; 2] = [1e-3, 1e-4];
/// Cosine of the angle between the contact's normal and gravity up to which a place is level.
const LEVEL: f64 = 1.0 - 1e-6;
/// First and last step of the search and the farthest turn, in radians.
const STEPS: [f64; 2] = [0.02, 1e-5];
const FARTHEST: f64 = 0.4;
/// Moves and halvings of the step, at most.
const MOVES: usize = 400;
/// Directions that are tried for a step: along the body's axes, as the sharp valleys above edges of faces lie along these,
/// and some apart by the golden angle.
const TRIED: usize = 8;
const APART: f64 = 2.399_963_229_728_653;

impl Layout {
    /// Turns a body of this half size and with this centre of mass, in its own frame, if it touches nothing but a level
    /// place and can be turned without an overlap deeper than `tolerance` metres.
    pub(super) fn lower(
        &mut self,
        body: usize,
        (half, centre): (f64, ParryVector),
        down: ParryVector,
        tolerance: f64,
    ) {
        let Some(floor) = self.level_below(body, half, down) else { return };
        let pose = self.poses()[body];
        let start = pose.rotation.inverse() * down;
        let (depth, lowest) = self.lowest(body, centre, start);
        let mut lowered = pose;
        lowered.rotation = pose.rotation * Rotation::from_rotation_arc(lowest, start);
        let middle = pose * centre;
        let middle = middle + down * (floor - depth - middle.dot(down));
        lowered.translation = middle - lowered.rotation * centre;
        if lowered.is_finite() {
            self.put(body, lowered, tolerance);
        }
    }

    /// How far down the only thing that it touches is, along gravity from the origin; `None` if that is not level.
    fn level_below(&self, body: usize, half: f64, down: ParryVector) -> Option<f64> {
        let [share, least] = NEAR;
        let near = least.max(share * half);
        let mut floor: Option<f64> = None;
        for pair in self.near(near) {
            let [a, b] = pair.map(|i| &self.items[i]);
            if a.body != Some(body) && b.body != Some(body) {
                continue;
            }
            let [at_a, at_b] = [self.pose(a), self.pose(b)];
            let found = Dispatcher.contact(&at_a.inv_mul(&at_b), &*a.shape, &*b.shape, near);
            let Some(contact) = found.ok().flatten() else { continue };
            let first = a.body == Some(body);
            let (normal, ground) = match first {
                true => (at_a.rotation * contact.normal1, at_b * contact.point2),
                false => (at_b.rotation * contact.normal2, at_a * contact.point1),
            };
            let other = if first { b.body } else { a.body };
            if other.is_some() || normal.dot(down) < LEVEL {
                return None;
            }
            let height = ground.dot(down);
            floor = Some(floor.map_or(height, |f| f.min(height)));
        }
        floor
    }

    /// The least depth of the lowest point below the centre, and the body's direction that points down then: a pattern
    /// search.
    fn lowest(&self, body: usize, centre: ParryVector, start: ParryVector) -> (f64, ParryVector) {
        let parts: Vec<_> = self.items.iter().filter(|item| item.body == Some(body)).collect();
        let depth = |d: ParryVector| {
            let reach = |item: &&super::overlap::Item| {
                let way = item.local.rotation.inverse() * d;
                item.local.translation.dot(d) + reach(&*item.shape, way)
            };
            parts.iter().map(reach).fold(f64::NEG_INFINITY, f64::max) - centre.dot(d)
        };
        let mut best = (depth(start), start);
        let [mut step, last] = STEPS;
        for turn in 0..MOVES {
            if step < last {
                break;
            }
            let n = best.1;
            let (along, across) = n.any_orthonormal_pair();
            let axes = [ParryVector::X, ParryVector::Y, ParryVector::Z];
            let along_axes = axes.map(|axis| axis - n * n.dot(axis)).into_iter();
            let others = (0..TRIED).map(|k| {
                let (sin, cos) = (APART * (k + turn) as f64).sin_cos();
                along * cos + across * sin
            });
            let ways = along_axes.flat_map(|way| [way, -way]).chain(others);
            let lower = ways.filter_map(ParryVector::try_normalize).find_map(|way| {
                let d = (n + way * step).normalize();
                let found = depth(d);
                let nearer = d.dot(start) > FARTHEST.cos();
                (nearer && found < best.0 * (1.0 - 1e-15)).then_some((found, d))
            });
            match lower {
                Some(found) => best = found,
                None => step *= 0.5,
            }
        }
        best
    }
}

/// The support function of a shape with a support map or of pieces.
fn reach(shape: &dyn Shape, way: ParryVector) -> f64 {
    if let Some(pieces) = shape.as_shape::<Pieces>() {
        let pieces = pieces.pieces().iter();
        return pieces.map(|(_, piece)| reach(&**piece, way)).fold(f64::NEG_INFINITY, f64::max);
    }
    let map = shape.as_support_map();
    map.map_or(f64::NEG_INFINITY, |map| map.local_support_point(way).dot(way))
}
