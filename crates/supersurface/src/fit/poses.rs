//! Views whose sensors' poses are known within an error: how each must be moved for all to show one body.
//!
//! Body and views are moved together by damped least squares on the mixture's weights. Moving a point by `ω × x + τ` changes
//! its residual by `-∂d/∂t · (ω × x + τ)`, where `t` is the position of the body; the moves are held by their own errors:
//!
//! ```text
//! cost = -log likelihood + ½ Σ_k (|τ_k|²/σ_k² + |ω_k|²/σ_ω²),    σ_k² = shift² + (turn · distance_k)²
//! ```
//!
//! It begins at what all views say together as they are, and at what each says alone; the cheapest counts.

use nalgebra::{DMatrix, DVector, Isometry3, Rotation3, Translation3, UnitQuaternion};

use super::View;
use super::columns::{Evaluation, Sample};
use super::noise::{Law, Mixture};
use super::normal::Normal;
use super::parameters::{COUNT, POSITION, Parameters};
use super::prepare::Normalised;
use super::search::best;
use super::sights::Sights;
use super::solver::{DECAY, Hypothesis, NOISE_FLOOR};
use super::terms::{Beside, Sight, Terms};
use crate::shape::InvalidShape;
use crate::{Point, Vector};

/// Rounds of the solver.
const ROUNDS: usize = 24;
/// Rounds of estimating the noise after each step.
const NOISE_ROUNDS: usize = 2;
/// Free numbers of a move.
const MOVE: usize = 6;

/// How far the given pose of a view may be off, as standard deviations.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct PoseError {
    /// Of a sensor's place along each axis, in metres, at least 0.
    pub shift: f64,
    /// Of its turn about each axis, in radians, at least 0.
    pub turn: f64,
}

impl PoseError {
    /// The pose is exact.
    pub const NONE: Self = Self { shift: 0.0, turn: 0.0 };

    /// Fails for numbers that are negative or not finite.
    pub(super) fn check(&self) -> Result<(), InvalidShape> {
        for (what, value) in [("shift of a pose", self.shift), ("turn of a pose", self.turn)] {
            InvalidShape::check(value.is_finite() && value >= 0.0, what, value, "at least 0")?;
        }
        Ok(())
    }
}

/// Points and sensors of the views in normalised coordinates, as given and as moved.
struct Moved<'a> {
    cloud: &'a Normalised,
    moves: Vec<Isometry3<f64>>,
    sample: Sample,
    terms: Terms,
}

impl<'a> Moved<'a> {
    fn by(cloud: &'a Normalised, moves: Vec<Isometry3<f64>>) -> Self {
        let at = |p: &Vector, k: usize| (moves[k] * Point::from(*p)).coords;
        let points = cloud.points.iter().zip(&cloud.seen_by).map(|(p, k)| at(p, *k));
        let sample = match cloud.fine.has_rays() {
            true => Sample::seen(
                points
                    .zip(&cloud.seen_by)
                    .enumerate()
                    .map(|(i, (p, k))| (p, moves[*k] * cloud.fine.ray(i))),
            ),
            false => Sample::new(points),
        };
        let mut terms = cloud.terms.clone();
        for (k, eye) in terms.eyes.iter_mut().enumerate() {
            eye.place = at(&eye.place, k);
            eye.free.iter_mut().chain(&mut eye.before).for_each(|p| *p = at(p, k));
        }
        Self { cloud, moves, sample, terms }
    }

    /// The same with each view moved further.
    fn stepped(&self, step: &[f64]) -> Self {
        let further = |(old, step): (&Isometry3<f64>, &[f64])| {
            let turn = Rotation3::new(Vector::from_column_slice(&step[3..]));
            let shift = Translation3::from(Vector::from_column_slice(&step[..3]));
            Isometry3::from_parts(shift, UnitQuaternion::from_rotation_matrix(&turn)) * old
        };
        Self::by(self.cloud, self.moves.iter().zip(step.chunks_exact(MOVE)).map(further).collect())
    }
}

/// Precisions of a view's shifts and turns, in normalised coordinates.
fn precisions(cloud: &Normalised, k: usize, errors: &[PoseError]) -> [f64; 2] {
    let error = errors.get(k).copied().unwrap_or_default();
    let distance = cloud.terms.eyes.get(k).map_or(1.0, |eye| eye.place.norm());
    let shift = (error.shift / cloud.placement.scale).hypot(error.turn * distance);
    [shift, error.turn].map(|deviation| 1.0 / deviation.max(1e-6).powi(2))
}

