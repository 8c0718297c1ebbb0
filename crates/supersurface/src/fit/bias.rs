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
//! over cells of the surface and opposite draws of noise, the same for all bodies, so that it is smooth; the derivative
//! begins as that of least squares, without the curvature of the surface, and is kept up to date by Broyden's formula.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{DMatrix, DVector, Rotation3};

use super::columns::{Evaluation, Sample};
use super::normal::Normal;
use super::parameters::{BEND, COUNT, EXPONENT, POSITION, Parameters, RING, Row, TAPER, TWIST};
use super::samples::{cells, columns};
use super::solver::Hypothesis;
use crate::Vector;
use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, dispatch, dot};
use crate::numeric::random::Stream;

/// Most trials of a step.
const TRIALS: usize = 8;
/// No parameter moves farther than this in one.
const MOST: f64 = 0.3;
/// A step that promises less than this many nats is not made.
const SETTLED: f64 = 0.02;
/// A step that goes wrong is shortened by this.
const SHORTER: f64 = 0.4;
/// Step of the differences.
const STEP: f64 = 0.03;
/// Rounds in which the draws are levelled.
const LEVELLINGS: usize = 3;

/// Means over points that belong: of the score, by parameters, and of the weighted square of the distance.
struct Moments {
    score: Row,
    square: f64,
}

/// Draws of Gaussian noise, one for each cell of a body, in its frame.
struct Draws(Vec<Vector>);

impl Draws {
    fn new(s: &Parameters) -> Self {
        let (count, mut random) = (cells(s).len(), Stream::new(3, 1));
        let mut noise: Vec<Vector> =
            (0..count).map(|_| Vector::from_fn(|_, _| random.normal())).collect();
        // along rows and columns of cells the variances are made one, as chance there would bend the profiles
        let columns = columns(s);
        let mut level = |start: usize, stride: usize, many: usize| {
            let line = || (0..many).map(|i| start + i * stride);
            let squares = line().map(|i| noise[i].component_mul(&noise[i])).sum::<Vector>();
            let deviations = (squares / many as f64).map(f64::sqrt);
            line().for_each(|i| noise[i].component_div_assign(&deviations));
        };
        for _ in 0..LEVELLINGS {
            (0..count / columns).for_each(|row| level(row * columns, 1, columns));
            (0..columns).for_each(|column| level(column, columns, count / columns));
        }
        Self(noise)
    }

    /// Moments at the body of `h` of points drawn from another one with its noise.
    fn moments(&self, from: &Parameters, h: &Hypothesis, room: &mut Room) -> Moments {
        let cells = cells(from);
        let mirrored = !from.family.is_deformed();
        // the cells are those of an octant: its mirror images take turns
        let sign = |i: usize, k: usize| if mirrored && (5 * i) >> k & 1 == 1 { -1.0 } else { 1.0 };
        let rotation = from.rotation.matrix();
        let draw = |k: usize| {
            let (i, opposite) = (k / 2, k % 2 == 1);
            let scale = if opposite { -h.mixture.scale } else { h.mixture.scale };
            let p = cells[i].0 + scale * self.0[i];
            let p = Vector::new(sign(i, 0) * p.x, sign(i, 1) * p.y, sign(i, 2) * p.z);
            from.position + rotation * p
        };
        room.draws.set((0..2 * cells.len()).map(draw));
        room.moments.of(h, &room.draws, |i| cells[i / 2].1 as f32)
    }
}

/// Draws and their moments.
#[derive(Default)]
struct Room {
    draws: Sample<f32>,
    moments: Sums,
}

/// What moments are made of: means over many points, for which single precision is enough.
#[derive(Default)]
struct Sums {
    at: Evaluation<f32>,
    /// Equivalent least squares' weights times the shares, and these times the distances.
    weights: Column<f32>,
    pulls: Vec<f32>,
    belonging: f64,
}

impl Sums {
    /// Moments of points with shares, by a Gaussian's weights.
    fn of(
        &mut self,
        h: &Hypothesis,
        points: &Sample<f32>,
        share: impl Fn(usize) -> f32,
    ) -> Moments {
        let family = h.parameters.family;
        self.at.fill(&h.parameters, points);
        h.mixture.weigh(&self.at.distances, points.len(), &mut self.weights);
        self.weights.iter_mut().take(points.len()).enumerate().for_each(|(i, w)| *w *= share(i));
        let weight: f64 = self.weights.iter().map(|w| f64::from(*w)).sum();
        self.belonging = weight * h.mixture.scale * h.mixture.scale;
        self.pulls.clear();
        self.pulls.extend(self.weights.iter().zip(&self.at.distances).map(|(w, d)| w * d));
        let mean = |column: &[f32]| {
            let mut sum = 0.0;
            dispatch(Dot(&self.pulls, column, &mut sum));
            sum / self.belonging
        };
        let rows = &self.at.rows;
        let score = std::array::from_fn(|k| if family.has(k) { mean(&rows[k]) } else { 0.0 });
        Moments { score, square: mean(&self.at.distances) }
    }

    /// The information a point has of some parameters, by the first derivatives alone.
    fn information(&self, h: &Hypothesis, index: &[usize]) -> DMatrix<f64> {
        let family = h.parameters.family;
        let sums = Normal::of_points(family, &self.at, &self.weights, &mut Vec::new()).matrix;
        DMatrix::from_fn(index.len(), index.len(), |j, k| {
            sums[index[j.max(k)]][index[j.min(k)]] / self.belonging
        })
    }
}

/// Sum of products of two columns.
struct Dot<'a>(&'a [f32], &'a [f32], &'a mut f64);

impl Job for Dot<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        *self.2 = dot::<FUSED, f32>(self.0, self.1);
    }
}

