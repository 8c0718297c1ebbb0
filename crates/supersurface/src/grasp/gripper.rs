//! A gripper as data: kind, limits and the boxes of its fingers and body, in the tool frame.

use crate::{Point, Pose, Vector};

/// Numbers from which no gripper can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("gripper {name}: {what} is {value}: it must be {range}")]
pub struct InvalidGripper {
    /// Name of the gripper.
    pub name: String,
    /// The quantity, named as in the file.
    pub what: &'static str,
    /// The value that was given, in words.
    pub value: String,
    /// The range in words.
    pub range: &'static str,
}

/// A box along the axes of the tool frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Boxed {
    /// Centre in metres.
    pub center: Point,
    /// Edge lengths in metres.
    pub size: Vector,
    /// True for the part of a finger that carries the pad.
    pub pad: bool,
}

/// A parallel jaw. Lengths in metres, forces in newtons; fields are those of the gripper file.
#[derive(Clone, Debug, PartialEq)]
pub struct Jaw {
    /// Largest distance between the pads.
    pub max_opening: f64,
    /// Least distance between the pads.
    pub min_opening: f64,
    /// Free space wanted on each side before closing; half of it is accepted where the jaw has no more.
    pub clearance: f64,
    /// Pad size along z.
    pub pad_length: f64,
    /// Pad size along y.
    pub pad_width: f64,
    /// Finger size along x, at the tip.
    pub finger_thickness: f64,
    /// z of the tip plane in the tool frame.
    pub tip_beyond_tcp: f64,
    /// Distance from the tip to the palm.
    pub finger_depth: f64,
    /// Closing force of a finger.
    pub force: f64,
    /// Friction coefficient of the pads.
    pub mu: f64,
    /// Torsional friction of a soft pad, in metres.
    pub torsion_mu: f64,
    /// Advance of the tips along z against the closed jaw, as [opening, dz] pairs in rising order; empty
    /// for a straight jaw.
    pub tip_arc: Vec<[f64; 2]>,
    /// Distance over the outer faces of the closed tips, for jaws that may press outwards.
    pub outer_width_closed: Option<f64>,
    /// Friction coefficient of the outer faces.
    pub outside_mu: f64,
    /// Boxes of the +x finger with its pad face at x = 0; the other finger is the mirror image.
    pub finger: Vec<Boxed>,
}

/// A vacuum cup. Lengths in metres, pressure in pascals.
#[derive(Clone, Debug, PartialEq)]
pub struct Cup {
    /// Radius of the lip.
    pub lip_radius: f64,
    /// Radius of the area under vacuum.
    pub inner_radius: f64,
    /// Height of the cup's apex over the lip plane.
    pub height: f64,
    /// Bellows compression available.
    pub stroke: f64,
    /// Root mean square lip gap that the rubber closes by itself.
    pub lip_tolerance: f64,
    /// Bellows self-alignment, in radians.
    pub max_tilt: f64,
    /// Smallest convex radius that still seals.
    pub min_curvature_radius: f64,
    /// Pressure below ambient at the cup.
    pub vacuum: f64,
    /// Lip friction coefficient.
    pub mu: f64,
}

/// How a gripper holds.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// Two parallel fingers.
    Jaw(Jaw),
    /// One vacuum cup.
    Suction(Cup),
}

/// A gripper. Its tool frame: z approaches, x closes, origin midway between the pads (or at the centre of
/// the lip).
#[derive(Clone, Debug, PartialEq)]
pub struct Gripper {
    /// Name, as written into results.
    pub name: String,
    /// Jaw or suction.
    pub kind: Kind,
    /// Boxes that do not move with the fingers: palm, wrist, flange.
    pub body: Vec<Boxed>,
    /// Pose of the mounting frame in the tool frame.
    pub mount: Pose,
    /// Name of the mounting frame.
    pub mount_frame: String,
    /// Straight way before the grasp, in metres.
    pub approach_distance: f64,
    /// Height of the lift after it, in metres.
    pub lift_distance: f64,
}
