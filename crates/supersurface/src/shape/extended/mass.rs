//! Volume and moments of the parametric extended superellipsoid, as the divergence theorem counts them.
//!
//! Next to a seam, with the tangent `τ = u^(1/f0)` of the angle from it and the exponent `f0` there, both coordinates of
//! a curve are `M = (1 + τ²)^(-f/2)` and `N = τ^f M`, near 1 and near u: smooth where the slopes by the angle are
//! infinite. Its turn is `M N' - M' N = M N (f ln τ)'`. Where exponents change so fast that a curve runs back, it takes
//! away what it had added.

use std::f64::consts::FRAC_PI_2;

use super::ExtendedSuperellipsoid;
use crate::numeric::powers::power;
use crate::numeric::tanh_sinh::{Integral, integrate};
use crate::shape::product_moments::ProductMoments;
use crate::shape::{Mass, MassEstimate, MassProperties};

/// Relative difference at which the integration stops.
const ACCURACY: f64 = 1e-10;

/// An eighth of a curve next to a seam, at `u` in (0, 1): `[M, N]` and the turn by `u`. `exponent` gives the exponent
/// and its slope at an angle.
fn eighth(u: f64, seam: f64, side: f64, exponent: impl Fn(f64) -> [f64; 2]) -> ([f64; 2], f64) {
    let steep = 1.0 / exponent(seam)[0];
    let log = steep * u.ln();
    let tangent = log.exp();
    let square = 1.0 + tangent * tangent;
    let [f, slope] = exponent(seam + side * tangent.atan());
    let major = power(square, -0.5 * f);
    let minor = (f * log).exp() * major;
    let by_u = slope * side * tangent / square * (steep / u);
    ([major, minor], major * minor * (f * steep / u + by_u * log))
}

fn added(sum: Integral<6>, part: Integral<6>) -> Integral<6> {
    let both = |a: [f64; 6], b: [f64; 6]| std::array::from_fn(|i| a[i] + b[i]);
    Integral { value: both(sum.value, part.value), error: both(sum.error, part.error) }
}

impl ExtendedSuperellipsoid {
    /// Of the curves without the semi-axes.
    fn moments(&self) -> ProductMoments {
        let nothing = Integral { value: [0.0; 6], error: [0.0; 6] };
        // the seams by their quarter, which say where M and N go
        let section = [-2, -1, 0, 1].into_iter().flat_map(|q| [(q, 1.0), (q, -1.0)]);
        let around = section.fold(nothing, |sum, (quarter, side)| {
            let seam = f64::from(quarter) * FRAC_PI_2;
            let f = |u: f64| {
                let exponent = |omega: f64| self.exponents_and_slopes(0.0, omega)[1];
                let ([m, n], turn) = eighth(u, seam, side, exponent);
                let n = side * n;
                let [x, y] = match quarter {
                    0 => [m, n],
                    1 => [-n, m],
                    -1 => [n, -m],
                    _ => [-m, -n],
                };
                [1.0, x, y, x * x, x * y, y * y].map(|v| v * turn)
            };
            added(sum, integrate(f, 0.0, 1.0, ACCURACY))
        });
        let profile = [(0, 1.0), (0, -1.0), (1, -1.0), (-1, 1.0)];
        let along = profile.into_iter().fold(nothing, |sum, (quarter, side)| {
            let seam = f64::from(quarter) * FRAC_PI_2;
            let f = |u: f64| {
                let exponent = |eta: f64| self.exponents_and_slopes(eta, 0.0)[0];
                let ([m, n], turn) = eighth(u, seam, side, exponent);
                let [c, s] = if quarter == 0 { [m, side * n] } else { [n, -side * m] };
                [1.0, c, s, c * c, c * s, s * s].map(|v| v * turn * c)
            };
            added(sum, integrate(f, 0.0, 1.0, ACCURACY))
        });
        ProductMoments { around, along }
    }

    /// Volume and its estimated error, both in m³.
    pub fn volume_and_error(&self) -> [f64; 2] {
        let [a1, a2, a3] = self.semi_axes();
        let moments = self.moments();
        let volume = moments.volume() * (a1 * a2 * a3);
        [volume, volume.abs() * moments.error()]
    }
}

impl MassProperties for ExtendedSuperellipsoid {
    fn mass_properties(&self, density: f64) -> Mass {
        self.mass_estimate(density).mass
    }

    fn mass_estimate(&self, density: f64) -> MassEstimate {
        self.moments().mass(self.semi_axes(), density)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Parametric, Superellipsoid};
    use crate::{Point, Vector};

    #[test]
    fn constant_exponents_weigh_what_a_superellipsoid_weighs() {
        for e in [[0.05, 0.05], [0.1, 1.0], [1.0, 1.0], [0.6, 2.5], [2.5, 0.3]] {
            let axes = [0.4, 0.3, 0.5];
            let truth = Superellipsoid::new(axes, e).unwrap().mass_properties(2.0);
            let same = ExtendedSuperellipsoid::new(axes, &[e[0]; 3], &[e[1]; 4]).unwrap();
            let found = same.mass_estimate(2.0);
            let off = MassEstimate::refined(&truth, found.mass).error;
            assert!(off < 1e-9 && found.error < 1e-8, "{e:?} {off} {}", found.error);
        }
    }

    #[test]
    fn the_divergence_theorem_by_flat_pieces_agrees() {
        let (profile, section) = ([0.5, 1.4, 0.8, 1.7], [0.6, 1.2, 0.9, 1.6, 0.7, 1.1]);
        let vase = ExtendedSuperellipsoid::new([0.4, 0.3, 0.5], &profile, &section).unwrap();
        let found = vase.mass_estimate(1.0);
        let [[from, to], [start, end]] = vase.domain();
        let n = 700;
        let at = |i: usize, j: usize| {
            let part = |k: usize| k as f64 / n as f64;
            vase.point(from + (to - from) * part(i), start + (end - start) * part(j)).coords
        };
        let (mut volume, mut first) = (0.0, Vector::zeros());
        for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            for [a, b, c] in [[a, b, c], [a, c, d]] {
                let part = a.dot(&b.cross(&c)) / 6.0;
                volume += part;
                first += (a + b + c) * (part / 4.0);
            }
        }
        assert!((found.mass.mass / volume - 1.0).abs() < 1e-4, "{found:?} {volume}");
        assert!((found.mass.centre - Point::from(first / volume)).norm() < 1e-4);
        assert!(found.error < 1e-6, "{}", found.error);
    }
}
