//! Floor 7: where two things touch, how far apart or how deep in each other they are.

mod cells;
mod chart;
mod continuation;
mod convex;
mod derivative;
mod descent;
mod difference;
mod pair;
mod witness;

pub use convex::Convex;
pub use derivative::{BodyDerivative, differentiate};
pub use pair::{Contact, WarmStart, certify, intersect, pair};
