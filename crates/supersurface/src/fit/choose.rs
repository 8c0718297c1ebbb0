//! Which family: by the likelihood of the points and by whether the hole is really seen.

use super::Effort;
use super::centred::spread;
use super::columns::{Evaluation, Sample, distances};
use super::finish::{BLURRED, COMPARING};
use super::misfit::correlation;
use super::parameters::Family;
use super::prepare::Normalised;
use super::rays::Rays;
use super::search::{best, schedule};
use super::smeared::smeared_cost;
use super::solver::{Hypothesis, Workspace, refine};
use super::start::quantile;
use super::terms::Sight;
use crate::Vector;

/// Lines of sight that are looked at to see whether a body is hollow.
const RAYS: usize = 48;
/// Share of points deep inside a convex body from which it may be hollow.
const HOLLOW: f64 = 0.02;
/// Share of points left out by a convex body from which it may be hollow.
const LEFT_OUT: f64 = 0.15;
/// Share of the lines of sight through a convex body from which it may be hollow.
const CROSSED: f64 = 0.03;
/// A toroid that explains its points badly must be nearer to them than the ellipsoid by this logarithm.
const CLEARLY: f64 = 0.25;
/// Fewer points than this say nothing of bodies that explain them badly.
const MANY: usize = 600;
/// Points of a scan are correlated: about so many carry the evidence of one.
const PATCH: f64 = 8.0;

/// Fewer points on the wall of a hole than this show none.
const LEAST_INNER: usize = 12;

/// Correlation of neighbouring deviations above which they are no noise.
const CORRELATED: f64 = 0.15;
/// A body with more parameters must explain its points by this much less noise: else it has taken outliers in.
const CLEANER: f64 = 0.93;

/// The best of some families and its margin in nats over the next best that was tried.
///
/// Superellipsoid and supertoroid first. Where the winner's deviations look like noise there is nothing that a
/// deformation could explain; else the deformed families stand against it by evidence.
pub(super) fn choose(cloud: &Normalised, families: &[Family]) -> (Hypothesis, f64) {
    let asked = |family| families.contains(&family);
    let plain = match (asked(Family::Superellipsoid), asked(Family::Supertoroid)) {
        (true, true) => Some(ellipsoid_or_toroid(cloud)),
        (true, false) => Some((best(cloud, Family::Superellipsoid), 0.0)),
        (false, true) => Some((best(cloud, Family::Supertoroid), 0.0)),
        (false, false) => None,
    };
    let deformed = || families.iter().filter(|f| f.is_deformed()).map(|f| best(cloud, *f));
    let rivals: Vec<Hypothesis> = match plain {
        Some((h, margin)) if correlation(cloud, &h) < CORRELATED => return (h, margin),
        Some((h, _)) => {
            let cleaner = |d: &Hypothesis| d.mixture.scale < CLEANER * h.mixture.scale;
            std::iter::once(h).chain(deformed().filter(cleaner)).collect()
        }
        None => deformed().collect(),
    };
    match by_evidence(cloud, &rivals) {
        Some((k, margin)) => {
            (rivals[k], if rivals.len() > 1 { margin } else { plain.map_or(0.0, |p| p.1) })
        }
        None => (best(cloud, Family::Superellipsoid), 0.0),
    }
}

/// The hypothesis with the most evidence and its margin over the next.
fn by_evidence(cloud: &Normalised, rivals: &[Hypothesis]) -> Option<(usize, f64)> {
    let evidence = evidence(cloud, rivals);
    let mut order: Vec<usize> = (0..rivals.len()).collect();
    order.sort_by(|a, b| evidence[*b].total_cmp(&evidence[*a]));
    let first = *order.first()?;
    Some((first, order.get(1).map_or(0.0, |second| evidence[first] - evidence[*second])))
}

/// Logarithm of the evidence of each hypothesis, up to a common constant: the likelihood of all points under the same
/// terms, at a rate of independent points, less half a logarithm of their number for every parameter (BIC).
fn evidence(cloud: &Normalised, rivals: &[Hypothesis]) -> Vec<f64> {
    let noise = rivals.iter().map(|h| h.mixture.scale).fold(f64::INFINITY, f64::min);
    let mut work = Workspace::default();
    let cost = |h: &Hypothesis, work: &mut Workspace| match cloud.terms.sight {
        Sight::AllAround { volume } if noise > BLURRED => {
            let points = spread(&cloud.points, COMPARING);
            let cost = smeared_cost(&h.parameters, &h.mixture, &points, noise, volume);
            cost * cloud.points.len() as f64 / points.len() as f64
        }
        _ => refine(h, &cloud.fine, &cloud.terms, &schedule(0, 0, 0.0), work).cost,
    };
    let independent = cloud.points.len() as f64 / PATCH;
    let price = 0.5 * independent.max(2.0).ln();
    rivals
        .iter()
        .map(|h| -cost(h, &mut work) / PATCH - price * h.parameters.family.freedoms() as f64)
        .collect()
}

