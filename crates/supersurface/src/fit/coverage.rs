//! Do the points show all of a body or a part of it? Places on the surface are looked at, and the points about each are
//! counted:
//!
//! ```text
//! coverage = mean over places of min(1, found / due),    due = points on the surface per area, times π r²
//! ```
//!
//! Noise fills gaps that are narrower than itself, so `r` is not below three times its scale.

use std::f64::consts::PI;

use super::columns::{Evaluation, Sample, distances};
use super::neighbours::Neighbours;
use super::noise::Mixture;
use super::parameters::Parameters;
use super::prepare::Normalised;
use super::samples::sample;
use super::solver::{Hypothesis, NOISE_FLOOR};
use super::terms::Sight;
use crate::Vector;
use crate::numeric::random::Stream;

/// Coverage from which the points show all of the surface. Chance alone makes it less than 1.
const COVERED: f64 = 0.79;
/// What chance leaves of the coverage of a surface that is all seen.
const BY_CHANCE: f64 = 0.9;

/// True where the points are only on a part of the surface, though no sensor's place says so.
pub(super) fn shows_a_part(cloud: &Normalised, h: &Hypothesis) -> bool {
    cloud.terms.sight != Sight::OneSide && coverage(h, &cloud.middle) < COVERED
}

/// Negative log-likelihood of points as a density on that part of a body which they cover, beside outliers in a box of some
/// volume: a body that is cut where the points end has no advantage over one that goes on unseen.
pub(super) fn covering_cost(h: &Hypothesis, points: &Sample<f32>, volume: f64) -> f64 {
    let area = h.parameters.area() * (coverage(h, points) / BY_CHANCE).min(1.0);
    let mut at = Evaluation::default();
    at.fill_distances(&h.parameters, points);
    let mut mixture = Mixture { density: area / volume, ..h.mixture };
    mixture.update(&at.distances, points.len(), [NOISE_FLOOR, f64::INFINITY], 4);
    mixture.cost(&at.distances, points.len()) + points.len() as f64 * area.ln()
}

/// Share of the points that an evenly seen surface would have and this one has, in [0, 1]: of the points within some radius
/// of a place on it, those that are missing are counted, those too many are not.
fn coverage(h: &Hypothesis, points: &Sample<f32>) -> f64 {
    const PROBES: usize = 160;
    /// Points due within the radius.
    const DUE: f64 = 20.0;
    let s: &Parameters = &h.parameters;
    let near = 3.0 * h.mixture.scale + 1e-3;
    let on: Vec<Vector> = distances(s, points.points())
        .into_iter()
        .zip(points.points())
        .filter(|(d, _)| d.abs() < near)
        .map(|(_, p)| p)
        .collect();
    let mut probes = Vec::with_capacity(PROBES);
    sample(s, PROBES, &mut Stream::new(5, 1), &mut probes);
    let density = on.len().max(1) as f64 / s.area();
    let square = (DUE / (PI * density)).max((3.0 * h.mixture.scale).powi(2));
    let due = PI * square * density;
    let found = Neighbours::among(on.into_iter());
    let shares = probes.iter().map(|p| (found.count(p, square) as f64 / due).min(1.0));
    shares.sum::<f64>() / probes.len().max(1) as f64
}
