//! OpenUSD as text: meshes with their numbers as `supersurface:*` attributes, and UsdPhysics for mass and contact.
//!
//! Links of a body stand side by side under one Xform, since rigid bodies must not be nested. A spring is a joint of
//! six degrees of freedom with its translations locked and drives on its rotations, whose stiffness USD counts a degree.

use std::fmt::{Display, Write as _};

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use std::f64::consts::PI;
use supersurface::mesh::Mesh;
use supersurface::shape::Mass;
use supersurface::surface::Surface;
use supersurface::{Pose, Vector};

use super::gltf::vertex_normals;
use super::links::{Ball, FixedBox, Link, LinkPart, Prepared, Tree};
use super::{GRAVITY, SceneCamera};

/// The text of `scene.usda`.
pub(super) fn text(prepared: &Prepared<'_>) -> String {
    let mut out = Text::default();
    out.line("#usda 1.0");
    out.line("(");
    out.line("    defaultPrim = \"World\"");
    out.line("    kilogramsPerUnit = 1");
    out.line("    metersPerUnit = 1");
    out.line("    upAxis = \"Z\"");
    out.line(")");
    out.prim("Xform", "World", &[], |out| {
        out.prim("PhysicsScene", "Physics", &[], |out| {
            out.line("vector3f physics:gravityDirection = (0, 0, -1)");
            out.line(&format!("float physics:gravityMagnitude = {GRAVITY}"));
        });
        let largest = prepared.bodies.iter().map(|b| b.body.friction).fold(0.0, f64::max);
        out.prim("Scope", "materials", &[], |out| {
            for tree in &prepared.bodies {
                material(out, &tree.id, tree.body.friction);
            }
            material(out, FIXED, largest);
        });
        for fixed in &prepared.boxes {
            cube(out, fixed);
        }
        for tree in &prepared.bodies {
            body(out, tree);
        }
        for (id, camera) in &prepared.cameras {
            self::camera(out, id, camera);
        }
        for (id, site) in &prepared.sites {
            out.prim("Xform", id, &[], |out| out.pose(&site.pose));
        }
    });
    out.text
}

/// The material of what stands still; no id begins with an underscore.
const FIXED: &str = "_fixed";

fn material(out: &mut Text, id: &str, friction: f64) {
    out.prim("Material", id, &["PhysicsMaterialAPI"], |out| {
        for kind in ["dynamic", "static"] {
            out.line(&format!("float physics:{kind}Friction = {}", Single(friction)));
        }
    });
}

/// The line that binds a shape to the material of a body.
fn bound(out: &mut Text, id: &str) {
    out.line(&format!("rel material:binding:physics = </World/materials/{id}>"));
}

fn cube(out: &mut Text, fixed: &FixedBox) {
    out.prim("Cube", &fixed.id, &["PhysicsCollisionAPI", "MaterialBindingAPI"], |out| {
        out.line("float3[] extent = [(-1, -1, -1), (1, 1, 1)]");
        out.line("color3f[] primvars:displayColor = [(0.75, 0.7, 0.62)]");
        out.line("double size = 2");
        bound(out, FIXED);
        out.line(&format!("double3 xformOp:scale = {}", tuple(fixed.half_extents)));
        out.pose_and(&fixed.pose, "\"xformOp:scale\"");
    });
}

fn body(out: &mut Text, tree: &Tree<'_>) {
    let named = |out: &mut Text| {
        out.line(&format!("custom string supersurface:name = {}", quoted(&tree.body.name)));
    };
    if let [alone] = &tree.links[..] {
        link(out, tree, alone, &tree.body.pose, named);
        return;
    }
    out.prim("Xform", &tree.id, &[], |out| {
        named(out);
        out.pose(&tree.body.pose);
        for each in &tree.links {
            let pose = Pose::from_parts(each.origin.into(), UnitQuaternion::identity());
            link(out, tree, each, &pose, |_| ());
        }
        for each in &tree.links {
            if let Some(ball) = &each.joint {
                joint(out, tree, each, ball);
            }
        }
    });
}

fn link(out: &mut Text, tree: &Tree<'_>, link: &Link, pose: &Pose, named: impl Fn(&mut Text)) {
    let mut apis = vec!["PhysicsRigidBodyAPI", "PhysicsMassAPI"];
    let others = tree.links.iter().filter(|l| l.id != link.id);
    let others: Vec<String> = others.map(|l| format!("</World/{}/{}>", tree.id, l.id)).collect();
    if !others.is_empty() {
        apis.push("PhysicsFilteredPairsAPI");
    }
    out.prim("Xform", &link.id, &apis, |out| {
        named(out);
        if !others.is_empty() {
            out.line(&format!("rel physics:filteredPairs = [{}]", others.join(", ")));
        }
        weight(out, &link.mass);
        out.pose(pose);
        for part in &link.parts {
            self::part(out, tree, part);
        }
    });
}

