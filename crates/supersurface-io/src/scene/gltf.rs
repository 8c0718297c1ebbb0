//! Binary glTF 2.0: a node a body with its parts as meshes, and their numbers in `extras`.
//!
//! glTF has y up, so the root is turned by -90° about x. Positions and normals are single precision.

use nalgebra::UnitQuaternion;
use serde_json::{Map, Value, json};
use std::f64::consts::{FRAC_1_SQRT_2, PI};
use supersurface::mesh::Mesh;
use supersurface::{Point, Pose, Vector};

use super::SceneCamera;
use super::links::{Link, LinkPart, Prepared, Tree};
use crate::surface_row::SurfaceRow;

/// Colours of the bodies in turn, linear.
const COLOURS: [[f64; 3]; 6] = [
    [0.16, 0.34, 0.55],
    [0.65, 0.25, 0.12],
    [0.22, 0.45, 0.2],
    [0.55, 0.4, 0.1],
    [0.38, 0.2, 0.45],
    [0.12, 0.42, 0.42],
];
const BOARDS: [f64; 3] = [0.5, 0.45, 0.35];

/// The bytes of `scene.glb`.
pub(super) fn bytes(prepared: &Prepared<'_>) -> Vec<u8> {
    let mut file = File::default();
    let colours = COLOURS.iter().chain([&BOARDS]);
    let materials: Vec<Value> = colours
        .map(|[r, g, b]| {
            let factors = json!({"baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.6});
            json!({"pbrMetallicRoughness": factors})
        })
        .collect();
    let mut world = Vec::new();
    for fixed in &prepared.boxes {
        let (mesh, normals) = cuboid(fixed.half_extents);
        let mesh = file.mesh(&fixed.id, &mesh, &normals, COLOURS.len());
        world.push(file.node(&fixed.id, &fixed.pose, json!({"mesh": mesh})));
    }
    for (k, tree) in prepared.bodies.iter().enumerate() {
        world.push(body(&mut file, tree, k % COLOURS.len()));
    }
    for (id, placed) in &prepared.cameras {
        world.push(camera(&mut file, id, placed));
    }
    for (id, site) in &prepared.sites {
        world.push(file.node(id, &site.pose, json!({})));
    }
    let up = [-FRAC_1_SQRT_2, 0.0, 0.0, FRAC_1_SQRT_2];
    file.nodes.push(json!({"name": "scene", "rotation": up, "children": world}));
    let root = file.nodes.len() - 1;
    file.finish(root, &materials)
}

fn body(file: &mut File, tree: &Tree<'_>, material: usize) -> usize {
    let links: Vec<usize> = tree.links.iter().map(|l| link(file, tree, l, material)).collect();
    let extras = json!({"name": tree.body.name, "friction": tree.body.friction});
    file.node(&tree.id, &tree.body.pose, json!({"children": links, "extras": extras}))
}

fn link(file: &mut File, tree: &Tree<'_>, link: &Link, material: usize) -> usize {
    let parts: Vec<usize> = link.parts.iter().map(|p| part(file, p, material)).collect();
    let mass = &link.mass;
    let inertia: [[f64; 3]; 3] = mass.inertia.into();
    let centre: [f64; 3] = mass.centre.into();
    let extras = json!({"mass": mass.mass, "centre_of_mass": centre, "inertia": inertia});
    let pose = Pose::from_parts(link.origin.into(), UnitQuaternion::identity());
    let name = if tree.links.len() == 1 { format!("{}.link", link.id) } else { link.id.clone() };
    file.node(&name, &pose, json!({"children": parts, "extras": extras}))
}

fn part(file: &mut File, part: &LinkPart, material: usize) -> usize {
    let mesh = file.mesh(&part.id, &part.mesh, &vertex_normals(&part.mesh), material);
    let row = serde_json::to_value(SurfaceRow::new(&part.solid)).unwrap_or_default();
    let name = format!("{}.shape", part.id);
    let fields = json!({"mesh": mesh, "extras": {"supersurface": row}});
    file.node(&name, part.solid.pose(), fields)
}

/// glTF's cameras look against z with y up; their principal point is the middle.
fn camera(file: &mut File, id: &str, placed: &SceneCamera) -> usize {
    let ([width, height], [_, fy]) = (placed.camera.size(), placed.camera.focal());
    let (width, height) = (width as f64, height as f64);
    let perspective = json!({
        "aspectRatio": width / height,
        "yfov": 2.0 * (0.5 * height / fy).atan(),
        "znear": 0.01,
    });
    file.cameras.push(json!({"type": "perspective", "perspective": perspective}));
    let turn = UnitQuaternion::from_axis_angle(&Vector::x_axis(), PI);
    let camera = file.cameras.len() - 1;
    file.node(id, &(placed.pose * turn), json!({"camera": camera}))
}

/// Lists of glTF, and the bytes that they point into.
#[derive(Default)]
struct File {
    nodes: Vec<Value>,
    meshes: Vec<Value>,
    cameras: Vec<Value>,
    accessors: Vec<Value>,
    views: Vec<Value>,
    bytes: Vec<u8>,
}

impl File {
    fn node(&mut self, name: &str, pose: &Pose, fields: Value) -> usize {
        let q = pose.rotation.into_inner();
        let at: [f64; 3] = pose.translation.vector.into();
        let mut node = Map::new();
        node.insert("name".into(), name.into());
        node.insert("translation".into(), json!(at));
        node.insert("rotation".into(), json!([q.i, q.j, q.k, q.w]));
        if let Value::Object(fields) = fields {
            // a list of no children is an error
            let empty = |v: &Value| v.as_array().is_some_and(Vec::is_empty);
            node.extend(fields.into_iter().filter(|(_, v)| !empty(v)));
        }
        self.nodes.push(Value::Object(node));
        self.nodes.len() - 1
    }

    fn mesh(&mut self, name: &str, mesh: &Mesh, normals: &[[f64; 3]], material: usize) -> usize {
        let points: Vec<[f32; 3]> =
            mesh.vertices().iter().map(|v| [v.x, v.y, v.z].map(|c| c as f32)).collect();
        let normals: Vec<[f32; 3]> = normals.iter().map(|n| n.map(|c| c as f32)).collect();
        let bound = |better: fn(f32, f32) -> f32, start: f32| {
            points.iter().fold([start; 3], |b, p| std::array::from_fn(|k| better(b[k], p[k])))
        };
        let (low, high) = (bound(f32::min, f32::INFINITY), bound(f32::max, f32::NEG_INFINITY));
        let flat =
            |rows: &[[f32; 3]]| rows.iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
        let positions = json!({"count": points.len(), "type": "VEC3", "componentType": 5126, "min": low, "max": high});
        let positions = self.accessor(positions, flat(&points), 34962);
        let fields = json!({"count": normals.len(), "type": "VEC3", "componentType": 5126});
        let normals = self.accessor(fields, flat(&normals), 34962);
        let indices: Vec<u8> =
            mesh.triangles().iter().flatten().flat_map(|i| i.to_le_bytes()).collect();
        let count = 3 * mesh.triangles().len();
        let fields = json!({"count": count, "type": "SCALAR", "componentType": 5125});
        let indices = self.accessor(fields, indices, 34963);
        let attributes = json!({"POSITION": positions, "NORMAL": normals});
        let primitive = json!({"attributes": attributes, "indices": indices, "material": material});
        self.meshes.push(json!({"name": name, "primitives": [primitive]}));
        self.meshes.len() - 1
    }

    /// All components have four bytes, so that everything is aligned.
    fn accessor(&mut self, mut fields: Value, bytes: Vec<u8>, target: u32) -> usize {
        self.views.push(json!({
            "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len(), "target": target
        }));
        fields["bufferView"] = json!(self.views.len() - 1);
        self.bytes.extend(bytes);
        self.accessors.push(fields);
        self.accessors.len() - 1
    }

    /// The header, the JSON padded by spaces, the bytes.
    fn finish(self, root: usize, materials: &[Value]) -> Vec<u8> {
        let mut file = json!({
            "asset": {"version": "2.0", "generator": "supersurface"},
            "scene": 0,
            "scenes": [{"nodes": [root]}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"byteLength": self.bytes.len()}],
        });
        if !self.cameras.is_empty() {
            file["cameras"] = Value::Array(self.cameras);
        }
        let mut json = file.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut out = b"glTF".to_vec();
        let length = 12 + 8 + json.len() + 8 + self.bytes.len();
        for word in [2, length as u32, json.len() as u32] {
            out.extend(word.to_le_bytes());
        }
        out.extend(b"JSON");
        out.extend(json);
        out.extend((self.bytes.len() as u32).to_le_bytes());
        out.extend(b"BIN\0");
        out.extend(self.bytes);
        out
    }
}

/// Unit normals at the vertices: those of their triangles, by area.
pub(super) fn vertex_normals(mesh: &Mesh) -> Vec<[f64; 3]> {
    let mut sums = vec![Vector::zeros(); mesh.vertices().len()];
    for (corners, triangle) in mesh.corners().zip(mesh.triangles()) {
        let [a, b, c] = corners;
        let normal = (b - a).cross(&(c - a));
        for i in triangle {
            if let Some(sum) = sums.get_mut(*i as usize) {
                *sum += normal;
            }
        }
    }
    // a vertex whose triangles have no area has no normal, but must have one
    sums.into_iter().map(|n| n.try_normalize(0.0).unwrap_or_else(Vector::z).into()).collect()
}

/// A cuboid with corners of its own for each face, so that its edges look sharp.
fn cuboid(half: [f64; 3]) -> (Mesh, Vec<[f64; 3]>) {
    let half = Vector::from(half);
    let (mut vertices, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [-1.0, 1.0] {
            let normal = Vector::ith(axis, side);
            let (u, v) = (Vector::ith((axis + 1) % 3, side), Vector::ith((axis + 2) % 3, 1.0));
            let first = vertices.len() as u32;
            for corner in [-u - v, u - v, u + v, v - u] {
                vertices.push(Point::from((normal + corner).component_mul(&half)));
                normals.push(normal.into());
            }
            triangles.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
        }
    }
    (Mesh::new(vertices, triangles).unwrap_or_default(), normals)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuboids_face_outwards() {
        let (mesh, normals) = cuboid([0.1, 0.2, 0.3]);
        assert!((mesh.volume() - 0.048).abs() < 1e-15);
        for (corners, triangle) in mesh.corners().zip(mesh.triangles()) {
            let [a, b, c] = corners;
            let normal = (b - a).cross(&(c - a)).normalize();
            let given = Vector::from(normals[triangle[0] as usize]);
            assert!((normal - given).norm() < 1e-12);
        }
    }
}
