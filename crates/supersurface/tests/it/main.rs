//! Integration tests of the library, one binary.

mod assembly;
mod floors;
mod golden_antipodal;
mod golden_general;
mod golden_shapes;
mod hit;
mod picture;
mod pipeline;
mod scene;
mod segment;
