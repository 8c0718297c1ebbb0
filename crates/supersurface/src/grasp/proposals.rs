//! Candidates from the decision tables: a row fixes the contacts, the rest is free.
//!
//! Free are the angle of the approach about the closing line and, where the surface is flat, the place of the
//! pads on it: along the pads' width, and as deep as palm and table allow.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::gripper::Jaw;
use super::quality::Candidate;
use super::surroundings::Local;
use super::tables::{Bands, CupRow, JawRow, cup_rows, jaw_rows};
use crate::shape::{Implicit, Posed, SupportMap};
use crate::surface::Surface;
use crate::{Direction, Pose, Vector};

/// Steps of the approach's angle about the closing line.
const TURN: f64 = std::f64::consts::FRAC_PI_8;
/// Rows that may turn freely about z are taken so often in half a turn.
const DIRECTIONS: usize = 6;
/// Shifts of the pads on flat sides along their width and along the approach, in metres.
const SHIFTS: [f64; 7] = [0.0, -0.012, 0.012, -0.025, 0.025, -0.045, 0.045];
/// A shifted contact may leave the surface by this much, in metres.
const OFF: f64 = 0.0015;
/// Approaches from further below than this are no use.
const FROM_BELOW: f64 = 0.3;
/// Room between the closed jaw and a hole, and to the palm, in metres.
const ROOM: f64 = 0.002;
/// Tips stay this far above the table.
const FLOOR: f64 = 0.003;
/// Candidates that are kept for judgement.
const KEPT: usize = 60;

/// The most promising candidates of all rows; `surface` is in the frame of the table.
pub(super) fn proposals(surface: &Posed<Surface>, local: &Local, jaw: &Jaw) -> Vec<Candidate> {
    let mut found: Vec<(f64, Candidate)> = Vec::new();
    for row in jaw_rows(surface.shape(), &Bands::default()).iter().filter(|r| fits(r, jaw)) {
        for turn in turns(row.turning) {
            propose(surface, row, &turn, local, jaw, &mut found);
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0));
    found.truncate(KEPT);
    found.into_iter().map(|(_, c)| c).collect()
}

/// The cup's rows turned into the frame of the table: contact poses with z into the surface.
pub(super) fn cup_places(surface: &Posed<Surface>) -> Vec<(CupRow, Pose)> {
    let mut out = Vec::new();
    for row in cup_rows(surface.shape(), &Bands::default()) {
        // a row that turns freely stands for the whole circle
        let places = if row.turning { 2 * DIRECTIONS } else { 1 };
        for k in 0..places {
            let turn = about_z(std::f64::consts::TAU * k as f64 / places as f64);
            let z = surface.pose().rotation * (turn * -row.normal.into_inner());
            let at = surface.pose() * (turn * row.contact);
            out.push((row.clone(), Pose::from_parts(at.coords.into(), upright_tool(&z))));
        }
    }
    out
}

fn turns(free: bool) -> Vec<UnitQuaternion<f64>> {
    let count = if free { DIRECTIONS } else { 1 };
    (0..count).map(|k| about_z(std::f64::consts::PI * k as f64 / count as f64)).collect()
}

fn about_z(angle: f64) -> UnitQuaternion<f64> {
    UnitQuaternion::from_axis_angle(&Vector::z_axis(), angle)
}

/// Some tool orientation with this approach.
pub(super) fn upright_tool(z: &Vector) -> UnitQuaternion<f64> {
    let helper = if z.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
    tool(&(helper - z * z.dot(&helper)).normalize(), z)
}

fn tool(x: &Vector, z: &Vector) -> UnitQuaternion<f64> {
    let axes = Matrix3::from_columns(&[*x, z.cross(x), *z]);
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes))
}

/// The opening suits the jaw.
fn fits(row: &JawRow, jaw: &Jaw) -> bool {
    let width = row.width();
    match (row.inside, jaw.outer_width_closed) {
        (false, _) => width + jaw.clearance <= jaw.max_opening && width > jaw.min_opening,
        (true, Some(closed)) => {
            // flat pads meet a round hole with their edges
            width > closed + 2.0 * ROOM && width < closed + jaw.max_opening - 0.006
        }
        (true, None) => false,
    }
}

fn propose(
    surface: &Posed<Surface>,
    row: &JawRow,
    turn: &UnitQuaternion<f64>,
    local: &Local,
    jaw: &Jaw,
    found: &mut Vec<(f64, Candidate)>,
) {
    let to_table = surface.pose().rotation * turn;
    let Some(closing) = row.closing() else { return };
    let closing = Direction::new_unchecked(to_table * closing.into_inner());
    let steps = (row.freedom / TURN + 0.5) as i32;
    for step in -steps..=steps {
        let about = UnitQuaternion::from_axis_angle(&closing, TURN * f64::from(step));
        let named = about * (to_table * row.approach.into_inner());
        for approach in [named, -named] {
            if approach.z > FROM_BELOW && local.has_table {
                continue;
            }
            let hand = Hand { row, closing: closing.into_inner(), approach };
            hand.place(surface, turn, local, jaw, found);
        }
    }
}

/// A row with its approach, in the frame of the table.
struct Hand<'a> {
    row: &'a JawRow,
    closing: Vector,
    approach: Vector,
}

impl Hand<'_> {
    fn place(
        &self,
        surface: &Posed<Surface>,
        turn: &UnitQuaternion<f64>,
        local: &Local,
        jaw: &Jaw,
        found: &mut Vec<(f64, Candidate)>,
    ) {
        let (width, rotation) = (self.row.width(), tool(&self.closing, &self.approach));
        let contacts = self.row.contacts.map(|(p, n)| {
            let n = surface.pose().rotation * (turn * n.into_inner());
            (surface.pose() * (turn * p), n)
        });
        let along = self.approach.cross(&self.closing);
        let back = surface.support_point(&-self.approach);
        let mu = if self.row.inside { jaw.outside_mu } else { jaw.mu };
        let cone = 1.0 / mu.hypot(1.0);
        // an inside grasp ends where the wider part of the fingers meets the rim
        let reach = if self.row.inside { jaw.pad_length } else { jaw.finger_depth } - ROOM;
        for deeper in SHIFTS {
            for beside in SHIFTS {
                let shift = self.approach * deeper + along * beside;
                let held = contacts.iter().all(|(p, n)| {
                    let p = surface.to_local(&(p + shift));
                    let normal = surface.pose().rotation * surface.shape().gradient(&p);
                    surface.shape().first_order_distance(&p).abs() < OFF
                        && normal.dot(n) > cone * normal.norm()
                });
                if !held {
                    continue;
                }
                let middle = nalgebra::center(&contacts[0].0, &contacts[1].0) + shift;
                let tip = middle + self.approach * jaw.tip_beyond_tcp;
                if (tip - back).dot(&self.approach) > reach || (local.has_table && tip.z < FLOOR) {
                    continue;
                }
                let arm = (middle - local.centre).cross(&self.closing).norm();
                let edge = if self.row.is_edge() { 0.05 } else { 0.0 };
                let cost = arm + 0.02 * self.approach.z + edge + 0.01 * f64::from(self.row.rank);
                let pose = Pose::from_parts(middle.coords.into(), rotation);
                let (inside, source) = (self.row.inside, self.row.table);
                found.push((cost, Candidate { pose, width, inside, source }));
            }
        }
    }
}
