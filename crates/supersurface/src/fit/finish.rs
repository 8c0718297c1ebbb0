//! The last stage, on all points: by what the points can show of the surface.

use super::Effort;
use super::bias::without_bias;
use super::centred::spread;
use super::columns::Sample;
use super::prepare::Normalised;
use super::search::schedule;
use super::smeared::smeared_cost;
use super::solver::{Hypothesis, Schedule, Workspace, refine};
use super::terms::{Sight, Terms};
use crate::Vector;

/// Lines of sight that are looked at beside the fine set of points.
const RAYS: usize = 48;
/// Most rounds on all points.
const ROUNDS: usize = 15;
/// Noise, in normalised lengths, below which single precision may be seen.
pub(super) const PRECISE: f64 = 1e-3;
/// What the last rounds leave to gain, in nats.
const SETTLED: f64 = 0.005;
/// What such points leave to gain, in nats.
const END: f64 = 3e-7;
/// Rounds of the others that are compared, and the nats below which a promise ends them.
const ROUGHLY: usize = 6;
const ROUGH: f64 = 0.15;
/// Noise, in normalised lengths, from which its bias is taken back, and from which distances do not choose among bodies.
const BIASED: f64 = 0.018;
pub(super) const BLURRED: f64 = 0.02;
/// Most hypotheses that are compared in the end, and by how many nats a point the last may be worse at first.
const COMPARED: usize = 4;
const WORSE: f64 = 0.3;
/// The same for single views.
const SIGHTED: usize = 2;
/// Points by which bodies are compared.
pub(super) const COMPARING: usize = 400;

/// The best of a pool of hypotheses (best first, not empty), refined on all points.
pub(super) fn finish(cloud: &Normalised, terms: &Terms, pool: &[Hypothesis]) -> Hypothesis {
    let work = &mut Workspace::default();
    let settled = |h: &Hypothesis, work: &mut Workspace<f32>| {
        let last = Schedule { tolerance: SETTLED, ..schedule(ROUNDS, RAYS, h.mixture.scale) };
        refine(h, &cloud.fine, terms, &last, work)
    };
    let close = WORSE * cloud.middle.len() as f64;
    let near = pool[1..].iter().filter(|h| h.cost - pool[0].cost < close);
    let volume = match (terms.sight, cloud.effort) {
        (Sight::AllAround { volume }, _) => volume,
        (Sight::Partly, _) => {
            let rivals = pool[..1].iter().chain(near.take(COMPARED - 1));
            let rivals = rivals.map(|h| settled(h, work)).collect();
            return polished(cloud, terms, &cheapest(rivals).unwrap_or(pool[0]));
        }
        (Sight::OneSide, Effort::Rough) => return pool[0],
        (Sight::OneSide, Effort::Quick) => return settled(&pool[0], work),
        (Sight::OneSide, Effort::Thorough) => {
            let rivals = pool[..1].iter().chain(near.take(SIGHTED - 1));
            let rivals = rivals.map(|h| along_rays(h, &cloud.middle, terms, ROUGH, work)).collect();
            let best = cheapest(rivals).unwrap_or(pool[0]);
            let best = along_rays(&best, &cloud.fine, terms, SETTLED, work);
            return polished(cloud, terms, &best);
        }
    };
    let best = polished(cloud, terms, &settled(&pool[0], work));
    let noise = best.mixture.scale;
    if noise < BIASED {
        return best;
    }
    let some: Vec<Vector> = spread(&cloud.points, COMPARING);
    let corrected = |h: &Hypothesis| {
        let unbiased = without_bias(h, &cloud.fine);
        let cost = smeared_cost(&unbiased.parameters, &h.mixture, &some, noise, volume);
        Hypothesis { cost, ..unbiased }
    };
    let unbiased = corrected(&best);
    let roughly = near.take(if noise < BLURRED { 0 } else { COMPARED - 1 }).map(|h| {
        let rough = Schedule { tolerance: ROUGH, ..schedule(ROUGHLY, RAYS, h.mixture.scale) };
        let fitted = refine(h, &cloud.fine, terms, &rough, work);
        (fitted, corrected(&fitted).cost)
    });
    match roughly.min_by(|a, b| a.1.total_cmp(&b.1)) {
        Some((fitted, cost)) if cost < unbiased.cost => corrected(&settled(&fitted, work)),
        _ => unbiased,
    }
}

/// A hypothesis whose points show less noise than single precision is worth, refined with all digits.
fn polished(cloud: &Normalised, terms: &Terms, h: &Hypothesis) -> Hypothesis {
    if h.mixture.scale > PRECISE {
        return *h;
    }
    let along_rays = terms.sight == Sight::OneSide;
    let last = Schedule { along_rays, tolerance: END, ..schedule(ROUNDS, RAYS, 0.0) };
    refine(h, &cloud.exact(), terms, &last, &mut Workspace::default())
}

/// A hypothesis refined by residuals along the rays in which some points were seen.
fn along_rays(
    h: &Hypothesis,
    points: &Sample<f32>,
    terms: &Terms,
    tolerance: f64,
    work: &mut Workspace<f32>,
) -> Hypothesis {
    let last = Schedule { along_rays: true, tolerance, ..schedule(ROUNDS, RAYS, h.mixture.scale) };
    refine(h, points, terms, &last, work)
}

fn cheapest(rivals: Vec<Hypothesis>) -> Option<Hypothesis> {
    rivals.into_iter().min_by(|a, b| a.cost.total_cmp(&b.cost))
}
