//! Damped least squares (Levenberg-Marquardt) for any number of parameters, on the mixture's weights, with the noise
//! annealed and estimated again in each round.

use nalgebra::{Cholesky, DMatrix, DVector};

use super::member::{Body, Member};
use super::space::Space;
use crate::Vector;
use crate::fit::Stopped;
use crate::fit::noise::Mixture;
use crate::fit::solver::{DECAY, NOISE_FLOOR};

/// A body with its noise and its cost, the negative log-likelihood of the points as a density on the surface.
#[derive(Clone, Debug)]
pub(super) struct Hypothesis<M> {
    pub(super) body: Body<M>,
    pub(super) mixture: Mixture,
    pub(super) cost: f64,
    pub(super) iterations: usize,
    pub(super) stopped: Stopped,
}

/// How long to iterate and how the noise comes down.
#[derive(Clone, Copy, Debug)]
pub(super) struct Schedule {
    /// Most rounds.
    pub(super) rounds: usize,
    /// Lowest scale of the first round; multiplied by [`DECAY`] in each.
    pub(super) scale: f64,
    /// Most that the scale may be in all rounds.
    pub(super) ceiling: f64,
    /// A round that gains less than this many nats a point ends the search.
    pub(super) tolerance: f64,
}

/// Trials of a round, each with more damping.
const TRIALS: usize = 5;

/// Improves a hypothesis until a round gains nothing or the schedule ends.
pub(super) fn refine<M: Member>(
    start: &Hypothesis<M>,
    points: &[Vector],
    space: &Space,
    schedule: &Schedule,
) -> Hypothesis<M> {
    let mut h = start.clone();
    let mut annealed = schedule.scale;
    let mut damping = 1e-3;
    let mut failures = 0;
    h.stopped = Stopped::Rounds;
    h.mixture.density = space.outlier_density(space.area(&h.body));
    let (mut distances, mut rows) = h.body.rows(points);
    let estimate = |h: &mut Hypothesis<M>, distances: &[f64], annealed: f64| {
        let limits = [NOISE_FLOOR.max(annealed), schedule.ceiling];
        h.mixture.update(distances, distances.len(), limits, 2);
    };
    estimate(&mut h, &distances, annealed);
    for _ in 0..schedule.rounds {
        h.iterations += 1;
        let (matrix, gradient) = normal_equations(&distances, &rows, &h.mixture, h.body.count());
        let before = h.mixture.cost(&distances, points.len());
        let mut gain = None;
        for _ in 0..TRIALS {
            if let Some(step) = solve(&h.body, &matrix, &gradient, damping) {
                let next = h.body.stepped(&step);
                let after = h.mixture.cost(&next.distances(points), points.len());
                if after < before {
                    (h.body, gain) = (next, Some(before - after));
                    damping = (damping * 0.2).max(1e-8);
                    break;
                }
            }
            damping = (damping * 6.0).clamp(1e-4, 1e8);
        }
        if gain.is_some() {
            (distances, rows) = h.body.rows(points);
        }
        let scale = h.mixture.scale;
        annealed *= DECAY;
        estimate(&mut h, &distances, annealed);
        failures = if gain.is_some() { 0 } else { failures + 1 };
        let settled = (h.mixture.scale / scale - 1.0).abs() < 2e-3 && annealed < h.mixture.scale;
        let small = gain.is_some_and(|g| g < schedule.tolerance * points.len() as f64);
        if (settled && small) || (failures >= 2 && annealed < h.mixture.scale) {
            h.stopped = Stopped::Converged;
            break;
        }
    }
    let area = space.area(&h.body);
    h.mixture.density = space.outlier_density(area);
    h.mixture.update(&distances, points.len(), [NOISE_FLOOR, f64::INFINITY], 6);
    let cost = h.mixture.cost(&distances, points.len()) + points.len() as f64 * area.ln();
    h.cost = if cost.is_finite() { cost } else { f64::MAX };
    h
}

/// `Jᵀ W J` (its lower triangle) and `Jᵀ W d`.
fn normal_equations(
    distances: &[f64],
    rows: &[f64],
    mixture: &Mixture,
    count: usize,
) -> (DMatrix<f64>, DVector<f64>) {
    let (mut matrix, mut gradient) = (DMatrix::zeros(count, count), DVector::zeros(count));
    for (d, row) in distances.iter().zip(rows.chunks_exact(count)) {
        let weight = mixture.weight(*d);
        for (j, b) in row.iter().enumerate() {
            let weighted = weight * b;
            gradient[j] += weighted * d;
            for (i, a) in row.iter().enumerate().skip(j) {
                matrix[(i, j)] += weighted * a;
            }
        }
    }
    (matrix, gradient)
}

/// The damped step over the parameters that may move; `None` when the matrix is not positive definite.
fn solve<M: Member>(
    body: &Body<M>,
    matrix: &DMatrix<f64>,
    gradient: &DVector<f64>,
    damping: f64,
) -> Option<Vec<f64>> {
    let count = gradient.len();
    let free: Vec<usize> = (0..count).filter(|i| !body.is_held(*i, gradient[*i])).collect();
    let n = free.len();
    let largest = (0..count).map(|i| matrix[(i, i)]).fold(0.0, f64::max);
    let mut damped = DMatrix::from_fn(n, n, |i, j| matrix[(free[i.max(j)], free[i.min(j)])]);
    for i in 0..n {
        // directions that nothing determines stay where they are
        damped[(i, i)] += damping * damped[(i, i)] + 1e-3 + 1e-9 * largest;
    }
    let right = DVector::from_fn(n, |i, _| -gradient[free[i]]);
    let solution = Cholesky::new(damped)?.solve(&right);
    let mut step = vec![0.0; count];
    for (i, v) in free.iter().zip(solution.iter()) {
        step[*i] = *v;
    }
    step.iter().all(|v| v.is_finite()).then_some(step)
}
