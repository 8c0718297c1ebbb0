//! Where a vacuum cup seals and what it can carry.
//!
//! Places are spread over what was seen, and the rows of the decision tables name some more. Where points are, they
//! decide: the lip's ring must lie on matter all around, near a plane; the cup goes in along that plane's
//! normal. On the hidden side of a trusted fit its closed form decides (the sag test of rows S and T), at a
//! lower score. What a cup carries is limited less by the pull than by the peel: the moment of the object's
//! weight about the lip.

use nalgebra::Matrix3;

use super::gripper::Cup;
use super::proposals::{cup_places, upright_tool};
use super::surroundings::Local;
use super::tables::CupRow;
use crate::cloud::VoxelGrid;
use crate::numeric::symmetric::least_axis;
use crate::shape::Posed;
use crate::surface::Surface;
use crate::{Direction, Point, Pose, Vector};

/// Sectors of the lip's ring that must all hold matter.
const SECTORS: usize = 12;
/// Density at which an object's weight is guessed, in kg/m³.
const DENSITY: f64 = 600.0;
/// Weight times this covers shaking.
const SHAKING: f64 = 1.6;
/// Worth of a place that only the fit shows.
const HIDDEN: f64 = 0.5;
/// Load, as a share of what the cup holds, beyond which no error of the guessed weight helps.
const HOPELESS: f64 = 3.0;
/// Places that are tried.
const TRIED: usize = 350;

/// A place for the cup in the frame of the table.
#[derive(Clone, Debug)]
pub(super) struct Seal {
    pub(super) pose: Pose,
    pub(super) score: f64,
    pub(super) terms: Vec<(&'static str, f64)>,
    pub(super) contact: (Point, Direction),
    pub(super) source: &'static str,
}

/// The best of what was tried and did not seal, for the refusal.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct NearMiss {
    /// Least root mean square gap under the whole lip, in metres; infinite where the lip never lies on matter.
    pub(super) gap: f64,
    /// Places where the cup seals but the object's weight would tear it off.
    pub(super) heavy: usize,
}

/// Places where the cup seals, best first, and the nearest miss. `volume` is the object's, in m³; `surface` a
/// trusted fit in the frame of the table.
pub(super) fn seals(
    local: &Local,
    surface: Option<&Posed<Surface>>,
    cup: &Cup,
    volume: f64,
) -> (Vec<Seal>, NearMiss) {
    let seen: Vec<usize> = (0..local.spots.len()).filter(|i| local.spots[*i].seen).collect();
    let places: Vec<Point> = seen.iter().map(|i| local.spots[*i].at).collect();
    let mut miss = NearMiss { gap: f64::INFINITY, heavy: 0 };
    let radius = 1.15 * cup.lip_radius;
    let Some(grid) = VoxelGrid::new(&places, 0..places.len() as u32, 0.5 * radius) else {
        return (Vec::new(), miss);
    };
    let mut out = Vec::new();
    let stride = seen.len().div_ceil(TRIED).max(1);
    let mut near: Vec<Vector> = Vec::new();
    let look = |at: &Point, near: &mut Vec<Vector>| {
        near.clear();
        grid.within(at, radius, |i, _| near.push(places[i as usize] - at));
    };
    // rows first: of two equal places the one with a name is kept
    for (row, pose) in surface.map(cup_places).unwrap_or_default() {
        let at = Point::from(pose.translation.vector);
        let outward = pose.rotation * -Vector::z();
        if local.has_table && outward.z < -0.2 {
            continue;
        }
        look(&at, &mut near);
        out.extend(if near.is_empty() {
            modelled(local, cup, volume, &row, &pose, &mut miss)
        } else {
            seal(local, cup, volume, (&at, &outward), &near, row.table, &mut miss)
        });
    }
    for k in (0..seen.len()).step_by(stride) {
        let spot = local.spots[seen[k]];
        if spot.normal == Vector::zeros() || (local.has_table && spot.normal.z < -0.2) {
            continue;
        }
        look(&spot.at, &mut near);
        let place = (&spot.at, &spot.normal);
        out.extend(seal(local, cup, volume, place, &near, "flat spot", &mut miss));
    }
    out.sort_by(|a, b| b.score.total_cmp(&a.score));
    (out, miss)
}

