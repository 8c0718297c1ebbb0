//! Has a body the points' shape? Deviations that are noise are those of each point alone; where a body's shape is wrong,
//! neighbours deviate alike. So their correlation is measured:
//!
//! ```text
//! ρ = Σ (d(x) - m) (d(nearest to x) - m) / Σ (d(x) - m)²    over points near the surface, m their mean
//! ```

use super::columns::distances;
use super::neighbours::Neighbours;
use super::prepare::Normalised;
use super::search::EXACT;
use super::solver::Hypothesis;
use crate::Vector;

/// Nearest points among which is another: some are measured twice.
const LOOKED_AT: usize = 4;
/// Points whose neighbours are sought.
const PROBED: usize = 300;

/// Correlation of the deviations of neighbouring points, at most about 1; 0 for a body on which all points lie.
pub(super) fn correlation(cloud: &Normalised, h: &Hypothesis) -> f64 {
    if h.mixture.scale < EXACT {
        return 0.0;
    }
    let deviations = distances(&h.parameters, cloud.points.iter().copied());
    let near = 3.0 * h.mixture.scale;
    let on: Vec<(Vector, f64)> = cloud
        .points
        .iter()
        .zip(deviations)
        .filter(|(_, d)| d.abs() < near)
        .map(|(p, d)| (*p, d))
        .collect();
    // noise lies outside of a convex body on the average
    let mean = on.iter().map(|q| q.1).sum::<f64>() / on.len().max(1) as f64;
    let places: Vec<Vector> = on.iter().map(|q| q.0).collect();
    let mut neighbours = Neighbours::among(&places);
    let (mut product, mut square) = (0.0, 1e-300);
    for (p, d) in on.iter().step_by(on.len().div_ceil(PROBED).max(1)) {
        // not the point itself
        let others = neighbours.nearest(p, LOOKED_AT).iter().filter(|n| n.square() > 0.0);
        if let Some(nearest) = others.min() {
            product += (d - mean) * (on[nearest.place()].1 - mean);
            square += (d - mean) * (d - mean);
        }
    }
    product / square
}
