//! From the best body back to the view: units, every point judged, how sure all is.

use super::centred::is_finite;
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
    view: &View<'_>,
    h: &Hypothesis,
    margin: f64,
) -> Result<Fit, FitError> {
    let s = &h.parameters;
    let inward = |p: &Point| (p.coords - cloud.centre) / cloud.scale;
    let counts = |p: &Point| is_finite(&inward(p)) && Some(*p) != view.viewpoint;
    let counted = view.points.iter().filter(|p| counts(p)).map(inward);
    let mut distances = distances(s, counted);
    let mut next = distances.iter();
    let mut judge = |p: &Point| {
        let d = if counts(p) { next.next() } else { None };
        d.map_or(0.0, |d| h.mixture.belongs(*d) as f32)
    };
    let probabilities: Vec<f32> = view.points.iter().map(&mut judge).collect();
    let inliers: Vec<bool> = probabilities.iter().map(|p| *p > 0.5).collect();
    let share = inliers.iter().filter(|i| **i).count() as f64 / distances.len() as f64;
    distances.iter_mut().for_each(|d| *d = d.abs());
    if share.is_nan() || share < LEAST_SHARE {
        return Err(FitError::NoAgreement { share });
    }
    Ok(Fit {
        family: s.family,
        surface: s.surface(&cloud.centre, cloud.scale)?,
        noise: h.mixture.scale * cloud.scale,
        residual: quantile(&mut distances, 0.5) * cloud.scale,
        inliers,
        probabilities,
        margin,
        covariance: covariance(cloud, h),
        iterations: h.rounds,
        stopped: h.stopped,
    })
}
