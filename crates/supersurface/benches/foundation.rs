//! Microseconds of a mesh against a supersurface, on one core: the whole query, a vertex of the mesh near the solid, and
//! the same vertex by vertex, by closest points and with derivatives.
//!
//! `cargo bench -p supersurface --bench foundation`

#![allow(clippy::print_stdout)]

use std::hint::black_box;

use cpu_time::ProcessTime;
use supersurface::contact::{
    ByClosestPoint, Foundation, FoundationOptions, SmoothlyIndented, Twist,
};
use supersurface::mesh::tessellate;
use supersurface::numeric::random::Stream;
use supersurface::shape::{Implicit, Posed, Superellipsoid, Supertoroid};
use supersurface::{Point, Pose, Vector};

/// Poses of the mesh, and runs over them of which the best counts.
const POSES: usize = 200;
const RUNS: usize = 5;

fn main() {
    let finger = Superellipsoid::new([0.01, 0.012, 0.03], [0.6, 0.8]).unwrap();
    for tolerance in [1e-3, 1e-4, 1e-5] {
        let mesh = tessellate(&finger, Some(tolerance)).unwrap().mesh;
        let foundation = Foundation::new(&mesh).unwrap();
        println!("a finger of {} vertices, {} poses", mesh.vertices().len(), POSES);
        let tin = Superellipsoid::new([0.03, 0.04, 0.05], [0.3, 1.2]).unwrap();
        let ring = Supertoroid::new([0.015, 0.02, 0.02], 2.5, [0.8, 1.1]).unwrap();
        report("superellipsoid", &tin, &foundation);
        report("supertoroid", &ring, &foundation);
        let (exact_tin, exact_ring) =
            (ByClosestPoint::superellipsoid(&tin), ByClosestPoint::supertoroid(&ring));
        closest("superellipsoid", exact_tin, &foundation);
        closest("supertoroid", exact_ring, &foundation);
    }
}

/// Poses in which the finger's tip is in the solid.
fn poses(solid: &impl Implicit) -> Vec<Pose> {
    let mut random = Stream::new(8, 0);
    let mut poses = Vec::new();
    let [low, high] = solid.bounds();
    while poses.len() < POSES {
        let p = Vector::from_fn(|k, _| random.between(low[k], high[k]));
        let turn = Vector::from_fn(|_, _| random.between(-2.0, 2.0));
        let pose = Pose::new(p, turn);
        let tip = pose * Point::new(0.0, 0.0, 0.03);
        if (0.8..0.95).contains(&solid.gauge(&tip)) {
            poses.push(pose);
        }
    }
    poses
}

/// Best mean of some runs, in microseconds a pose.
fn timed(poses: &[Pose], mut run: impl FnMut(&Pose)) -> f64 {
    let once = |_| {
        let began = ProcessTime::now();
        poses.iter().for_each(&mut run);
        began.elapsed().as_secs_f64() * 1e6 / poses.len() as f64
    };
    (0..RUNS).map(once).fold(f64::INFINITY, f64::min)
}

fn report<S: SmoothlyIndented>(name: &str, shape: &S, foundation: &Foundation) {
    let solid = Posed::new(shape, Pose::identity()).unwrap();
    let (rest, options) = (Twist::default(), FoundationOptions::default());
    let poses = poses(shape);
    let inside: usize =
        poses.iter().map(|p| foundation.press(p, &solid, &rest, &options).unwrap().vertices).sum();
    let inside = inside as f64 / poses.len() as f64;
    let fast = timed(&poses, |p| {
        black_box(foundation.press(p, &solid, &rest, &options).unwrap());
    });
    let plain = timed(&poses, |p| {
        black_box(foundation.forces(p, &solid, &rest, &options).unwrap());
    });
    let slope = timed(&poses, |p| {
        let found = foundation.press_derivative(p, &solid, 1e8, &Point::origin());
        black_box(found.unwrap());
    });
    println!(
        "  {name:15} {inside:6.0} inside   {fast:8.2} µs a query, {:5.1} ns a vertex inside   one by one {:5.1} times as long   derivatives {slope:8.2} µs",
        1e3 * fast / inside,
        plain / fast,
    );
}

fn closest<S: Implicit + Clone>(name: &str, exact: ByClosestPoint<S>, foundation: &Foundation) {
    let (rest, options) = (Twist::default(), FoundationOptions::default());
    let poses = poses(&exact);
    let time = |exact: &ByClosestPoint<S>| {
        let solid = Posed::new(exact, Pose::identity()).unwrap();
        timed(&poses[..20], |p| {
            black_box(foundation.press(p, &solid, &rest, &options).unwrap());
        })
    };
    println!(
        "  {name:15} closest points {:8.1} µs a query, from the foot alone {:8.1} µs",
        time(&exact),
        time(&exact.clone().from_foot())
    );
}
