//! URDF: `scene.urdf` with all bodies on floating joints, and a file a body for programs that place bodies themselves.
//!
//! URDF has neither ball joints nor springs. A ball becomes three joints about x, y and z with two light links between
//! them, each of a ten thousandth of what it carries; the damping is kept, the stiffness lost. What follows the
//! standard's own elements is for one program each: MuJoCo (the path of meshes), PyBullet and Drake (friction).

use nalgebra::{Matrix3, UnitQuaternion};
use supersurface::shape::Mass;
use supersurface::{Pose, Vector};

use super::links::{FixedBox, Link, Prepared, Tree};
use super::xml::{Element, numbers};
use super::{Files, MESHES};

/// Mass and inertia of the links within a ball joint, as a share of the link that it carries.
const LIGHT: f64 = 1e-4;

pub(super) fn add(prepared: &Prepared<'_>, files: &mut Files) {
    let rough = prepared.bodies.iter().map(|b| b.body.friction).fold(1.0, f64::max);
    let mut all = robot("scene").child(Element::new("link").with("name", "world"));
    for fixed in &prepared.boxes {
        all = all.children(board(fixed, rough));
    }
    for tree in &prepared.bodies {
        let links = links(tree, files);
        let joint = joint(&tree.id, "floating", "world", &tree.id, &tree.body.pose);
        all = all.child(joint).children(links);
    }
    for (id, site) in &prepared.sites {
        let link = Element::new("link").with("name", id);
        all = all.child(link).child(joint(id, "fixed", "world", id, &site.pose));
    }
    files.add("scene.urdf", all.document());
    for tree in &prepared.bodies {
        let alone = robot(&tree.id).children(links(tree, files));
        files.add(format!("{}.urdf", tree.id), alone.document());
    }
}

fn robot(name: &str) -> Element {
    // MuJoCo takes folders off paths otherwise, and drops what is only seen
    let compiler =
        Element::new("compiler").with("strippath", "false").with("discardvisual", "false");
    Element::new("robot")
        .with("name", name)
        .with("xmlns:drake", "http://drake.mit.edu")
        .child(Element::new("mujoco").child(compiler))
}

/// A fixed link with the mass of light wood, for programs that want one of every link.
fn board(fixed: &FixedBox, friction: f64) -> [Element; 2] {
    let [x, y, z] = fixed.half_extents;
    let weight = 500.0 * 8.0 * x * y * z;
    let inertia = Vector::new(y * y + z * z, x * x + z * z, x * x + y * y) * (weight / 3.0);
    let mass = Mass {
        mass: weight,
        centre: Default::default(),
        inertia: Matrix3::from_diagonal(&inertia),
    };
    let size = numbers(&fixed.half_extents.map(|h| 2.0 * h));
    let shape = |kind| {
        let geometry = Element::new("geometry").child(Element::new("box").with("size", &size));
        Element::new(kind).child(geometry)
    };
    let link = Element::new("link")
        .with("name", &fixed.id)
        .child(inertial(&mass))
        .child(shape("visual"))
        .child(shape("collision").child(drake_friction(friction)))
        .child(bullet_friction(friction));
    [link, joint(&fixed.id, "fixed", "world", &fixed.id, &fixed.pose)]
}

/// A body's links and the joints between them.
fn links(tree: &Tree<'_>, files: &mut Files) -> Vec<Element> {
    let mut all = Vec::new();
    for link in &tree.links {
        let mut element = Element::new("link").with("name", &link.id).child(inertial(&link.mass));
        for part in &link.parts {
            let shape = |kind, file: &str| {
                let mesh = Element::new("mesh").with("filename", format!("{MESHES}/{file}"));
                let geometry = Element::new("geometry").child(mesh);
                Element::new(kind).child(origin(part.solid.pose())).child(geometry)
            };
            let seen = files.add_obj(&part.id, &part.mesh);
            element = element.child(shape("visual", &seen).with("name", &part.id));
            for (k, file) in files.add_pieces(part).iter().enumerate() {
                let name = format!("{}_contact_{k}", part.id);
                let felt = shape("collision", file).with("name", name);
                element = element.child(felt.child(drake_friction(tree.body.friction)));
            }
        }
        all.push(element.child(bullet_friction(tree.body.friction)));
        if let Some((ball, parent)) =
            link.joint.as_ref().and_then(|j| Some((j, tree.links.get(j.parent)?)))
        {
            all.extend(three_joints(link, parent, ball.damping));
        }
    }
    all
}