/// The better of superellipsoid and supertoroid, and its margin in nats: negative where the likelihood alone speaks for a
/// ring whose hole is not seen.
fn ellipsoid_or_toroid(cloud: &Normalised) -> (Hypothesis, f64) {
    let ellipsoid = best(cloud, Family::Superellipsoid);
    if !may_be_hollow(cloud, &ellipsoid) {
        return (ellipsoid, 0.0);
    }
    let toroid = best(cloud, Family::Supertoroid);
    if cloud.effort == Effort::Thorough && matches!(cloud.terms.sight, Sight::AllAround { .. }) {
        // all of the surface is there to say whether there is a hole
        let rivals = [ellipsoid, toroid];
        return by_evidence(cloud, &rivals).map_or((ellipsoid, 0.0), |(k, m)| (rivals[k], m));
    }
    let mut margin = toroid_margin(&ellipsoid, &toroid, cloud.fine.len());
    let poor = |h: &Hypothesis| h.mixture.scale > 0.99 * h.mixture.law.largest_scale();
    if poor(&ellipsoid) && poor(&toroid) {
        // neither explains the points (a bowl): a ring that is clearly nearer to most of many says more
        let nearer = (typical(cloud, &ellipsoid) / typical(cloud, &toroid)).ln();
        margin = if cloud.fine.len() < MANY { -1.0 } else { nearer - CLEARLY };
    }
    if margin > 0.0 && shows_hole(&toroid, &cloud.points, cloud.terms.only_eye()) {
        (toroid, margin)
    } else {
        (ellipsoid, -margin)
    }
}

/// Median distance of the points.
fn typical(cloud: &Normalised, h: &Hypothesis) -> f64 {
    let mut distances = distances(&h.parameters, cloud.points.iter().copied());
    distances.iter_mut().for_each(|d| *d = d.abs());
    quantile(&mut distances, 0.5)
}

/// A hole shows itself by points or by free lines of sight that lie deep in the convex body, or by many points
/// that it leaves out: half of a ring.
fn may_be_hollow(cloud: &Normalised, h: &Hypothesis) -> bool {
    if h.mixture.outliers > LEFT_OUT {
        return true;
    }
    let deep = -(3.0 * h.mixture.scale).max(0.04);
    let deep_among = |points: &[Vector]| {
        let distances = distances(&h.parameters, points.iter().copied());
        distances.into_iter().filter(|d| *d < deep).count()
    };
    let within = deep_among(&cloud.points);
    let mut intrusions = Vec::new();
    let mut rays = Rays::default();
    cloud.terms.intrusions(&h.parameters, RAYS, true, &mut rays, &mut intrusions);
    let through = deep_among(&intrusions);
    let looked = cloud.terms.lines_of_sight(RAYS, true);
    within as f64 > HOLLOW * cloud.points.len() as f64 || through as f64 > CROSSED * looked as f64
}

/// By how many nats a point the toroid explains the same points better, after the price of its further
/// parameter (half a logarithm of the independent points, as in BIC). Positive: the toroid.
fn toroid_margin(ellipsoid: &Hypothesis, toroid: &Hypothesis, points: usize) -> f64 {
    let independent = points as f64 / PATCH;
    let price = 0.5 * independent.max(2.0).ln();
    (ellipsoid.cost - toroid.cost) / PATCH - price
}

/// True when the cloud shows the hole of a toroid: enough points lie on the inner half of the tube, none
/// lies in the mouth of the hole (a floor farther in makes it a pot), and the hole is wider than the noise.
fn shows_hole(toroid: &Hypothesis, points: &[Vector], eye: Option<Vector>) -> bool {
    let s = &toroid.parameters;
    if !s.family.is_ring() {
        return false;
    }
    let axes = s.log_axes.map(f64::exp);
    let hole = (s.ring - 1.0) * axes[0].min(axes[1]);
    let outer = (s.ring + 1.0) * axes[0].min(axes[1]);
    if hole < 4.0 * toroid.mixture.scale || hole < 0.12 * outer {
        return false;
    }
    // the side of the mid-plane on which the sensor stands; without one, or with several, both count
    let mouth = eye.map(|v| s.rotation.inverse_transform_vector(&(v - s.position)).z.signum());
    let (mut inner, mut blocked, mut inliers) = (0usize, 0usize, 0usize);
    let mut all = Evaluation::default();
    all.fill_distances(s, &Sample::new(points.iter().copied()));
    for (p, d) in points.iter().zip(&all.distances) {
        let q = s.rotation.inverse_transform_vector(&(p - s.position));
        let radius = crate::numeric::superellipse::norm(
            (q.x / axes[0]).abs(),
            (q.y / axes[1]).abs(),
            2.0 / s.exponents[1],
        );
        let before_floor = mouth.is_none_or(|m| m * q.z > 0.0);
        if radius < 0.8 * (s.ring - 1.0) && q.z.abs() < 1.2 * axes[2] && before_floor {
            blocked += 1;
        }
        if d.abs() < 4.0 * toroid.mixture.scale {
            inliers += 1;
            // on the wall of the hole, not on the ridge over it
            if radius < s.ring - 0.35 && q.z.abs() < 0.95 * axes[2] {
                inner += 1;
            }
        }
    }
    let n = points.len() as f64;
    let enough = inner as f64 > 0.025 * n && inner >= LEAST_INNER;
    inliers as f64 > 0.6 * n && enough && (blocked as f64) < 0.03 * n
}
