//! Floor 3: what generic mathematics answers from the traits of a shape.

mod closest;
mod hit;
mod taubin;

pub use closest::{Closest, ClosestFinder};
pub use hit::{Hit, first_hit};
pub use taubin::{first_order, second_order, second_order_distance};
