//! What stands in a gripper's way, as boxes: walls, boards, furniture.

use crate::measure::OrientedBox;
use crate::segment::footprint::{Ground, Outline, Rectangle, spot_on};
use crate::segment::table::Support;
use crate::shape::Plane;
use crate::{Point, Pose};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

/// How far behind its face, and beside it, what belongs to a wall or a board lies, in metres: its rim, its edge.
pub(crate) const THICK: f64 = 0.035;
pub(crate) const SIDE: f64 = 0.03;

/// Whether a point lies in the thickness of a facet, at most so far beside its outline.
pub(crate) fn is_part(p: &Point, plane: &Plane, outline: &Outline, beside: f64) -> bool {
    let height = plane.height(p);
    height > -THICK && height < 0.5 * THICK && outline.holds(&Ground::of(plane).spot(p), -beside)
}

/// Whether the foot of a point on a plane is within an outline, or nearly.
pub(crate) fn is_over(p: &Point, plane: &Plane, outline: &Outline) -> bool {
    outline.holds(&Ground::of(plane).spot(p), -SIDE)
}

impl Support {
    /// The board that it is as seen from below: its outline's rectangle, a few centimetres thick, in metres.
    pub(crate) fn board(&self) -> Option<OrientedBox> {
        let rectangle = self.outline.rectangle()?;
        flat_box(&self.plane, &rectangle, [-0.5 * THICK, 0.0])
    }
}

/// The least box around some points one of whose faces is parallel to a plane; `None` where they have no area.
pub(crate) fn box_about(cloud: &[Point], points: &[u32], plane: &Plane) -> Option<OrientedBox> {
    let ground = Ground::of(plane);
    let step = points.len().div_ceil(5000).max(1);
    let some = || points.iter().step_by(step).filter_map(|i| cloud.get(*i as usize));
    let outline = Outline::around(&mut some().map(|p| ground.spot(p)).collect());
    let heights = some().map(|p| plane.height(p));
    let range = heights.fold([f64::MAX, f64::MIN], |r, h| [r[0].min(h), r[1].max(h)]);
    flat_box(plane, &outline.rectangle()?, range)
}

/// The box over a rectangle in a plane, between two heights.
fn flat_box(plane: &Plane, r: &Rectangle, [low, high]: [f64; 2]) -> Option<OrientedBox> {
    let [u, v] = plane.tangents();
    let (z, x) = (plane.normal().into_inner(), *u * r.along[0] + *v * r.along[1]);
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z]));
    let middle = spot_on(plane, &r.middle) + z * (0.5 * (low + high));
    let pose = Pose::from_parts(middle.into(), UnitQuaternion::from_rotation_matrix(&turn));
    OrientedBox::new(pose, [r.half[0], r.half[1], 0.5 * (high - low)]).ok()
}
