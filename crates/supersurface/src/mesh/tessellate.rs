//! Watertight triangle meshes of closed parametric surfaces, adapted to curvature.
//!
//! What holds: vertices lie on the surface, triangles face outwards, the mesh is closed, and at five points of every
//! cell of angles the distance is within the tolerance. What is not guaranteed: the distance between these points
//! (within the tolerance in all tests, at 10⁴ random points of each mesh), and that triangles are well shaped (near poles
//! and sharp edges they are thin).

use super::Mesh;
use super::angle_grid::Grid;
use crate::shape::Parametric;

/// Share of the tolerance that the chords of each direction may use.
const SHARE: f64 = 0.45;
/// Share of the tolerance that the compared points may use, since the farthest point may lie between them.
const CHECKED: f64 = 0.9;
/// Tolerances, as shares of the surface's size, that are not tried.
const FINEST: f64 = 1e-9;
/// How often cells that are too far are cut again.
const ROUNDS: usize = 24;

/// Why there is no mesh.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TessellateError {
    /// The surface has a border, or is not of a size between 1e-100 and 1e100 m.
    #[error(
        "the surface is not closed (its angles end neither in poles nor where they began), or is not of a size between 1e-100 and 1e100 m"
    )]
    Open,
    /// The tolerance is no length.
    #[error("the tolerance is {0} m: it must be positive and finite")]
    Tolerance(f64),
    /// More triangles, or finer angles than numbers can tell apart, would be needed.
    #[error("a tolerance of {tolerance:.3e} m is too fine ({}): take a larger one", reached(*distance))]
    TooFine {
        /// The tolerance asked for, in metres.
        tolerance: f64,
        /// The largest distance that was reached, in metres; infinite when the grid alone was too fine.
        distance: f64,
    },
}

fn reached(distance: f64) -> String {
    match distance.is_finite() {
        true => format!("the best mesh is {distance:.3e} m off"),
        false => "it needs more than four million cells, or finer angles than there are".into(),
    }
}

/// A mesh, and how far it is from its surface.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Tessellation {
    /// The mesh: closed, its triangles counter-clockwise seen from outside.
    pub mesh: Mesh,
    /// The largest distance between mesh and surface that was asked for or chosen, in metres.
    pub tolerance: f64,
    /// The largest distance that was found, in metres, at most the tolerance.
    pub distance: f64,
}

/// The mesh of a closed surface, no farther than `tolerance` metres from it.
///
/// `None` chooses the tolerance so that the volume is within 0.1 % of the solid's: a five hundredth of volume over area, or more where that is enough.
/// Surfaces are closed when η ends in two poles or where it began, and ω where it began; any other has
/// [`TessellateError::Open`].
///
/// ```
/// use supersurface::deform::{Bend, Deformed};
/// use supersurface::{mesh::tessellate, shape::Superellipsoid};
/// let stick = Superellipsoid::new([0.01, 0.01, 0.06], [0.5, 1.0])?;
/// let banana = Deformed::new(stick, Bend::new(12.0, 0.0)?)?;
/// let found = tessellate(&banana, Some(1e-4))?;
/// assert!(found.mesh.is_watertight() && found.distance <= 1e-4);
/// assert!((found.mesh.volume() / stick.volume() - 1.0).abs() < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tessellate<S: Parametric + ?Sized>(
    surface: &S,
    tolerance: Option<f64>,
) -> Result<Tessellation, TessellateError> {
    let mut grid = Grid::new(surface).filter(Grid::is_closed).ok_or(TessellateError::Open)?;
    let chords = match tolerance {
        Some(given) => [SHARE * checked(given)?; 2],
        None => grid.default_chords(),
    };
    let mut found = fine_enough(&mut grid, chords)?;
    if found.mesh.volume() < 0.0 {
        found.mesh = found.mesh.flipped();
    }
    Ok(found)
}

