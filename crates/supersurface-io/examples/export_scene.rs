//! Writes scenes as files for simulators and viewers, in all formats: `cargo run --example export_scene FOLDER` makes a
//! folder each of a laid table and of things that are hard to export. `compare/check_export.py` loads what is written.

use std::error::Error;
use std::f64::consts::FRAC_PI_2;
use std::path::PathBuf;

use nalgebra::UnitQuaternion;
use supersurface::combine::{Assembly, Joint, JointKind, Part};
use supersurface::scene::{Board, Body, FRICTION, Scene, demo};
use supersurface::shape::{InvalidShape, Posed, Superellipsoid, Supertoroid};
use supersurface::surface::Surface;
use supersurface::{Point, Pose, Vector};
use supersurface_io::{SceneCamera, SceneExtras, SceneFormat, Site, write_scene};

fn main() -> Result<(), Box<dyn Error>> {
    let folder =
        std::env::args_os().nth(1).map(PathBuf::from).ok_or("usage: export_scene FOLDER")?;
    let table = demo(1)?;
    let name = "overview".to_owned();
    let camera = SceneCamera { name, camera: table.camera, pose: table.camera_pose };
    let above = UnitQuaternion::from_axis_angle(&Vector::x_axis(), 2.0 * FRAC_PI_2);
    let site =
        Site { name: "grasp 1".to_owned(), pose: Pose::from_parts([0.1, 0.0, 0.15].into(), above) };
    let extras = SceneExtras { cameras: vec![camera], sites: vec![site], ..Default::default() };
    write_scene(&folder.join("table"), &table.scene, &extras, &SceneFormat::ALL)?;
    write_scene(&folder.join("workshop"), &workshop()?, &extras, &SceneFormat::ALL)?;
    Ok(())
}

/// A hammer, a bear on springs, a ring, a cup, a banana and a twisted bar, between two boards.
fn workshop() -> Result<Scene, InvalidShape> {
    let mut scene = Scene::empty([0.5, 0.4]);
    let solid = |a, e| Superellipsoid::new(a, e);
    let ring = Supertoroid::new([0.0125, 0.0125, 0.015], 3.0, [0.8, 1.0])?;
    let ring = Surface::Supertoroid(ring);
    scene.bodies.push(Body::single("ring <a&\"b\">", ring, Pose::translation(0.2, 0.1, 0.015))?);
    let cup = Surface::tapered(solid([0.03, 0.03, 0.05], [0.1, 1.0])?, [0.2, 0.2])?;
    scene.bodies.push(Body::single("../../cup", cup, Pose::translation(0.2, -0.1, 0.05))?);
    let lying = UnitQuaternion::from_axis_angle(&Vector::x_axis(), FRAC_PI_2);
    let banana = Surface::bent(solid([0.016, 0.016, 0.08], [0.1, 0.8])?, 10.0, 0.0)?;
    let pose = Pose::from_parts([0.0, 0.15, 0.016].into(), lying);
    scene.bodies.push(Body::single("banana", banana, pose)?);
    let bar = Surface::twisted(solid([0.02, 0.03, 0.04], [0.1, 0.1])?, 0.25)?;
    scene.bodies.push(Body::single("", bar, Pose::translation(-0.05, -0.15, 0.04))?);
    scene.bodies.push(hammer()?);
    scene.bodies.push(bear()?);
    for (name, y) in [("wall", 0.35), ("wall", -0.35)] {
        let pose = Pose::translation(0.0, y, 0.05);
        scene.boards.push(Board { name: name.to_owned(), half_extents: [0.4, 0.01, 0.05], pose });
    }
    Ok(scene)
}

fn part(
    name: &str,
    a: [f64; 3],
    e: [f64; 2],
    at: [f64; 3],
    density: f64,
) -> Result<Part<Surface>, InvalidShape> {
    let surface = Surface::Superellipsoid(Superellipsoid::new(a, e)?);
    Part::new(name, Posed::new(surface, Pose::translation(at[0], at[1], at[2]))?, density)
}

/// Standing on its steel head, with a wooden handle.
fn hammer() -> Result<Body, InvalidShape> {
    let parts = vec![
        part("head", [0.05, 0.02, 0.02], [0.2, 0.2], [0.0, 0.0, 0.0], 7800.0)?,
        part("handle", [0.012, 0.015, 0.1], [0.2, 1.0], [0.0, 0.0, 0.11], 700.0)?,
    ];
    let neck = Joint::new(0, 1, Point::new(0.0, 0.0, 0.02), JointKind::Fixed)?;
    let shape = Assembly::new(parts, vec![neck])?;
    let pose = Pose::translation(-0.2, 0.1, 0.02);
    Ok(Body { name: "hammer".to_owned(), shape, pose, friction: 0.8 })
}

/// A trunk that lies on its back, with a head and four limbs on springs; one limb at rest is turned.
fn bear() -> Result<Body, InvalidShape> {
    let trunk = part("trunk", [0.04, 0.03, 0.025], [0.6, 0.8], [0.0; 3], 300.0)?;
    let mut parts =
        vec![trunk, part("head", [0.022, 0.022, 0.022], [1.0, 1.0], [0.06, 0.0, 0.0], 300.0)?];
    let spring = |turn: Vector| JointKind::Spring {
        stiffness: 2.0,
        damping: 0.01,
        rest: UnitQuaternion::from_scaled_axis(turn),
    };
    let mut joints = vec![Joint::new(0, 1, Point::new(0.04, 0.0, 0.0), spring(Vector::zeros()))?];
    for (x, y) in [(0.03, 0.045), (0.03, -0.045), (-0.035, 0.045), (-0.035, -0.045)] {
        let child = parts.len();
        parts.push(part("limb", [0.012, 0.022, 0.012], [0.8, 0.8], [x, y, 0.0], 300.0)?);
        let turn = if child == 3 { Vector::z() * 0.5 } else { Vector::zeros() };
        joints.push(Joint::new(0, child, Point::new(x, 0.5 * y, 0.0), spring(turn))?);
    }
    let shape = Assembly::new(parts, joints)?;
    let pose = Pose::translation(-0.2, -0.15, 0.025);
    Ok(Body { name: "Bär".to_owned(), shape, pose, friction: FRICTION })
}
