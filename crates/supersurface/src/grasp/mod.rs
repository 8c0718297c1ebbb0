//! Floor 8: where to hold an object.
//!
//! The tool frame (TCP) has its origin midway between the pads at pad centre (suction: at the centre of
//! the uncompressed lip), z approaches, x closes, y = z × x.

mod check;
mod clumps;
mod gripper;
mod hole;
mod plan;
mod proposals;
mod quality;
mod section;
mod shell;
mod sight;
mod strip;
mod suction;
mod surroundings;
mod sweep;
mod tables;

pub use gripper::{Boxed, Cup, Gripper, InvalidGripper, Jaw, Kind};
pub use plan::{GraspOptions, plan};
pub use section::{Section, Stationary};
pub use surroundings::Surroundings;
pub use tables::{Bands, CupRow, JawRow, Profile, cup_rows, jaw_rows};

use crate::{Direction, Point, Pose};

/// One way to hold an object.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Grasp {
    /// Pose of the tool frame in the frame of the cloud: the pads (or the lip) stand in its origin once the
    /// jaw has closed to `contact_width`. The tips of a linkage move on an arc and are behind it before.
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
    /// Too little of the object was seen.
    #[error("too few points to plan on")]
    NoPoints,
    /// Every way to close needs more than the jaw has.
    #[error("wider than the jaw: {needed:.3} m against {available:.3} m")]
    TooWide {
        /// Least width of the object over the ways to close, in metres.
        needed: f64,
        /// Largest opening of the jaw, in metres.
        available: f64,
    },
    /// Nowhere do two sides face the pads well enough.
    #[error("no two opposite sides that the pads could press on")]
    NoContact,
    /// Every grasp runs into something on its way in.
    #[error(
        "every way in is blocked: {table} grasps meet the table, {object} the object itself, \
         {neighbour} a neighbour, {solid} a wall, a board above or furniture"
    )]
    Blocked {
        /// Grasps that meet the table.
        table: usize,
        /// Grasps that meet the object, or what nobody saw behind it.
        object: usize,
        /// Grasps that meet something else.
        neighbour: usize,
        /// Grasps that meet a wall, a board above or furniture.
        solid: usize,
    },
    /// The cup seals nowhere.
    #[error(
        "no flat spot for a cup of {:.0} mm: {}", 2e3 * radius, near_miss(*gap, *tolerance)
    )]
    NoSeal {
        /// Radius of the lip, in metres.
        radius: f64,
        /// Least gap under the lip, in metres; infinite where the lip never lies on the object.
        gap: f64,
        /// Gap that the rubber closes, in metres.
        tolerance: f64,
    },
    /// The cup seals, but not where it could carry the object.
    #[error("a cup of {:.0} mm seals only where the object's weight would peel it off", 2e3 * lip_radius)]
    TooHeavy {
        /// Radius of the lip, in metres.
        lip_radius: f64,
    },
}

fn near_miss(gap: f64, tolerance: f64) -> String {
    if gap.is_finite() {
        format!(
            "the least gap under the lip is {:.1} mm against {:.1} mm",
            1e3 * gap,
            1e3 * tolerance
        )
    } else {
        "its lip nowhere lies on the object all around".to_owned()
    }
}
