//! Mass properties of a watertight mesh: sums over tetrahedra with one corner in common.
//!
//! For a tetrahedron with the corners 0, a, b, c: `V = a·(b × c)/6`, first moment `V s/4` and second moment
//! `V (aaᵀ + bbᵀ + ccᵀ + ssᵀ)/20` with `s = a + b + c`.

use nalgebra::Matrix3;

use super::Mesh;
use crate::shape::{Mass, MassProperties};
use crate::{Point, Vector};

impl MassProperties for Mesh {
    /// Of the polyhedron itself: exact for the mesh, near those of the surface that it was made of. They mean something
    /// where the mesh is watertight; a mesh without volume has its centre of mass at the origin.
    fn mass_properties(&self, density: f64) -> Mass {
        let nothing = Mass { mass: 0.0, centre: Point::origin(), inertia: Matrix3::zeros() };
        // near the mesh, so that little cancels
        let Some(origin) = self.vertices().first() else { return nothing };
        let (mut volume, mut first, mut second) = (0.0, Vector::zeros(), Matrix3::zeros());
        for corners in self.corners() {
            let [a, b, c] = corners.map(|p| p - origin);
            let (part, s) = (a.dot(&b.cross(&c)) / 6.0, a + b + c);
            volume += part;
            first += s * (part / 4.0);
            let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
            second += (squares + s * s.transpose()) * (part / 20.0);
        }
        if volume == 0.0 || !volume.is_finite() {
            return nothing;
        }
        let middle = first / volume;
        let central = second - middle * middle.transpose() * volume;
        let inertia = Matrix3::identity() * central.trace() - central;
        Mass { mass: density * volume, centre: origin + middle, inertia: inertia * density }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::tessellate;
    use crate::shape::{Superellipsoid, Supertoroid};

    #[test]
    fn fine_meshes_weigh_what_their_solids_weigh() {
        let tin = Superellipsoid::new([0.03, 0.05, 0.08], [0.4, 1.2]).unwrap();
        let ring = Supertoroid::new([0.01, 0.02, 0.015], 3.0, [0.7, 1.3]).unwrap();
        let tin_mesh = tessellate(&tin, Some(2e-5)).unwrap().mesh;
        let ring_mesh = tessellate(&ring, Some(1e-5)).unwrap().mesh;
        for (mesh, truth) in
            [(tin_mesh, tin.mass_properties(700.0)), (ring_mesh, ring.mass_properties(700.0))]
        {
            let found = mesh.mass_properties(700.0);
            assert!((found.mass / truth.mass - 1.0).abs() < 2e-3, "{found:?} {truth:?}");
            assert!((found.centre - truth.centre).norm() < 1e-6);
            let off = (found.inertia - truth.inertia).norm() / truth.inertia.norm();
            assert!(off < 4e-3, "{off}");
        }
        assert_eq!(Mesh::default().mass_properties(1.0).mass, 0.0);
    }
}
