//! Several points where two convex shapes touch: enough to stand on, and the exact one among them.
//!
//! The points are where the polygons of both shapes towards each other overlap. As the polygons' corners lie on the true
//! surfaces, the distance at each point is the true one or a little more: none pushes bodies apart that do not touch. The
//! exact point is the deepest; without it a round body would sink until its polygon's corners touch.

use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::details::{NormalConstraints, NormalConstraintsPair};
use parry3d_f64::query::{ContactManifold, TrackedContact, Unsupported};
use parry3d_f64::shape::{PackedFeatureId, PolygonalFeature, PolygonalFeatureMap, Shape};

use super::exact::Touch;
use super::search::{Found, search};

/// A point that normal constraints made more than this many times as deep as the contact is dropped: it is one of a far
/// part of the other shape.
const DEEPEST: f64 = 5.0;

fn feature_map(g: &dyn Shape) -> Result<(&dyn PolygonalFeatureMap, f64), Unsupported> {
    g.as_polygonal_feature_map().ok_or(Unsupported)
}

/// The nearest or deepest points by parry's iterations on support points.
pub(super) fn touch_by_search<M, C>(
    manifold: &ContactManifold<M, C>,
    pos12: &ParryPose,
    [g1, g2]: [&dyn Shape; 2],
    prediction: f64,
) -> Result<Touch, Unsupported> {
    let (map1, border1) = feature_map(g1)?;
    let (map2, border2) = feature_map(g2)?;
    let facing = |n: ParryVector| [n, pos12.rotation.inverse() * -n];
    let middle = |g: &dyn Shape| g.compute_local_aabb().center();
    let between = || pos12 * middle(g2) - middle(g1);
    let before = manifold.local_n1.try_normalize().or_else(|| between().try_normalize());
    let (before, touched) = (before.unwrap_or(ParryVector::X), !manifold.points.is_empty());
    let reach = prediction + border1 + border2;
    // most pieces of two bodies are parted by their boxes already
    let far = |g: &dyn Shape, way: ParryVector| {
        let bounds = g.compute_local_aabb();
        bounds.center().dot(way) + bounds.half_extents().dot(way.abs())
    };
    let [n1, n2] = facing(before);
    if pos12.translation.dot(before) - far(g1, n1) - far(g2, n2) > reach {
        return Ok(Touch { distance: f64::INFINITY, normals: [n1, n2], points: None });
    }
    Ok(match search(pos12, map1, map2, reach, before, touched) {
        Found::Touching([p1, p2], n) => {
            let points = Some([p1, pos12.inverse_transform_point(p2)]);
            Touch { distance: (p2 - p1).dot(n), normals: facing(n), points }
        }
        Found::Apart(n) => Touch { distance: f64::INFINITY, normals: facing(n), points: None },
    })
}

/// Fills the manifold of two shapes that touch in this way. Where they do not, it remembers the normal.
pub(super) fn fill<M, C: Default + Copy>(
    manifold: &mut ContactManifold<M, C>,
    pos12: &ParryPose,
    [g1, g2]: [&dyn Shape; 2],
    constraints: [Option<&dyn NormalConstraints>; 2],
    touch: Touch,
) {
    let old = std::mem::take(&mut manifold.points);
    let [mut n1, mut n2] = touch.normals;
    [manifold.local_n1, manifold.local_n2] = [n1, n2];
    let (Some([p1, p2]), Ok((map1, border1)), Ok((map2, border2))) =
        (touch.points, feature_map(g1), feature_map(g2))
    else {
        return;
    };
    let [first, second] = constraints;
    if !(first, second).project_local_normals(pos12, &mut n1, &mut n2) {
        return;
    }
    let [mut face1, mut face2] = [PolygonalFeature::default(), PolygonalFeature::default()];
    map1.local_support_feature_toward(n1, p1, &mut face1);
    map2.local_support_feature_toward(n2, p2, &mut face2);
    PolygonalFeature::contacts(pos12, &pos12.inverse(), n1, n2, &face1, &face2, manifold, false);
    // a normal that was turned no longer belongs to these points
    if n1 == touch.normals[0] {
        let unknown = PackedFeatureId::UNKNOWN;
        manifold.points.push(TrackedContact::new(p1, p2, unknown, unknown, touch.distance));
    }
    if first.is_some() || second.is_some() {
        let lowest = DEEPEST * touch.distance;
        manifold.points.retain(|p| touch.distance >= 0.0 || p.dist >= 0.0 || p.dist >= lowest);
    }
    if border1 != 0.0 || border2 != 0.0 {
        for point in &mut manifold.points {
            point.local_p1 += n1 * border1;
            point.local_p2 += n2 * border2;
            point.dist -= border1 + border2;
        }
    }
    [manifold.local_n1, manifold.local_n2] = [n1, n2];
    manifold.match_contacts(&old);
}

/// Fills the manifold of a half space and a shape: the corners of its polygon, and its lowest point.
pub(super) fn fill_on_half_space<M, C: Default + Copy>(
    manifold: &mut ContactManifold<M, C>,
    pos12: &ParryPose,
    [g1, g2]: [&dyn Shape; 2],
    prediction: f64,
) -> Result<(), Unsupported> {
    let flipped = g1.as_halfspace().is_none();
    let [ground, body] = if flipped { [g2, g1] } else { [g1, g2] };
    let pose = if flipped { pos12.inverse() } else { *pos12 };
    let (map, border) = feature_map(body)?;
    let normal = ground.as_halfspace().ok_or(Unsupported)?.normal;
    let down = pose.rotation.inverse() * -normal;
    let [n1, n2] = if flipped { [down, normal] } else { [normal, down] };
    [manifold.local_n1, manifold.local_n2] = [n1, n2];
    // most pieces of a body are far above
    let bounds = body.compute_local_aabb();
    let reach = bounds.center().dot(down) + bounds.half_extents().dot(down.abs());
    if pose.translation.dot(normal) - reach - border > prediction {
        manifold.points.clear();
        return Ok(());
    }
    let mut face = PolygonalFeature::default();
    map.local_support_feature(down, &mut face);
    let lowest = (map.local_support_point(down), PackedFeatureId::UNKNOWN);
    let corners = face.vertices.into_iter().zip(face.vids).take(face.num_vertices);
    let old = std::mem::take(&mut manifold.points);
    for (point, id) in corners.chain([lowest]) {
        let height = (pose * point).dot(normal);
        if height - border <= prediction {
            manifold.points.push(TrackedContact::flipped(
                pose * point - normal * height,
                point + down * border,
                PackedFeatureId::face(0),
                id,
                height - border,
                flipped,
            ));
        }
    }
    manifold.match_contacts(&old);
    Ok(())
}
