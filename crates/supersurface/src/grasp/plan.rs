//! From candidates to ranked grasps: propose, judge, check, and keep what is diverse.

use nalgebra::UnitQuaternion;

use super::check::{Obstruction, boxes, meets_table, obstruction};
use super::gripper::{Cup, Gripper, Jaw, Kind};
use super::hole::holes;
use super::proposals::proposals;
use super::quality::{Candidate, Judged, judge};
use super::suction::seals;
use super::surroundings::{Local, Surroundings, is_trusted};
use super::sweep::{narrowest, sweep};
use super::{Grasp, Refusal};
use crate::fit::Fit;
use crate::shape::{Implicit, Posed, SupportMap};
use crate::surface::Surface;
use crate::{Direction, Point, Pose, Vector};

/// How to plan.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GraspOptions {
    /// Most grasps an object.
    pub most: usize,
    /// Grasps with a lesser score are left out, in [0, 1].
    pub least_score: f64,
}

impl Default for GraspOptions {
    fn default() -> Self {
        Self { most: 20, least_score: 0.12 }
    }
}

/// Share of inliers from which a fit is the whole object: no handle, no rim.
const WHOLE: f64 = 0.985;
/// Sine of the steepest closing direction.
const STEEP: f64 = 0.8;
/// Opening of the jaw, times this, that no error of a fit makes up for.
const SURELY: f64 = 1.1;
/// How much narrower than expected an object may turn out, in metres.
const NARROWER: f64 = 0.006;
/// Two grasps nearer than this are one: metres and radians.
const SAME_PLACE: f64 = 0.010;
const SAME_TURN: f64 = 0.26;

/// Ways to hold an object, best first; or why there is none.
///
/// `fit` is what is known of the object's hidden side; without one, or where it fits badly or is deformed (which no table
/// knows), the points alone decide. Poses are in the frame of the cloud.
pub fn plan(
    object: usize,
    fit: Option<&Fit>,
    around: &Surroundings<'_>,
    gripper: &Gripper,
    options: &GraspOptions,
) -> Result<Vec<Grasp>, Refusal> {
    let fit = fit.filter(|f| !f.family.is_deformed());
    if let (Kind::Jaw(jaw), Some(fit)) = (&gripper.kind, fit) {
        whole_is_too_wide(fit, around, jaw)?;
    }
    let local =
        around.local(object, fit).filter(|l| l.spots.len() >= 12).ok_or(Refusal::NoPoints)?;
    let trusted = fit.filter(|_| local.trusted);
    let surface = trusted.map(|f| f.surface.moved(&around.frame.inverse()));
    let surface = surface.as_ref();
    let mut found = match &gripper.kind {
        Kind::Jaw(jaw) => by_jaw(&local, surface, jaw, gripper, options)?,
        Kind::Suction(cup) => by_suction(&local, surface, cup, gripper, options)?,
    };
    found.truncate(options.most);
    for grasp in &mut found {
        grasp.pose = canonical(&(around.frame * grasp.pose));
        for (point, normal) in &mut grasp.contacts {
            *point = around.frame * *point;
            *normal = Direction::new_unchecked(around.frame * normal.into_inner());
        }
    }
    Ok(found)
}

/// Refuses a convex body that explains all points and has no narrow side: no part of it can be held, and looking
/// for one would be in vain.
fn whole_is_too_wide(fit: &Fit, around: &Surroundings<'_>, jaw: &Jaw) -> Result<(), Refusal> {
    if !fit.surface.is_convex() || fit.inlier_share() < WHOLE || !is_trusted(fit) {
        return Ok(());
    }
    let width = |d: &Vector| (fit.surface.support_point(d) - fit.surface.support_point(&-d)).dot(d);
    // closing directions that are nearly level, and the body's own axes among them
    let lattice =
        (0..24).flat_map(|k| (-2..=2).map(move |l| [f64::from(k) / 24.0, f64::from(l) / 5.0]));
    let level = lattice.map(|[turn, slope]| {
        let (s, c) = (std::f64::consts::PI * turn).sin_cos();
        around.frame.rotation
            * Vector::new(c, s, (std::f64::consts::PI * slope / 2.0).tan()).normalize()
    });
    let up = around.frame.rotation * Vector::z();
    let axes = fit.surface.pose().rotation.to_rotation_matrix().into_inner();
    let own = axes.column_iter().map(Vector::from).filter(|d| d.dot(&up).abs() < STEEP);
    let needed = level.chain(own).map(|d| width(&d)).fold(f64::INFINITY, f64::min);
    if needed > SURELY * jaw.max_opening {
        return Err(Refusal::TooWide { needed, available: jaw.max_opening });
    }
    Ok(())
}

/// How often a candidate met what.
#[derive(Default)]
struct Met {
    table: usize,
    object: usize,
    neighbour: usize,
    solid: usize,
}

