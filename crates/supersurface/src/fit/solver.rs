//! Damped least squares on the mixture's weights, with the noise annealed and re-estimated in each round.

use super::kernel::distance;
use super::noise::Mixture;
use super::parameters::{COUNT, Parameters, Row};
use super::terms::{Beside, Normal, Terms};
use crate::Vector;

/// A body with its noise and its cost (negative log-likelihood of the points plus all other terms).
#[derive(Clone, Copy, Debug)]
pub(super) struct Hypothesis {
    pub(super) parameters: Parameters,
    pub(super) mixture: Mixture,
    pub(super) cost: f64,
}

/// How long to iterate and how the noise comes down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    /// Most rounds.
    pub(super) rounds: usize,
    /// Lowest scale of the first round; multiplied by `decay` in each.
    pub(super) scale: f64,
    pub(super) decay: f64,
    /// Scale below which noise is never estimated.
    pub(super) floor: f64,
    /// Lines of sight that are looked at.
    pub(super) rays: usize,
    /// A round that gains less than this many nats ends the search.
    pub(super) tolerance: f64,
}

/// Buffers that are used again from one hypothesis to the next.
#[derive(Clone, Debug, Default)]
pub(super) struct Workspace {
    distances: Vec<f64>,
    trial: Vec<f64>,
    rows: Vec<Row>,
    trial_rows: Vec<Row>,
    intrusions: Vec<Vector>,
}

/// What stands in for a distance that is not a number: far away.
const FAR: f64 = 10.0;

impl Workspace {
    /// Distances of all points, with derivatives, into the trial buffers.
    fn evaluate(&mut self, s: &Parameters, points: &[Vector]) {
        self.trial.resize(points.len(), 0.0);
        self.trial_rows.resize(points.len(), [0.0; COUNT]);
        for ((x, d), row) in points.iter().zip(&mut self.trial).zip(&mut self.trial_rows) {
            let value = distance::<true>(s, x, row);
            *d = if value.is_finite() { value } else { FAR };
        }
    }

    fn beside(&self, mixture: &Mixture, schedule: &Schedule) -> Beside<'_> {
        Beside {
            points: self.distances.len(),
            scale: mixture.scale,
            rays: schedule.rays,
            intrusions: &self.intrusions,
        }
    }

    fn accept(&mut self) {
        std::mem::swap(&mut self.distances, &mut self.trial);
        std::mem::swap(&mut self.rows, &mut self.trial_rows);
    }
}

/// Improves a hypothesis until a round gains nothing or the schedule ends.
pub(super) fn refine(
    start: &Hypothesis,
    points: &[Vector],
    terms: &Terms,
    schedule: &Schedule,
    work: &mut Workspace,
) -> Hypothesis {
    let mut s = start.parameters;
    let mut mixture = start.mixture;
    let mut annealed = schedule.scale;
    let mut damping = 1e-3;
    let mut failures = 0;
    work.evaluate(&s, points);
    work.accept();
    mixture.density = terms.outlier_density(&s);
    mixture.update(&work.distances, schedule.floor.max(annealed), 2);
    for _ in 0..schedule.rounds {
        terms.intrusions(&s, schedule.rays, &mut work.intrusions);
        let mut normal = Normal::zero();
        for (d, row) in work.distances.iter().zip(&work.rows) {
            normal.add(*d, mixture.weight(*d), row);
        }
        normal.cost = mixture.cost(&work.distances);
        terms.add(&s, &work.beside(&mixture, schedule), &mut normal);
        let before = normal.cost;
        let mut gain = None;
        for _ in 0..4 {
            let Some(step) = solve(&s, &normal, damping) else {
                damping *= 10.0;
                continue;
            };
            let next = s.stepped(&step);
            work.evaluate(&next, points);
            let mut after = Normal::zero();
            terms.add(&next, &work.beside(&mixture, schedule), &mut after);
            let after = after.cost + mixture.cost(&work.trial);
            if after < before {
                (s, gain) = (next, Some(before - after));
                work.accept();
                damping = (damping * 0.25).max(1e-7);
                break;
            }
            damping = (damping * 6.0).max(1e-4);
        }
        let scale = mixture.scale;
        annealed *= schedule.decay;
        mixture.density = terms.outlier_density(&s);
        mixture.update(&work.distances, schedule.floor.max(annealed), 2);
        failures = if gain.is_some() { 0 } else { failures + 1 };
        let settled = (mixture.scale / scale - 1.0).abs() < 2e-3 && annealed < mixture.scale;
        let small = gain.is_some_and(|g| g < schedule.tolerance);
        if (settled && small) || (failures >= 2 && annealed < mixture.scale) {
            break;
        }
    }
    mixture.update(&work.distances, schedule.floor, 6);
    terms.intrusions(&s, schedule.rays, &mut work.intrusions);
    let mut extra = Normal::zero();
    terms.add(&s, &work.beside(&mixture, schedule), &mut extra);
    let cost = mixture.cost(&work.distances)
        + extra.cost
        + terms.spread_cost(&s, points.len())
        + terms.facing_cost(&s, &mixture, points);
    Hypothesis { parameters: s, mixture, cost: if cost.is_finite() { cost } else { f64::MAX } }
}

/// The damped step `-(H + λ diag H)⁻¹ b` over the parameters that may move; `None` when the matrix is not
/// positive definite.
fn solve(s: &Parameters, normal: &Normal, damping: f64) -> Option<Row> {
    let mut free = [0usize; COUNT];
    let mut n = 0;
    for i in 0..COUNT {
        if s.is_active(i) && !s.is_held(i, normal.gradient[i]) {
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
