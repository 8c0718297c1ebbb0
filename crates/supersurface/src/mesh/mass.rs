//! Mass properties of a watertight mesh, and by meshes of any solid: sums over tetrahedra with one corner in common.
//!
//! For a tetrahedron with the corners 0, a, b, c: `V = a·(b × c)/6`, first moment `V s/4` and second moment
//! `V (aaᵀ + bbᵀ + ccᵀ + ssᵀ)/20` with `s = a + b + c`.

use super::{MarchError, MarchOptions, Mesh, Resolution, march};
use crate::shape::{Implicit, Mass, MassEstimate, MassProperties, Moments};

impl MassProperties for Mesh {
    /// Of the polyhedron itself: exact for the mesh, near those of the surface that it was made of. They mean something
    /// where the mesh is watertight; a mesh without volume has its centre of mass at the origin.
    fn mass_properties(&self, density: f64) -> Mass {
        // near the mesh, so that little cancels
        let Some(origin) = self.vertices().first() else { return Moments::nothing().mass(density) };
        let mut sum = Moments::nothing();
        for corners in self.corners() {
            let [a, b, c] = corners.map(|p| p - origin);
            let (part, s) = (a.dot(&b.cross(&c)) / 6.0, a + b + c);
            sum.volume += part;
            sum.first += s * (part / 4.0);
            let squares = a * a.transpose() + b * b.transpose() + c * c.transpose();
            sum.second += (squares + s * s.transpose()) * (part / 20.0);
        }
        if sum.volume == 0.0 || !sum.volume.is_finite() {
            return Moments::nothing().mass(density);
        }
        sum.mass(density).moved(&origin.coords.into())
    }
}

/// Of the finer of two meshes: it is nearer than the error says, by about a factor of four.
fn of_meshes(coarse: &Mesh, fine: &Mesh, density: f64) -> MassEstimate {
    MassEstimate::refined(&coarse.mass_properties(density), fine.mass_properties(density))
}

/// Mass properties of a bounded implicit solid, for a density in kg/m³, marched with `cells` along its longest side and
/// with half as many. The errors are those of [`march`].
pub fn mass_of_solid<S: Implicit + Sync + ?Sized>(
    solid: &S,
    density: f64,
    cells: usize,
) -> Result<MassEstimate, MarchError> {
    let marched = |cells| {
        let resolution = Resolution::Count(cells);
        march(solid, &MarchOptions { resolution, ..MarchOptions::default() })
    };
    Ok(of_meshes(&marched(cells / 2)?, &marched(cells)?, density))
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

    #[test]
    fn errors_are_not_larger_than_estimated() {
        let tin = Superellipsoid::new([0.03, 0.05, 0.08], [0.4, 1.2]).unwrap();
        let ring = Supertoroid::new([0.01, 0.02, 0.015], 3.0, [0.7, 1.3]).unwrap();
        let truths = [tin.mass_properties(2.0), ring.mass_properties(2.0)];
        let found = [mass_of_solid(&tin, 2.0, 60).unwrap(), mass_of_solid(&ring, 2.0, 60).unwrap()];
        for (found, truth) in found.iter().zip(truths.iter().cycle()) {
            assert!(found.error < 0.02, "{found:?}");
            assert!((found.mass.mass / truth.mass - 1.0).abs() < found.error);
            let off = (found.mass.inertia - truth.inertia).norm() / truth.inertia.norm();
            assert!(off < found.error, "{off} {found:?}");
        }
    }
}
