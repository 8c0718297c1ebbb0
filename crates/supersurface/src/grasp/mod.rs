//! Floor 8: where to hold an object.
//!
//! The tool frame (TCP) has its origin midway between the pads at pad centre (suction: at the centre of
//! the uncompressed lip), z approaches, x closes, y = z × x.

mod gripper;

pub use gripper::{Boxed, Cup, Gripper, InvalidGripper, Jaw, Kind};

use crate::{Direction, Point, Pose};

/// One way to hold an object.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Grasp {
    /// Pose of the tool frame in the frame of the cloud.
    pub pose: Pose,
    /// Jaw opening while approaching, in metres (inside grasps: over the outer faces; suction: 0).
    pub opening: f64,
    /// Expected distance between the contacts, in metres (suction: 0).
    pub contact_width: f64,
    /// True for a grasp that goes into a hole and presses outwards.
    pub inside: bool,
    /// In [0, 1], larger is better; comparable within one run and gripper.
    pub score: f64,
    /// The terms of the score by name, each in [0, 1].
    pub terms: Vec<(&'static str, f64)>,
    /// Where it comes from: a row of the decision tables ("T4a", "P2") or a search on the points.
    pub source: &'static str,
    /// Contact points and the outward normals of the object there.
    pub contacts: Vec<(Point, Direction)>,
}

/// Why an object cannot be held.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum Refusal {
    /// Every way to close needs more than the jaw has.
    #[error("wider than the jaw: {needed:.3} m against {available:.3} m")]
    TooWide {
        /// Narrowest opening that would do, in metres.
        needed: f64,
        /// Largest opening of the jaw, in metres.
        available: f64,
    },
}

/// stub
#[derive(Clone, Debug, Default)]
pub struct GraspOptions {}
/// stub
#[derive(Clone, Debug)]
pub struct Surroundings<'a> { _c: &'a crate::cloud::PointCloud }
impl<'a> Surroundings<'a> {
    /// stub
    pub fn new(c: &'a crate::cloud::PointCloud, _s: &'a crate::segment::Segmentation) -> Self { Self { _c: c } }
}
/// stub
pub fn plan(_object: usize, _fit: Option<&crate::fit::Fit>, _around: &Surroundings<'_>, _g: &Gripper, _o: &GraspOptions) -> Result<Vec<Grasp>, Refusal> {
    Err(Refusal::TooWide { needed: 0.0, available: 0.0 })
}
