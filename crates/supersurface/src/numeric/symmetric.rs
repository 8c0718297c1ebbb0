//! Eigenvalues of symmetric 3 × 3 matrices in closed form, and the axis of the least, for neighbourhoods by the thousand.
//!
//! With `q = tr A/3`, `6p² = tr (A - qI)²` and `cos 3φ = det(A - qI)/2p³`, the eigenvalues are `q + 2p cos(φ + 2πk/3)`
//! (Smith, Communications of the ACM 4, 1961). The eigenvector of the one that stands apart is the largest cross product of
//! two rows of `A - λI`; the other two turn in the plane across it.

use std::f64::consts::{FRAC_PI_2, PI};

use nalgebra::Matrix3;

use crate::Vector;

/// The eigenvalues of a finite symmetric matrix, rising, and a unit eigenvector of the least.
pub(crate) fn least_axis(m: &Matrix3<f64>) -> ([f64; 3], Vector) {
    let q = m.trace() / 3.0;
    let centred = m - Matrix3::identity() * q;
    let p = (centred.norm_squared() / 6.0).sqrt();
    if p <= f64::EPSILON * q.abs() || p < f64::MIN_POSITIVE {
        return ([q; 3], Vector::x());
    }
    let cosine = (0.5 * (centred / p).determinant()).clamp(-1.0, 1.0);
    let angle = cosine.acos() / 3.0;
    let is_least = cosine < 0.0;
    let turn = if is_least { 2.0 * PI / 3.0 } else { 0.0 };
    let apart = across(m, q + 2.0 * p * (angle + turn).cos());
    // the other two by the block in the plane across it, which keeps their digits where they are alike
    let helper = if apart.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
    let u = (helper - apart * apart.dot(&helper)).normalize();
    let w = apart.cross(&u);
    let (mu, mw) = (m * u, m * w);
    let (middle, half) = (0.5 * (u.dot(&mu) + w.dot(&mw)), 0.5 * (u.dot(&mu) - w.dot(&mw)));
    let mixed = u.dot(&mw);
    let spread = (half * half + mixed * mixed).sqrt();
    let (value, pair) = (apart.dot(&(m * apart)), [middle - spread, middle + spread]);
    if is_least {
        return ([value, pair[0], pair[1]], apart);
    }
    let turn = 0.5 * mixed.atan2(half) + FRAC_PI_2;
    ([pair[0], pair[1], value], u * turn.cos() + w * turn.sin())
}

/// The unit eigenvector of an eigenvalue that no other is near.
fn across(m: &Matrix3<f64>, value: f64) -> Vector {
    // columns are rows
    let [a, b, c] = (m - Matrix3::identity() * value).data.0.map(Vector::from);
    let crosses = [a.cross(&b), b.cross(&c), c.cross(&a)];
    let best = crosses.into_iter().max_by(|a, b| a.norm_squared().total_cmp(&b.norm_squared()));
    best.and_then(|v| v.try_normalize(0.0)).unwrap_or_else(Vector::x)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, SymmetricEigen};

    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn agrees_with_iteration() {
        let mut random = Stream::new(4, 0);
        let kinds = [
            [1.0, 2.0, 3.0],
            [1e-8, 1.0, 1.0],
            [1e-9, 1e-3, 1.0],
            [0.2, 0.2, 1.0],
            [0.3, 1.0, 1.0 + 1e-9],
        ];
        for k in 0..500 {
            let turn = Rotation3::new(Vector::from_fn(|_, _| random.between(-3.0, 3.0)));
            let values = Vector::from(kinds[k % kinds.len()]) * 10f64.powi(k as i32 % 7 - 3);
            let m = turn.matrix() * Matrix3::from_diagonal(&values) * turn.matrix().transpose();
            let m = 0.5 * (m + m.transpose());
            let (found, axis) = least_axis(&m);
            let mut known: Vec<f64> = SymmetricEigen::new(m).eigenvalues.iter().copied().collect();
            known.sort_by(f64::total_cmp);
            for i in 0..3 {
                assert!((found[i] - known[i]).abs() < 1e-13 * values.max(), "{found:?} {known:?}");
            }
            assert!((m * axis - axis * known[0]).norm() < 1e-13 * values.max(), "{values}");
            assert!((axis.norm() - 1.0).abs() < 1e-12);
        }
        for m in [Matrix3::zeros(), Matrix3::identity() * 1e-300, Matrix3::identity() * 4.0] {
            let (values, axis) = least_axis(&m);
            assert!(axis.norm() == 1.0 && values == [m[0]; 3]);
        }
    }
}