fn weight(out: &mut Text, mass: &Mass) {
    let (moments, axes) = principal(&mass.inertia);
    let q = axes.into_inner();
    let single = |v: [f64; 3]| tuple(v.map(Single));
    out.line(&format!("float physics:mass = {}", Single(mass.mass)));
    out.line(&format!("point3f physics:centerOfMass = {}", single(mass.centre.into())));
    out.line(&format!("float3 physics:diagonalInertia = {}", single(moments)));
    let axes = [q.w, q.i, q.j, q.k].map(Single);
    out.line(&format!("quatf physics:principalAxes = {}", tuple(axes)));
}

/// Principal moments, and the rotation of their axes.
fn principal(inertia: &Matrix3<f64>) -> ([f64; 3], UnitQuaternion<f64>) {
    let eigen = inertia.symmetric_eigen();
    let mut axes = eigen.eigenvectors;
    if axes.determinant() < 0.0 {
        axes.column_mut(2).neg_mut();
    }
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    (eigen.eigenvalues.into(), turn)
}

fn part(out: &mut Text, tree: &Tree<'_>, part: &LinkPart) {
    let felt = ["PhysicsCollisionAPI", "PhysicsMeshCollisionAPI", "MaterialBindingAPI"];
    let whole = part.pieces.is_empty();
    out.prim("Mesh", &format!("{}_shape", part.id), if whole { &felt } else { &[] }, |out| {
        mesh(out, &part.mesh);
        out.line("color3f[] primvars:displayColor = [(0.55, 0.65, 0.75)]");
        let normals = vertex_normals(&part.mesh).into_iter().map(|n| tuple(n.map(Single)));
        out.line(&format!("normal3f[] normals = [{}] (", list(normals)));
        out.line("    interpolation = \"vertex\"");
        out.line(")");
        parameters(out, part.solid.shape());
        if whole {
            hull(out, &tree.id);
        }
        out.pose(part.solid.pose());
    });
    for (k, piece) in part.pieces.iter().enumerate() {
        out.prim("Mesh", &format!("{}_contact_{k}", part.id), &felt, |out| {
            out.line("uniform token purpose = \"guide\"");
            mesh(out, piece);
            hull(out, &tree.id);
            out.pose(part.solid.pose());
        });
    }
}

fn hull(out: &mut Text, material: &str) {
    out.line("uniform token physics:approximation = \"convexHull\"");
    bound(out, material);
}

fn mesh(out: &mut Text, mesh: &Mesh) {
    let (mut low, mut high) = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    for v in mesh.vertices() {
        (low, high) = (low.inf(&v.coords), high.sup(&v.coords));
    }
    let point = |v: Vector| tuple([v.x, v.y, v.z].map(Single));
    out.line(&format!("float3[] extent = [{}, {}]", point(low), point(high)));
    let counts = mesh.triangles().iter().map(|_| 3);
    out.line(&format!("int[] faceVertexCounts = [{}]", list(counts)));
    let indices = mesh.triangles().iter().flatten();
    out.line(&format!("int[] faceVertexIndices = [{}]", list(indices)));
    let points = mesh.vertices().iter().map(|v| point(v.coords));
    out.line(&format!("point3f[] points = [{}]", list(points)));
    out.line("uniform token subdivisionScheme = \"none\"");
}

/// What the part was made of.
fn parameters(out: &mut Text, surface: &Surface) {
    let mut line = |kind: &str, name: &str, value: String| {
        out.line(&format!("custom {kind} supersurface:{name} = {value}"));
    };
    line("string", "type", quoted(surface.name()));
    line("double3", "semiAxes", tuple(surface.semi_axes()));
    line("double2", "exponents", tuple(surface.exponents()));
    if let Some(ratio) = surface.ring_ratio() {
        line("double", "ringRatio", ratio.to_string());
    }
    if let Some(taper) = surface.taper() {
        line("double2", "taper", tuple(taper.slopes()));
    }
    if let Some(twist) = surface.twist() {
        line("double", "twist", twist.turns().to_string());
    }
    if let Some(bend) = surface.bend() {
        line("double2", "bend", tuple([bend.curvature(), bend.angle()]));
    }
}

