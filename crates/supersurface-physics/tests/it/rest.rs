//! Single bodies come to rest where they should: on a local minimum of the height of their centre.

use std::f64::consts::TAU;

use supersurface::mesh::Mesh;
use supersurface::nalgebra::Translation3;
use supersurface::numeric::random::Stream;
use supersurface::shape::{Superellipsoid, SupportMap};
use supersurface::surface::Surface;
use supersurface::{Point, Pose, Vector};
use supersurface_physics::{Ground, SettleOptions, settle};

use crate::scenes;

/// The direction near `down` in which the solid is lowest on its feet: a pattern search on the sphere of directions for a
/// local minimum of the support function.
fn stable(solid: &Superellipsoid, down: &Vector) -> Vector {
    let mut best = (solid.support(down), *down);
    let mut step = 0.02;
    while step > 1e-7 {
        let n = best.1;
        let aside = if n.x.abs() < 0.6 { Vector::x() } else { Vector::y() };
        let along = n.cross(&aside).normalize();
        let across = n.cross(&along);
        let lower = (0..16).find_map(|k| {
            let (sin, cos) = (TAU * k as f64 / 16.0).sin_cos();
            let m = (n + (along * cos + across * sin) * step).normalize();
            let height = solid.support(&m);
            (height < best.0 - 1e-15).then_some((height, m))
        });
        match lower {
            Some(found) => best = found,
            None => step *= 0.5,
        }
    }
    best.1
}

/// A floor at z = 0, as the half space, the top of a cuboid, or a mesh of 800 triangles.
fn floor(kind: u64, half: f64) -> Ground {
    let mut ground = Ground::default();
    if kind == 1 {
        ground.floor = None;
        ground.cuboids.push((Pose::translation(0.0, 0.0, -0.1 * half), [half, half, 0.1 * half]));
    }
    if kind == 2 {
        const N: u32 = 20;
        ground.floor = None;
        let at = |i: u32| (f64::from(i) / f64::from(N) * 2.0 - 1.0) * half;
        let nodes = (0..=N).flat_map(|i| (0..=N).map(move |j| Point::new(at(i), at(j), 0.0)));
        let squares = (0..N).flat_map(|i| (0..N).map(move |j| i * (N + 1) + j));
        let triangles = squares.flat_map(|a| {
            let [b, c, d] = [a + N + 1, a + N + 2, a + 1];
            [[a, b, c], [a, c, d]]
        });
        ground.mesh = Some(Mesh::new(nodes.collect(), triangles.collect()).unwrap());
    }
    ground
}

/// Semi-axes up to 1 cm to 1 m, exponents 0.1 to 1.9: within half a millimetre and a degree. `SUPERSURFACE_RESTS` says how
/// many are dropped.
#[test]
fn bodies_rest_on_stable_poses() {
    let count = scenes::count("SUPERSURFACE_RESTS", 18);
    let mut wrong = Vec::new();
    let mut worst = [0.0f64; 2];
    for k in 0..count {
        let mut random = Stream::new(3, k);
        let size = (random.uniform() * 100f64.ln()).exp() * 0.01;
        let axes = [0; 3].map(|_| size * random.between(0.35, 1.0));
        let exponents = [0; 2].map(|_| random.between(0.1, 1.9));
        let solid = Superellipsoid::new(axes, exponents).unwrap();
        let place = Translation3::new(0.0, 0.0, 2.0 * size);
        let start = Pose::from_parts(place, scenes::turn(&mut random));
        let body = scenes::falling(Surface::Superellipsoid(solid), start);
        let options = SettleOptions { time_limit: 20.0, ..SettleOptions::default() };
        let settled = settle(&[body], &floor(k % 3, 20.0 * size), &options).unwrap();
        let pose = settled.bodies[0].pose;
        let down = pose.rotation.inverse() * -Vector::z();
        let goal = stable(&solid, &down);
        let angle = down.angle(&goal).to_degrees();
        let height = (pose.translation.z - solid.support(&goal)).abs();
        worst = [worst[0].max(angle), worst[1].max(height)];
        if !(settled.all_at_rest() && height < 5e-4 && angle < 1.0) {
            wrong.push(format!("{k}: {angle} degrees, {height} m, {settled:?} of {solid:?}"));
        }
    }
    let figures = format!("{count} bodies, worst {worst:?}");
    // shown by --nocapture
    std::io::Write::write_all(&mut std::io::stderr(), figures.as_bytes()).unwrap();
    assert!(wrong.is_empty(), "{} of {figures}:\n{}", wrong.len(), wrong.join("\n"));
}
