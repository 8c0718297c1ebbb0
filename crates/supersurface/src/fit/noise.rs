//! How points scatter about a surface, and the constant density of those that do not belong to it. Scale and
//! outlier share are estimated, not given.
//!
//! Seen from all around, noise is taken as Gaussian: a heavy tail would swallow outliers that the density
//! should explain. On single views, whose noise acts along the rays and grows at edges, it is a Student-t
//! with 3 degrees of freedom.

use crate::numeric::lanes::{Job, WIDTH, dispatch, exp, ln};

/// The law of the inliers' distances.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Law {
    Gaussian,
    StudentT,
}

impl Law {
    /// Scale above which deviations are no longer noise. A camera's is far below a twentieth of an object's
    /// size: a surface that explains most points well and leaves the rest out is better than one that explains
    /// all of them badly.
    pub(super) const fn largest_scale(self) -> f64 {
        match self {
            Self::Gaussian => 0.12,
            Self::StudentT => 0.05,
        }
    }
}

/// The mixture `(1 - w) law(d; scale) + w density`, in normalised lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mixture {
    pub(super) law: Law,
    /// Scale of the law.
    pub(super) scale: f64,
    /// Outlier share `w`.
    pub(super) outliers: f64,
    /// Density of outliers a unit of length.
    pub(super) density: f64,
}

/// Normalising constant of the t distribution with 3 degrees of freedom: 2/(π√3).
const T3: f64 = 0.367_552_596_947_861_4;
/// Normalising constant of the Gaussian: 1/√(2π).
const GAUSS: f64 = 0.398_942_280_401_432_7;

/// The mixture at one distance: probability of belonging, equivalent weight of `d²/scale²`, density.
#[derive(Clone, Copy)]
struct Share {
    belongs: f64,
    weight: f64,
    density: f64,
}

impl Mixture {
    #[inline(always)]
    fn share<const FUSED: bool>(&self, d: f64) -> Share {
        let t = d * d / (self.scale * self.scale);
        let q = 1.0 / (1.0 + t / 3.0);
        let (law, weight) = match self.law {
            Law::Gaussian => (GAUSS / self.scale * exp::<FUSED>(-0.5 * t), 1.0),
            Law::StudentT => (T3 / self.scale * q * q, 4.0 / 3.0 * q),
        };
        let inlier = (1.0 - self.outliers) * law;
        let density = inlier + self.outliers * self.density;
        Share { belongs: inlier / density, weight, density }
    }

    /// Weight of one squared distance in the equivalent least squares problem, in 1/length².
    pub(super) fn weight(&self, d: f64) -> f64 {
        let share = self.share::<false>(d);
        share.belongs * share.weight / (self.scale * self.scale)
    }

    /// Second derivative of the negative log-likelihood of one distance, in 1/length²: below the weight where the law is
    /// wider than a Gaussian, negative for outliers.
    pub(super) fn curvature(&self, d: f64) -> f64 {
        let Share { belongs, weight, .. } = self.share::<false>(d);
        let precision = 1.0 / (self.scale * self.scale);
        let slope = weight * d * precision;
        let within = match self.law {
            Law::Gaussian => 1.0,
            Law::StudentT => weight * (1.5 * weight - 1.0),
        };
        belongs * (within * precision - (1.0 - belongs) * slope * slope)
    }

    /// Probability that a point at distance `d` belongs to the surface.
    #[inline]
    pub(super) fn belongs(&self, d: f64) -> f64 {
        self.share::<false>(d).belongs
    }

    /// By how much the cost rises when a point at distance `d` is an outlier after all.
    pub(super) fn price_of_leaving(&self, d: f64) -> f64 {
        (self.share::<false>(d).density / (self.outliers * self.density)).ln()
    }

    /// Weights of squared distances in the equivalent least squares problem, in 1/length², and the negative
    /// log-likelihood of the first `count` distances; the others weigh nothing.
    pub(super) fn weigh(&self, distances: &[f64], count: usize, weights: &mut Vec<f64>) -> f64 {
        weights.resize(distances.len(), 0.0);
        self.sums::<true>(distances, count, weights).cost
    }

    /// Negative log-likelihood of the first `count` distances.
    pub(super) fn cost(&self, distances: &[f64], count: usize) -> f64 {
        self.sums::<true>(distances, count, &mut []).cost
    }

