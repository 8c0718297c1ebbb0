//! Surfaces in a picture: members of the family with lines of longitude and latitude, and meshes.

use super::draw::{Picture, level};
use super::tessellate::{tessellate, wires};
use super::{Colour, mix};
use crate::mesh::Mesh;
use crate::shape::Posed;
use crate::surface::{Solid, Surface};
use crate::{Direction, Point, Pose, Vector};

/// Cosine of the angle from which faces of a mesh meet at an edge: 30 degrees.
const SMOOTH: f64 = 0.866;

impl Picture {
    /// A supersurface, shaded, with lines of longitude and latitude; `alpha` in [0, 1].
    pub fn surface(&mut self, surface: &Posed<Surface>, colour: Colour, alpha: f64) -> &mut Self {
        self.solid(&Solid::from(*surface.shape()), surface.pose(), colour, alpha)
    }

    /// The same for any closed solid at a pose.
    pub fn solid(&mut self, solid: &Solid, pose: &Pose, colour: Colour, alpha: f64) -> &mut Self {
        let grid = tessellate(solid);
        let alpha = level(alpha);
        let vertices: Vec<(Point, [f64; 3])> = grid
            .vertices
            .iter()
            .map(|(p, n)| (pose * p, self.shade(colour, &(pose.rotation * n.into_inner()), 0.35)))
            .collect();
        for (row, next) in vertices.chunks(grid.columns).zip(vertices.chunks(grid.columns).skip(1))
        {
            for (ab, dc) in row.windows(2).zip(next.windows(2)) {
                if let ([a, b], [d, c]) = (ab, dc) {
                    self.triangle([*a, *b, *c], alpha);
                    self.triangle([*a, *c, *d], alpha);
                }
            }
        }
        let eye = Point::from(self.view.pose.translation.vector);
        let ink = mix(colour, [0; 3], 0.45).map(f64::from);
        let strong = if alpha == u8::MAX { alpha } else { alpha.max(190) };
        for line in wires(solid) {
            for pair in line.windows(2) {
                if let [(a, m), (b, n)] = pair {
                    let (a, b) = (pose * a, pose * b);
                    let normal = pose.rotation * (m.into_inner() + n.into_inner());
                    if normal.dot(&(eye - a)) > 0.0 {
                        self.stroke([&a, &b], ink, 0.9, strong, 1.002);
                    }
                }
            }
        }
        self
    }

    /// A triangle mesh, shaded: smooth where its faces meet at less than 30 degrees.
    pub fn mesh(&mut self, mesh: &Mesh, colour: Colour, alpha: f64) -> &mut Self {
        let alpha = level(alpha);
        let areas: Vec<Vector> = mesh.corners().map(|[a, b, c]| (b - a).cross(&(c - a))).collect();
        let mut faces = vec![Vec::new(); mesh.vertices().len()];
        for (face, triangle) in mesh.triangles().iter().enumerate() {
            for i in triangle {
                faces[*i as usize].push(face);
            }
        }
        for ((corners, triangle), area) in mesh.corners().zip(mesh.triangles()).zip(&areas) {
            let Some(own) = Direction::try_new(*area, 0.0) else { continue };
            let smooth = |i: u32| {
                let near = faces[i as usize].iter().map(|f| areas[*f]);
                near.filter(|n| n.dot(&own) > SMOOTH * n.norm()).sum::<Vector>()
            };
            let [a, b, c] = *triangle;
            let shades = [a, b, c].map(|i| self.shade(colour, &smooth(i), 0.35));
            let [p, q, r] = corners;
            self.triangle([(p, shades[0]), (q, shades[1]), (r, shades[2])], alpha);
        }
        self
    }
}