/// The mesh of any surface over its domain, closed or with a border, no farther than `tolerance` metres from it; its
/// triangles face along the normals. [`TessellateError::Open`] only for surfaces without a size.
///
/// ```
/// use supersurface::{mesh::tessellate_patch, shape::Superparaboloid};
/// let bowl = Superparaboloid::new([0.1, 0.1, 0.05], [1.0, 1.0])?;
/// let found = tessellate_patch(&bowl, 1e-4)?;
/// // π/6 a/h² ((a² + 4h²)^(3/2) - a³) for the radius a and the height h
/// let area = std::f64::consts::PI / 6.0 * 0.1 / 0.0025 * (0.02f64.powi(3).sqrt() - 0.001);
/// assert!((found.mesh.area() / area - 1.0).abs() < 2e-3 && !found.mesh.is_watertight());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn tessellate_patch<S: Parametric + ?Sized>(
    surface: &S,
    tolerance: f64,
) -> Result<Tessellation, TessellateError> {
    let mut grid = Grid::new(surface).ok_or(TessellateError::Open)?;
    let mut found = fine_enough(&mut grid, [SHARE * checked(tolerance)?; 2])?;
    if grid.faces_inwards() {
        found.mesh = found.mesh.flipped();
    }
    Ok(found)
}

fn checked(tolerance: f64) -> Result<f64, TessellateError> {
    match tolerance > 0.0 && tolerance.is_finite() {
        true => Ok(tolerance),
        false => Err(TessellateError::Tolerance(tolerance)),
    }
}

/// Cuts the grid, first by the distances of chords along both directions, until its mesh is close enough.
fn fine_enough<S: Parametric + ?Sized>(
    grid: &mut Grid<'_, S>,
    chords: [f64; 2],
) -> Result<Tessellation, TessellateError> {
    let tolerance = (chords[0] + chords[1]) / (2.0 * SHARE);
    let mut best = f64::INFINITY;
    if tolerance > FINEST * grid.size {
        grid.cut(chords);
        // more than a few rounds are needed only where the two directions twist each other
        for _ in 0..ROUNDS {
            if grid.is_too_fine() {
                break;
            }
            let (mesh, distance, further) = grid.mesh(CHECKED * tolerance);
            best = best.min(distance);
            if distance <= CHECKED * tolerance {
                return Ok(Tessellation { mesh, tolerance, distance });
            }
            if !grid.refine(&further) {
                break;
            }
        }
    }
    Err(TessellateError::TooFine { tolerance, distance: best })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Superellipsoid;
    use crate::{Point, Vector};

    #[test]
    fn what_cannot_be_meshed_says_why() {
        struct Band(Superellipsoid);
        impl Parametric for Band {
            fn domain(&self) -> [[f64; 2]; 2] {
                [[-0.5, 0.5], self.0.domain()[1]]
            }
            fn point(&self, eta: f64, omega: f64) -> Point {
                self.0.point(eta, omega)
            }
            fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
                self.0.tangents(eta, omega)
            }
            fn normal(&self, eta: f64, omega: f64) -> Option<crate::Direction> {
                self.0.normal(eta, omega)
            }
        }
        let ball = Superellipsoid::new([1.0; 3], [1.0; 2]).unwrap();
        assert_eq!(tessellate(&Band(ball), None), Err(TessellateError::Open));
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(matches!(tessellate(&ball, Some(bad)), Err(TessellateError::Tolerance(_))));
        }
        for fine in [1e-300, 1e-12, 3e-9] {
            let found = tessellate(&ball, Some(fine));
            assert!(matches!(found, Err(TessellateError::TooFine { .. })), "{fine}");
        }
        assert!(tessellate(&ball, Some(1e9)).unwrap().mesh.is_watertight());
        for size in [5e-324, 1e-200, 1e-90, 1e90, 1e308] {
            for e in [0.01, 1.0, 10.0] {
                let Ok(shape) = Superellipsoid::new([size, size, 1.0], [e, e]) else { continue };
                let _ = tessellate(&shape, None);
                let shape = Superellipsoid::new([size; 3], [e, e]).unwrap();
                let _ = tessellate(&shape, None);
            }
        }
    }
}
