//! Two superellipsoids by the library's own query.

use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::details::{ContactManifoldsWorkspace, TypedWorkspaceData, WorkspaceData};
use parry3d_f64::shape::Shape;
use supersurface::Pose;
use supersurface::contact::{self, Convex, WarmStart};
use supersurface::shape::Posed;

use crate::convert::{from_point, from_vector, to_pose};
use crate::convex::ConvexSolid;

/// How two shapes touch.
pub(super) struct Touch {
    /// Distance in metres, negative for a depth.
    pub(super) distance: f64,
    /// Outward normals, each in the frame of its shape.
    pub(super) normals: [ParryVector; 2],
    /// Nearest or deepest points, each in the frame of its shape; `None` beyond the distance that was asked for.
    pub(super) points: Option<[ParryVector; 2]>,
}

/// Both as superellipsoids.
pub(super) fn superellipsoids<'a>(g1: &'a dyn Shape, g2: &'a dyn Shape) -> Option<[&'a Convex; 2]> {
    let convex = |g: &'a dyn Shape| g.as_shape::<ConvexSolid>()?.superellipsoid();
    Some([convex(g1)?, convex(g2)?])
}

fn posed(pos12: &ParryPose, [a, b]: [&Convex; 2]) -> Option<[Posed<Convex>; 2]> {
    let first = Posed::new(*a, Pose::identity()).ok()?;
    Some([first, Posed::new(*b, to_pose(pos12)).ok()?])
}

/// The contact, with points where the distance is at most `within`. Poses that are not finite touch nothing.
pub(super) fn touch(
    pos12: &ParryPose,
    pair: [&Convex; 2],
    within: f64,
    start: &mut WarmStart,
) -> Touch {
    let Some([a, b]) = posed(pos12, pair) else {
        return Touch { distance: f64::INFINITY, normals: [ParryVector::X; 2], points: None };
    };
    let found = contact::pair(&a, &b, start);
    let normal = from_vector(&found.normal);
    let points = (found.distance <= within).then(|| {
        let [p1, p2] = found.witnesses.each_ref().map(from_point);
        [p1, pos12.inverse_transform_point(p2)]
    });
    let normals = [normal, pos12.rotation.inverse() * -normal];
    Touch { distance: found.distance, normals, points }
}

/// True where they overlap.
pub(super) fn intersect(pos12: &ParryPose, pair: [&Convex; 2]) -> bool {
    posed(pos12, pair).is_some_and(|[a, b]| contact::intersect(&a, &b))
}

/// A warm start kept with a pair from step to step.
#[derive(Clone, Default)]
struct Memory(WarmStart);

impl WorkspaceData for Memory {
    fn as_typed_workspace_data(&self) -> TypedWorkspaceData<'_> {
        TypedWorkspaceData::Custom
    }

    fn clone_dyn(&self) -> Box<dyn WorkspaceData> {
        Box::new(self.clone())
    }
}

/// The contact of a pair that is asked about step by step; the workspace keeps what was found out.
pub(super) fn touch_again(
    pos12: &ParryPose,
    pair: [&Convex; 2],
    within: f64,
    workspace: &mut Option<ContactManifoldsWorkspace>,
) -> Touch {
    // a workspace of another type is one of other shapes
    let kept = workspace.take().and_then(|w| w.0.downcast::<Memory>().ok());
    let mut memory = kept.unwrap_or_default();
    let touch = touch(pos12, pair, within, &mut memory.0);
    *workspace = Some(ContactManifoldsWorkspace(memory));
    touch
}
