//! Floor 3: what generic mathematics answers from the traits of a shape.

mod closest;
mod hit;
mod implicit_curvature;
mod nearest;
mod nearest_on_quadric;
mod oriented_bounds;
mod taubin;

pub use closest::{Closest, ClosestFinder};
pub use hit::{Hit, first_hit};
pub use implicit_curvature::{CurvatureFrame, implicit_curvature, level_curvature};
pub use nearest::NearestFinder;
pub use nearest_on_quadric::nearest_on_quadric;
pub use oriented_bounds::{OrientedBox, tight_bounds};
pub use taubin::{first_order, second_order, second_order_distance};
