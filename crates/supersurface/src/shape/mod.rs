//! Floor 2: the members of the family, each with its closed forms, and the traits that say what a
//! shape can answer.

mod error;
mod mass;
mod plane;
mod posed;
mod ray;
pub mod superellipsoid;
pub mod supertoroid;
mod traits;

pub use error::InvalidShape;
pub use mass::Mass;
pub use plane::Plane;
pub use posed::Posed;
pub use ray::Ray;
pub use superellipsoid::Superellipsoid;
pub use supertoroid::Supertoroid;
pub(crate) use traits::box_extent;
pub use traits::{Implicit, MassProperties, Parametric, SecondOrder, SupportMap};
