//! From the best body back to the view: units, every point judged, how sure all is.

use nalgebra::Isometry3;

use super::columns::{Evaluation, Sample};
use super::covariance::covariance;
use super::finish::PRECISE;
use super::prepare::Normalised;
use super::solver::Hypothesis;
use super::start::quantile;
use super::{Effort, Fit, FitError, View};
use crate::numeric::lanes::Lane;
use crate::{Point, Vector};

/// A fit with a lesser share of inliers explains nothing.
const LEAST_SHARE: f64 = 0.1;

/// The fit that a hypothesis is.
pub(super) fn judge(
    cloud: &Normalised,
    views: &[View<'_>],
    h: &Hypothesis,
    margin: f64,
    moves: Vec<Isometry3<f64>>,
) -> Result<Fit, FitError> {
    let (s, placement) = (&h.parameters, &cloud.placement);
    let all = || views.iter().flat_map(|view| view.points.iter().map(move |p| (view, p)));
    let counted = all().filter(|(view, p)| view.counts(p)).map(|(_, p)| placement.inward(p));
    let (mut distances, belonging) = match h.mixture.scale < PRECISE {
        true => judged::<f64>(h, counted),
        false => judged::<f32>(h, counted),
    };
    let mut next = belonging.into_iter();
    let mut judge = |(view, p): (&View<'_>, &Point)| {
        let own = if view.counts(p) { next.next() } else { None };
        own.unwrap_or(0.0)
    };
    let probabilities: Vec<f32> = all().map(&mut judge).collect();
    let inliers: Vec<bool> = probabilities.iter().map(|p| *p > 0.5).collect();
    let share = inliers.iter().filter(|i| **i).count() as f64 / distances.len() as f64;
    if share.is_nan() || share < LEAST_SHARE {
        return Err(FitError::NoAgreement { share });
    }
    Ok(Fit {
        family: s.family,
        surface: s.surface(placement)?,
        noise: h.mixture.scale * placement.scale,
        residual: quantile(&mut distances, 0.5) * placement.scale,
        inliers,
        probabilities,
        margin,
        moves,
        covariance: (cloud.effort != Effort::Rough).then(|| covariance(cloud, h)).flatten(),
        iterations: h.rounds,
        stopped: h.stopped,
        body: (*s, *placement),
    })
}

/// Magnitudes of the first-order distances of points in normalised coordinates, and their probabilities of belonging.
fn judged<L: Lane>(h: &Hypothesis, points: impl Iterator<Item = Vector>) -> (Vec<f64>, Vec<f32>) {
    let sample = Sample::<L>::new(points);
    let mut at = Evaluation::default();
    at.fill_distances(&h.parameters, &sample);
    let distances = &at.distances[..sample.len()];
    let belonging = h.mixture.belonging(distances);
    let distances = distances.iter().map(|d| d.wide().abs()).collect();
    (distances, belonging.into_iter().map(|p| p.wide() as f32).collect())
}
