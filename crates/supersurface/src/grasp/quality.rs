//! How good a jaw grasp is, measured on the places that its pads touch.

use super::gripper::Jaw;
use super::surroundings::{Local, Spot};
use crate::{Direction, Point, Pose, Vector};

/// A jaw grasp in the frame of the table, before it is judged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    /// Pose of the tool frame.
    pub(super) pose: Pose,
    /// Distance between the contacts.
    pub(super) width: f64,
    /// Goes into a hole and presses outwards.
    pub(super) inside: bool,
    pub(super) source: &'static str,
}

/// What the pads of a candidate touch, and the terms of its score.
#[derive(Clone, Debug)]
pub(super) struct Judged {
    pub(super) score: f64,
    pub(super) terms: Vec<(&'static str, f64)>,
    pub(super) contacts: Vec<(Point, Direction)>,
}

/// Places within this distance of a pad's plane are touched, in metres.
const TOUCH: f64 = 0.004;
/// Weight of a hidden place with a normal from the fit, and of one without, against a seen one.
const MODELLED: f64 = 0.6;
const GUESSED: f64 = 0.3;
/// Weight of touched places that fill a pad.
const FULL: f64 = 8.0;
/// Lever arm at which a grasp is worth half, in metres.
const LEVER: f64 = 0.04;
/// Free opening beyond the clearance at which the margin is full, in metres.
const MARGIN: f64 = 0.008;

/// One pad's share in a grasp.
#[derive(Clone, Copy, Debug, Default)]
struct Side {
    weight: f64,
    seen: f64,
    /// Weight of the places whose normal lies in the friction cone, and outside.
    good: f64,
    bad: f64,
    cells: [bool; 9],
    sum: Vector,
    normal: Vector,
}

impl Side {
    fn add(&mut self, spot: &Spot, q: &Point, outward: f64, cone: f64, cell: usize) {
        let known = spot.normal != Vector::zeros();
        let weight = match (spot.seen, known) {
            (true, _) => 1.0,
            (false, true) => MODELLED,
            (false, false) => GUESSED,
        };
        self.weight += weight;
        if spot.seen {
            self.seen += 1.0;
        }
        if known {
            if outward > cone {
                self.good += weight
            } else {
                self.bad += weight
            }
            self.normal += spot.normal * weight;
        }
        self.cells[cell.min(8)] = true;
        self.sum += q.coords * weight;
    }

    fn covered(&self) -> f64 {
        self.cells.iter().filter(|c| **c).count() as f64 / 9.0
    }

    /// Share of the normals in the cone; without any known normal a middling guess.
    fn straight(&self) -> f64 {
        (self.good + 0.5) / (self.good + self.bad + 1.0)
    }
}

/// Judges a candidate; `None` when a pad touches nothing.
pub(super) fn judge(candidate: &Candidate, local: &Local, jaw: &Jaw) -> Option<Judged> {
    let axes = candidate.pose.rotation.to_rotation_matrix();
    let origin = Point::from(candidate.pose.translation.vector);
    let (mu, outside) = if candidate.inside { (jaw.outside_mu, -1.0) } else { (jaw.mu, 1.0) };
    // cos(atan mu)
    let cone = 1.0 / (1.0 + mu * mu).sqrt();
    let tip = jaw.tip_beyond_tcp;
    let half = 0.5 * candidate.width;
    let mut sides = [Side::default(); 2];
    // the ball around the places that one pad touches
    let reach = (1.5 * TOUCH).hypot(0.525 * jaw.pad_width).hypot(0.55 * jaw.pad_length);
    for (side, sign) in sides.iter_mut().zip([1.0, -1.0]) {
        let pad = candidate.pose * Point::new(sign * half, 0.0, tip - 0.5 * jaw.pad_length);
        for spot in local.clumps.near(pad, reach).flat_map(|k| &local.spots[k]) {
            if (spot.at - pad).norm_squared() > reach * reach {
                continue;
            }
            let q = Point::from(axes.inverse_transform_vector(&(spot.at - origin)));
            let (y, z) = (q.y / (0.5 * jaw.pad_width), (tip - q.z) / jaw.pad_length);
            if y.abs() > 1.05 || !(-0.05..=1.05).contains(&z) || q.x * sign < 0.0 {
                continue;
            }
            // inside grasps touch from within: the matter lies beyond the pads
            let depth = (half - q.x.abs()) * outside;
            if !(-0.5 * TOUCH..=TOUCH).contains(&depth) {
                continue;
            }
            let outward = axes.matrix().column(0).dot(&spot.normal) * sign * outside;
            let column = (((y + 1.0) * 1.5) as usize).min(2);
            let row = ((z * 3.0).max(0.0) as usize).min(2);
            side.add(spot, &q, outward, cone, 3 * row + column);
        }
    }
    let [a, b] = &sides;
    if a.weight < 0.5 || b.weight < 0.5 {
        return None;
    }
    let closing = candidate.pose.rotation * Vector::x();
    let arm = local.centre - Point::from(candidate.pose.translation.vector);
    let across = arm - closing * arm.dot(&closing);
    // gravity turns by the horizontal arm, shaking by the vertical one too
    let lever = across.x.hypot(across.y).hypot(0.5 * across.z);
    let free = jaw.max_opening - candidate.width - jaw.clearance;
    let approach = candidate.pose.rotation * Vector::z();
    let contact = |s: &Side| (s.weight / FULL).min(1.0);
    let seen = 0.5 * ((a.seen / FULL).min(1.0) + (b.seen / FULL).min(1.0));
    let straight = a.straight().min(b.straight());
    let terms = vec![
        ("contact", contact(a).min(contact(b)).sqrt()),
        ("seen", seen),
        ("patch", a.covered().min(b.covered())),
        ("normal", straight),
        ("lever", 1.0 / (1.0 + (lever / LEVER) * (lever / LEVER))),
        ("margin", if candidate.inside { 1.0 } else { (free / MARGIN).clamp(0.0, 1.0) }),
        ("approach", 0.5 * (1.0 - approach.z)),
    ];
    Some(Judged { score: score(&terms), terms, contacts: contacts(candidate, &sides, outside) })
}

fn contacts(candidate: &Candidate, sides: &[Side; 2], outside: f64) -> Vec<(Point, Direction)> {
    let mut out = Vec::with_capacity(2);
    for (k, side) in sides.iter().enumerate() {
        let sign = if k == 0 { 1.0 } else { -1.0 };
        let mean = side.sum / side.weight;
        let at = candidate.pose * Point::new(sign * 0.5 * candidate.width, mean.y, mean.z);
        let straight = candidate.pose.rotation * Vector::new(sign * outside, 0.0, 0.0);
        let normal = Direction::try_new(side.normal, 1e-9);
        out.push((at, normal.unwrap_or(Direction::new_unchecked(straight))));
    }
    out
}

/// Terms that spoil a grasp alone are factors; the others are weighed against each other.
fn score(terms: &[(&'static str, f64)]) -> f64 {
    let term = |name: &str| terms.iter().find(|t| t.0 == name).map_or(0.0, |t| t.1);
    let weighed =
        0.25 * term("seen") + 0.25 * term("patch") + 0.35 * term("lever") + 0.15 * term("approach");
    let spoiling = term("contact") * (0.1 + 0.9 * term("normal")) * (0.3 + 0.7 * term("margin"));
    (spoiling * weighed).clamp(0.0, 1.0)
}
