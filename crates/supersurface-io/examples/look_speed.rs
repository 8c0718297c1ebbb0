//! CPU time of the depth frame that the first camera of a scene sees, on one core, into new images and over the images of the
//! frame before, and what another ray caster needs to make the same frame:
//! `cargo run --release --example look_speed SCENE.json OUT --tolerance 1e-4`.
//!
//! OUT gets a mesh of each part in the world, `part_000.ply` and on, no farther than the tolerance (in metres) from the
//! surface, and `depth.f32`, the depths along the optical axis by rows. `compare/look_open3d.py` reads them.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::path::Path;

use cpu_time::ProcessTime;
use supersurface::mesh::tessellate;
use supersurface::scene::{DepthNoise, look};
use supersurface::surface::Solid;
use supersurface_io::{read_scene, write_mesh};

/// Runs of which the fastest counts.
const RUNS: usize = 7;

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [scene, out, option, tolerance] = arguments.as_slice() else {
        return Err("usage: look_speed SCENE.json OUT --tolerance METRES".into());
    };
    if option != "--tolerance" {
        return Err(format!("{option}: only --tolerance is known").into());
    }
    let (out, tolerance) = (Path::new(out), tolerance.parse()?);
    let read = read_scene(Path::new(scene))?;
    let scene_camera = read.extras.cameras.first().ok_or("the scene has no camera")?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build()?;
    let (camera, pose, none) = (&scene_camera.camera, &scene_camera.pose, DepthNoise::none());
    let frame = || pool.install(|| look(&read.scene, camera, pose, &none, 0));
    let mut seen = frame();
    let fresh = fastest(|| drop(frame()));
    let again = fastest(|| pool.install(|| seen.again(&read.scene, camera, pose, &none, 0)));
    std::fs::create_dir_all(out)?;
    let depths: Vec<u8> = seen.depth.depth().iter().flat_map(|z| z.to_le_bytes()).collect();
    std::fs::write(out.join("depth.f32"), depths)?;
    let solids: Vec<_> = read.scene.bodies.iter().flat_map(|body| body.solids()).collect();
    for (k, solid) in solids.iter().enumerate() {
        let mesh = tessellate(&Solid::from(*solid.shape()), Some(tolerance))?.mesh;
        write_mesh(&out.join(format!("part_{k:03}.ply")), &mesh.moved(solid.pose()))?;
    }
    println!("{fresh:.3} ms, again {again:.3} ms, best of {RUNS}, {} parts", solids.len());
    Ok(())
}

/// CPU milliseconds.
fn fastest(mut work: impl FnMut()) -> f64 {
    let timed = |_| {
        let began = ProcessTime::now();
        work();
        1e3 * began.elapsed().as_secs_f64()
    };
    (0..RUNS).map(timed).fold(f64::INFINITY, f64::min)
}
