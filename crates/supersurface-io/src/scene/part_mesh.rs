//! The triangles that stand for a part: few, and as heavy as the part.
//!
//! A mesh with its vertices on a convex surface is smaller than the solid. So it is nudged: its vertices move along their
//! normals by a length δ and by a small symmetric map E about the centre, `v + δ n + E (v - c)`, until volume and second
//! moments are those of the solid. Seven unknowns, seven numbers, by damped Gauss-Newton steps; of many nudges that
//! would do (an offset of a ball is a scaling) these take a small one.

use nalgebra::{Matrix3, SMatrix, SVector};
use supersurface::mesh::{Mesh, TessellateError, tessellate};
use supersurface::shape::{Implicit, Mass, MassProperties};
use supersurface::surface::{Solid, Surface};
use supersurface::{Point, Vector};

use super::gltf::vertex_normals;

/// Distances of mesh and surface that are tried, as shares of the least half extent.
const DISTANCES: [f64; 4] = [1e-2, 5e-3, 2.5e-3, 1.25e-3];
/// Most that a nudge may stretch, and move a vertex along its normal as a share of the least half extent.
const NUDGE: f64 = 0.015;
/// Most that an entry of the inertia may be off, as a share of the (mean) diagonal entries in its row and column.
const INERTIA: f64 = 5e-4;
/// Gauss-Newton steps, and their damping.
const STEPS: usize = 8;
const DAMPING: f64 = 1e-4;

/// E (xx, yy, zz, xy, xz, yz), and δ as a share of the least half extent.
type Nudge = SVector<f64, 7>;

/// A closed mesh in the part's own frame, facing outwards, with the volume and the centre of the solid.
pub(super) fn part_mesh(surface: &Surface) -> Result<Mesh, TessellateError> {
    let solid = Solid::from(*surface);
    let exact = surface.mass_properties(1.0);
    let [low, high] = surface.bounds();
    let size = 0.5 * (high - low).min();
    for share in DISTANCES {
        let found = tessellate(&solid, Some(share * size));
        if let Some(mesh) = found.ok().and_then(|found| nudged(&found.mesh, &exact, size)) {
            return Ok(mesh);
        }
    }
    let mesh = tessellate(&solid, None)?.mesh;
    Ok(weighed(&mesh, &exact).unwrap_or(mesh))
}

/// The mesh with the solid's volume and moments, where a small nudge gives it these.
fn nudged(mesh: &Mesh, exact: &Mass, size: f64) -> Option<Mesh> {
    let normals: Vec<Vector> = vertex_normals(mesh).into_iter().map(Vector::from).collect();
    let moved = |nudge: &Nudge| -> Option<Mesh> {
        let [xx, yy, zz, xy, xz, yz, along] = (*nudge).into();
        let stretch = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let place =
            |(v, n): (&Point, &Vector)| v + stretch * (v - exact.centre) + n * (along * size);
        let vertices = mesh.vertices().iter().zip(&normals).map(place).collect();
        Mesh::new(vertices, mesh.triangles().to_vec()).ok()
    };
    let off = |nudge: &Nudge| Some(difference(&moved(nudge)?.mass_properties(1.0), exact));
    let mut nudge = Nudge::zeros();
    for _ in 0..STEPS {
        let now = off(&nudge)?;
        let mut slopes = SMatrix::<f64, 7, 7>::zeros();
        for k in 0..7 {
            let step = Nudge::ith(k, 1e-5);
            slopes.set_column(k, &((off(&(nudge + step))? - now) / 1e-5));
        }
        let normal = slopes.transpose() * slopes + SMatrix::identity() * DAMPING;
        nudge -= normal.cholesky()?.solve(&(slopes.transpose() * now));
    }
    let mesh = weighed(&moved(&nudge)?, exact)?;
    let off = mesh.mass_properties(1.0).inertia - exact.inertia;
    let sizes = exact.inertia.diagonal().map(f64::sqrt);
    let right = off.component_div(&(sizes * sizes.transpose())).amax() <= INERTIA;
    (nudge.amax() <= NUDGE && right).then_some(mesh)
}

/// By what shares volume and second moments are off.
fn difference(now: &Mass, exact: &Mass) -> Nudge {
    let second = |m: &Mass| Matrix3::identity() * (0.5 * m.inertia.trace()) - m.inertia;
    let (seen, known) = (second(now), second(exact));
    let share = |i, j| {
        let size: f64 = known[(i, i)] * known[(j, j)];
        (seen[(i, j)] - known[(i, j)]) / size.sqrt()
    };
    let volume = now.mass / exact.mass - 1.0;
    [share(0, 0), share(1, 1), share(2, 2), share(0, 1), share(0, 2), share(1, 2), volume].into()
}

/// Scaled about its centre until the volume is right, and that put where it belongs.
fn weighed(mesh: &Mesh, exact: &Mass) -> Option<Mesh> {
    let now = mesh.mass_properties(1.0);
    let scale = (exact.mass / now.mass).cbrt();
    let place = |v: &Point| exact.centre + (v - now.centre) * scale;
    Mesh::new(mesh.vertices().iter().map(place).collect(), mesh.triangles().to_vec()).ok()
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
            Surface::bent(solid([0.016, 0.016, 0.08], [0.7, 0.8]), 10.0, 0.0).unwrap(),
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
            assert!(mesh.triangles().len() < 10_000, "{surface:?}: {}", mesh.triangles().len());
        }
    }
}