fn three_joints(link: &Link, parent: &Link, damping: f64) -> Vec<Element> {
    let light = Mass {
        mass: link.mass.mass * LIGHT,
        centre: Default::default(),
        inertia: link.mass.inertia * LIGHT,
    };
    let names = ["x", "y"].map(|axis| format!("{}.turned_{axis}", link.id));
    let chain = [&parent.id, &names[0], &names[1], &link.id];
    let mut all: Vec<Element> = names
        .iter()
        .map(|name| Element::new("link").with("name", name).child(inertial(&light)))
        .collect();
    let steps = chain.iter().zip(chain.iter().skip(1)).zip(["x", "y", "z"]);
    for (k, ((from, to), letter)) in steps.enumerate() {
        let at = if k == 0 { link.origin - parent.origin } else { Vector::zeros() };
        let pose = Pose::from_parts(at.into(), UnitQuaternion::identity());
        let axis = numbers(Vector::ith(k, 1.0).as_slice());
        let name = format!("{}.{letter}", link.id);
        all.push(
            joint(&name, "continuous", from, to, &pose)
                .child(Element::new("axis").with("xyz", axis))
                .child(Element::new("dynamics").with("damping", damping)),
        );
    }
    all
}

fn joint(name: &str, kind: &str, parent: &str, child: &str, pose: &Pose) -> Element {
    Element::new("joint")
        .with("name", format!("{name}_joint"))
        .with("type", kind)
        .child(origin(pose))
        .child(Element::new("parent").with("link", parent))
        .child(Element::new("child").with("link", child))
}

fn inertial(mass: &Mass) -> Element {
    let i = &mass.inertia;
    let centre = Pose::from_parts(mass.centre.coords.into(), UnitQuaternion::identity());
    let inertia = Element::new("inertia")
        .with("ixx", i[(0, 0)])
        .with("ixy", i[(0, 1)])
        .with("ixz", i[(0, 2)])
        .with("iyy", i[(1, 1)])
        .with("iyz", i[(1, 2)])
        .with("izz", i[(2, 2)]);
    Element::new("inertial")
        .child(origin(&centre))
        .child(Element::new("mass").with("value", mass.mass))
        .child(inertia)
}

/// The friction of a link, for PyBullet.
fn bullet_friction(friction: f64) -> Element {
    Element::new("contact").child(Element::new("lateral_friction").with("value", friction))
}

/// The friction of a shape, for Drake.
fn drake_friction(friction: f64) -> Element {
    let both = ["drake:mu_dynamic", "drake:mu_static"];
    let both = both.map(|name| Element::new(name).with("value", friction));
    Element::new("drake:proximity_properties").children(both)
}

fn origin(pose: &Pose) -> Element {
    Element::new("origin")
        .with("xyz", numbers(pose.translation.vector.as_slice()))
        .with("rpy", numbers(&roll_pitch_yaw(&pose.rotation)))
}

/// Angles of `Rz(yaw) Ry(pitch) Rx(roll)` in radians; where x stands upright the yaw is 0.
fn roll_pitch_yaw(rotation: &UnitQuaternion<f64>) -> [f64; 3] {
    let r = rotation.to_rotation_matrix();
    let level = r[(0, 0)].hypot(r[(1, 0)]);
    let pitch = (-r[(2, 0)]).atan2(level);
    match level > 1e-8 {
        true => [r[(2, 1)].atan2(r[(2, 2)]), pitch, r[(1, 0)].atan2(r[(0, 0)])],
        false => [(-r[(1, 2)]).atan2(r[(1, 1)]), pitch, 0.0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    #[test]
    fn angles_make_the_rotation() {
        for axis in [[0.3, 0.2, -1.0], [0.0, 1.0, 0.0], [1.0, 1.0, 1.0], [0.0, 0.0, 1.0]] {
            for angle in [0.0, 0.4, FRAC_PI_2, FRAC_PI_2 - 1e-7, -FRAC_PI_2, 2.0, PI] {
                let axis = nalgebra::Unit::new_normalize(axis.into());
                for first in [0.0, 0.7] {
                    let given = UnitQuaternion::from_axis_angle(&axis, angle)
                        * UnitQuaternion::from_axis_angle(&Vector::x_axis(), first);
                    let [roll, pitch, yaw] = roll_pitch_yaw(&given);
                    let made = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
                    assert!(made.angle_to(&given) < 3e-8, "{given} {made}");
                }
            }
        }
    }
}
