//! Support point by Lagrange's multiplier, the same kind of root as the gauge.
//!
//! With `c = |a n|` and `t_i = |x_i/a_i|^k_i`, `Σ t_i = 1`, a stationary point of `Σ c_i t_i^(1/k_i)` has one
//! multiplier `μ` with `t_i = (c_i/(k_i μ))^r_i`, `r = k/(k - 1)`, so `μ` solves `Σ t_i = 1`. Exponents up to
//! 1 make their summand convex in `t`, so at most one such axis takes part in the maximum; each is tried.

use super::SeparableSuperquadric;
use super::gauge::root;
use crate::numeric::powers::power;
use crate::shape::SupportMap;
use crate::{Point, Vector};

impl SupportMap for SeparableSuperquadric {
    /// Exact for any exponents; for one under 1 a support point of the convex hull.
    fn support_point(&self, n: &Vector) -> Point {
        let scale = n.amax();
        if !(scale > 0.0 && scale.is_finite()) {
            return Point::origin();
        }
        let widest = self.semi_axes.into_iter().fold(0.0, f64::max);
        let reach = [0, 1, 2].map(|i: usize| (self.semi_axes[i] / widest * (n[i] / scale)).abs());
        let mut best = self.shares(reach, None);
        for axis in (0..3).filter(|i| self.powers[*i] <= 1.0) {
            let other = self.shares(reach, Some(axis));
            if self.reached(reach, other) > self.reached(reach, best) {
                best = other;
            }
        }
        Point::from(Vector::from_fn(|i, _| {
            (self.semi_axes[i] * power(best[i], 1.0 / self.powers[i])).copysign(n[i])
        }))
    }
}

impl SeparableSuperquadric {
    /// `Σ c_i t_i^(1/k_i)`.
    fn reached(&self, reach: [f64; 3], terms: [f64; 3]) -> f64 {
        (0..3).map(|i| reach[i] * power(terms[i], 1.0 / self.powers[i])).sum()
    }

    /// The terms `t`, which add up to 1, of the greatest stationary point over the axes with exponents
    /// above 1 and, of the others, over `axis` alone; all zero where there is none.
    fn shares(&self, reach: [f64; 3], axis: Option<usize>) -> [f64; 3] {
        let ratios = [0, 1, 2].map(|i: usize| reach[i] / self.powers[i]);
        let exponents = self.powers.map(|k| k / (k - 1.0));
        let round = [0, 1, 2].map(|i: usize| if self.powers[i] > 1.0 { ratios[i] } else { 0.0 });
        let Some(axis) = axis else {
            // exponents of the rest do not matter: their ratios are zero
            let positive =
                [0, 1, 2].map(|i: usize| if self.powers[i] > 1.0 { exponents[i] } else { 1.0 });
            return root(round, positive).map_or([0.0; 3], |found| found.terms);
        };
        let mut terms = [0.0; 3];
        let start = ratios[axis];
        if start == 0.0 {
            return terms;
        }
        // from μ of the axis alone downwards: the sum is convex in ln μ and grows there
        let logs = round.map(|v| (v / start).ln());
        let falling =
            |s: f64| {
                [0, 1, 2].map(|i: usize| {
                    if round[i] > 0.0 { (exponents[i] * (logs[i] - s)).exp() } else { 0.0 }
                })
            };
        let mut s = 0.0;
        if self.powers[axis] < 1.0 {
            let rise = -exponents[axis];
            for _ in 0..100 {
                let others = falling(s);
                let own = (rise * s).exp();
                let slope = rise * own
                    - others
                        .iter()
                        .zip(exponents)
                        .filter(|(t, _)| **t > 0.0)
                        .map(|(t, r)| t * r)
                        .sum::<f64>();
                let excess = own + others.iter().sum::<f64>() - 1.0;
                if slope <= 0.0 {
                    return [0.0; 3];
                }
                s -= excess.max(0.0) / slope;
                if excess <= 1e-16 {
                    break;
                }
            }
        }
        terms = falling(s);
        let others: f64 = terms.iter().sum();
        if others > 1.0 {
            return [0.0; 3];
        }
        terms[axis] = 1.0 - others;
        terms
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Implicit, Superellipsoid, checks};

    #[test]
    fn with_equal_exponents_it_is_that_of_a_superellipsoid() {
        let a = [0.3, 0.5, 0.2];
        for epsilon in [0.1, 1.0, 1.7] {
            let s = SeparableSuperquadric::new(a, [2.0 / epsilon; 3]).unwrap();
            let same = Superellipsoid::new(a, [epsilon; 2]).unwrap();
            for p in checks::points([0.0; 3], [1.0; 3], 50) {
                let n = p.coords;
                assert!((s.support_point(&n) - same.support_point(&n)).norm() < 1e-13);
                assert!((s.gauge(&s.support_point(&n)) - 1.0).abs() < 1e-14);
            }
        }
    }
}
