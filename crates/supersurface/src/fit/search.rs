//! The best body of one family: many starts, few refined, near-symmetries tried.

use super::Effort;
use super::columns::Sample;
use super::coverage::{covering_cost, shows_a_part};
use super::finish::{BLURRED, finish};
use super::misfit::correlation;
use super::noise::{Law, Mixture};
use super::parameters::{Family, Parameters};
use super::prepare::Normalised;
use super::solver::{Hypothesis, Schedule, Stopped, Workspace, refine};
use super::start::{Frame, starts, turned_frames};
use super::switch::{dual, relatives};
use super::terms::{Sight, Terms};
use crate::Vector;

/// Lines of sight that are looked at beside the middle set of points.
const MIDDLE_RAYS: usize = 24;
/// The same beside the coarse set, for rings.
const COARSE_RAYS: usize = 16;
/// How many starts of a single view are ranked, and how many of all are refined.
const SHORTLIST: [usize; 3] = [4, 8, 8];
const KEPT: [usize; 3] = [1, 4, 4];
/// More starts than this are sorted out by a sketch.
const SKETCHED: usize = 16;
/// More starts of a single view than this are sorted out on the way.
const MANY: usize = 36;
/// Nats a point by which a start that is farther behind the best is left.
const FAR: f64 = 0.4;
/// A step that promises less than this many nats is not made while bodies are ranked.
const ROUGH: f64 = 0.02;
/// Starts that are kept though half of them are fewer.
const LEAST_KEPT: usize = 6;
/// Noise, in normalised lengths, below which a body is the one that was looked for.
pub(super) const EXACT: f64 = 1e-3;
/// How many times the annealed scale noise may be while starts are ranked (for each effort): a leash keeps bodies from
/// taking outliers for noise, but of things that touch it hides that one body does not explain them.
const LEASH: [f64; 3] = [f64::INFINITY, f64::INFINITY, 1.5];
/// How often the near-symmetries are tried (for each effort).
const SWITCHES: [usize; 3] = [0, 1, 2];
/// Share of points that a body may leave out before it is asked whether only a part is seen.
const LEFT_OUT: f64 = 0.2;
/// How many bodies are looked at to see whether only a part is seen, and the nats by which that must explain the points better.
const DOUBTED: usize = 2;
const PLAINLY: f64 = 2.0;
/// Correlation of neighbouring deviations on a single view (whose noise comes in steps) above which the search went astray.
const ASTRAY: f64 = 0.5;
/// Rounds by which a relative is told to be far behind.
const GLIMPSE: usize = 5;
/// Least scale from which a body that was set to another shape settles.
const SHAKEN: f64 = 0.05;
/// Two hypotheses whose costs differ by less than this many nats are one.
const SAME: f64 = 0.5;

/// The best body of a family; a ball where there is no start.
pub(super) fn best(cloud: &Normalised, family: Family) -> Hypothesis {
    let mut work = Workspace::default();
    let mut pool = Vec::new();
    search(cloud, family, &cloud.frames, &mut pool, &mut work);
    if pool.is_empty() {
        pool.push(begin(&Parameters::ball(family), &cloud.terms));
    }
    if !family.is_deformed() {
        let terms = Terms { sight: Sight::Partly, ..cloud.terms.clone() };
        if let Some(mut parts) = in_part(cloud, &terms, &pool, &mut work) {
            switch(cloud, &terms, &mut parts, &mut work);
            return finish(cloud, &terms, &parts);
        }
    }
    let found = finish(cloud, &cloud.terms, &pool);
    let thorough_view = cloud.terms.sight == Sight::OneSide && cloud.effort == Effort::Thorough;
    if !thorough_view || correlation(cloud, &found) < ASTRAY {
        return found;
    }
    let points: Vec<Vector> = cloud.coarse.points().collect();
    search(cloud, family, &turned_frames(&points, &cloud.terms), &mut pool, &mut work);
    finish(cloud, &cloud.terms, &pool)
}