    /// `rounds` of expectation maximisation of scale (within limits) and outlier share by the first `count`
    /// distances.
    pub(super) fn update(
        &mut self,
        distances: &[f64],
        count: usize,
        [low, high]: [f64; 2],
        rounds: usize,
    ) {
        let n = count as f64;
        for _ in 0..rounds {
            let Sums { belonging, spread, .. } = self.sums::<false>(distances, count, &mut []);
            let belonging = belonging + 1e-9;
            let most = high.min(self.law.largest_scale());
            self.scale = (spread / belonging).sqrt().min(most).max(low);
            self.outliers = ((n - belonging + 0.5) / (n + 10.0)).clamp(1e-4, 0.9);
        }
    }

    fn sums<const COST: bool>(&self, distances: &[f64], count: usize, weights: &mut [f64]) -> Sums {
        let mut sums = Sums::default();
        dispatch(Weigh::<COST> { mixture: self, distances, count, weights, sums: &mut sums });
        sums
    }
}

/// Sums over all distances.
#[derive(Clone, Copy, Default)]
struct Sums {
    /// Probabilities of belonging.
    belonging: f64,
    /// Squared distances that belong, with their weights.
    spread: f64,
    /// Negative log-likelihood; zero where it is not asked for.
    cost: f64,
}

/// One pass over distances, of which only the first count; the weights are kept where there is room for them.
struct Weigh<'a, const COST: bool> {
    mixture: &'a Mixture,
    distances: &'a [f64],
    count: usize,
    weights: &'a mut [f64],
    sums: &'a mut Sums,
}

/// Blocks whose densities are multiplied before a logarithm is taken: within 1e±160, as each is within 1e±20.
const MULTIPLIED: usize = 8;

impl<const COST: bool> Job for Weigh<'_, COST> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let precision = 1.0 / (self.mixture.scale * self.mixture.scale);
        let mut lanes = [[0.0; WIDTH]; 3];
        for (g, group) in self.distances.chunks(MULTIPLIED * WIDTH).enumerate() {
            let mut product = [1.0; WIDTH];
            for (b, block) in group.chunks(WIDTH).enumerate() {
                let first = (g * MULTIPLIED + b) * WIDTH;
                let (mut d, mut weights) = ([0.0; WIDTH], [0.0; WIDTH]);
                d[..block.len()].copy_from_slice(block);
                for i in 0..WIDTH {
                    // padding has no say
                    let counts = first + i < self.count;
                    let here = if counts { 1.0 } else { 0.0 };
                    let share = self.mixture.share::<FUSED>(d[i]);
                    let weight = here * share.belongs * share.weight;
                    weights[i] = weight * precision;
                    lanes[0][i] += here * share.belongs;
                    lanes[1][i] += weight * d[i] * d[i];
                    product[i] *= if counts { share.density } else { 1.0 };
                }
                if let Some(out) = self.weights.get_mut(first..first + block.len()) {
                    out.copy_from_slice(&weights[..block.len()]);
                }
            }
            if COST {
                for i in 0..WIDTH {
                    lanes[2][i] -= ln::<FUSED>(product[i]);
                }
            }
        }
        let [belonging, spread, cost] = lanes.map(|l| l.iter().sum());
        *self.sums = Sums { belonging, spread, cost };
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_pass_is_the_sum_of_its_points() {
        for law in [Law::Gaussian, Law::StudentT] {
            let mixture = Mixture { law, scale: 0.1, outliers: 0.2, density: 0.5 };
            let d: Vec<f64> = (0..16).map(|i| 0.03 * i as f64 - 0.1).collect();
            let mut weights = Vec::new();
            let cost = mixture.weigh(&d, 13, &mut weights);
            let expected: f64 =
                d[..13].iter().map(|d| -mixture.share::<false>(*d).density.ln()).sum();
            assert!((cost - expected).abs() < 1e-12 && weights[13..] == [0.0; 3]);
            // the weight is the slope of the cost by half the squared distance
            for (d, w) in d[..13].iter().zip(&weights).filter(|(d, _)| d.abs() > 0.01) {
                let cost = |d: f64| mixture.cost(&[d; 8], 1);
                let slope = (cost(d + 1e-6) - cost(d - 1e-6)) / (2e-6 * d);
                assert!((slope - w).abs() < 1e-4 * (1.0 + w), "{slope} {w}");
                let slope = |d: f64| mixture.weight(d) * d;
                let curvature = (slope(d + 1e-6) - slope(d - 1e-6)) / 2e-6;
                assert!((curvature - mixture.curvature(*d)).abs() < 1e-4 * (1.0 + w));
            }
        }
    }
}