/// Body, moves and noise while they are improved.
struct Settling<'a> {
    body: Parameters,
    mixture: Mixture,
    views: Moved<'a>,
    at: Evaluation,
}

impl<'a> Settling<'a> {
    fn new(body: Parameters, mixture: Mixture, views: Moved<'a>) -> Self {
        let mut at = Evaluation::default();
        if !views.sample.has_rays() {
            at.fill(&body, &views.sample);
        } else {
            Sights::default().fill(&body, &views.sample, &mut at);
        }
        Self { body, mixture, views, at }
    }

    fn beside(&self) -> Normal {
        let mut normal = Normal::zero();
        let points = self.views.sample.len();
        let beside = Beside {
            points,
            scale: self.mixture.scale,
            rays: 0,
            intrusions: &Sample::<f64>::default(),
        };
        self.views.terms.add(&self.body, &beside, &mut Evaluation::default(), &mut normal);
        normal
    }

    /// The cost of the moves alone.
    fn strain(&self, errors: &[PoseError]) -> f64 {
        let each = self.views.moves.iter().enumerate().map(|(k, m)| {
            let [shift, turn] = precisions(self.views.cloud, k, errors);
            let [t, w] = [m.translation.vector, m.rotation.scaled_axis()];
            0.5 * (shift * t.norm_squared() + turn * w.norm_squared())
        });
        each.sum()
    }

    fn cost(&self, errors: &[PoseError]) -> f64 {
        let points = self.mixture.cost(&self.at.distances, self.views.sample.len());
        points + self.beside().cost + self.strain(errors)
    }

    /// The damped step of body and views; `None` when there is none.
    fn step(&self, errors: &[PoseError], damping: f64) -> Option<DVector<f64>> {
        let views = &self.views;
        let size = COUNT + MOVE * views.moves.len();
        let mut matrix = DMatrix::<f64>::zeros(size, size);
        let mut gradient = DVector::<f64>::zeros(size);
        let beside = self.beside();
        for i in 0..COUNT {
            gradient[i] = beside.gradient[i];
            for j in 0..=i {
                matrix[(i, j)] = beside.matrix[i][j];
            }
        }
        for (i, x) in views.sample.points().enumerate() {
            let d = self.at.distances[i];
            let weight = self.mixture.weight(d);
            let own = self.at.row(&self.body, i);
            let along = -Vector::from_column_slice(&own[POSITION..POSITION + 3]);
            let about = x.cross(&along);
            let first = COUNT + MOVE * views.cloud.seen_by[i];
            let moved = along.iter().chain(about.iter()).enumerate();
            let row = own.iter().copied().enumerate().chain(moved.map(|(k, v)| (first + k, *v)));
            for (j, a) in row.clone() {
                gradient[j] += weight * a * d;
                for (k, b) in row.clone().take_while(|(k, _)| *k <= j) {
                    matrix[(j, k)] += weight * a * b;
                }
            }
        }
        for (k, m) in views.moves.iter().enumerate() {
            let precisions = precisions(views.cloud, k, errors);
            let parts = [m.translation.vector, m.rotation.scaled_axis()];
            for (part, (value, precision)) in parts.iter().zip(precisions).enumerate() {
                for axis in 0..3 {
                    let i = COUNT + MOVE * k + 3 * part + axis;
                    gradient[i] += precision * value[axis];
                    matrix[(i, i)] += precision;
                }
            }
        }
        for i in 0..size {
            if i < COUNT && (!self.body.family.has(i) || self.body.is_held(i, gradient[i])) {
                gradient[i] = 0.0;
                matrix.row_mut(i).fill(0.0);
                matrix.column_mut(i).fill(0.0);
            }
            matrix[(i, i)] += damping * matrix[(i, i)] + 1e-3;
        }
        Some(-matrix.cholesky()?.solve(&gradient))
    }

    /// The next state, if one is better.
    fn better(&self, errors: &[PoseError], damping: &mut f64) -> Option<(Self, f64)> {
        let before = self.cost(errors);
        for _ in 0..5 {
            if let Some(step) = self.step(errors, *damping) {
                let body = self.body.stepped(&std::array::from_fn(|i| step[i]));
                let views = self.views.stepped(&step.as_slice()[COUNT..]);
                let next = Self::new(body, self.mixture, views);
                let gain = before - next.cost(errors);
                if gain > 0.0 {
                    *damping = (*damping * 0.25).max(1e-7);
                    return Some((next, gain));
                }
            }
            *damping *= 8.0;
        }
        None
    }
}

