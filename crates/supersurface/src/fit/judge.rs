//! From the best body back to the view: units, every point judged, how sure all is.

use nalgebra::Isometry3;

use super::columns::distances;
use super::covariance::covariance;
use super::prepare::Normalised;
use super::solver::Hypothesis;
use super::start::quantile;
use super::{Fit, FitError, View};
use crate::Point;

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
    let mut distances = distances(s, counted);
    let mut next = distances.iter();
    let mut judge = |(view, p): (&View<'_>, &Point)| {
        let d = if view.counts(p) { next.next() } else { None };
        d.map_or(0.0, |d| h.mixture.belongs(*d) as f32)
    };
    let probabilities: Vec<f32> = all().map(&mut judge).collect();
    let inliers: Vec<bool> = probabilities.iter().map(|p| *p > 0.5).collect();
    let share = inliers.iter().filter(|i| **i).count() as f64 / distances.len() as f64;
    distances.iter_mut().for_each(|d| *d = d.abs());
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
        covariance: covariance(cloud, h),
        iterations: h.rounds,
        stopped: h.stopped,
    })
}