/// The information a point has of some parameters, with the noise of `h`: the derivative, but for the sign, of the
/// expected score at a body by the body from which the points are drawn. Also the expected score of its own points.
pub(super) fn information(h: &Hypothesis, index: &[usize]) -> (DMatrix<f64>, DVector<f64>) {
    let (draws, mut room) = (Draws::new(&h.parameters), Room::default());
    let here = draws.moments(&h.parameters, h, &mut room);
    let s = &h.parameters;
    let mut out = DMatrix::zeros(index.len(), index.len());
    for (j, k) in index.iter().enumerate() {
        // away from the limits
        let back = (EXPONENT..POSITION).contains(k) && s.exponents[k - EXPONENT] > 1.0;
        let mut step: Row = [0.0; COUNT];
        step[*k] = if back { -STEP } else { STEP };
        let there = draws.moments(&s.stepped(&step), h, &mut room);
        out.set_column(j, &pick(index, |i| (here.score[i] - there.score[i]) / step[*k]));
    }
    (out, pick(index, |k| here.score[k]))
}

fn pick(index: &[usize], value: impl Fn(usize) -> f64) -> DVector<f64> {
    DVector::from_iterator(index.len(), index.iter().map(|k| value(*k)))
}

/// The body without its bias and with the noise that suits it; the cost is left as it was.
pub(super) fn without_bias(h: &Hypothesis, points: &Sample<f32>) -> Hypothesis {
    let mut best = Hypothesis { parameters: wide_last(&h.parameters), corrected: true, ..*h };
    // by symmetry the place of a body has no bias
    let moves = |k: &usize| h.parameters.family.has(*k) && !(POSITION..TAPER).contains(k);
    let index: Vec<usize> = (0..COUNT).filter(moves).collect();
    let all = points.len() as f64;
    let draws = Draws::new(&best.parameters);
    let (mut of_draws, mut of_points) = (Room::default(), Sums::default());
    let mut excess = |h: &Hypothesis, of_draws: &mut Room| {
        let seen = of_points.of(h, points, |_| 1.0);
        let due = draws.moments(&h.parameters, h, of_draws);
        let noise = (seen.square / due.square).sqrt().clamp(0.8, 1.25);
        (pick(&index, |k| seen.score[k] - due.score[k]), noise)
    };
    let (mut left, _) = excess(&best, &mut of_draws);
    let prior = DMatrix::identity(index.len(), index.len()) / all;
    let information = of_draws.moments.information(&best, &index) + prior;
    let Some(mut inverse) = information.try_inverse() else { return best };
    let mut share = 1.0;
    for _ in 0..TRIALS {
        let way = &inverse * &left;
        let promise = left.dot(&way).abs();
        if 0.5 * all * promise < SETTLED {
            break;
        }
        let mut step: Row = [0.0; COUNT];
        let ways = index.iter().zip(way.iter());
        ways.for_each(|(k, w): (&usize, &f64)| step[*k] = (-share * w).clamp(-MOST, MOST));
        let mut trial = Hypothesis { parameters: best.parameters.stepped(&step), ..best };
        let (there, noise) = excess(&trial, &mut of_draws);
        // Broyden's update by the way that was gone
        let gone = pick(&index, |k| value(&trial.parameters, k) - value(&best.parameters, k));
        let foreseen = &inverse * (&there - &left);
        let along = gone.dot(&foreseen);
        if along > 0.1 * gone.norm_squared() {
            let row = gone.transpose() * &inverse;
            inverse += (&gone - foreseen) * row / along;
        }
        if there.dot(&(&inverse * &there)).abs() < promise {
            trial.mixture.scale *= noise;
            (best, left, share) = (trial, there, 1.0);
        } else {
            share *= SHORTER;
        }
    }
    best
}

/// The same body with its second semi-axis not below the first, where these can be exchanged: of equal bodies one, so
/// that the draws are the same for all.
fn wide_last(s: &Parameters) -> Parameters {
    let mut out = *s;
    if !s.family.is_deformed() && s.log_axes[0] > s.log_axes[1] {
        out.log_axes.swap(0, 1);
        out.rotation *= Rotation3::new(Vector::z() * FRAC_PI_2);
    }
    out
}

/// A parameter of the shape, in the coordinates of the steps.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::noise::{Law, Mixture};
    use crate::fit::parameters::Family;
    use crate::fit::samples::sample;
    use crate::fit::solver::Stopped;

    #[test]
    fn the_right_body_is_left_and_a_wrong_one_mended() {
        let mut random = Stream::new(4, 0);
        let right = Parameters {
            log_axes: [-0.5, -0.2, 0.1],
            exponents: [0.6, 1.2],
            ..Parameters::ball(Family::Superellipsoid)
        };
        let mut points = Vec::new();
        sample(&right, 4000, &mut random, &mut points);
        let noise = points.iter().map(|p| p + Vector::from_fn(|_, _| 0.06 * random.normal()));
        let points = Sample::new(noise);
        let mixture = Mixture { law: Law::Gaussian, scale: 0.06, outliers: 1e-4, density: 1.0 };
        for off in [0.0, 0.06] {
            let mut step: Row = [0.0; COUNT];
            step[..3].fill(off);
            step[EXPONENT] = 2.0 * off;
            let parameters = right.stepped(&step);
            let stopped = Stopped::Rounds;
            let h =
                Hypothesis { parameters, mixture, cost: 0.0, rounds: 0, stopped, corrected: false };
            let found = without_bias(&h, &points);
            for k in [0, 1, 2, EXPONENT, EXPONENT + 1] {
                let error = (value(&found.parameters, k) - value(&right, k)).abs();
                assert!(error < 0.04, "{off}, parameter {k}: {error}");
            }
            assert!((found.mixture.scale - 0.06).abs() < 0.004);
        }
    }
}