fn joint(out: &mut Text, tree: &Tree<'_>, link: &Link, ball: &Ball) {
    let Some(parent) = tree.links.get(ball.parent) else { return };
    let springy = ball.stiffness > 0.0 || ball.damping > 0.0;
    let locks = ["transX", "transY", "transZ"];
    let drives = ["rotX", "rotY", "rotZ"];
    let mut apis: Vec<String> = Vec::new();
    if springy {
        apis.extend(locks.iter().map(|axis| format!("PhysicsLimitAPI:{axis}")));
        apis.extend(drives.iter().map(|axis| format!("PhysicsDriveAPI:{axis}")));
    }
    let apis: Vec<&str> = apis.iter().map(String::as_str).collect();
    let kind = if springy { "PhysicsJoint" } else { "PhysicsSphericalJoint" };
    // no id begins with an underscore, so that no link has this name
    out.prim(kind, &format!("_joint_{}", link.id), &apis, |out| {
        let path = |link: &Link| format!("</World/{}/{}>", tree.id, link.id);
        out.line(&format!("rel physics:body0 = {}", path(parent)));
        out.line(&format!("rel physics:body1 = {}", path(link)));
        let at: [f64; 3] = (link.origin - parent.origin).into();
        out.line(&format!("point3f physics:localPos0 = {}", tuple(at.map(Single))));
        out.line("point3f physics:localPos1 = (0, 0, 0)");
        out.line("quatf physics:localRot0 = (1, 0, 0, 0)");
        out.line("quatf physics:localRot1 = (1, 0, 0, 0)");
        if !springy {
            return;
        }
        for axis in locks {
            // a lower limit above the upper one locks
            out.line(&format!("float limit:{axis}:physics:high = -1"));
            out.line(&format!("float limit:{axis}:physics:low = 1"));
        }
        for axis in drives {
            let degree = PI / 180.0;
            for (what, value) in [("damping", ball.damping), ("stiffness", ball.stiffness)] {
                out.line(&format!(
                    "float drive:{axis}:physics:{what} = {}",
                    Single(value * degree)
                ));
            }
            out.line(&format!("uniform token drive:{axis}:physics:type = \"force\""));
        }
    });
}

/// Cameras of USD look against z with y up; lengths of the film are in tenths of a unit, of which only ratios matter.
fn camera(out: &mut Text, id: &str, placed: &SceneCamera) {
    const APERTURE: f64 = 20.955;
    let ([width, height], [fx, fy], [cx, cy]) =
        (placed.camera.size(), placed.camera.focal(), placed.camera.centre());
    let (width, height) = (width as f64, height as f64);
    let focal = APERTURE * fx / width;
    let vertical = focal * height / fy;
    out.prim("Camera", id, &[], |out| {
        out.line("float2 clippingRange = (0.01, 100)");
        for (name, value) in [
            ("focalLength", focal),
            ("horizontalAperture", APERTURE),
            ("horizontalApertureOffset", APERTURE * (0.5 - (cx + 0.5) / width)),
            ("verticalAperture", vertical),
            ("verticalApertureOffset", vertical * ((cy + 0.5) / height - 0.5)),
        ] {
            out.line(&format!("float {name} = {}", Single(value)));
        }
        let turn = UnitQuaternion::from_axis_angle(&Vector::x_axis(), PI);
        out.pose(&(placed.pose * turn));
    });
}

/// Lines, indented by how deep they are.
#[derive(Default)]
struct Text {
    text: String,
    depth: usize,
}

impl Text {
    fn line(&mut self, line: &str) {
        // writing into a string cannot fail
        let _ = writeln!(self.text, "{}{line}", "    ".repeat(self.depth));
    }

    fn prim(&mut self, kind: &str, name: &str, apis: &[&str], inside: impl FnOnce(&mut Self)) {
        match apis.is_empty() {
            true => self.line(&format!("def {kind} \"{name}\"")),
            false => {
                let apis: Vec<String> = apis.iter().map(|api| format!("\"{api}\"")).collect();
                self.line(&format!("def {kind} \"{name}\" ("));
                self.line(&format!("    prepend apiSchemas = [{}]", apis.join(", ")));
                self.line(")");
            }
        }
        self.line("{");
        self.depth += 1;
        inside(self);
        self.depth -= 1;
        self.line("}");
    }

    fn pose(&mut self, pose: &Pose) {
        self.pose_and(pose, "");
    }

    /// The pose as operations, and the name of one more that was written before.
    fn pose_and(&mut self, pose: &Pose, more: &str) {
        let q = pose.rotation.into_inner();
        self.line(&format!("quatd xformOp:orient = {}", tuple([q.w, q.i, q.j, q.k])));
        let at: [f64; 3] = pose.translation.vector.into();
        self.line(&format!("double3 xformOp:translate = {}", tuple(at)));
        let more = if more.is_empty() { String::new() } else { format!(", {more}") };
        self.line(&format!(
            "uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\"{more}]"
        ));
    }
}

/// A number as single precision: its shortest text.
#[derive(Clone, Copy)]
struct Single(f64);

impl Display for Single {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        (self.0 as f32).fmt(f)
    }
}

fn list(values: impl Iterator<Item = impl ToString>) -> String {
    values.map(|v| v.to_string()).collect::<Vec<_>>().join(", ")
}

fn tuple<const N: usize>(values: [impl ToString; N]) -> String {
    format!("({})", list(values.into_iter()))
}

/// A string of USD; what steers a terminal or a line becomes a space.
fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => out.push(' '),
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn principal_axes_make_the_inertia() {
        let inertia = Matrix3::new(2.0, 0.1, -0.2, 0.1, 3.0, 0.3, -0.2, 0.3, 4.0);
        let (moments, turn) = principal(&inertia);
        let r = turn.to_rotation_matrix().into_inner();
        let made = r * Matrix3::from_diagonal(&moments.into()) * r.transpose();
        assert!((made - inertia).amax() < 1e-12, "{made}");
    }

    #[test]
    fn strings_stay_strings() {
        assert_eq!(quoted("a \"b\" \\ \n"), r#""a \"b\" \\  ""#);
    }
}
