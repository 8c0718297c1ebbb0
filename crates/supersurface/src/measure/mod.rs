//! Floor 3: what generic mathematics answers from the traits of a shape.

mod hit;

pub use hit::{Hit, first_hit};
