//! Floor 7: from a cloud to the table plane and the objects on it.

use crate::shape::Plane;

/// What a cloud is made of. Indices into the cloud's points; never copies.
#[derive(Clone, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Segmentation {
    /// The plane that the objects stand on, its normal towards the sensor; `None` when the objects
    /// were given.
    pub support: Option<Plane>,
    /// Standard deviation of the support's own points about it, in metres.
    pub support_noise: f64,
    /// Points of each object.
    pub objects: Vec<Vec<u32>>,
    /// What was seen above the support and left out, with the reason.
    pub dropped: Vec<Dropped>,
}

/// A piece that is not reported as an object.
#[derive(Clone, Debug, PartialEq)]
pub struct Dropped {
    /// Its points.
    pub points: Vec<u32>,
    /// Why.
    pub reason: DropReason,
}

/// Why a piece was left out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum DropReason {
    /// Too few points or too small to be an object.
    Speck,
}
