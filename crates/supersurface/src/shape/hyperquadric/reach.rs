//! How far a convex solid reaches from an inner point: an upper bound of its support function, made of
//! supporting planes.
//!
//! A plane `G·x = 1` supports the solid when `G·x <= 1` holds in it. If `n = Σ λ_k G_k` with `λ >= 0` then
//! `n·x <= Σ λ_k`, for certain. Three planes are kept; they meet in a vertex `v`, the gauge's gradient at `v` is
//! the plane that cuts it off best, and the simplex rule says which of the three it replaces. The bound never
//! grows, and is exact to `gauge(v) - 1`.

use nalgebra::Matrix3;

use crate::Vector;

/// How far the bound may lie above a value that is reached.
const SLACK: f64 = 1e-3;
/// Planes tried at most; the bound is certain after any number.
const PLANES: usize = 100;

/// An upper bound of `max n·x`, from three supporting planes with independent normals whose cone holds `n` and
/// from the gauge about the inner point with its (sub)gradient.
pub(super) fn reach(
    n: &Vector,
    planes: [Vector; 3],
    gauge: impl Fn(&Vector) -> (f64, Vector),
) -> f64 {
    let mut columns = Matrix3::from_columns(&planes);
    let mut best = f64::INFINITY;
    for _ in 0..PLANES {
        let Some(inverse) = columns.try_inverse() else { break };
        let shares = inverse * n;
        let rest = (n - columns * shares.map(|s| s.max(0.0))).norm();
        if rest.is_nan() || rest > 1e-10 * n.norm() {
            break;
        }
        best = best.min(shares.map(|s| s.max(0.0)).sum());
        let vertex = inverse.transpose() * Vector::repeat(1.0);
        let (value, plane) = gauge(&vertex);
        if value.is_nan() || value <= 1.0 + SLACK {
            break;
        }
        let weights = inverse * plane;
        let leaving = (0..3)
            .filter(|k| weights[*k] > 1e-12)
            .min_by(|a, b| (shares[*a] / weights[*a]).total_cmp(&(shares[*b] / weights[*b])));
        let Some(k) = leaving else { break };
        columns.set_column(k, &plane);
    }
    // for the rounding of all this
    best * (1.0 + 1e-9)
}
