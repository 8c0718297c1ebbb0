//! Piles of ten superellipsoids in a bin: this crate's shapes against convex hulls of 512 points of them, in the same rapier
//! worlds; and the whole of `settle`. CPU milliseconds a pile and the deepest overlap by the exact query.
//!
//! `cargo bench -p supersurface-physics --bench piles`; SUPERSURFACE_PILES says how many.

#![allow(clippy::print_stdout)]

#[path = "../tests/it/scenes.rs"]
mod scenes;

use cpu_time::ProcessTime;
use supersurface::contact::{Convex, contacts, half_space};
use supersurface::numeric::random::Stream;
use supersurface::shape::{Plane, Posed, Superellipsoid, SupportMap};
use supersurface::surface::Surface;
use supersurface::{Point, Pose};
use supersurface_physics::convert::{from_point, from_pose, to_pose};
use supersurface_physics::rapier::prelude::*;
use supersurface_physics::{
    Dispatcher, Falling, SettleOptions, integration_parameters, settle, shape,
};

/// Points of a hull.
const POINTS: usize = 512;
/// Simulated seconds.
const SECONDS: f64 = 3.0;

/// The hull of support points of even directions; `None` where parry finds none, as many of the points nearly coincide.
fn hull(solid: &Superellipsoid) -> Option<SharedShape> {
    let mut random = Stream::new(1, 1);
    let points: Vec<_> = (0..POINTS)
        .map(|_| {
            let n = supersurface::Vector::from_fn(|_, _| random.normal());
            from_point(&solid.support_point(&n))
        })
        .collect();
    SharedShape::convex_hull(&points)
}

/// Drops the shapes in the bin; returns where they are in the end.
fn drop_in_bin(shapes: &[SharedShape], starts: &[Pose], ours: bool) -> Vec<Pose> {
    let mut world = PhysicsWorld::new();
    world.gravity = Vector::new(0.0, 0.0, -9.81);
    world.integration_parameters = integration_parameters(0.03, 240.0);
    if ours {
        world.narrow_phase.set_query_dispatcher(Dispatcher);
    }
    let floor = SharedShape::halfspace(Vector::Z);
    world.insert_collider(ColliderBuilder::new(floor).friction(0.5), None);
    for (pose, [x, y, z]) in scenes::bin().cuboids {
        let wall = ColliderBuilder::cuboid(x, y, z).position(from_pose(&pose)).friction(0.5);
        world.insert_collider(wall, None);
    }
    let handles: Vec<_> = shapes
        .iter()
        .zip(starts)
        .map(|(shape, start)| {
            let body = RigidBodyBuilder::dynamic()
                .pose(from_pose(start))
                .angular_damping(18.0)
                .soft_ccd_prediction(0.03);
            let collider = ColliderBuilder::new(shape.clone()).density(800.0).friction(0.5);
            world.insert(body, collider).0
        })
        .collect();
    // never asleep, so that both do the same number of steps
    for handle in &handles {
        world.bodies[*handle].activation_mut().normalized_linear_threshold = -1.0;
    }
    for _ in 0..(SECONDS * 240.0) as usize {
        world.step();
    }
    handles.iter().map(|h| to_pose(world.bodies[*h].position())).collect()
}

/// The deepest overlap in metres between bodies and with the floor.
fn deepest(shapes: &[Superellipsoid], poses: &[Pose]) -> f64 {
    let bodies: Vec<_> = shapes
        .iter()
        .zip(poses)
        .map(|(s, pose)| Posed::new(Convex::new(*s).unwrap(), *pose).unwrap())
        .collect();
    let floor = Plane::through(&Point::origin(), supersurface::Vector::z_axis());
    let between = contacts(&bodies, 0.0).into_iter().map(|c| c.contact.distance);
    let below = bodies.iter().map(|b| half_space(b, &floor).distance);
    between.chain(below).fold(0.0, |worst: f64, d| worst.max(-d))
}

fn main() {
    let count = scenes::count("SUPERSURFACE_PILES", 20);
    let (mut times, mut depths) = ([0.0; 3], [const { Vec::new() }; 3]);
    for seed in 0..count {
        let (solids, starts) = scenes::pile(seed);
        let surfaces: Vec<_> = solids.iter().map(|s| Surface::Superellipsoid(*s)).collect();
        let exact: Vec<_> = surfaces.iter().map(|s| shape(s).unwrap()).collect();
        let Some(hulls) = solids.iter().map(hull).collect::<Option<Vec<_>>>() else {
            println!("seed {seed} is left out: a body has no hull");
            continue;
        };
        let bodies: Vec<Falling> =
            surfaces.iter().zip(&starts).map(|(s, at)| scenes::falling(*s, *at)).collect();
        let runs: [&dyn Fn() -> Vec<Pose>; 3] = [
            &|| drop_in_bin(&exact, &starts, true),
            &|| drop_in_bin(&hulls, &starts, false),
            &|| {
                let settled = settle(&bodies, &scenes::bin(), &SettleOptions::default()).unwrap();
                settled.bodies.iter().map(|body| body.pose).collect()
            },
        ];
        for (k, run) in runs.iter().enumerate() {
            let start = ProcessTime::now();
            let poses = run();
            times[k] += start.elapsed().as_secs_f64() * 1e3;
            depths[k].push(deepest(&solids, &poses) * 1e3);
        }
    }
    if depths[0].is_empty() {
        return;
    }
    let names = ["exact shapes", "hulls of 512 points", "settle"];
    for ((name, time), depths) in names.iter().zip(times).zip(&mut depths) {
        let time = time / depths.len() as f64;
        depths.sort_by(f64::total_cmp);
        let (middle, worst) = (depths[depths.len() / 2], depths[depths.len() - 1]);
        println!(
            "{name:20} {time:7.1} ms a pile, overlap {middle:.4} mm in the middle, {worst:.4} mm at most"
        );
    }
    println!("exact shapes take {:.2} of the time of the hulls", times[0] / times[1]);
}
