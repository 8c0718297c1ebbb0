//! Which family: by the likelihood of the points and by whether the hole is really seen.

use super::Effort;
use super::centred::{Placement, spread};
use super::columns::{Evaluation, Sample, distances};
use super::coverage::shows_a_part;
use super::finish::{BLURRED, COMPARING};
use super::misfit::correlation;
use super::parameters::{Family, Parameters};
use super::prepare::Normalised;
use super::rays::Rays;
use super::samples::sample;
use super::search::{best, schedule};
use super::smeared::smeared_cost;
use super::solver::{Hypothesis, Workspace, refine};
use super::start::quantile;
use super::switch::cycled;
use super::terms::{Sight, Terms};
use crate::Vector;
use crate::numeric::random::Stream;

/// Lines of sight that are looked at to see whether a body is hollow.
const RAYS: usize = 48;
/// Share of points deep inside a convex body from which it may be hollow.
const HOLLOW: f64 = 0.02;
/// Share of points left out by a convex body from which it may be hollow.
const LEFT_OUT: f64 = 0.15;
/// Share of the lines of sight deep through a convex body from which it may be hollow, and of those through it at all, as a thin
/// one is nowhere deep.
const CROSSED: f64 = 0.03;
const ENTERED: f64 = 0.1;
/// Depth in a body, in normalised lengths, to which lines of sight come at its rim.
const GRAZING: f64 = 0.04;
/// A toroid that explains its points badly must be nearer to them than the ellipsoid by this logarithm.
const CLEARLY: f64 = 0.25;
/// Fewer points than this say nothing of bodies that explain them badly.
const MANY: usize = 600;
/// Points of a scan are correlated: about so many carry the evidence of one.
const PATCH: f64 = 8.0;

/// Fewer points on the wall of a hole than this show none.
const LEAST_INNER: usize = 12;

/// Nats from which evidence is plain.
const PLAIN: f64 = 5.0;
/// Rounds in which a deformation must show what it is worth.
const TRIAL: usize = 8;
/// Share of the points that a body claims which must lie near it.
const THERE: f64 = 0.8;

/// Correlation of neighbouring deviations above which they are no noise.
const CORRELATED: f64 = 0.15;
/// A body with more parameters must explain its points by this much less noise: else it has taken outliers in.
const CLEANER: f64 = 0.93;

/// The best of some families and its margin in nats over the next best that was tried.
///
/// Superellipsoid and supertoroid first. Where the winner's deviations look like noise there is nothing that a
/// deformation could explain; else the deformed families that promise to stand against it by evidence.
pub(super) fn choose(cloud: &Normalised, families: &[Family]) -> (Hypothesis, f64) {
    let asked = |family| families.contains(&family);
    let ellipsoid = asked(Family::Superellipsoid).then(|| best(cloud, Family::Superellipsoid));
    let plain = match (ellipsoid, asked(Family::Supertoroid)) {
        (Some(ellipsoid), true) => Some(ellipsoid_or_toroid(cloud, ellipsoid)),
        (Some(ellipsoid), false) => Some((ellipsoid, 0.0)),
        (None, true) => Some((best(cloud, Family::Supertoroid), 0.0)),
        (None, false) => None,
    };
    let deformed = || families.iter().filter(|f| f.is_deformed()).map(|f| best(cloud, *f));
    let rivals: Vec<Hypothesis> = match (plain, ellipsoid) {
        (Some((h, margin)), _) if !families.iter().any(|f| f.is_deformed()) => return (h, margin),
        (Some((h, margin)), _) if correlation(cloud, &h) < CORRELATED => return (h, margin),
        (Some((h, _)), Some(ellipsoid)) => {
            std::iter::once(h).chain(deformations(cloud, families, &h, &ellipsoid)).collect()
        }
        (Some((h, _)), None) => {
            std::iter::once(h).chain(deformed().filter(|d| is_better(cloud, d, &h))).collect()
        }
        (None, _) => deformed().collect(),
    };
    match by_evidence(cloud, &rivals) {
        Some((k, margin)) => {
            (rivals[k], if rivals.len() > 1 { margin } else { plain.map_or(0.0, |p| p.1) })
        }
        None => (best(cloud, Family::Superellipsoid), 0.0),
    }
}