/// A row on the hidden side, where the closed form has the say.
fn modelled(
    local: &Local,
    cup: &Cup,
    volume: f64,
    row: &CupRow,
    pose: &Pose,
    miss: &mut NearMiss,
) -> Option<Seal> {
    let lip = Point::from(pose.translation.vector);
    let sag = row.sag(cup.lip_radius);
    let sharpest = row.sections.iter().map(|s| s.curvature().unwrap_or(f64::INFINITY));
    if sag > cup.lip_tolerance || sharpest.fold(0.0, f64::max) * cup.min_curvature_radius > 1.0 {
        return None;
    }
    let normal = pose.rotation * -Vector::z();
    let closed = (1.0 - sag / cup.lip_tolerance).clamp(0.0, 1.0);
    let Some(mut seal) = carried(local, cup, volume, &lip, &normal, closed, row.table) else {
        miss.heavy += 1;
        return None;
    };
    seal.terms.push(("seen", 0.0));
    seal.score *= HIDDEN;
    Some(seal)
}

fn seal(
    local: &Local,
    cup: &Cup,
    volume: f64,
    (at, outward): (&Point, &Vector),
    near: &[Vector],
    source: &'static str,
    miss: &mut NearMiss,
) -> Option<Seal> {
    if near.len() < 16 {
        return None;
    }
    let count = near.len() as f64;
    let mean = near.iter().sum::<Vector>() / count;
    let scatter: Matrix3<f64> = near.iter().map(|d| (d - mean) * (d - mean).transpose()).sum();
    let (_, axis) = least_axis(&(scatter / count));
    let normal = if axis.dot(outward) < 0.0 { -axis } else { axis };
    let helper = if normal.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
    let u = (helper - normal * normal.dot(&helper)).normalize();
    let v = normal.cross(&u);
    // the ring under the lip, about the place itself
    let (mut sectors, mut square, mut ring) = ([false; SECTORS], 0.0, 0usize);
    let mut inner = 0usize;
    for d in near {
        let height = (d - mean).dot(&normal);
        let (a, b) = (d.dot(&u), d.dot(&v));
        let r = a.hypot(b) / cup.lip_radius;
        if r > 0.7 {
            let turn = b.atan2(a) / std::f64::consts::TAU + 0.5;
            if height.abs() < 2.0 * cup.lip_tolerance + 0.001 {
                sectors[((turn * SECTORS as f64) as usize).min(SECTORS - 1)] = true;
            }
            square += height * height;
            ring += 1;
        } else {
            inner += 1;
        }
    }
    let covered = sectors.iter().filter(|s| **s).count();
    if covered < SECTORS || inner < 4 {
        return None;
    }
    let gap = (square / ring as f64).sqrt();
    miss.gap = miss.gap.min(gap);
    // the noise of the points counts as gap too: a little is forgiven
    if gap > cup.lip_tolerance {
        return None;
    }
    let lip = at + normal * mean.dot(&normal);
    let closed = (1.0 - gap / cup.lip_tolerance).clamp(0.0, 1.0);
    let seal = carried(local, cup, volume, &lip, &normal, closed, source);
    miss.heavy += usize::from(seal.is_none());
    seal
}

/// What a cup that closes at a place can carry; `None` where the object is far too heavy for it there. `closed` says how well its lip lies there, in [0, 1].
fn carried(
    local: &Local,
    cup: &Cup,
    volume: f64,
    lip: &Point,
    normal: &Vector,
    closed: f64,
    source: &'static str,
) -> Option<Seal> {
    let arm = local.centre - lip;
    let across = arm - normal * arm.dot(normal);
    let lever = across.norm();
    let tilted = normal.xy().norm();
    // hanging under the cup the moment is that of the lever; held from the side the whole arm counts
    let moment_arm = lever.max(tilted * arm.norm());
    let pull = cup.vacuum * std::f64::consts::PI * cup.inner_radius * cup.inner_radius;
    let weight = SHAKING * 9.81 * DENSITY * volume;
    let peel = 0.5 * cup.lip_radius * (pull - weight * normal.z.max(0.0)).max(0.0);
    let shear = cup.mu * (pull - weight * normal.z.max(0.0)).max(0.0);
    let load = (weight * moment_arm / peel.max(1e-9)).max(weight * tilted / shear.max(1e-9));
    if load > HOPELESS {
        return None;
    }
    let terms = vec![
        ("seal", closed),
        ("lever", 1.0 / (1.0 + (lever / 0.02) * (lever / 0.02))),
        ("load", (1.5 - load).clamp(0.0, 1.0)),
        ("approach", 0.5 * (1.0 + normal.z)),
    ];
    let [seal, lever_term, load_term, approach] = [terms[0].1, terms[1].1, terms[2].1, terms[3].1];
    let score = (0.3 + 0.7 * load_term) * (0.45 * seal + 0.4 * lever_term + 0.15 * approach);
    Some(Seal {
        pose: Pose::from_parts(lip.coords.into(), upright_tool(&-normal)),
        score,
        terms,
        contact: (*lip, Direction::new_unchecked(*normal)),
        source,
    })
}
