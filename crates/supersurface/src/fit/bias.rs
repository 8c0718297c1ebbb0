//! Noise makes bodies of other sizes: outside an edge there is more room than inside, so distances pull the fit.
//! Unbiased estimating equations say how far.
//!
//! A fit ends where the score of the points, the mean of `w d ∇d`, is zero; but points that are drawn from the right body
//! with noise have another in the mean. So what is solved is
//!
//! ```text
//! S(θ) - E[S(θ); θ] = 0
//! ```
//!
//! which the right body fulfils in the mean (Fisher consistency: Hampel and others, *Robust Statistics*, §4.2), by
//! Newton's steps. As both parts change alike with the body at which they are looked at, the derivative that is left is
//! that of the expected score by the body from which the points are drawn: the information. The expectation is a sum
//! over cells of the surface and opposite draws of noise, the same for all bodies, so that it is smooth.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, DVector};

use super::columns::{Evaluation, Sample};
use super::parameters::{COUNT, EXPONENT, POSITION, BEND, Parameters, RING, Row, TAPER, TWIST};
use super::samples::cells;
use super::solver::Hypothesis;
use crate::Vector;

/// Most trials of a step.
const TRIALS: usize = 5;
/// No parameter moves farther than this in one.
const MOST: f64 = 0.3;
/// A step that promises less than this many nats is the last.
const SETTLED: f64 = 0.01;
/// Step of the differences.
const STEP: f64 = 0.03;
/// Opposite pairs of draws a cell.
const PAIRS: usize = 1;

/// `1/x` to `1/x⁴` for the root of `x⁵ = x + 1`.
const RECURRENCE: [f64; 4] = [0.856_674_883_854_503, 0.733_891_856_627_126, 0.628_706_721_057_846, 0.538_597_256_991_131];

/// Means over points: the score, by parameters, and the weighted square of the distance, both of those that belong.
struct Moments {
    score: Row,
    square: f64,
}

/// Draws of noise for the cells of a body.
struct Draws {
    noise: Vec<Vector>,
}

impl Draws {
    fn new(s: &Parameters) -> Self {
        let count = PAIRS * cells(s).len();
        // evenly spread in four dimensions (the additive recurrence by powers of the root of x⁵ = x + 1), then Gaussian
        // by Box and Muller
        let noise = |i: usize| {
            let [a, b, c, d] = RECURRENCE.map(|share| (0.5 + share * i as f64).fract());
            let radius = |u: f64| (-2.0 * (1.0 - u).ln()).sqrt();
            let (sin, cos) = (TAU * b).sin_cos();
            Vector::new(radius(a) * cos, radius(a) * sin, radius(c) * (TAU * d).cos())
        };
        Self { noise: (0..count).map(noise).collect() }
    }

    /// Moments at the body of `h` of points drawn from another one with the noise `sigma`.
    fn moments(&self, from: &Parameters, sigma: f64, h: &Hypothesis) -> Moments {
        let cells = cells(from);
        let mut points = Vec::with_capacity(2 * self.noise.len());
        let whole = from.family.is_deformed();
        for (i, noise) in self.noise.iter().enumerate() {
            let mut p = cells[i / PAIRS].0;
            if !whole {
                // the cells are those of an octant: its mirror images take turns
                let octant = (5 * (i / PAIRS) + 3 * (i % PAIRS)) % 8;
                (0..3).filter(|k| octant >> k & 1 == 1).for_each(|k| p[k] = -p[k]);
            }
            let p = from.position + from.rotation * p;
            points.extend([p + sigma * noise, p - sigma * noise]);
        }
        moments(h, &Sample::new(points.into_iter()), |i| cells[i / (2 * PAIRS)].1)
    }
}

/// Moments of points with shares.
fn moments(h: &Hypothesis, points: &Sample, share: impl Fn(usize) -> f64) -> Moments {
    let mut at = Evaluation::default();
    at.fill(&h.parameters, points);
    let (mut belonging, mut square) = (0.0, 0.0);
    let mut pulls = Vec::with_capacity(points.len());
    for (i, d) in at.distances[..points.len()].iter().enumerate() {
        let pull = share(i) * h.mixture.weight(*d) * d;
        pulls.push(pull);
        square += pull * d;
        belonging += share(i) * h.mixture.belongs(*d);
    }
    let of = |row: &Vec<f64>| pulls.iter().zip(row).map(|(p, r)| p * r).sum::<f64>() / belonging;
    let family = h.parameters.family;
    let score = std::array::from_fn(|k| if family.has(k) { of(&at.rows[k]) } else { 0.0 });
    Moments { score, square: square / belonging }
}

