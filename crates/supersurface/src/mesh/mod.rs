//! Floor 6: triangle meshes of surfaces, and points spread evenly on curves and surfaces.
//!
//! | for | use | holds |
//! |---|---|---|
//! | a closed parametric surface | [`tessellate`] | closed, within a tolerance, fine where it is curved |
//! | one with a border | [`tessellate_patch`] | within a tolerance |
//! | any bounded implicit solid | [`march`] | closed, details of a cell are lost |
//! | random points | [`SurfaceSampler`] | uniform over the area, on the surface |
//! | grids of points | [`superellipsoid_grid`], [`supertoroid_grid`] | equal angles, or equal arcs along meridians |
//!
//! ```
//! use supersurface::{mesh::tessellate, shape::Superellipsoid};
//! let tin = Superellipsoid::new([0.033, 0.033, 0.05], [0.1, 1.0])?;
//! let found = tessellate(&tin, None)?;
//! assert!(found.mesh.is_watertight());
//! assert!((found.mesh.volume() / tin.volume() - 1.0).abs() < 1e-3);
//! assert!(found.distance <= found.tolerance);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod angle_grid;
mod chords;
mod equal_arc;
mod equal_arc_grid;
mod march;
mod mass;
mod sample;
mod tessellate;
mod triangles;

pub use equal_arc::{SuperellipseArc, pilu_fisher, pilu_fisher_step};
pub use equal_arc_grid::{Spacing, superellipsoid_grid, supertoroid_grid};
pub use march::{MarchError, MarchOptions, Resolution, march};
pub use mass::mass_of_solid;
pub use sample::{SurfacePoint, SurfaceSampler};
pub use tessellate::{TessellateError, Tessellation, tessellate, tessellate_patch};
pub use triangles::{Mesh, MeshSampler};
