//! Floor 6: triangle meshes of surfaces, and points spread evenly on curves and surfaces.

mod equal_arc;
mod triangles;

pub use equal_arc::{SuperellipseArc, pilu_fisher, pilu_fisher_step};
pub use triangles::{Mesh, MeshSampler};
