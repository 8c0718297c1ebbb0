//! Manifolds have enough points to stand on, and pairs without any are errors.

use supersurface::shape::{Superellipsoid, Supertoroid};
use supersurface::surface::Surface;
use supersurface_physics::parry::math::{Pose, Vector};
use supersurface_physics::parry::query::{
    ContactManifold, PersistentQueryDispatcher, QueryDispatcher,
};
use supersurface_physics::parry::shape::{Ball, Shape, SharedShape};
use supersurface_physics::rapier::prelude::*;
use supersurface_physics::{Dispatcher, shape};

use crate::unsupported::OnlySupport;

fn superellipsoid(axes: [f64; 3], exponents: [f64; 2]) -> SharedShape {
    shape(&Surface::Superellipsoid(Superellipsoid::new(axes, exponents).unwrap())).unwrap()
}

fn manifolds(pos12: &Pose, g1: &dyn Shape, g2: &dyn Shape) -> Vec<ContactManifold<(), ()>> {
    let mut found = Vec::new();
    Dispatcher.contact_manifolds(pos12, g1, g2, 0.003, &mut found, &mut None).unwrap();
    found
}

#[test]
fn faces_touch_in_four_points_or_more() {
    let solids = [[0.1, 0.1], [0.3, 1.0], [0.1, 1.9], [0.6, 0.6]];
    let quad = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    let corners = quad.map(|[x, y]| Vector::new(x, y, 0.01)).to_vec();
    let grounds = [
        SharedShape::cuboid(1.0, 1.0, 0.01),
        SharedShape::trimesh(corners, vec![[0, 1, 2], [0, 2, 3]]).unwrap(),
        superellipsoid([0.1, 0.1, 0.01], [0.1, 0.1]),
    ];
    for exponents in solids {
        let solid = superellipsoid([0.03, 0.04, 0.05], exponents);
        // 0.1 mm over the ground, over the inside of one of the triangles
        let over = Pose::translation(0.01, -0.06, 0.0601);
        for (k, ground) in grounds.iter().enumerate() {
            let at = if k == 2 { Pose::translation(0.0, 0.0, 0.0601) } else { over };
            for found in
                [manifolds(&at, &**ground, &*solid), manifolds(&at.inverse(), &*solid, &**ground)]
            {
                let points = found.iter().map(|m| m.points.len()).max().unwrap();
                assert!(points >= 4, "{exponents:?} on {k}: {points}");
            }
        }
    }
}

#[test]
fn a_half_space_is_touched_in_five_points_of_which_one_is_the_lowest() {
    let ground = SharedShape::halfspace(Vector::Z);
    let solid = superellipsoid([0.03, 0.04, 0.05], [0.2, 0.7]);
    let pose = Pose::new(Vector::new(0.0, 0.0, 0.05), Vector::new(0.02, 0.01, 0.0));
    let lowest = Dispatcher.contact(&pose, &*ground, &*solid, 1.0).unwrap().unwrap().dist;
    let turned = Dispatcher.contact(&pose.inverse(), &*solid, &*ground, 1.0).unwrap().unwrap();
    assert!((turned.dist - lowest).abs() < 1e-15);
    for found in
        [manifolds(&pose, &*ground, &*solid), manifolds(&pose.inverse(), &*solid, &*ground)]
    {
        let points = &found[0].points;
        let least = points.iter().map(|p| p.dist).fold(f64::INFINITY, f64::min);
        assert!(points.len() == 5 && (least - lowest).abs() < 1e-12);
    }
}

#[test]
fn a_pair_without_contacts_is_an_error() {
    let solid = superellipsoid([0.03, 0.04, 0.05], [0.2, 0.7]);
    let ring = Surface::Supertoroid(Supertoroid::new([0.01; 3], 3.0, [1.0; 2]).unwrap());
    let ring = shape(&ring).unwrap();
    let supported = [
        solid.clone(),
        ring,
        SharedShape::cuboid(1.0, 1.0, 1.0),
        SharedShape::ball(0.1),
        SharedShape::halfspace(Vector::Z),
        SharedShape::capsule_z(0.1, 0.1),
    ];
    for other in &supported {
        Dispatcher.check(&*solid, &**other).unwrap();
    }
    let only = SharedShape::new(OnlySupport(Ball::new(0.1)));
    assert!(Dispatcher.check(&*solid, &*only).is_err());
    let halves = SharedShape::compound(vec![(Pose::identity(), only.clone())]);
    assert!(Dispatcher.check(&*halves, &*solid).is_err());

    let mut world = PhysicsWorld::new();
    world.insert_collider(ColliderBuilder::new(only), None);
    Dispatcher.check_world(&world.bodies, &world.colliders).unwrap();
    world.insert(RigidBodyBuilder::dynamic(), ColliderBuilder::new(solid));
    let error = Dispatcher.check_world(&world.bodies, &world.colliders).unwrap_err();
    assert!(error.to_string().contains("Custom"), "{error}");
}
