//! Integration tests of the library, one binary.

mod assembly;
mod closest;
mod combined;
mod conformance;
mod fit_generic;
mod fit_turned;
mod fit_views;
mod floors;
mod foundation;
mod golden_antipodal;
mod golden_deform;
mod golden_general;
mod golden_indentation;
mod golden_jacobian;
mod golden_members;
mod golden_sampling;
mod golden_shapes;
mod hit;
mod jacobians;
mod mesh;
mod picture;
mod pipeline;
mod scene;
mod segment;
mod separate;
