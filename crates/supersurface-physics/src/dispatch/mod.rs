//! Which query answers for which two shapes: a dispatcher for parry and rapier.
//!
//! | pair | contact and distance | manifold |
//! |---|---|---|
//! | two superellipsoids | exact ([`supersurface::contact::pair`]), warm started | polygons clipped, and the exact point |
//! | a half space and a [`ConvexSolid`] or a ring | exact | four points of the solid, and the exact lowest one |
//! | a [`ConvexSolid`] and a cuboid, hull, triangle, … | by parry's GJK and EPA | polygons clipped, and the nearest point |
//! | cut solids, compounds, meshes | those of their parts | those of their parts |
//! | anything else | parry's default | parry's default |
//!
//! A pair that nothing answers for would fall through each other in silence, as rapier does not report it:
//! [`Dispatcher::check`] and [`Dispatcher::check_world`] make it an error.

mod exact;
mod manifold;
mod query;
mod search;
mod supported;

use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::query::details::{
    ContactManifoldsWorkspace, NormalConstraints,
    contact_manifolds_composite_shape_composite_shape, contact_manifolds_composite_shape_shape,
    contact_manifolds_trimesh_shape_shapes,
};
use parry3d_f64::query::{
    ContactManifold, DefaultQueryDispatcher, PersistentQueryDispatcher, Unsupported,
};
use parry3d_f64::shape::{Shape, ShapeType};
use supersurface::contact::WarmStart;

pub use self::supported::UnsupportedPair;
use crate::convex::ConvexSolid;
use crate::pieces::Pieces;

/// The dispatcher: it answers for this crate's shapes and leaves all others to parry's default one.
///
/// ```
/// use supersurface_physics::{Dispatcher, rapier::prelude::*};
/// let mut world = PhysicsWorld::new();
/// world.narrow_phase.set_query_dispatcher(Dispatcher);
/// ```
#[derive(Clone, Copy, Debug, Default)]
pub struct Dispatcher;

impl<M, C> PersistentQueryDispatcher<M, C> for Dispatcher
where
    M: Default + Clone + Send + Sync,
    C: Default + Copy + Send + Sync,
{
    fn contact_manifolds(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        prediction: f64,
        manifolds: &mut Vec<ContactManifold<M, C>>,
        workspace: &mut Option<ContactManifoldsWorkspace>,
    ) -> Result<(), Unsupported> {
        // a half space touches nothing of a ring but its hull
        let [g1, g2] = match [g1.as_halfspace(), g2.as_halfspace()] {
            [Some(_), None] => [g1, hull(g2)],
            [None, Some(_)] => [hull(g1), g2],
            _ => [g1, g2],
        };
        // the order of parry's own; the parts of a shape with parts come back to this dispatcher
        let is = |kind: ShapeType| [g1, g2].iter().any(|g| g.shape_type() == kind);
        match [g1.as_composite_shape(), g2.as_composite_shape()] {
            [Some(parts1), Some(parts2)] => contact_manifolds_composite_shape_composite_shape(
                self, pos12, parts1, parts2, prediction, manifolds, workspace,
            ),
            _ if is(ShapeType::TriMesh) => contact_manifolds_trimesh_shape_shapes(
                self, pos12, g1, g2, prediction, manifolds, workspace,
            ),
            _ if is(ShapeType::HeightField) || is(ShapeType::Voxels) => {
                return DefaultQueryDispatcher
                    .contact_manifolds(pos12, g1, g2, prediction, manifolds, workspace);
            }
            [Some(parts), None] => contact_manifolds_composite_shape_shape(
                self, pos12, parts, g2, prediction, manifolds, workspace, false,
            ),
            [None, Some(parts)] => {
                let pos21 = pos12.inverse();
                contact_manifolds_composite_shape_shape(
                    self, &pos21, parts, g1, prediction, manifolds, workspace, true,
                );
            }
            [None, None] => {
                if manifolds.is_empty() {
                    manifolds.push(ContactManifold::new());
                }
                let Some(manifold) = manifolds.first_mut() else { return Ok(()) };
                let Some(pair) = exact::superellipsoids(g1, g2) else {
                    return self.contact_manifold_convex_convex(
                        pos12, g1, g2, None, None, prediction, manifold,
                    );
                };
                let touch = exact::touch_again(pos12, pair, prediction, workspace);
                manifold::fill(manifold, pos12, [g1, g2], [None, None], touch);
            }
        }
        Ok(())
    }

    fn contact_manifold_convex_convex(
        &self,
        pos12: &ParryPose,
        g1: &dyn Shape,
        g2: &dyn Shape,
        constraints1: Option<&dyn NormalConstraints>,
        constraints2: Option<&dyn NormalConstraints>,
        prediction: f64,
        manifold: &mut ContactManifold<M, C>,
    ) -> Result<(), Unsupported> {
        let ours = |g: &dyn Shape| g.as_shape::<ConvexSolid>().is_some();
        let is = |kind: ShapeType| [g1, g2].iter().any(|g| g.shape_type() == kind);
        if is(ShapeType::Ball) || !(ours(g1) || ours(g2)) {
            return DefaultQueryDispatcher.contact_manifold_convex_convex(
                pos12,
                g1,
                g2,
                constraints1,
                constraints2,
                prediction,
                manifold,
            );
        }
        if is(ShapeType::HalfSpace) {
            return manifold::fill_on_half_space(manifold, pos12, [g1, g2], prediction);
        }
        let touch = match exact::superellipsoids(g1, g2) {
            Some(pair) => exact::touch(pos12, pair, prediction, &mut WarmStart::default()),
            None => manifold::touch_by_search(manifold, pos12, [g1, g2], prediction)?,
        };
        manifold::fill(manifold, pos12, [g1, g2], [constraints1, constraints2], touch);
        Ok(())
    }
}

/// The convex hull of a cut solid where it is known, else the shape itself.
fn hull(shape: &dyn Shape) -> &dyn Shape {
    match shape.as_shape::<Pieces>().and_then(Pieces::hull) {
        Some(hull) => hull,
        None => shape,
    }
}
