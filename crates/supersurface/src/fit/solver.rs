//! Damped least squares on the mixture's weights, with the noise annealed and re-estimated in each round.

use super::columns::{Evaluation, Sample};
use super::noise::Mixture;
use super::parameters::{COUNT, Family, Parameters, Row};
use super::rays::Rays;
use super::sights::Sights;
use super::terms::{Beside, Normal, Terms};
use crate::Vector;
use crate::numeric::lanes::{Job, dispatch, dot};

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
    /// A round gained nothing that counts.
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
    /// A round that gains less than this many nats ends the search.
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
const LOOKS: usize = 2;

/// Buffers that are used again from one hypothesis to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    now: Evaluation,
    trial: Evaluation,
    weights: Vec<f64>,
    weighted: Vec<f64>,
    intruders: Vec<Vector>,
    intrusions: Sample,
    intruding: Evaluation,
    search: Rays,
    sights: Sights,
}

impl Workspace {
    /// The points' part of the normal equations at the present body.
    fn normal(&mut self, family: Family, mixture: &Mixture, points: usize) -> Normal {
        let cost = mixture.weigh(&self.now.distances, points, &mut self.weights);
        let mut normal = normal_equations(family, &self.now, &self.weights, &mut self.weighted);
        normal.cost = cost;
        normal
    }

    /// Adds what is known beside the points.
    fn add(
        &mut self,
        terms: &Terms,
        s: &Parameters,
        [points, rays]: [usize; 2],
        scale: f64,
        to: &mut Normal,
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
    fn evaluate(&mut self, s: &Parameters, points: &Sample, schedule: &Schedule) {
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

/// `Jᵀ W J` (its lower triangle) and `Jᵀ W d`; `weighted` is a buffer.
pub(super) fn normal_equations(
    family: Family,
    evaluation: &Evaluation,
    weights: &[f64],
    weighted: &mut Vec<f64>,
) -> Normal {
    weighted.resize(weights.len(), 0.0);
    let mut normal = Normal::zero();
    dispatch(Accumulate { family, evaluation, weights, weighted, normal: &mut normal });
    normal
}

/// The same, a column at a time.
struct Accumulate<'a> {
    family: Family,
    evaluation: &'a Evaluation,
    weights: &'a [f64],
    weighted: &'a mut [f64],
    normal: &'a mut Normal,
}

impl Job for Accumulate<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Evaluation { distances, rows } = self.evaluation;
        let has = |(i, _): &(usize, &Vec<f64>)| self.family.has(*i);
        for (i, row) in rows.iter().enumerate().filter(has) {
            for ((w, weight), value) in self.weighted.iter_mut().zip(self.weights).zip(row) {
                *w = weight * value;
            }
            self.normal.gradient[i] = dot::<FUSED>(self.weighted, distances);
            for (j, other) in rows[..=i].iter().enumerate().filter(has) {
                self.normal.matrix[i][j] = dot::<FUSED>(self.weighted, other);
            }
        }
    }
}

/// Improves a hypothesis until a round gains nothing or the schedule ends.
pub(super) fn refine(
    start: &Hypothesis,
    points: &Sample,
    terms: &Terms,
    schedule: &Schedule,
    work: &mut Workspace,
) -> Hypothesis {
    let mut s = start.parameters;
    let mut mixture = start.mixture;
    let mut annealed = schedule.scale;
    let mut damping = 1e-3;
    let mut failures = 0;
    let n = points.len();
    let counts = [n, schedule.rays];
    work.evaluate(&s, points, schedule);
    work.accept();
    mixture.density = terms.outlier_density(&s);
    mixture.update(&work.now.distances, n, schedule.limits(&s, annealed), 2);
    let (mut rounds, mut stopped) = (start.rounds, Stopped::Rounds);
    for round in 0..schedule.rounds {
        rounds += 1;
        if round % LOOKS == 0 {
            work.look(&s, terms, schedule.rays);
        }
        let mut normal = work.normal(s.family, &mixture, n);
        work.add(terms, &s, counts, mixture.scale, &mut normal);
        let before = normal.cost;
        let mut gain = None;
        for _ in 0..4 {
            let Some(step) = solve(&s, &normal, damping) else {
                damping *= 10.0;
                continue;
            };
            let next = s.stepped(&step);
            work.evaluate(&next, points, schedule);
            let mut after = Normal::zero();
            work.add(terms, &next, counts, mixture.scale, &mut after);
            let after = after.cost + mixture.cost(&work.trial.distances, n);
            if after < before - LEAST_GAIN {
                (s, gain) = (next, Some(before - after));
                work.accept();
                damping = (damping * 0.25).max(1e-7);
                break;
            }
            damping = (damping * 6.0).max(1e-4);
        }
        let scale = mixture.scale;
        annealed *= DECAY;
        mixture.density = terms.outlier_density(&s);
        mixture.update(&work.now.distances, n, schedule.limits(&s, annealed), 2);
        failures = if gain.is_some() { 0 } else { failures + 1 };
        let settled = (mixture.scale / scale - 1.0).abs() < 2e-3 && annealed < mixture.scale;
        let small = gain.is_some_and(|g| g < schedule.tolerance);
        if settled && small {
            stopped = Stopped::Converged;
            break;
        }
        if failures >= 2 && annealed < mixture.scale {
            stopped = Stopped::Stuck;
            break;
        }
    }
    mixture.update(&work.now.distances, n, [NOISE_FLOOR, noisiest(&s)], 6);
    work.look(&s, terms, schedule.rays);
    let mut extra = Normal::zero();
    work.add(terms, &s, counts, mixture.scale, &mut extra);
    let cost = mixture.cost(&work.now.distances, n)
        + extra.cost
        + terms.spread_cost(&s, n)
        + terms.facing_cost(&s, &mixture, points, &work.now);
    let cost = if cost.is_finite() { cost } else { f64::MAX };
    Hypothesis { parameters: s, mixture, cost, rounds, stopped, corrected: false }
}

/// The damped step `-(H + λ diag H)⁻¹ b` over the parameters that may move; `None` when the matrix is not
/// positive definite.
fn solve(s: &Parameters, normal: &Normal, damping: f64) -> Option<Row> {
    let mut free = [0usize; COUNT];
    let mut n = 0;
    for i in 0..COUNT {
        if s.family.has(i) && !s.is_held(i, normal.gradient[i]) {
            free[n] = i;
            n += 1;
        }
    }
    let mut l = [[0.0; COUNT]; COUNT];
    let mut x = [0.0; COUNT];
    for i in 0..n {
        for j in 0..=i {
            l[i][j] = normal.matrix[free[i]][free[j]];
        }
        l[i][i] += damping * l[i][i] + 1e-3;
        x[i] = -normal.gradient[free[i]];
    }
    for i in 0..n {
        for j in 0..=i {
            let dot: f64 = (0..j).map(|k| l[i][k] * l[j][k]).sum();
            let value = l[i][j] - dot;
            if i == j {
                if !(value > 0.0 && value.is_finite()) {
                    return None;
                }
                l[i][i] = value.sqrt();
            } else {
                l[i][j] = value / l[j][j];
            }
        }
    }
    for i in 0..n {
        let dot: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i][i];
    }
    for i in (0..n).rev() {
        let dot: f64 = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - dot) / l[i][i];
    }
    let mut step = [0.0; COUNT];
    for i in 0..n {
        step[free[i]] = x[i];
    }
    Some(step)
}
