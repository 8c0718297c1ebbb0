//! Pairs that nothing answers for, found before they fall through each other.

use std::any::{Any, TypeId};
use std::collections::HashSet;

use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::math::Vector as ParryVector;
use parry3d_f64::query::{ContactManifold, PersistentQueryDispatcher};
use parry3d_f64::shape::{Cuboid, Shape, ShapeType, Triangle};
use rapier3d_f64::dynamics::RigidBodySet;
use rapier3d_f64::geometry::ColliderSet;

use super::Dispatcher;

/// Two shapes between which no contacts can be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error(
    "no contacts are known between {first:?} and {second:?}: they would pass through each other"
)]
pub struct UnsupportedPair {
    /// Type of the first shape, of a part where it has some.
    pub first: ShapeType,
    /// Type of the second.
    pub second: ShapeType,
}

impl Dispatcher {
    /// Fails where contacts between two shapes, or between any of their parts, are not known.
    ///
    /// ```
    /// use supersurface_physics::{Dispatcher, parry::shape::{Ball, HalfSpace}, parry::math::Vector};
    /// let ground = HalfSpace::new(Vector::Z);
    /// assert!(Dispatcher.check(&ground, &Ball::new(0.1)).is_ok());
    /// assert!(Dispatcher.check(&ground, &ground).is_err());
    /// ```
    pub fn check(&self, first: &dyn Shape, second: &dyn Shape) -> Result<(), UnsupportedPair> {
        let mut result = Ok(());
        for_each_kind(first, &mut |a| {
            for_each_kind(second, &mut |b| {
                let mut manifold = ContactManifold::<(), ()>::new();
                // far apart, as only the kinds count
                let apart = ParryPose::from_translation(ParryVector::X * 1e6);
                let found = self.contact_manifold_convex_convex(
                    &apart,
                    a,
                    b,
                    None,
                    None,
                    0.0,
                    &mut manifold,
                );
                if found.is_err() && result.is_ok() {
                    result = Err(UnsupportedPair { first: a.shape_type(), second: b.shape_type() });
                }
            });
        });
        result
    }

    /// Fails where two colliders of a world could meet, one of them on a body that moves, and contacts between them are
    /// not known. Costs a query for each pair of different kinds of shapes; call it once the world is built.
    pub fn check_world(
        &self,
        bodies: &RigidBodySet,
        colliders: &ColliderSet,
    ) -> Result<(), UnsupportedPair> {
        let all: Vec<_> = colliders.iter().map(|(_, c)| c).collect();
        let mut seen = HashSet::new();
        for (k, first) in all.iter().enumerate() {
            for second in &all[..k] {
                let same = first.parent().is_some() && first.parent() == second.parent();
                let moves = [first, second].iter().any(|c| {
                    c.parent().and_then(|h| bodies.get(h)).is_some_and(|body| body.is_dynamic())
                });
                // shapes with parts may have any
                let kinds = [first, second].map(|c| (c.shape() as &dyn Any).type_id());
                let whole =
                    [first, second].iter().all(|c| c.shape().as_composite_shape().is_none());
                if moves && !same && (!whole || seen.insert(kinds)) {
                    self.check(first.shape(), second.shape())?;
                }
            }
        }
        Ok(())
    }
}

/// One part of each kind that a shape has.
fn for_each_kind(shape: &dyn Shape, each: &mut dyn FnMut(&dyn Shape)) {
    match shape.shape_type() {
        ShapeType::TriMesh | ShapeType::HeightField => {
            each(&Triangle::new(ParryVector::ZERO, ParryVector::X, ParryVector::Y));
        }
        ShapeType::Voxels => each(&Cuboid::new(ParryVector::ONE)),
        _ => match shape.as_composite_shape() {
            None => each(shape),
            Some(parts) => {
                let mut seen: Vec<TypeId> = Vec::new();
                for leaf in parts.bvh().leaves(|_| true) {
                    parts.map_part_at(leaf, &mut |_, part, _| {
                        let kind = (part as &dyn Any).type_id();
                        if !seen.contains(&kind) {
                            seen.push(kind);
                            each(part);
                        }
                    });
                }
            }
        },
    }
}
