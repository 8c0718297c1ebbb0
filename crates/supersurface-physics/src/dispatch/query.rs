//! Distances, contacts and casts of two shapes: exact between superellipsoids, parry's between all others.

use parry3d_f64::bounding_volume::BoundingVolume;
use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::details::ShapeCastOptions;
use parry3d_f64::query::{
    ClosestPoints, Contact, DefaultQueryDispatcher, NonlinearRigidMotion, QueryDispatcher,
    ShapeCastHit, ShapeDistance, ShapeIntersection, Unsupported,
};
use parry3d_f64::shape::{CompositeShape, Shape};
use supersurface::contact::WarmStart;

use super::{Dispatcher, exact};

impl QueryDispatcher for Dispatcher {
    fn intersection_test(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeIntersection, Unsupported> {
        match exact::superellipsoids(g1, g2) {
            Some(pair) => Ok(ShapeIntersection::from(exact::intersect(pos12, pair))),
            None => DefaultQueryDispatcher.intersection_test(pos12, g1, g2),
        }
    }

    fn distance(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
    ) -> Result<ShapeDistance, Unsupported> {
        match exact::superellipsoids(g1, g2) {
            Some(pair) => {
                let touch = exact::touch(pos12, pair, f64::INFINITY, &mut WarmStart::default());
                Ok(ShapeDistance::new(touch.distance.max(0.0)))
            }
            None => DefaultQueryDispatcher.distance(pos12, g1, g2),
        }
    }

    /// Of shapes with several parts, the nearest or deepest contact.
    fn contact(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: f64,
    ) -> Result<Option<Contact>, Unsupported> {
        if let Some(pair) = exact::superellipsoids(g1, g2) {
            let touch = exact::touch(pos12, pair, prediction, &mut WarmStart::default());
            return Ok(touch.points.map(|[p1, p2]| {
                let [n1, n2] = touch.normals;
                Contact::new(p1, p2, n1, n2, touch.distance)
            }));
        }
        // parry forgets to turn the pose around for a half space that comes second
        if g2.as_halfspace().is_some() && g1.as_halfspace().is_none() {
            let turned = self.contact(&pos12.inverse(), g2, g1, prediction)?;
            return Ok(turned.map(Contact::flipped));
        }
        match [g1.as_composite_shape(), g2.as_composite_shape()] {
            [Some(parts), _] => Ok(of_parts(pos12, parts, g2, prediction)),
            [None, Some(parts)] => {
                Ok(of_parts(&pos12.inverse(), parts, g1, prediction).map(Contact::flipped))
            }
            _ => DefaultQueryDispatcher.contact(pos12, g1, g2, prediction),
        }
    }

    fn closest_points(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        max_dist: f64,
    ) -> Result<ClosestPoints, Unsupported> {
        let Some(pair) = exact::superellipsoids(g1, g2) else {
            return DefaultQueryDispatcher.closest_points(pos12, g1, g2, max_dist);
        };
        let touch = exact::touch(pos12, pair, max_dist, &mut WarmStart::default());
        Ok(match touch.points {
            None => ClosestPoints::Disjoint,
            Some(_) if touch.distance <= 0.0 => ClosestPoints::Intersecting,
            Some([p1, p2]) => ClosestPoints::WithinMargin(p1, p2),
        })
    }

    fn cast_shapes(
        &self,
        pos12: &ParryPose,
        local_vel12: ParryVector,
        g1: &dyn Shape,
        g2: &dyn Shape,
        options: ShapeCastOptions,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes(pos12, local_vel12, g1, g2, options)
    }

    fn cast_shapes_nonlinear(
        &self,
        motion1: &NonlinearRigidMotion,
        g1: &dyn Shape,
        motion2: &NonlinearRigidMotion,
        g2: &dyn Shape,
        start_time: f64,
        end_time: f64,
        stop_at_penetration: bool,
    ) -> Result<Option<ShapeCastHit>, Unsupported> {
        DefaultQueryDispatcher.cast_shapes_nonlinear(
            motion1,
            g1,
            motion2,
            g2,
            start_time,
            end_time,
            stop_at_penetration,
        )
    }
}

/// The nearest or deepest contact of one of the parts with a shape.
fn of_parts(
    pos12: &ParryPose,
    parts: &(dyn CompositeShape + Sync),
    other: &dyn Shape,
    prediction: f64,
) -> Option<Contact> {
    let near = other.compute_aabb(pos12).loosened(prediction.max(0.0));
    let mut best: Option<Contact> = None;
    for leaf in parts.bvh().intersect_aabb(&near) {
        parts.map_part_at(leaf, &mut |pose, part, _| {
            let pose = pose.copied().unwrap_or_else(ParryPose::identity);
            let found = Dispatcher.contact(&pose.inv_mul(pos12), part, other, prediction);
            let Ok(Some(mut contact)) = found else { return };
            contact.point1 = pose * contact.point1;
            contact.normal1 = pose.rotation * contact.normal1;
            if best.as_ref().is_none_or(|b| contact.dist < b.dist) {
                best = Some(contact);
            }
        });
    }
    best
}