fn by_jaw(
    local: &Local,
    surface: Option<&Posed<Surface>>,
    jaw: &Jaw,
    gripper: &Gripper,
    options: &GraspOptions,
) -> Result<Vec<Grasp>, Refusal> {
    // rows first: of two equal grasps the one with a name is kept
    let mut candidates = surface.map_or_else(Vec::new, |s| proposals(s, local, jaw));
    candidates.extend(sweep(local, jaw));
    candidates.extend(holes(local, jaw));
    if candidates.is_empty() {
        return Err(match narrowest(local) {
            width if width + jaw.clearance > jaw.max_opening => {
                Refusal::TooWide { needed: width, available: jaw.max_opening }
            }
            _ => Refusal::NoContact,
        });
    }
    let mut judged: Vec<(Candidate, Judged)> = candidates
        .into_iter()
        .filter_map(|c| judge(&c, local, jaw).map(|j| (c, j)))
        .filter(|(_, j)| j.score >= options.least_score)
        .collect();
    judged.sort_by(|a, b| b.1.score.total_cmp(&a.1.score));
    if judged.is_empty() {
        let width = narrowest(local);
        return Err(if width + jaw.clearance > jaw.max_opening {
            Refusal::TooWide { needed: width, available: jaw.max_opening }
        } else {
            Refusal::NoContact
        });
    }
    let mut met = Met::default();
    let mut out: Vec<Grasp> = Vec::new();
    for (candidate, judged) in judged {
        if out.len() == options.most {
            break;
        }
        let grasp = jaw_grasp(&candidate, judged, jaw);
        if out.iter().any(|other| same(&other.pose, &grasp.pose)) {
            continue;
        }
        let gap = if candidate.inside { 0.0 } else { grasp.opening };
        // the tips of a linkage come out as it closes, and an object may be narrower than it seems
        let width = if candidate.inside { 0.0 } else { candidate.width };
        let closed = boxes(gripper, (width - NARROWER).max(0.0), width);
        let met_table = !candidate.inside && meets_table(&closed, &grasp.pose, local);
        let way = gripper.approach_distance;
        let open = obstruction(&boxes(gripper, gap, width), &grasp.pose, way, local);
        match open.or(met_table.then_some(Obstruction::Table)) {
            None => out.push(grasp),
            Some(Obstruction::Table) => met.table += 1,
            Some(Obstruction::Object) => met.object += 1,
            Some(Obstruction::Neighbour) => met.neighbour += 1,
            Some(Obstruction::Solid) => met.solid += 1,
        }
    }
    if out.is_empty() { Err(blocked(&met)) } else { Ok(out) }
}

fn blocked(met: &Met) -> Refusal {
    Refusal::Blocked {
        table: met.table,
        object: met.object,
        neighbour: met.neighbour,
        solid: met.solid,
    }
}

fn jaw_grasp(candidate: &Candidate, judged: Judged, jaw: &Jaw) -> Grasp {
    let opening = if candidate.inside {
        jaw.outer_width_closed.unwrap_or(candidate.width)
    } else {
        (candidate.width + 2.0 * jaw.clearance + 0.004).min(jaw.max_opening)
    };
    Grasp {
        pose: candidate.pose,
        opening,
        contact_width: candidate.width,
        inside: candidate.inside,
        score: judged.score,
        terms: judged.terms,
        source: candidate.source,
        contacts: judged.contacts,
    }
}

fn by_suction(
    local: &Local,
    surface: Option<&Posed<Surface>>,
    cup: &Cup,
    gripper: &Gripper,
    options: &GraspOptions,
) -> Result<Vec<Grasp>, Refusal> {
    let volume = surface.map_or_else(|| box_volume(local), |s| s.shape().volume());
    let (seals, miss) = seals(local, surface, cup, volume);
    if seals.is_empty() && miss.heavy > 0 {
        return Err(Refusal::TooHeavy { lip_radius: cup.lip_radius });
    }
    if seals.is_empty() {
        return Err(Refusal::NoSeal {
            radius: cup.lip_radius,
            gap: miss.gap,
            tolerance: cup.lip_tolerance,
        });
    }
    let parts = boxes(gripper, 0.0, 0.0);
    let mut met = Met::default();
    let mut out: Vec<Grasp> = Vec::new();
    for seal in seals.into_iter().filter(|s| s.score >= options.least_score) {
        if out.len() == options.most {
            break;
        }
        if out.iter().any(|other| same(&other.pose, &seal.pose)) {
            continue;
        }
        match obstruction(&parts, &seal.pose, gripper.approach_distance, local) {
            None => out.push(Grasp {
                pose: seal.pose,
                opening: 0.0,
                contact_width: 0.0,
                inside: false,
                score: seal.score,
                terms: seal.terms,
                source: seal.source,
                contacts: vec![seal.contact],
            }),
            Some(Obstruction::Table) => met.table += 1,
            Some(Obstruction::Object) => met.object += 1,
            Some(Obstruction::Neighbour) => met.neighbour += 1,
            Some(Obstruction::Solid) => met.solid += 1,
        }
    }
    match (out.is_empty(), met.table + met.object + met.neighbour + met.solid) {
        (false, _) => Ok(out),
        (true, 0) => Err(Refusal::TooHeavy { lip_radius: cup.lip_radius }),
        (true, _) => Err(blocked(&met)),
    }
}

/// Two thirds of the box of what was seen, down to the table.
fn box_volume(local: &Local) -> f64 {
    let bounds = local.spots.iter().fold(None, |b: Option<(Point, Point)>, s| {
        Some(b.map_or((s.at, s.at), |(l, h)| (l.inf(&s.at), h.sup(&s.at))))
    });
    bounds.map_or(0.0, |(low, high)| {
        let size = high - low;
        2.0 / 3.0 * size.x * size.y * (local.heights[1] - local.heights[0]).max(size.z)
    })
}

/// Of the two quaternions of a rotation the one whose scalar part is not negative.
fn canonical(pose: &Pose) -> Pose {
    let q = pose.rotation.into_inner();
    let q = if q.w < 0.0 { -q } else { q };
    Pose::from_parts(pose.translation, UnitQuaternion::new_unchecked(q))
}

/// The same grasp, also when turned by half a turn about its approach.
fn same(a: &Pose, b: &Pose) -> bool {
    let place = (a.translation.vector - b.translation.vector).norm();
    let turn = a.rotation.angle_to(&b.rotation);
    let flipped = a.rotation * UnitQuaternion::from_scaled_axis(Vector::z() * std::f64::consts::PI);
    place < SAME_PLACE && turn.min(flipped.angle_to(&b.rotation)) < SAME_TURN
}
