//! Which family: by the likelihood of the points and by whether the hole is really seen.

use super::columns::{Evaluation, Sample};
use super::solver::Hypothesis;
use crate::Vector;

/// Points of a scan are correlated: about so many carry the evidence of one.
const PATCH: f64 = 8.0;

/// Fewer points on the wall of a hole than this show none.
const LEAST_INNER: usize = 12;

/// By how many nats a point the toroid explains the same points better, after the price of its further
/// parameter (half a logarithm of the independent points, as in BIC). Positive: the toroid.
pub(super) fn toroid_margin(ellipsoid: &Hypothesis, toroid: &Hypothesis, points: usize) -> f64 {
    let independent = points as f64 / PATCH;
    let price = 0.5 * independent.max(2.0).ln();
    (ellipsoid.cost - toroid.cost) / PATCH - price
}

/// True when the cloud shows the hole of a toroid: enough points lie on the inner half of the tube, none
/// lies in the mouth of the hole (a floor farther in makes it a pot), and the hole is wider than the noise.
pub(super) fn shows_hole(
    toroid: &Hypothesis,
    points: &[Vector],
    viewpoint: Option<Vector>,
) -> bool {
    let s = &toroid.parameters;
    if !s.family.is_ring() {
        return false;
    }
    let axes = s.log_axes.map(f64::exp);
    let hole = (s.ring - 1.0) * axes[0].min(axes[1]);
    let outer = (s.ring + 1.0) * axes[0].min(axes[1]);
    if hole < 4.0 * toroid.mixture.scale || hole < 0.12 * outer {
        return false;
    }
    // the side of the mid-plane on which the sensor stands; without one both count
    let mouth =
        viewpoint.map(|v| s.rotation.inverse_transform_vector(&(v - s.position)).z.signum());
    let (mut inner, mut blocked, mut inliers) = (0usize, 0usize, 0usize);
    let mut all = Evaluation::default();
    all.fill_distances(s, &Sample::new(points.iter().copied()));
    for (p, d) in points.iter().zip(&all.distances) {
        let q = s.rotation.inverse_transform_vector(&(p - s.position));
        let radius = crate::numeric::superellipse::norm(
            (q.x / axes[0]).abs(),
            (q.y / axes[1]).abs(),
            2.0 / s.exponents[1],
        );
        let before_floor = mouth.is_none_or(|m| m * q.z > 0.0);
        if radius < 0.8 * (s.ring - 1.0) && q.z.abs() < 1.2 * axes[2] && before_floor {
            blocked += 1;
        }
        if d.abs() < 4.0 * toroid.mixture.scale {
            inliers += 1;
            // on the wall of the hole, not on the ridge over it
            if radius < s.ring - 0.35 && q.z.abs() < 0.95 * axes[2] {
                inner += 1;
            }
        }
    }
    let n = points.len() as f64;
    let enough = inner as f64 > 0.025 * n && inner >= LEAST_INNER;
    inliers as f64 > 0.6 * n && enough && (blocked as f64) < 0.03 * n
}