/// The best bodies of a pool by the terms of bodies of which a part is seen, where the points say that it is so: by what
/// they cover of the best, or because another, on the part that they cover of it, explains them better.
fn in_part(
    cloud: &Normalised,
    terms: &Terms,
    pool: &[Hypothesis],
    work: &mut Workspace<f32>,
) -> Option<Vec<Hypothesis>> {
    let Sight::AllAround { volume } = cloud.terms.sight else { return None };
    let plainly = shows_a_part(cloud, &pool[0]);
    if !plainly && pool[0].mixture.outliers < LEFT_OUT {
        return None;
    }
    let mut parts = Vec::new();
    for h in pool.iter().take(if plainly { KEPT[cloud.effort as usize] } else { DOUBTED }) {
        let schedule = schedule(8, 0, h.mixture.scale);
        add(&mut parts, refine(h, &cloud.middle, terms, &schedule, work));
    }
    let cost = |h: &Hypothesis| covering_cost(h, &cloud.middle, volume);
    let least = cost(&pool[0]) - PLAINLY;
    (plainly || parts.iter().any(|h| cost(h) < least)).then_some(parts)
}

/// Adds what is found from some frames to a pool of hypotheses, best first.
fn search(
    cloud: &Normalised,
    family: Family,
    frames: &[Frame],
    pool: &mut Vec<Hypothesis>,
    work: &mut Workspace<f32>,
) {
    let terms = &cloud.terms;
    let (shortlist, most) = (SHORTLIST[cloud.effort as usize], KEPT[cloud.effort as usize]);
    // among outliers a sketch misleads: there all starts are ranked at once
    let sketch = terms.sight == Sight::OneSide && cloud.effort != Effort::Thorough;
    let holes: &[f64] =
        if terms.sight == Sight::OneSide && !sketch { &[1.0, 0.45] } else { &[1.0] };
    let starts = starts(frames, terms, family, holes);
    let mut ranked: Vec<Hypothesis> = starts.iter().map(|s| begin(s, terms)).collect();
    let half = starts.len().div_ceil(2).max(LEAST_KEPT);
    let rounds: &[(&Sample<f32>, usize, usize)] = match (terms.sight, sketch) {
        (Sight::OneSide, true) => &[(&cloud.sketch, 4, shortlist), (&cloud.coarse, 6, most)],
        (Sight::OneSide, false) if starts.len() > MANY => {
            &[(&cloud.coarse, 4, SKETCHED), (&cloud.coarse, 6, most)]
        }
        (Sight::OneSide, false) => &[(&cloud.coarse, 10, most)],
        _ if starts.len() > SKETCHED => &[(&cloud.sketch, 4, SKETCHED), (&cloud.coarse, 8, most)],
        // a start that is far behind after a few rounds does not catch up
        _ => &[(&cloud.coarse, 4, half), (&cloud.coarse, 6, most)],
    };
    // a ring hides its own far wall, which only rays can tell
    let rays = if family.is_ring() && !sketch { COARSE_RAYS } else { 0 };
    for &(points, rounds, kept) in rounds {
        for i in 0..ranked.len() {
            let schedule = coarse_schedule(&ranked[i], rounds, rays);
            let schedule = Schedule { leash: LEASH[cloud.effort as usize], ..schedule };
            ranked[i] = refine(&ranked[i], points, terms, &schedule, work);
            // on one side more than one body may be exact
            if terms.sight != Sight::OneSide && is_exact(&ranked[i]) {
                ranked.swap(0, i);
                ranked.truncate(1);
                break;
            }
        }
        keep(&mut ranked, kept, points.len());
    }
    if family.is_ring() && !sketch {
        // a ring whose section is turned by 45 degrees hardly finds its way
        let duals: Vec<Hypothesis> = ranked.iter().filter_map(turned_by_half).collect();
        ranked.extend(duals.iter().map(|h| {
            let schedule = schedule(6, rays, (2.0 * h.mixture.scale).max(SHAKEN));
            let schedule = Schedule { leash: LEASH[cloud.effort as usize], ..schedule };
            refine(h, &cloud.coarse, terms, &schedule, work)
        }));
        keep(&mut ranked, most, cloud.coarse.len());
    }
    for h in &ranked {
        let schedule = schedule(12, MIDDLE_RAYS, 2.0 * h.mixture.scale);
        add(pool, refine(h, &cloud.middle, terms, &schedule, work));
        if pool.first().is_some_and(is_exact) {
            return;
        }
    }
    switch(cloud, terms, pool, work);
}