/// Deformed bodies that may explain the points better than the present winner.
///
/// A family is searched when it promises something: a body of it that begins at the superellipsoid, with its axes in each
/// role, soon gains a quarter of the price of its parameters, and a third of what another gains. The most promising comes
/// first; the first that leaves nothing but noise ends it. Both deformations at once come last, where they promise more
/// than one, or add to what one has reached.
fn deformations(
    cloud: &Normalised,
    families: &[Family],
    winner: &Hypothesis,
    ellipsoid: &Hypothesis,
) -> Vec<Hypothesis> {
    let mut work = Workspace::default();
    let share = cloud.middle.len() as f64 / cloud.fine.len() as f64;
    let dues = 0.25 * price(cloud) * PATCH * share;
    let mut trial = |family: Family, from: &Hypothesis| {
        let start = Hypothesis { parameters: Parameters { family, ..from.parameters }, ..*from };
        let rounds = schedule(TRIAL, 0, from.mixture.scale);
        let cost = refine(&start, &cloud.middle, &cloud.terms, &rounds, &mut work).cost;
        cost + dues * family.freedoms() as f64
    };
    let s = &ellipsoid.parameters;
    let roles = [*s, cycled(s, 1), cycled(s, 2)];
    let roles = roles.map(|parameters| Hypothesis { parameters, ..*ellipsoid });
    let plain = trial(Family::Superellipsoid, ellipsoid);
    let least = match winner.parameters.family {
        Family::Superellipsoid => plain,
        family => 0.5 * (plain + trial(family, winner)),
    };
    let simple = [Family::Tapered, Family::Bent, Family::Twisted].into_iter();
    let simple = simple.filter(|f| families.contains(f));
    let mut promise = |family| roles.iter().map(|h| trial(family, h)).fold(f64::INFINITY, f64::min);
    let both = promise(Family::TaperedBent);
    let mut promises: Vec<(f64, Family)> = simple.map(|f| (promise(f), f)).collect();
    promises.sort_by(|a, b| a.0.total_cmp(&b.0));
    let most = promises.first().map_or(least, |p| p.0.min(least));
    let mut found: Vec<Hypothesis> = Vec::new();
    for (promised, family) in promises {
        if promised >= least - (least - most) / 3.0 {
            break;
        }
        let d = best(cloud, family);
        if is_better(cloud, &d, winner) {
            found.push(d);
            if correlation(cloud, &d) < CORRELATED {
                return found;
            }
        }
    }
    if families.contains(&Family::TaperedBent) {
        let parts = found.iter().filter(|h| !h.parameters.family.is_twisted());
        let part = parts.min_by(|a, b| a.cost.total_cmp(&b.cost));
        let adds = |h: &Hypothesis| trial(Family::TaperedBent, h) < trial(h.parameters.family, h);
        if both < most || part.is_some_and(adds) {
            let d = best(cloud, Family::TaperedBent);
            found.extend(Some(d).filter(|d| is_better(cloud, d, winner)));
        }
    }
    found
}

/// True for a deformed body that is no pretence: less noisy, and where its points are.
fn is_better(cloud: &Normalised, deformed: &Hypothesis, than: &Hypothesis) -> bool {
    is_cleaner(cloud, deformed, than) && is_there(cloud, deformed)
}

/// A body with more parameters must not have taken outliers in. On a view the camera's steps are most of the noise, which
/// no body can explain.
fn is_cleaner(cloud: &Normalised, deformed: &Hypothesis, than: &Hypothesis) -> bool {
    let least = if cloud.terms.sight == Sight::OneSide { 1.0 } else { CLEANER };
    deformed.mixture.scale < least * than.mixture.scale
}

/// False for a body that is none, or is not where its points are: beyond the end of a tapered body, where the map has its pole,
/// first-order distances are small and mean nothing.
fn is_there(cloud: &Normalised, h: &Hypothesis) -> bool {
    const PROBES: usize = 800;
    const LOOKED_AT: usize = 200;
    let s = &h.parameters;
    if s.surface(&Placement::identity()).is_err() {
        return false;
    }
    let mut probes = Vec::with_capacity(PROBES);
    sample(s, PROBES, &mut Stream::new(7, 1), &mut probes);
    let points = spread(&cloud.points, LOOKED_AT);
    let deviations = distances(s, points.iter().copied());
    let reach = 3.0 * h.mixture.scale + 2.5 * (s.area() / PROBES as f64).sqrt();
    let on = |d: f64| d.abs() < 3.0 * h.mixture.scale;
    let (mut near, mut claimed) = (0usize, 0usize);
    for (p, _) in points.iter().zip(&deviations).filter(|(_, d)| on(**d)) {
        claimed += 1;
        near += usize::from(probes.iter().any(|q| (q - p).norm_squared() < reach * reach));
    }
    near as f64 > THERE * claimed as f64
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
    let partly = rivals
        .first()
        .is_some_and(|h| !h.parameters.family.is_deformed() && shows_a_part(cloud, h))
        .then(|| Terms { sight: Sight::Partly, ..cloud.terms.clone() });
    let mut cost = |h: &Hypothesis| match (&partly, cloud.terms.sight) {
        // all that is known of a view is in what it was fitted by
        (_, Sight::OneSide) => h.cost,
        (Some(terms), _) => {
            refine(h, &cloud.fine, terms, &schedule(TRIAL, 0, h.mixture.scale), &mut work).cost
        }
        (None, Sight::AllAround { volume }) if noise > BLURRED => {
            let points = spread(&cloud.points, COMPARING);
            let cost = smeared_cost(&h.parameters, &h.mixture, &points, noise, volume);
            cost * cloud.points.len() as f64 / points.len() as f64
        }
        _ => refine(h, &cloud.fine, &cloud.terms, &schedule(0, 0, 0.0), &mut work).cost,
    };
    let price = price(cloud);
    rivals
        .iter()
        .map(|h| -cost(h) / PATCH - price * h.parameters.family.freedoms() as f64)
        .collect()
}

