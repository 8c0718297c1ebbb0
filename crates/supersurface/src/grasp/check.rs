//! Does the gripper meet anything on its way in: its boxes, swept along the approach, against the table,
//! neighbours, the object itself and what no ray passed through.

use nalgebra::Translation3;

use super::gripper::{Boxed, Gripper, Kind};
use super::surroundings::Local;
use crate::measure::OrientedBox;
use crate::{Point, Pose, Vector};

/// Clearance kept to the table, in metres.
const TABLE_MARGIN: f64 = 0.0015;
/// Clearance kept to points.
const POINT_MARGIN: f64 = 0.001;
/// Points of the object or its hidden side that may lie within the boxes: strays.
const ALLOWED: usize = 2;

/// What a gripper runs into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Obstruction {
    Table,
    Object,
    Neighbour,
    Solid,
}

/// Boxes of a gripper in the tool frame. For a jaw `gap` is the distance between the pads now; `closed` that at
/// which they stand in the tool frame's origin.
pub(super) fn boxes(gripper: &Gripper, gap: f64, closed: f64) -> Vec<Boxed> {
    let mut out = gripper.body.clone();
    if let Kind::Jaw(jaw) = &gripper.kind {
        let back = tip_advance(&jaw.tip_arc, closed);
        let advance = tip_advance(&jaw.tip_arc, gap) - back;
        for part in &mut out {
            part.center.z -= back;
        }
        for side in [1.0, -1.0] {
            for part in &jaw.finger {
                let mut moved = *part;
                moved.center.x = side * (part.center.x + 0.5 * gap);
                moved.center.z += advance;
                out.push(moved);
            }
        }
    }
    out
}

/// How far the tips of a linkage stand out at an opening, against the closed jaw.
fn tip_advance(arc: &[[f64; 2]], opening: f64) -> f64 {
    let (Some(first), Some(last)) = (arc.first(), arc.last()) else { return 0.0 };
    if opening <= first[0] {
        return first[1];
    }
    for pair in arc.windows(2) {
        let [[x0, z0], [x1, z1]] = [pair[0], pair[1]];
        if opening <= x1 {
            return z0 + (z1 - z0) * (opening - x0) / (x1 - x0);
        }
    }
    last[1]
}

/// True when a box comes too near to the table.
pub(super) fn meets_table(boxes: &[Boxed], pose: &Pose, local: &Local) -> bool {
    local.has_table && boxes.iter().any(|b| lowest(b, pose) < TABLE_MARGIN)
}

/// The first obstruction of a gripper with these boxes at a pose in the table's frame.
/// They come in along the approach from `way` metres before it.
pub(super) fn obstruction(
    boxes: &[Boxed],
    pose: &Pose,
    way: f64,
    local: &Local,
) -> Option<Obstruction> {
    let before = pose * Translation3::new(0.0, 0.0, -way);
    if meets_table(boxes, pose, local) || meets_table(boxes, &before, local) {
        return Some(Obstruction::Table);
    }
    let axes = pose.rotation.to_rotation_matrix();
    let (low, high) = swept(boxes, way);
    let meets = |p: &Point| {
        let q = Point::from(axes.inverse_transform_vector(&(p - pose.translation.vector).coords));
        if !(0..3).all(|k| (low[k]..=high[k]).contains(&q[k])) {
            return false;
        }
        boxes.iter().any(|b| {
            let half = b.size * 0.5 + Vector::repeat(POINT_MARGIN);
            let d = q - b.center;
            d.x.abs() < half.x && d.y.abs() < half.y && d.z < half.z && d.z > -half.z - way
        })
    };
    if !local.solids.is_empty() && boxes.iter().any(|b| meets_solid(b, pose, way, local)) {
        return Some(Obstruction::Solid);
    }
    let (middle, radius) = (pose * nalgebra::center(&low, &high), 0.5 * (high - low).norm());
    let own = local.clumps.near(middle, radius).flat_map(|k| &local.spots[k]);
    if own.filter(|s| meets(&s.at)).nth(ALLOWED).is_some() {
        return Some(Obstruction::Object);
    }
    let others = local.obstacle_clumps.near(middle, radius).flat_map(|k| &local.obstacles[k]);
    others.filter(|p| meets(p)).nth(ALLOWED).map(|_| Obstruction::Neighbour)
}

/// True when a box on its way in meets a wall or another solid.
fn meets_solid(b: &Boxed, pose: &Pose, way: f64, local: &Local) -> bool {
    let middle = pose * Translation3::from(b.center - Vector::z() * (0.5 * way));
    let half = (b.size + Vector::z() * way) * 0.5 + Vector::repeat(POINT_MARGIN);
    let swept = OrientedBox::new(middle, half.into());
    swept.is_ok_and(|swept| local.solids.iter().any(|solid| swept.meets(solid)))
}

/// The box around all boxes on their way in.
fn swept(boxes: &[Boxed], way: f64) -> (Point, Point) {
    let none = (Point::from([f64::INFINITY; 3]), Point::from([f64::NEG_INFINITY; 3]));
    boxes.iter().fold(none, |(low, high), b| {
        let half = b.size * 0.5 + Vector::repeat(POINT_MARGIN);
        let back = Vector::z() * way;
        (low.inf(&(b.center - half - back)), high.sup(&(b.center + half)))
    })
}

/// Height of the lowest corner of a box.
fn lowest(b: &Boxed, pose: &Pose) -> f64 {
    let up = pose.rotation.inverse_transform_vector(&Vector::z());
    (pose * b.center).z - 0.5 * up.abs().dot(&b.size)
}
