//! Physics.
pub mod convert;
mod convex;
mod dispatch;
mod pieces;
mod settle;
mod shape;
pub use parry3d_f64 as parry;
pub use rapier3d_f64 as rapier;
pub use convex::ConvexSolid;
pub use dispatch::{Dispatcher, UnsupportedPair};
pub use pieces::Pieces;
pub use settle::{Falling, Ground, Rest, SettleError, SettleOptions, Settled, settle};
pub use shape::{NoShape, compound, shape};
