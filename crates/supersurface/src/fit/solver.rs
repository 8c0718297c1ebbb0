//! Damped least squares on the mixture's weights, with the noise annealed and re-estimated in each round.

use super::columns::{Evaluation, Sample};
use super::noise::{Mixture, Tally};
use super::normal::{Normal, Sum, Sums};
use super::parameters::{Family, Parameters};
use super::rays::Rays;
use super::sights::Sights;
use super::terms::{Beside, Terms};
use crate::Vector;
use crate::numeric::column::Column;
use crate::numeric::lanes::Lane;

/// A body with its noise and its cost (negative log-likelihood of the points plus all other terms).
#[derive(Clone, Copy, Debug)]
pub(super) struct Hypothesis {
    pub(super) parameters: Parameters,
    pub(super) mixture: Mixture,
    pub(super) cost: f64,
    /// Rounds that were made, from the start on.
    pub(super) rounds: usize,
    /// Why the last rounds ended.
    pub(super) stopped: Stopped,
    /// True when the bias of the noise is taken back.
    pub(super) corrected: bool,
}

/// Why the iteration of a fit ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stopped {
    /// No step promised a gain that counts.
    Converged,
    /// No step lowered the cost any more: rounding or a kink of the surface.
    Stuck,
    /// The rounds were used up while each still gained a little.
    Rounds,
}

/// How long to iterate and how the noise comes down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    /// Most rounds.
    pub(super) rounds: usize,
    /// Lowest scale of the first round; multiplied by [`DECAY`] in each.
    pub(super) scale: f64,
    /// How many times the annealed scale the noise may be while iterating, where that is limited: then a body cannot
    /// take outliers for noise.
    pub(super) leash: f64,
    /// Lines of sight that are looked at.
    pub(super) rays: usize,
    /// By residuals along the rays in which the points were seen; these must be known.
    pub(super) along_rays: bool,
    /// A step that promises to gain less than this many nats is not made any more.
    pub(super) tolerance: f64,
}

impl Schedule {
    /// Limits of the noise when the annealed scale is `annealed`.
    fn limits(&self, s: &Parameters, annealed: f64) -> [f64; 2] {
        let low = NOISE_FLOOR.max(annealed);
        [low, (self.leash * low.max(LEASHED)).min(noisiest(s))]
    }
}

/// A step that gains less than this many nats is none: so little may be rounding.
const LEAST_GAIN: f64 = 1e-9;
/// How the lowest scale comes down from round to round.
pub(super) const DECAY: f64 = 0.7;
/// Scale below which noise is never estimated, in normalised lengths.
pub(super) const NOISE_FLOOR: f64 = 1e-5;

/// Most noise that a body may have, as a share of its mean half extent: what is more is no surface.
const NOISIEST: f64 = 0.15;

/// Largest scale of the noise of a body.
fn noisiest(s: &Parameters) -> f64 {
    NOISIEST / 3.0 * s.half_extents().iter().sum::<f64>()
}

/// No leash holds noise below this.
const LEASHED: f64 = 0.01;

/// Rounds from one look along the lines of sight to the next.
const LOOKS: usize = 3;

/// Buffers that are used again from one hypothesis to the next.
#[derive(Debug, Default)]
pub(super) struct Workspace<L = f64> {
    now: Box<Evaluation<L>>,
    trial: Box<Evaluation<L>>,
    weights: Column<L>,
    sums: Vec<Sums<L>>,
    intruders: Vec<Vector>,
    intrusions: Sample<L>,
    intruding: Evaluation<L>,
    search: Rays<L>,
    sights: Sights<L>,
}

impl<L: Lane> Workspace<L> {
    /// The points' part of the normal equations at the present body, and what they add up to.
    fn normal(&mut self, family: Family, mixture: &Mixture, points: usize) -> (Normal, Tally) {
        let tally = mixture.weigh(&self.now.distances, points, &mut self.weights);
        let normal = Normal::of_points(family, &self.now, &self.weights, &mut self.sums);
        (Normal { cost: tally.cost, ..normal }, tally)
    }

