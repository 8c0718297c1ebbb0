//! MJCF for MuJoCo 3.3.5 and later.
//!
//! A plain member is a mesh that MuJoCo makes from its numbers: `supersphere` with (ε2, ε1), `supertorus` with 1/a4 and
//! (ε1, ε2) and the semi-axes times a4. A contact has the larger friction of both sides, so what stands still has none.
//! Links of one body pass through each other, as those of other formats do by default: parts overlap at their joints.

use super::links::{FixedBox, Link, LinkPart, Prepared, Tree};
use super::xml::{Element, numbers};
use super::{Files, GRAVITY, MESHES};
use nalgebra::UnitQuaternion;
use std::f64::consts::PI;
use supersurface::surface::Surface;
use supersurface::{Pose, Vector};

/// Angular steps of MuJoCo's own meshes.
const RESOLUTION: [u32; 2] = [40, 64];

pub(super) fn add(prepared: &Prepared<'_>, files: &mut Files) {
    let compiler = Element::new("compiler").with("angle", "radian").with("meshdir", MESHES);
    let option = Element::new("option")
        .with("gravity", numbers(&[0.0, 0.0, -GRAVITY]))
        .with("integrator", "implicitfast")
        .with("cone", "elliptic")
        .with("impratio", 10);
    let class = |name: &str, geom: Element| Element::new("default").with("class", name).child(geom);
    let seen = Element::new("geom").with("contype", 0).with("conaffinity", 0).with("group", 2);
    let felt = Element::new("geom").with("group", 3);
    let defaults = Element::new("default")
        .child(Element::new("geom").with("condim", 4))
        .child(class("seen", seen.with("density", 0)))
        .child(class("felt", felt.with("density", 0)));

    let mut assets = Vec::new();
    let mut world: Vec<Element> = prepared.boxes.iter().map(fixed).collect();
    let mut excluded = Vec::new();
    for tree in &prepared.bodies {
        world.push(body(tree, 0, &mut assets, files));
        for (i, a) in tree.links.iter().enumerate() {
            excluded.extend(
                tree.links
                    .iter()
                    .skip(i + 1)
                    .map(|b| Element::new("exclude").with("body1", &a.id).with("body2", &b.id)),
            );
        }
    }
    world.extend(prepared.sites.iter().map(|(id, site)| {
        posed(Element::new("site").with("name", id), &site.pose).with("size", 0.005)
    }));
    world.extend(prepared.cameras.iter().map(|(id, c)| {
        // MuJoCo's cameras look against z, with y up
        let turn = UnitQuaternion::from_axis_angle(&Vector::x_axis(), PI);
        let [width, height] = c.camera.size();
        let fovy = 2.0 * (0.5 * height as f64 / c.camera.focal()[1]).atan();
        posed(Element::new("camera").with("name", id), &(c.pose * turn))
            .with("fovy", fovy)
            .with("resolution", format!("{width} {height}"))
    }));
    let root = Element::new("mujoco")
        .with("model", "scene")
        .child(compiler)
        .child(option)
        .child(defaults)
        .child(Element::new("asset").children(assets))
        .child(Element::new("worldbody").children(world))
        .child(Element::new("contact").children(excluded));
    files.add("scene.xml", root.document());
}

fn fixed(fixed: &FixedBox) -> Element {
    let geom = Element::new("geom").with("name", &fixed.id).with("type", "box");
    posed(geom.with("size", numbers(&fixed.half_extents)), &fixed.pose)
        .with("friction", "0 0.005 0.0001")
        .with("rgba", "0.75 0.7 0.62 1")
}