/// Adds the relatives of the best, as long as that helps.
fn switch(
    cloud: &Normalised,
    terms: &Terms,
    pool: &mut Vec<Hypothesis>,
    work: &mut Workspace<f32>,
) {
    for _ in 0..SWITCHES[cloud.effort as usize] {
        let Some(best) = pool.first().copied() else { return };
        let few = &cloud.coarse;
        // where noise does not blur what sets them apart, few points tell those that are far behind
        let clear = terms.sight != Sight::OneSide && best.mixture.scale < BLURRED;
        let here = schedule(0, 0, best.mixture.scale);
        let limit = match clear {
            true => refine(&best, few, terms, &here, work).cost + FAR * few.len() as f64,
            false => f64::INFINITY,
        };
        for relative in relatives(&best.parameters, terms.only_eye()) {
            let start = Hypothesis { parameters: relative, ..best };
            let scale = (2.0 * best.mixture.scale).max(SHAKEN);
            if clear && refine(&start, few, terms, &schedule(GLIMPSE, 0, scale), work).cost > limit
            {
                continue;
            }
            let schedule = schedule(8, MIDDLE_RAYS, scale);
            add(pool, refine(&start, &cloud.middle, terms, &schedule, work));
        }
        if pool[0].cost > best.cost - SAME {
            break;
        }
    }
}

/// Keeps the best of a list by some points, without doubles and what is far behind.
fn keep(ranked: &mut Vec<Hypothesis>, kept: usize, points: usize) {
    ranked.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    ranked.dedup_by(|b, a| is_same(a, b));
    ranked.truncate(kept);
    let most = ranked.first().map_or(0.0, |h| h.cost) + FAR * points as f64;
    ranked.retain(|h| h.cost <= most);
}

fn turned_by_half(h: &Hypothesis) -> Option<Hypothesis> {
    Some(Hypothesis { parameters: dual(&h.parameters)?, ..*h })
}

/// True for a body on which all points lie.
fn is_exact(h: &Hypothesis) -> bool {
    h.mixture.scale < EXACT && h.mixture.outliers < 0.01
}

/// True for two ways to the same body.
fn is_same(a: &Hypothesis, b: &Hypothesis) -> bool {
    let apart = (a.parameters.position - b.parameters.position).norm();
    (a.cost - b.cost).abs() < SAME && apart < 0.02
}

/// Adds a hypothesis, best first, unless it is known.
fn add(pool: &mut Vec<Hypothesis>, h: Hypothesis) {
    if pool.iter().all(|other| (other.cost - h.cost).abs() > SAME) {
        let at = pool.partition_point(|other| other.cost < h.cost);
        pool.insert(at, h);
    }
}

fn begin(s: &Parameters, terms: &Terms) -> Hypothesis {
    let law = if terms.sight == Sight::OneSide { Law::StudentT } else { Law::Gaussian };
    let mixture = Mixture { law, scale: 0.1, outliers: 0.3, density: 1.0 };
    let (cost, stopped) = (f64::MAX, Stopped::Rounds);
    Hypothesis { parameters: *s, mixture, cost, rounds: 0, stopped, corrected: false }
}

/// The scale of the first rounds is tied to the start's own body, so that a small body among outliers is not
/// swallowed by a wide kernel; a body that has settled starts from its noise.
fn coarse_schedule(h: &Hypothesis, rounds: usize, rays: usize) -> Schedule {
    let size = h.parameters.half_extents().iter().sum::<f64>() / 3.0;
    let scale = if h.cost < f64::MAX { h.mixture.scale.min(0.04 * size) } else { 0.12 * size };
    schedule(rounds, rays, scale)
}

pub(super) fn schedule(rounds: usize, rays: usize, scale: f64) -> Schedule {
    Schedule { rounds, rays, scale, leash: f64::INFINITY, along_rays: false, tolerance: ROUGH }
}