    /// Adds what is known beside the points.
    fn add(
        &mut self,
        terms: &Terms,
        s: &Parameters,
        [points, rays]: [usize; 2],
        scale: f64,
        to: &mut impl Sum,
    ) {
        let beside = Beside { points, scale, rays, intrusions: &self.intrusions };
        terms.add(s, &beside, &mut self.intruding, to);
    }

    /// Looks for the lines of sight that a body intrudes on. Only a toroid can hide its own far wall.
    fn look(&mut self, s: &Parameters, terms: &Terms, rays: usize) {
        let own = s.family.is_ring();
        terms.intrusions(s, rays, own, &mut self.search, &mut self.intruders);
        self.intrusions.set(self.intruders.iter().copied());
    }

    /// Evaluates the points for a body that is tried.
    fn evaluate(&mut self, s: &Parameters, points: &Sample<L>, schedule: &Schedule) {
        if schedule.along_rays {
            self.sights.fill(s, points, &mut self.trial);
        } else {
            self.trial.fill(s, points);
        }
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.now, &mut self.trial);
    }
}

/// Improves a hypothesis until a step promises nothing or the schedule ends.
pub(super) fn refine<L: Lane>(
    start: &Hypothesis,
    points: &Sample<L>,
    terms: &Terms,
    schedule: &Schedule,
    work: &mut Workspace<L>,
) -> Hypothesis {
    let mut s = start.parameters;
    let mut mixture = start.mixture;
    let mut annealed = schedule.scale;
    let mut damping = 1e-3;
    let (mut failures, mut settled, mut looked) = (0, false, false);
    let n = points.len();
    let counts = [n, schedule.rays];
    // of the sum of so many costs
    let rounding = L::EPSILON * n as f64;
    work.evaluate(&s, points, schedule);
    work.accept();
    mixture.density = terms.outlier_density(&s);
    mixture.update(&work.now.distances, n, schedule.limits(&s, annealed), 2);
    let (mut rounds, mut stopped) = (start.rounds, Stopped::Rounds);
    'rounds: for round in 0..schedule.rounds {
        if round % LOOKS == 0 {
            work.look(&s, terms, schedule.rays);
            looked = true;
        }
        let (mut normal, mut tally) = work.normal(s.family, &mixture, n);
        work.add(terms, &s, counts, mixture.scale, &mut normal);
        let mut gained = false;
        for _ in 0..4 {
            let Some(step) = normal.step(&s, damping) else {
                damping *= 10.0;
                continue;
            };
            if settled && normal.promise(&step) < schedule.tolerance {
                stopped = Stopped::Converged;
                break 'rounds;
            }
            let next = s.stepped(&step);
            work.evaluate(&next, points, schedule);
            let tried = mixture.tally(&work.trial.distances, n);
            let mut after = tried.cost;
            work.add(terms, &next, counts, mixture.scale, &mut after);
            if after < normal.cost - LEAST_GAIN + rounding {
                (s, tally, gained, looked) = (next, tried, true, false);
                work.accept();
                damping = (damping * 0.25).max(1e-7);
                break;
            }
            damping = (damping * 6.0).max(1e-4);
        }
        rounds += 1;
        let scale = mixture.scale;
        annealed *= DECAY;
        let limits = schedule.limits(&s, annealed);
        mixture.follow(&tally, n, limits);
        mixture.density = terms.outlier_density(&s);
        mixture.update(&work.now.distances, n, limits, 1);
        failures = if gained { 0 } else { failures + 1 };
        settled = (mixture.scale / scale - 1.0).abs() < 2e-3 && annealed < mixture.scale;
        if failures >= 2 && annealed < mixture.scale {
            stopped = Stopped::Stuck;
            break;
        }
    }
    mixture.update(&work.now.distances, n, [NOISE_FLOOR, noisiest(&s)], 6);
    if !looked {
        work.look(&s, terms, schedule.rays);
    }
    let mut cost = mixture.cost(&work.now.distances, n)
        + terms.spread_cost(&s, n)
        + terms.facing_cost(&s, &mixture, points, &work.now);
    work.add(terms, &s, counts, mixture.scale, &mut cost);
    let cost = if cost.is_finite() { cost } else { f64::MAX };
    Hypothesis { parameters: s, mixture, cost, rounds, stopped, corrected: false }
}
