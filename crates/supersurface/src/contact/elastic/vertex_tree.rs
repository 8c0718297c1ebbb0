//! Vertices of a mesh with their areas, in a tree of boxes.

use nalgebra::Matrix3;

use crate::mesh::Mesh;
use crate::{Pose, Vector};

/// Vertices in one leaf.
const LEAF: usize = 32;

/// A vertex in the mesh's frame, with a third of the areas of its triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Vertex {
    pub(super) point: Vector,
    pub(super) area: f64,
    pub(super) index: u32,
}

#[derive(Clone, Debug)]
struct Node {
    centre: Vector,
    half: Vector,
    /// The node that comes next when this one is left out.
    after: usize,
    /// The vertices of a leaf; empty for the others.
    vertices: std::ops::Range<usize>,
}

/// Nodes in the order of a walk from the root, each before what it contains.
#[derive(Clone, Debug)]
pub(super) struct VertexTree {
    nodes: Vec<Node>,
    vertices: Vec<Vertex>,
}

impl VertexTree {
    /// Vertices without area are left out: they carry no force.
    pub(super) fn new(mesh: &Mesh) -> Self {
        let mut areas = vec![0.0; mesh.vertices().len()];
        for (triangle, [a, b, c]) in mesh.triangles().iter().zip(mesh.corners()) {
            let third = (b - a).cross(&(c - a)).norm() / 6.0;
            for i in triangle {
                areas[*i as usize] += third;
            }
        }
        let vertex = |(index, (p, area)): (usize, (&crate::Point, f64))| Vertex {
            point: p.coords,
            area,
            index: index as u32,
        };
        let pairs = mesh.vertices().iter().zip(areas).enumerate();
        let mut vertices: Vec<Vertex> = pairs.map(vertex).filter(|v| v.area > 0.0).collect();
        let mut nodes = Vec::new();
        if !vertices.is_empty() {
            grow(&mut vertices, 0, &mut nodes);
        }
        Self { nodes, vertices }
    }

    pub(super) fn vertices(&self) -> &[Vertex] {
        &self.vertices
    }

    /// Visits each vertex that lies in a box, with its place in the box's frame. The mesh stands at `pose` in that
    /// frame.
    pub(super) fn inside(
        &self,
        pose: &Pose,
        middle: &Vector,
        half: &Vector,
        mut visit: impl FnMut(Vector, &Vertex),
    ) {
        let turn: Matrix3<f64> = pose.rotation.to_rotation_matrix().into_inner();
        let (reach, shift) = (turn.abs(), pose.translation.vector - middle);
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            let away = (turn * node.centre + shift).abs();
            let limit = half + reach * node.half;
            if away.x > limit.x || away.y > limit.y || away.z > limit.z {
                at = node.after;
                continue;
            }
            at += 1;
            for vertex in &self.vertices[node.vertices.clone()] {
                let away = turn * vertex.point + shift;
                if away.x.abs() <= half.x && away.y.abs() <= half.y && away.z.abs() <= half.z {
                    visit(away + middle, vertex);
                }
            }
        }
    }
}

/// Sorts vertices into leaves by halving the longest side of their box, and lists the boxes.
fn grow(vertices: &mut [Vertex], first: usize, nodes: &mut Vec<Node>) {
    let start = (Vector::repeat(f64::INFINITY), Vector::repeat(f64::NEG_INFINITY));
    let (low, high) =
        vertices.iter().fold(start, |(low, high), v| (low.inf(&v.point), high.sup(&v.point)));
    // halves first: the sum of both may overflow
    let (centre, half) = (low * 0.5 + high * 0.5, high * 0.5 - low * 0.5);
    let own = nodes.len();
    let count = vertices.len();
    let is_leaf = count <= LEAF;
    let held = if is_leaf { first..first + count } else { 0..0 };
    nodes.push(Node { centre, half, after: 0, vertices: held });
    if !is_leaf {
        let axis = half.imax();
        vertices.select_nth_unstable_by(count / 2, |a, b| a.point[axis].total_cmp(&b.point[axis]));
        let (left, right) = vertices.split_at_mut(count / 2);
        grow(left, first, nodes);
        grow(right, first + count / 2, nodes);
    }
    let after = nodes.len();
    nodes[own].after = after;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Point;
    use crate::mesh::tessellate;
    use crate::numeric::random::Stream;
    use crate::shape::Supertoroid;

    #[test]
    fn the_tree_finds_what_all_vertices_one_by_one_find() {
        let ring = Supertoroid::new([0.1; 3], 3.0, [0.7, 1.2]).unwrap();
        let mesh = tessellate(&ring, Some(1e-3)).unwrap().mesh;
        let tree = VertexTree::new(&mesh);
        let sum: f64 = tree.vertices().iter().map(|v| v.area).sum();
        assert!((sum / mesh.area() - 1.0).abs() < 1e-12);
        let mut random = Stream::new(2, 0);
        let mut vector = |size: f64| Vector::from_fn(|_, _| random.between(-size, size));
        let mut some = 0;
        for _ in 0..200 {
            let pose = Pose::new(vector(0.5), vector(3.0));
            let (middle, half) = (vector(0.1), vector(0.3).abs());
            let mut found = Vec::new();
            tree.inside(&pose, &middle, &half, |p, v| {
                assert!((p - (pose * Point::from(v.point)).coords).norm() < 1e-14);
                found.push(v.index);
            });
            found.sort_unstable();
            let in_box = |p: &Point| {
                let away = ((pose * p).coords - middle).abs();
                away.x <= half.x && away.y <= half.y && away.z <= half.z
            };
            let truth: Vec<u32> = (0..mesh.vertices().len() as u32)
                .filter(|i| in_box(&mesh.vertices()[*i as usize]))
                .collect();
            some += usize::from(!truth.is_empty());
            assert_eq!(found, truth);
        }
        assert!(some > 50, "{some}");
    }
}
