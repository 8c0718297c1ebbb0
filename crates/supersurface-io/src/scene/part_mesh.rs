//! The triangles that stand for a part: few, and as heavy as the part.
//!
//! A mesh with its vertices on a convex surface is smaller than the solid. It is scaled about its centre until the
//! volume is right, by less than half a percent; then a coarse mesh has the solid's inertia within 0.1 % too.

use supersurface::Point;
use supersurface::mesh::{Mesh, TessellateError, tessellate};
use supersurface::shape::{Implicit, Mass, MassProperties};
use supersurface::surface::{Solid, Surface};

/// Distances of mesh and surface that are tried, as shares of the largest half extent.
const DISTANCES: [f64; 4] = [4e-3, 2e-3, 1e-3, 5e-4];
/// Most that the inertia may be off, as a share of its least diagonal entry.
const INERTIA: f64 = 7e-4;

/// A closed mesh in the part's own frame, facing outwards, with the volume and the centre of the solid.
pub(super) fn part_mesh(surface: &Surface) -> Result<Mesh, TessellateError> {
    let solid = Solid::from(*surface);
    let exact = surface.mass_properties(1.0);
    let [low, high] = surface.bounds();
    let size = 0.5 * (high - low).amax();
    for share in DISTANCES {
        if let Ok(found) = tessellate(&solid, Some(share * size)) {
            let mesh = weighed(found.mesh, &exact);
            let off = (mesh.mass_properties(1.0).inertia - exact.inertia).amax();
            if off <= INERTIA * exact.inertia.diagonal().min() {
                return Ok(mesh);
            }
        }
    }
    Ok(weighed(tessellate(&solid, None)?.mesh, &exact))
}

/// Scaled about its centre, and that put where it belongs.
fn weighed(mesh: Mesh, exact: &Mass) -> Mesh {
    let now = mesh.mass_properties(1.0);
    let scale = (exact.mass / now.mass).cbrt();
    let (vertices, triangles) = mesh.clone().into_parts();
    let moved = |v: Point| exact.centre + (v - now.centre) * scale;
    Mesh::new(vertices.into_iter().map(moved).collect(), triangles).unwrap_or(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;
    use supersurface::shape::{Superellipsoid, Supertoroid};

    #[test]
    fn meshes_are_small_and_right() {
        let solid = |a, e| Superellipsoid::new(a, e).unwrap();
        let stick = solid([0.01, 0.012, 0.06], [0.5, 1.0]);
        let surfaces = [
            Surface::Superellipsoid(solid([0.044, 0.03, 0.062], [0.12; 2])),
            Surface::Superellipsoid(solid([0.033, 0.033, 0.055], [0.1, 1.0])),
            Surface::Superellipsoid(solid([0.03, 0.02, 0.025], [1.0, 1.0])),
            Surface::Superellipsoid(solid([0.03, 0.02, 0.025], [2.0, 1.5])),
            Surface::Supertoroid(
                Supertoroid::new([0.0125, 0.0125, 0.016], 3.0, [0.8, 1.0]).unwrap(),
            ),
            Surface::tapered(solid([0.03, 0.03, 0.05], [0.15, 1.0]), [0.3, 0.3]).unwrap(),
            Surface::bent(stick, 12.0, 0.4).unwrap(),
            Surface::twisted(solid([0.01, 0.02, 0.05], [0.2, 0.2]), 0.2).unwrap(),
        ];
        for surface in surfaces {
            let mesh = part_mesh(&surface).unwrap();
            let (exact, found) = (surface.mass_properties(1.0), mesh.mass_properties(1.0));
            assert!(mesh.is_watertight() && mesh.volume() > 0.0);
            assert!((found.mass / exact.mass - 1.0).abs() < 1e-9, "{surface:?}");
            assert!((found.centre - exact.centre).norm() < 1e-6, "{surface:?}");
            for k in 0..3 {
                let ratio = found.inertia[(k, k)] / exact.inertia[(k, k)];
                assert!((ratio - 1.0).abs() < 1e-3, "{surface:?}: {ratio}");
            }
            assert!(mesh.triangles().len() < 8000, "{surface:?}: {}", mesh.triangles().len());
        }
    }
}
