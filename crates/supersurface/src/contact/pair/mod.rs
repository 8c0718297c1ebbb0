//! Two convex bodies: from the one function of a pair (`difference`) by Newton's method in coordinates that flat faces
//! need (`chart`, `descent`), over rounder bodies or a simplex where it stalls (`continuation`, `gilbert`), to the least
//! of all minima (`cells`, and `proven` for the next query), the points that it belongs to (`witness`, `common`) and its
//! derivatives (`derivative`).

mod cells;
mod chart;
mod common;
mod continuation;
mod convex;
mod derivative;
mod descent;
mod difference;
mod gilbert;
mod proven;
mod query;
mod witness;

pub use common::common_point;
pub use convex::Convex;
pub use derivative::{BodyDerivative, differentiate};
pub(super) use query::pair_by_cells;
pub use query::{Contact, WarmStart, certify, intersect, pair};