/// Derivative of the expected score a point at a body by the body itself, of some parameters.
pub(super) fn information(h: &Hypothesis, index: &[usize]) -> DMatrix<f64> {
    let draws = Draws::new(&h.parameters);
    let here = draws.moments(&h.parameters, h.mixture.scale, h);
    by_differences(h, &draws, &here, index)
}

fn by_differences(h: &Hypothesis, draws: &Draws, here: &Moments, index: &[usize]) -> DMatrix<f64> {
    let s = &h.parameters;
    let mut out = DMatrix::zeros(index.len(), index.len());
    for (j, k) in index.iter().enumerate() {
        let mut step: Row = [0.0; COUNT];
        // away from the limits
        let back = (EXPONENT..POSITION).contains(k) && s.exponents[k - EXPONENT] > 1.0;
        step[*k] = if back { -STEP } else { STEP };
        let there = draws.moments(&s.stepped(&step), h.mixture.scale, h);
        for (i, row) in index.iter().enumerate() {
            out[(i, j)] = (here.score[*row] - there.score[*row]) / step[*k];
        }
    }
    out
}

/// The body without its bias and with the noise that suits it; its cost is not known.
pub(super) fn without_bias(h: &Hypothesis, points: &Sample) -> Hypothesis {
    // the place of a body is not biased
    let moves = |k: &usize| h.parameters.family.has(*k) && !(POSITION..TAPER).contains(k);
    let index: Vec<usize> = (0..COUNT).filter(moves).collect();
    let draws = Draws::new(&h.parameters);
    let excess = |h: &Hypothesis, seen: &Moments, due: &Moments| {
        let _ = h;
        DVector::from_iterator(index.len(), index.iter().map(|k| seen.score[*k] - due.score[*k]))
    };
    let all = points.len() as f64;
    let mut best = *h;
    let (mut seen, mut due) =
        (moments(h, points, |_| 1.0), draws.moments(&h.parameters, h.mixture.scale, h));
    let prior = DMatrix::identity(index.len(), index.len()) / all;
    let Some(mut inverse) = (by_differences(h, &draws, &due, &index) + prior).try_inverse() else {
        return best;
    };
    let mut left = excess(&best, &seen, &due);
    let mut share = 1.0;
    for _ in 0..TRIALS {
        let way = &inverse * &left;
        let promise = 0.5 * all * left.dot(&way).abs();
        if promise < SETTLED {
            break;
        }
        let mut step: Row = [0.0; COUNT];
        for (k, w) in index.iter().zip(way.iter()) {
            step[*k] = (-share * w).clamp(-MOST, MOST);
        }
        let mut trial = Hypothesis { parameters: best.parameters.stepped(&step), ..best };
        seen = moments(&trial, points, |_| 1.0);
        due = draws.moments(&trial.parameters, trial.mixture.scale, &trial);
        let there = excess(&trial, &seen, &due);
        // Broyden's update by the way that was gone
        let gone = DVector::from_iterator(
            index.len(),
            index.iter().map(|k| value(&trial.parameters, *k) - value(&best.parameters, *k)),
        );
        let expected = &inverse * (&there - &left);
        let scale = gone.dot(&expected);
        if scale > 0.1 * gone.norm_squared() {
            let row = gone.transpose() * &inverse;
            inverse += (&gone - expected) * row / scale;
        }
        if all * (there.transpose() * &inverse * &there)[0].abs() * 0.5 < promise {
            trial.mixture.scale *= (seen.square / due.square).sqrt().clamp(0.8, 1.25);
            (best, left, share) = (trial, there, 1.0);
        } else {
            share *= 0.4;
        }
    }
    best
}

/// A shape parameter in the coordinates of the steps.
fn value(s: &Parameters, index: usize) -> f64 {
    match index {
        0..RING => s.log_axes[index],
        RING => s.ring,
        EXPONENT..POSITION => s.exponents[index - EXPONENT],
        TAPER..TWIST => s.taper[index - TAPER],
        TWIST => s.twist,
        BEND.. => s.bend[index - BEND],
        _ => 0.0,
    }
}