/// A link with all that hangs from it.
fn body(tree: &Tree<'_>, index: usize, assets: &mut Vec<Element>, files: &mut Files) -> Element {
    let Some(link) = tree.links.get(index) else { return Element::new("body") };
    let start = Element::new("body").with("name", &link.id);
    let parent = link.joint.as_ref().and_then(|j| tree.links.get(j.parent));
    let mut element = match (&link.joint, parent) {
        (Some(ball), Some(parent)) => {
            let joint = Element::new("joint").with("name", &link.id).with("type", "ball");
            let joint = joint.with("stiffness", ball.stiffness).with("damping", ball.damping);
            start.with("pos", numbers((link.origin - parent.origin).as_slice())).child(joint)
        }
        _ => posed(start, &tree.body.pose).child(Element::new("freejoint").with("name", &link.id)),
    };
    element = element.child(inertial(link));
    for part in &link.parts {
        element = element.children(geoms(part, tree.body.friction, assets, files));
    }
    let hanging = |l: &Link| l.joint.as_ref().is_some_and(|j| j.parent == index);
    let children = tree.links.iter().enumerate().filter(|(_, l)| hanging(l));
    for (child, _) in children {
        element = element.child(body(tree, child, assets, files));
    }
    element
}

fn inertial(link: &Link) -> Element {
    let i = &link.mass.inertia;
    let full = [i[(0, 0)], i[(1, 1)], i[(2, 2)], i[(0, 1)], i[(0, 2)], i[(1, 2)]];
    Element::new("inertial")
        .with("pos", numbers(link.mass.centre.coords.as_slice()))
        .with("mass", link.mass.mass)
        .with("fullinertia", numbers(&full))
}

/// One geom, or one to be seen and the pieces that are felt.
fn geoms(
    part: &LinkPart,
    friction: f64,
    assets: &mut Vec<Element>,
    files: &mut Files,
) -> Vec<Element> {
    let rough = |geom: Element| geom.with("friction", numbers(&[friction, 0.005, 0.0001]));
    let pose = part.solid.pose();
    let geom = |kind: &str, name: &str| {
        posed(Element::new("geom").with("name", name).with("type", kind), pose)
    };
    if part.is_ellipsoid() {
        let size = numbers(&part.solid.shape().semi_axes());
        return vec![rough(geom("ellipsoid", &part.id).with("size", size).with("mass", 0))];
    }
    assets.push(mesh(part, files));
    let whole = geom("mesh", &part.id).with("mesh", &part.id);
    if part.pieces.is_empty() {
        return vec![rough(whole.with("mass", 0))];
    }
    let mut geoms = vec![whole.with("class", "seen")];
    for file in files.add_pieces(part) {
        let name = file.trim_end_matches(".obj").to_owned();
        assets.push(Element::new("mesh").with("name", &name).with("file", file));
        geoms.push(rough(geom("mesh", &name).with("mesh", &name).with("class", "felt")));
    }
    geoms
}

/// The mesh of a part: MuJoCo's own, or a file for what is deformed.
fn mesh(part: &LinkPart, files: &mut Files) -> Element {
    let asset = Element::new("mesh").with("name", &part.id);
    let [around, ring] = RESOLUTION;
    let built_in = |kind: &str, parameters: String, scale: [f64; 3]| {
        let asset = Element::new("mesh").with("name", &part.id).with("builtin", kind);
        asset.with("params", parameters).with("scale", numbers(&scale)).with("inertia", "exact")
    };
    match part.solid.shape() {
        Surface::Superellipsoid(s) => {
            let [e1, e2] = s.exponents();
            built_in("supersphere", format!("{around} {e2} {e1}"), s.semi_axes())
        }
        Surface::Supertoroid(s) => {
            let (a4, [e1, e2]) = (s.ring_ratio(), s.exponents());
            let parameters = format!("{ring} {} {e1} {e2}", 1.0 / a4);
            built_in("supertorus", parameters, s.semi_axes().map(|a| a * a4))
        }
        _ => asset.with("file", files.add_obj(&part.id, &part.mesh)),
    }
}

fn posed(element: Element, pose: &Pose) -> Element {
    let q = pose.rotation.into_inner();
    element
        .with("pos", numbers(pose.translation.vector.as_slice()))
        .with("quat", numbers(&[q.w, q.i, q.j, q.k]))
}
