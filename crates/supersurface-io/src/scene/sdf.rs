//! A world of SDFormat 1.9: a static model for table and boards, and one a body.
//!
//! The file is never called `scene.sdf` or `world.sdf`: by a relative path libsdformat would read its own schema of that
//! name. Gazebo takes the smaller friction of both sides, so what stands still has the largest of all. Ball joints have
//! no springs here.

use nalgebra::UnitQuaternion;
use supersurface::{Pose, Vector};

use super::links::{Link, LinkPart, Prepared, Tree};
use super::xml::{Element, numbers};
use super::{Files, GRAVITY, MESHES};

pub(super) fn add(prepared: &Prepared<'_>, files: &mut Files) {
    let largest = prepared.bodies.iter().map(|b| b.body.friction).fold(1.0, f64::max);
    let mut world = Element::new("world")
        .with("name", "scene")
        .child(Element::text("gravity", numbers(&[0.0, 0.0, -GRAVITY])))
        .child(fixed(prepared, largest));
    world = world.children(prepared.bodies.iter().map(|tree| model(tree, files)));
    for (id, site) in &prepared.sites {
        world = world.child(Element::new("frame").with("name", id).child(pose(&site.pose)));
    }
    let root = Element::new("sdf")
        .with("version", "1.9")
        .with("xmlns:drake", "drake.mit.edu")
        .child(world);
    files.add("scene_world.sdf", root.document());
}

fn fixed(prepared: &Prepared<'_>, friction: f64) -> Element {
    let mut link = Element::new("link").with("name", "boards");
    for fixed in &prepared.boxes {
        let boxed = |kind| {
            let size = Element::text("size", numbers(&fixed.half_extents.map(|h| 2.0 * h)));
            let geometry = Element::new("geometry").child(Element::new("box").child(size));
            Element::new(kind).with("name", &fixed.id).child(pose(&fixed.pose)).child(geometry)
        };
        link = link.child(boxed("visual")).child(boxed("collision").child(surface(friction)));
    }
    // no id has a dot, so that no body has this name
    Element::new("model")
        .with("name", "fixed.boards")
        .child(Element::text("static", true))
        .child(link)
}

fn model(tree: &Tree<'_>, files: &mut Files) -> Element {
    let mut model = Element::new("model").with("name", &tree.id).child(pose(&tree.body.pose));
    for link in &tree.links {
        model = model.child(self::link(tree, link, files));
    }
    for link in &tree.links {
        let Some(parent) = link.joint.as_ref().and_then(|j| tree.links.get(j.parent)) else {
            continue;
        };
        // nor has a link this name
        let joint = Element::new("joint").with("name", format!("{}.joint", link.id));
        model = model.child(
            joint
                .with("type", "ball")
                .child(Element::text("parent", &parent.id))
                .child(Element::text("child", &link.id)),
        );
    }
    model
}

fn link(tree: &Tree<'_>, link: &Link, files: &mut Files) -> Element {
    let at = |v: Vector| Pose::from_parts(v.into(), UnitQuaternion::identity());
    let i = &link.mass.inertia;
    let moments =
        [("ixx", 0, 0), ("ixy", 0, 1), ("ixz", 0, 2), ("iyy", 1, 1), ("iyz", 1, 2), ("izz", 2, 2)];
    let inertia = Element::new("inertia")
        .children(moments.map(|(name, row, column)| Element::text(name, i[(row, column)])));
    let inertial = Element::new("inertial")
        .child(pose(&at(link.mass.centre.coords)))
        .child(Element::text("mass", link.mass.mass))
        .child(inertia);
    let mut element =
        Element::new("link").with("name", &link.id).child(pose(&at(link.origin))).child(inertial);
    for part in &link.parts {
        element = element.children(shapes(part, tree.body.friction, files));
    }
    element
}

fn shapes(part: &LinkPart, friction: f64, files: &mut Files) -> Vec<Element> {
    let named = |kind, name: &str, shape: Element| {
        Element::new(kind)
            .with("name", name)
            .child(pose(part.solid.pose()))
            .child(Element::new("geometry").child(shape))
    };
    let rough = |element: Element| element.child(surface(friction));
    if part.is_ellipsoid() {
        let ellipsoid = || {
            let radii = Element::text("radii", numbers(&part.solid.shape().semi_axes()));
            Element::new("ellipsoid").child(radii)
        };
        return vec![
            named("visual", &part.id, ellipsoid()),
            rough(named("collision", &part.id, ellipsoid())),
        ];
    }
    let mesh =
        |file: &str| Element::new("mesh").child(Element::text("uri", format!("{MESHES}/{file}")));
    let mut all = vec![named("visual", &part.id, mesh(&files.add_obj(&part.id, &part.mesh)))];
    for (k, file) in files.add_pieces(part).iter().enumerate() {
        // Drake would take the mesh itself, and only its vertices, otherwise
        let convex = mesh(file).child(Element::new("drake:declare_convex"));
        all.push(rough(named("collision", &format!("{}_contact_{k}", part.id), convex)));
    }
    all
}

fn surface(friction: f64) -> Element {
    let ode = Element::new("ode")
        .child(Element::text("mu", friction))
        .child(Element::text("mu2", friction));
    Element::new("surface").child(Element::new("friction").child(ode))
}

fn pose(pose: &Pose) -> Element {
    let (t, q) = (&pose.translation.vector, pose.rotation.into_inner());
    Element::text("pose", numbers(&[t.x, t.y, t.z, q.i, q.j, q.k, q.w]))
        .with("rotation_format", "quat_xyzw")
}
