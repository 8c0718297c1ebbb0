//! Has a body the points' shape? Deviations that are noise are those of each point alone; where a body's shape is wrong,
//! neighbours deviate alike. So their correlation is measured:
//!
//! ```text
//! ρ = Σ (d(x) - m) (d(nearest to x) - m) / Σ (d(x) - m)²    over points near the surface, m their mean
//! ```

use super::columns::distances;
use super::prepare::Normalised;
use super::search::EXACT;
use super::solver::Hypothesis;
use crate::Vector;
use crate::numeric::lanes::WIDTH;

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
    // columns, so that the search vectorises
    let columns: [Vec<f64>; 3] = std::array::from_fn(|k| on.iter().map(|q| q.0[k]).collect());
    let mut squares = vec![0.0; on.len()];
    let (mut product, mut square) = (0.0, 1e-300);
    for (p, d) in on.iter().step_by(on.len().div_ceil(PROBED).max(1)) {
        for (i, s) in squares.iter_mut().enumerate() {
            let (dx, dy, dz) = (columns[0][i] - p.x, columns[1][i] - p.y, columns[2][i] - p.z);
            let apart = dx * dx + dy * dy + dz * dz;
            // not the point itself
            *s = if apart > 0.0 { apart } else { f64::INFINITY };
        }
        let least = least(&squares);
        if let Some(nearest) = squares.iter().position(|s| *s == least && s.is_finite()) {
            product += (d - mean) * (on[nearest].1 - mean);
            square += (d - mean) * (d - mean);
        }
    }
    product / square
}

/// The least of the values, eight side by side.
fn least(values: &[f64]) -> f64 {
    let mut lanes = [f64::INFINITY; WIDTH];
    let (blocks, rest) = values.as_chunks::<WIDTH>();
    for block in blocks {
        for (least, v) in lanes.iter_mut().zip(block) {
            *least = if v < least { *v } else { *least };
        }
    }
    lanes.iter().chain(rest).fold(f64::INFINITY, |least, v| least.min(*v))
}