/// How each of the views that make up `cloud` must be moved, in metres and the frame of the points, for all to show one
/// body, which is at first nearly `merged`.
pub(super) fn moves(
    cloud: &Normalised,
    views: &[View<'_>],
    errors: &[PoseError],
    merged: &Hypothesis,
) -> Vec<Isometry3<f64>> {
    let still = vec![Isometry3::identity(); views.len()];
    let alone = |view| {
        let alone = Normalised::new(std::slice::from_ref(view), cloud.effort).ok()?;
        Some(carried(&best(&alone, merged.parameters.family), &alone, cloud))
    };
    let starts: Vec<Hypothesis> =
        [*merged].into_iter().chain(views.iter().filter_map(alone)).collect();
    let settled = starts.iter().map(|start| settle(cloud, errors, start, still.clone()));
    let best = settled.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(still, |(_, moves)| moves);
    let home = cloud.placement.pose(&Vector::zeros(), &Rotation3::identity());
    let outward = |m: Isometry3<f64>| {
        let shift = m.translation.vector * cloud.placement.scale;
        home * Isometry3::from_parts(shift.into(), m.rotation) * home.inverse()
    };
    best.into_iter().map(outward).collect()
}

/// A body that was found in the coordinates of `from` in those of `to`.
fn carried(h: &Hypothesis, from: &Normalised, to: &Normalised) -> Hypothesis {
    let (from, to) = (&from.placement, &to.placement);
    let ratio = from.scale / to.scale;
    let parameters = Parameters {
        log_axes: h.parameters.log_axes.map(|a| a + ratio.ln()),
        position: to.inward(&from.outward(&h.parameters.position)),
        rotation: to.axes.inverse() * from.axes * h.parameters.rotation,
        bend: h.parameters.bend.map(|k| k / ratio),
        ..h.parameters
    };
    let mixture = Mixture { scale: h.mixture.scale * ratio, ..h.mixture };
    Hypothesis { parameters, mixture, ..*h }
}

fn settle(
    cloud: &Normalised,
    errors: &[PoseError],
    start: &Hypothesis,
    still: Vec<Isometry3<f64>>,
) -> (f64, Vec<Isometry3<f64>>) {
    let law = if cloud.terms.sight == Sight::OneSide { Law::StudentT } else { Law::Gaussian };
    let mixture = Mixture { law, ..start.mixture };
    let mut now = Settling::new(start.parameters, mixture, Moved::by(cloud, still));
    let count = cloud.fine.len();
    // what the poses are off looks like noise at first
    let largest = |of: fn(&PoseError) -> f64| errors.iter().map(of).fold(0.0, f64::max);
    let off = largest(|e| e.shift) / cloud.placement.scale + largest(|e| e.turn);
    let mut annealed = off.clamp(NOISE_FLOOR, 0.1);
    let mut damping = 1e-3;
    for _ in 0..ROUNDS {
        let limits = [annealed.max(NOISE_FLOOR), f64::INFINITY];
        now.mixture.density = now.views.terms.outlier_density(&now.body);
        now.mixture.update(&now.at.distances, count, limits, NOISE_ROUNDS);
        let settled = annealed < now.mixture.scale;
        annealed *= DECAY;
        match now.better(errors, &mut damping) {
            Some((next, gain)) => {
                now = next;
                if settled && gain < 0.02 {
                    break;
                }
            }
            None if settled => break,
            None => damping = 1e-3,
        }
    }
    (now.cost(errors), now.views.moves)
}

/// The points and what is known beside them, moved.
#[derive(Clone, Debug)]
pub(super) struct MovedView {
    points: Vec<Point>,
    free: Vec<Point>,
    viewpoint: Option<Point>,
}

impl MovedView {
    pub(super) fn new(view: &View<'_>, by: &Isometry3<f64>) -> Self {
        let all = |points: &[Point]| points.iter().map(|p| by * p).collect();
        Self {
            points: all(view.points),
            free: all(view.free),
            viewpoint: view.viewpoint.map(|p| by * p),
        }
    }

    /// The view; its support stays where it is.
    pub(super) fn of<'a>(&'a self, view: &View<'a>) -> View<'a> {
        View { points: &self.points, free: &self.free, viewpoint: self.viewpoint, ..*view }
    }
}
