//! Floor 6: several solids as one, by Boolean operations or by joints.

mod assembly;
mod bounds;
mod overlap;
mod program;
pub mod rfunction;
mod solid;

pub use assembly::{Assembly, Joint, JointKind, Part};
pub use rfunction::{Alpha, Blend};
pub use solid::CombinedSolid;
