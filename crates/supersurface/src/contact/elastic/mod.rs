//! A mesh pressed into a supersurface: how deep its vertices lie in it, what an elastic layer answers.

mod closest_point;
pub mod foundation;
mod foundation_columns;
mod foundation_error;
mod gauge_columns;
pub mod indentation;
mod indentation_columns;
mod indentation_slope;
pub mod laws;
mod slope_columns;
mod twist;
mod vertex_tree;
mod wrench;
mod wrench_derivative;

pub use closest_point::ByClosestPoint;
pub use foundation::{
    Application, Foundation, FoundationContact, FoundationOptions, VertexForce, layer_stiffness,
};
pub use foundation_error::FoundationError;
pub use indentation::{BLOCK, Indentation, Indentations, Indented};
pub use indentation_slope::{IndentationSlope, IndentationSlopes, SmoothlyIndented};
pub use twist::Twist;
pub use wrench::Wrench;
pub use wrench_derivative::WrenchDerivative;
