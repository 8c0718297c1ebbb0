//! Floor 2: the members of the family, each with its closed forms, and the traits that say what a
//! shape can answer.

mod angular;
mod capped;
#[cfg(test)]
mod checks;
mod curvature;
mod error;
pub mod extended;
mod filled;
pub mod hyperquadric;
mod jet;
mod mass;
mod plane;
mod posed;
mod product_moments;
pub mod quadric;
mod ray;
pub mod separable_superquadric;
pub mod supercone;
pub mod supercylinder;
pub mod superellipsoid;
pub mod superformula;
pub mod superhyperboloid;
pub mod superparaboloid;
pub mod supertoroid;
mod traits;

pub use curvature::{Curvature, FundamentalForms};
pub use error::InvalidShape;
pub use extended::{ExtendedSuperellipsoid, RadialExtended};
pub use filled::Filled;
pub(crate) use filled::{filled_mass, mass_of_sections};
pub use hyperquadric::{Hyperquadric, HyperquadricForm};
pub(crate) use mass::Moments;
pub use mass::{Mass, MassEstimate};
pub use plane::Plane;
pub use posed::Posed;
pub use quadric::{NormalForm, Quadric, QuadricType};
pub use ray::Ray;
pub use separable_superquadric::SeparableSuperquadric;
pub use supercone::Supercone;
pub use supercylinder::Supercylinder;
pub use superellipsoid::Superellipsoid;
pub use superformula::{Superformula, Supershape};
pub use superhyperboloid::{Sheet, SuperhyperboloidOneSheet, SuperhyperboloidTwoSheets};
pub use superparaboloid::Superparaboloid;
pub use supertoroid::Supertoroid;
pub use traits::{Implicit, MassProperties, Parametric, SecondOrder, SupportMap};
pub(crate) use traits::{box_extent, finite_or_zero};
