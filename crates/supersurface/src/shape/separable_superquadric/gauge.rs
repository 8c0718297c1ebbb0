//! Gauge, gradient and second derivatives by a root along the ray from the origin.
//!
//! The gauge `λ` of a point solves `Σ (u_i/λ)^k_i = 1` with `u = |x/a|`. In the logarithm `s = ln λ` the
//! function `φ(s) = ln Σ exp(k_i (ln u_i - s))` falls and is convex, so Newton's steps from the left, where
//! `λ` is the largest `u`, never pass the root.

use nalgebra::Matrix3;

use super::SeparableSuperquadric;
use crate::numeric::powers::power;
use crate::shape::{Implicit, SecondOrder};
use crate::{Point, Vector};

/// The root and the terms of the sum there, which add up to 1.
pub(super) struct Root {
    pub(super) value: f64,
    pub(super) terms: [f64; 3],
}

/// Solves `Σ (u_i/λ)^k_i = 1` for non-negative `u` and positive `k`; `None` where all `u` are zero or one is
/// not finite.
pub(super) fn root(u: [f64; 3], k: [f64; 3]) -> Option<Root> {
    let largest = u.into_iter().fold(0.0, f64::max);
    if !(largest > 0.0 && u.iter().all(|v| v.is_finite())) {
        return None;
    }
    let logs = u.map(|v| (v / largest).ln());
    let terms_at = |s: f64| [0, 1, 2].map(|i: usize| (k[i] * (logs[i] - s)).exp());
    let mut s = 0.0;
    // about 5 steps; 30 where exponents of 0.2 and 1e6 meet
    for _ in 0..100 {
        let terms = terms_at(s);
        let sum: f64 = terms.iter().sum();
        let slope = terms.iter().zip(k).map(|(t, k)| t * k).sum::<f64>() / sum;
        let step = sum.ln() / slope;
        s += step.max(0.0);
        if step <= 1e-16 * (1.0 + s) {
            break;
        }
    }
    let terms = terms_at(s);
    let sum: f64 = terms.iter().sum();
    Some(Root { value: largest * s.exp(), terms: terms.map(|t| t / sum) })
}

impl SeparableSuperquadric {
    /// `F` of equation (6): below 1 inside, 1 on the surface; infinite where it overflows.
    pub fn implicit_value(&self, p: &Point) -> f64 {
        let u = self.scaled(p);
        u.iter().zip(self.powers).map(|(u, k)| power(*u, k)).sum()
    }

    fn scaled(&self, p: &Point) -> [f64; 3] {
        let [a1, a2, a3] = self.semi_axes;
        [(p.x / a1).abs(), (p.y / a2).abs(), (p.z / a3).abs()]
    }
}

impl Implicit for SeparableSuperquadric {
    /// The factor by which the surface must grow about its centre to reach the point: 1-homogeneous.
    fn gauge(&self, p: &Point) -> f64 {
        let u = self.scaled(p);
        match root(u, self.powers) {
            Some(found) => found.value,
            None if u == [0.0; 3] => 0.0,
            None => f64::INFINITY,
        }
    }

    /// `∂λ/∂x_i = λ ω_i / x_i` with the shares `ω_i = k_i t_i / Σ k_j t_j` of the terms `t_i`.
    fn gradient(&self, p: &Point) -> Vector {
        let Some((slopes, _, _)) = self.slopes(p) else { return Vector::zeros() };
        if slopes.iter().all(|v| v.is_finite()) { slopes } else { Vector::zeros() }
    }

    fn bounds(&self) -> [Point; 2] {
        let a = Vector::from(self.semi_axes);
        [Point::from(-a), Point::from(a)]
    }

    /// The sum is convex for exponents from 1, and the gauge of a convex symmetric body is a norm.
    fn is_convex(&self) -> bool {
        self.powers.iter().all(|k| *k >= 1.0)
    }
}

