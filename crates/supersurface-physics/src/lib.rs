//! Physics.
pub mod convert;
mod convex;
mod dispatch;
mod pieces;
mod shape;
pub use parry3d_f64 as parry;
pub use rapier3d_f64 as rapier;
pub use convex::ConvexSolid;
pub use dispatch::{Dispatcher, UnsupportedPair};
pub use pieces::Pieces;
pub use shape::{NoShape, compound, shape};