/// What a parameter costs: half a logarithm of the independent points.
fn price(cloud: &Normalised) -> f64 {
    0.5 * (cloud.fine.len() as f64 / PATCH).max(2.0).ln()
}

/// The better of superellipsoid and supertoroid, and its margin in nats: negative where the likelihood alone speaks for a
/// ring whose hole is not seen.
fn ellipsoid_or_toroid(cloud: &Normalised, ellipsoid: Hypothesis) -> (Hypothesis, f64) {
    let hollow = may_be_hollow(cloud, &ellipsoid);
    let thorough = cloud.effort == Effort::Thorough;
    // a quick fit has no time to look for rings that hide their holes
    let misfit = thorough && correlation(cloud, &ellipsoid) > CORRELATED;
    if !hollow && !misfit {
        return (ellipsoid, 0.0);
    }
    let toroid = best(cloud, Family::Supertoroid);
    if thorough && matches!(cloud.terms.sight, Sight::AllAround { .. }) {
        if !hollow && !shows_hole(&toroid, &cloud.points, None, false) {
            return (ellipsoid, 0.0);
        }
        // all of the surface is there to say whether there is a hole
        let rivals = [ellipsoid, toroid];
        return by_evidence(cloud, &rivals).map_or((ellipsoid, 0.0), |(k, m)| (rivals[k], m));
    }
    let mut margin = (ellipsoid.cost - toroid.cost) / PATCH - price(cloud);
    let plain = thorough && margin > PLAIN;
    let poor = |h: &Hypothesis| h.mixture.scale > 0.99 * h.mixture.law.largest_scale();
    if poor(&ellipsoid) && poor(&toroid) {
        // neither explains the points (a bowl): a ring that is clearly nearer to most of many says more
        let nearer = (typical(cloud, &ellipsoid) / typical(cloud, &toroid)).ln();
        margin = if cloud.fine.len() < MANY { -1.0 } else { nearer - CLEARLY };
    }
    if margin > 0.0 && shows_hole(&toroid, &cloud.points, cloud.terms.only_eye(), plain) {
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
    let deep = (3.0 * h.mixture.scale).max(GRAZING);
    let deeper_than = |depth: f64, points: &[Vector]| {
        let distances = distances(&h.parameters, points.iter().copied());
        distances.into_iter().filter(|d| *d < -depth).count() as f64
    };
    let mut intrusions = Vec::new();
    let mut rays = Rays::<f64>::default();
    cloud.terms.intrusions(&h.parameters, RAYS, true, &mut rays, &mut intrusions);
    let looked = cloud.terms.lines_of_sight(RAYS, true) as f64;
    deeper_than(deep, &cloud.points) > HOLLOW * cloud.points.len() as f64
        || deeper_than(deep, &intrusions) > CROSSED * looked
        || deeper_than(GRAZING, &intrusions) > ENTERED * looked
}

/// True when the cloud shows the hole of a toroid: enough points lie on the inner half of the tube, none
/// lies in the mouth of the hole (a floor farther in makes it a pot), and the hole is wider than the noise. Where the
/// evidence is `plain` the wall of the hole need not be seen.
fn shows_hole(toroid: &Hypothesis, points: &[Vector], eye: Option<Vector>, plain: bool) -> bool {
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
    let mut all = Evaluation::<f64>::default();
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
    let enough = plain || inner as f64 > 0.025 * n && inner >= LEAST_INNER;
    inliers as f64 > 0.6 * n && enough && (blocked as f64) < 0.03 * n
}