impl SeparableSuperquadric {
    /// Gradient, gauge and terms at the root.
    fn slopes(&self, p: &Point) -> Option<(Vector, f64, Vector)> {
        let found = root(self.scaled(p), self.powers)?;
        let terms = Vector::from(found.terms);
        let shares = terms.component_mul(&Vector::from(self.powers));
        let sum = shares.sum();
        let slopes =
            shares.zip_map(
                &p.coords,
                |share, c| {
                    if c == 0.0 { 0.0 } else { found.value * (share / sum) / c }
                },
            );
        Some((slopes, found.value, terms))
    }
}

impl SecondOrder for SeparableSuperquadric {
    /// `λ_ij = λ_i λ_j (1 - k_i - k_j + E/D)/λ + δ_ij λ_i (k_i - 1)/x_i` with `D = Σ k t`, `E = Σ k² t`.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let (slopes, value, terms) = self.slopes(p)?;
        let k = Vector::from(self.powers);
        let d = k.dot(&terms);
        let ratio = k.component_mul(&k).dot(&terms) / d;
        let mut hessian =
            Matrix3::from_fn(|i, j| slopes[i] * (slopes[j] / value) * (1.0 - k[i] - k[j] + ratio));
        for i in 0..3 {
            let scale = self.semi_axes[i] * value;
            hessian[(i, i)] += match p[i] == 0.0 {
                false => slopes[i] * (k[i] - 1.0) / p[i],
                // the term is |x/(a λ)|^k: flat for k > 2, a parabola for 2, a kink or a spike below
                true if k[i] > 2.0 => 0.0,
                true if k[i] == 2.0 => value * 2.0 / d / scale / scale,
                true => return None,
            };
        }
        hessian.iter().all(|v| v.is_finite()).then_some(hessian)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Superellipsoid, checks};

    #[test]
    fn with_equal_exponents_it_is_a_superellipsoid() {
        let a = [0.3, 0.5, 0.2];
        for epsilon in [0.1, 0.5, 1.0, 1.7, 2.4] {
            let s = SeparableSuperquadric::new(a, [2.0 / epsilon; 3]).unwrap();
            let same = Superellipsoid::new(a, [epsilon; 2]).unwrap();
            for p in checks::points([0.0; 3], [0.6; 3], 50) {
                assert!((s.gauge(&p) / same.gauge(&p) - 1.0).abs() < 4e-15);
                assert!(
                    (s.gradient(&p) - same.gradient(&p)).norm() < 1e-13 * s.gradient(&p).norm()
                );
            }
        }
    }

    #[test]
    fn the_root_is_one_for_any_pair_of_exponents() {
        for (i, k) in [0.2, 1.0, 7.0, 1e3, 1e6]
            .into_iter()
            .flat_map(|a| {
                [0.2, 2.0, 1e6].into_iter().flat_map(move |b| [0.3, 1e5].map(|c| [a, b, c]))
            })
            .enumerate()
        {
            let u = [1.0, 1.0 - 1e-3 * i as f64, 0.4];
            let found = root(u, k).unwrap();
            let sum: f64 = u.iter().zip(k).map(|(u, k)| (k * (u / found.value).ln()).exp()).sum();
            let steepest = k.into_iter().fold(0.0, f64::max);
            assert!((sum - 1.0).abs() < 1e-14 * (10.0 + steepest), "{k:?}: {sum}");
        }
    }

    #[test]
    fn second_derivatives_on_the_seams() {
        let s = |k| SeparableSuperquadric::new([1.0; 3], [k, 2.0, 2.0]).unwrap();
        let p = Point::new(0.0, 0.6, 0.8);
        assert!(s(1.5).hessian(&p).is_none());
        assert!((s(2.0).hessian(&p).unwrap()[(0, 0)] - 1.0).abs() < 1e-14);
        assert_eq!(s(3.0).hessian(&p).unwrap()[(0, 0)], 0.0);
    }
}
