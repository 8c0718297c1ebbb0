//! How points scatter about a surface, and the constant density of those that do not belong to it. Scale and
//! outlier share are estimated, not given.
//!
//! Seen from all around, noise is taken as Gaussian: a heavy tail would swallow outliers that the density
//! should explain. On single views, whose noise acts along the rays and grows at edges, it is a Student-t
//! with 3 degrees of freedom.

use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, Lane, WIDEST, dispatch};

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
struct Share<L> {
    belongs: L,
    weight: L,
    density: L,
}

impl Mixture {
    #[inline(always)]
    fn share<const FUSED: bool, L: Lane>(&self, d: L) -> Share<L> {
        let one = L::of(1.0);
        let t = d * d * L::of(1.0 / (self.scale * self.scale));
        let (law, weight) = match self.law {
            Law::Gaussian => ((L::of(-0.5) * t).exp::<FUSED>(), one),
            Law::StudentT => {
                let q = one / t.times_plus::<FUSED>(L::of(1.0 / 3.0), one);
                (q * q, L::of(4.0 / 3.0) * q)
            }
        };
        let constant = match self.law {
            Law::Gaussian => GAUSS,
            Law::StudentT => T3,
        };
        let inlier = L::of((1.0 - self.outliers) * constant / self.scale) * law;
        let density = inlier + L::of(self.outliers * self.density);
        let belongs = inlier / density;
        // less is nothing, and products with it would be too small for fast units
        let belongs = if belongs > L::of(LEAST_SHARE) { belongs } else { L::of(0.0) };
        Share { belongs, weight, density }
    }

    /// What up to [`TOGETHER`] distances say.
    #[inline(always)]
    fn shares<const FUSED: bool, L: Lane>(&self, distances: &[L], each: &mut Together<L>) {
        let precision = L::of(1.0 / (self.scale * self.scale));
        let n = distances.len();
        let (belonging, spread) = (&mut each.belonging[..n], &mut each.spread[..n]);
        let (density, weight) = (&mut each.density[..n], &mut each.weight[..n]);
        for i in 0..n {
            let d = distances[i];
            let share = self.share::<FUSED, L>(d);
            let own = share.belongs * share.weight;
            (belonging[i], spread[i]) = (share.belongs, own * d * d);
            (density[i], weight[i]) = (share.density, own * precision);
        }
    }

    /// Weight of one squared distance in the equivalent least squares problem, in 1/length².
    pub(super) fn weight(&self, d: f64) -> f64 {
        let share = self.share::<false, f64>(d);
        share.belongs * share.weight / (self.scale * self.scale)
    }

    /// Second derivatives of the negative log-likelihoods of distances, in 1/length²: below the weight where the law is
    /// wider than a Gaussian, negative for outliers.
    pub(super) fn curvatures<L: Lane>(&self, distances: &[L]) -> Vec<L> {
        let mut out = vec![L::of(0.0); distances.len()];
        dispatch(Each::<true, L> { mixture: self, distances, out: &mut out });
        out
    }

    /// Probabilities that points at some distances belong to the surface.
    pub(super) fn belonging<L: Lane>(&self, distances: &[L]) -> Vec<L> {
        let mut out = vec![L::of(0.0); distances.len()];
        dispatch(Each::<false, L> { mixture: self, distances, out: &mut out });
        out
    }

    #[inline(always)]
    fn curvature<const FUSED: bool, L: Lane>(&self, d: L) -> L {
        let Share { belongs, weight, .. } = self.share::<FUSED, L>(d);
        let (one, precision) = (L::of(1.0), L::of(1.0 / (self.scale * self.scale)));
        let slope = weight * d * precision;
        let within = match self.law {
            Law::Gaussian => one,
            Law::StudentT => weight * (L::of(1.5) * weight - one),
        };
        belongs * (within * precision - (one - belongs) * slope * slope)
    }

    /// By how much the cost rises when a point at distance `d` is an outlier after all.
    pub(super) fn price_of_leaving(&self, d: f64) -> f64 {
        (self.share::<false, f64>(d).density / (self.outliers * self.density)).ln()
    }

    /// Weights of squared distances in the equivalent least squares problem, in 1/length², and what the first `count`
    /// distances add up to, which are padded to a multiple of [`Lane::WIDTH`]; padding weighs nothing.
    pub(super) fn weigh<L: Lane>(
        &self,
        distances: &[L],
        count: usize,
        weights: &mut Column<L>,
    ) -> Tally {
        weights.resize(distances.len(), L::of(0.0));
        self.sums::<true, true, L>(distances, count, weights)
    }

    /// What the first `count` distances add up to, padded as for [`Self::weigh`].
    pub(super) fn tally<L: Lane>(&self, distances: &[L], count: usize) -> Tally {
        self.sums::<true, false, L>(distances, count, &mut [])
    }

    /// Negative log-likelihood of the first `count` distances, padded as for [`Self::weigh`].
    pub(super) fn cost<L: Lane>(&self, distances: &[L], count: usize) -> f64 {
        self.tally(distances, count).cost
    }

    /// `rounds` of expectation maximisation of scale (within limits) and outlier share by the first `count`
    /// distances, padded as for [`Self::weigh`].
    pub(super) fn update<L: Lane>(
        &mut self,
        distances: &[L],
        count: usize,
        limits: [f64; 2],
        rounds: usize,
    ) {
        for _ in 0..rounds {
            let tally = self.sums::<false, false, L>(distances, count, &mut []);
            self.follow(&tally, count, limits);
        }
    }

    /// The same by what `count` distances added up to.
    pub(super) fn follow(&mut self, tally: &Tally, count: usize, [low, high]: [f64; 2]) {
        let (n, belonging) = (count as f64, tally.belonging + 1e-9);
        let most = high.min(self.law.largest_scale());
        self.scale = (tally.spread / belonging).sqrt().min(most).max(low);
        self.outliers = ((n - belonging + 0.5) / (n + 10.0)).clamp(1e-4, 0.9);
    }

    fn sums<const COST: bool, const WEIGHTS: bool, L: Lane>(
        &self,
        distances: &[L],
        count: usize,
        weights: &mut [L],
    ) -> Tally {
        let mut tally = Tally::default();
        let out = &mut tally;
        dispatch(Weigh::<COST, WEIGHTS, L> { mixture: self, distances, count, weights, out });
        tally
    }
}

/// What each distance says: the curvature, or the probability of belonging.
struct Each<'a, const CURVATURE: bool, L> {
    mixture: &'a Mixture,
    distances: &'a [L],
    out: &'a mut [L],
}

impl<const CURVATURE: bool, L: Lane> Job for Each<'_, CURVATURE, L> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        for (d, out) in self.distances.iter().zip(self.out) {
            *out = match CURVATURE {
                true => self.mixture.curvature::<FUSED, L>(*d),
                false => self.mixture.share::<FUSED, L>(*d).belongs,
            };
        }
    }
}

/// Sums over all distances.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Tally {
    /// Probabilities of belonging.
    belonging: f64,
    /// Squared distances that belong, with their weights.
    spread: f64,
    /// Negative log-likelihood; zero where it is not asked for.
    pub(super) cost: f64,
}

/// One pass over distances, of which only the first count, for the likelihood and the weights where these are asked for.
struct Weigh<'a, const COST: bool, const WEIGHTS: bool, L> {
    mixture: &'a Mixture,
    distances: &'a [L],
    count: usize,
    weights: &'a mut [L],
    out: &'a mut Tally,
}

/// Least probability of belonging to the surface that is not none.
const LEAST_SHARE: f64 = 1e-15;

/// Distances that are looked at together.
const TOGETHER: usize = 64;

/// What distances that are looked at together add to the sums.
struct Together<L> {
    belonging: [L; TOGETHER],
    spread: [L; TOGETHER],
    density: [L; TOGETHER],
    weight: [L; TOGETHER],
}

impl<const COST: bool, const WEIGHTS: bool, L: Lane> Job for Weigh<'_, COST, WEIGHTS, L> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let (zero, one) = (L::of(0.0), L::of(1.0));
        let none = [zero; TOGETHER];
        let mut each = Together { belonging: none, spread: none, density: none, weight: none };
        let mut lanes = [[zero; WIDEST]; 3];
        for (g, group) in self.distances.chunks(TOGETHER).enumerate() {
            let n = group.len();
            self.mixture.shares::<FUSED, L>(group, &mut each);
            // padding has no say
            for i in self.count.saturating_sub(g * TOGETHER)..n {
                (each.belonging[i], each.spread[i]) = (zero, zero);
                (each.density[i], each.weight[i]) = (one, zero);
            }
            // one logarithm of up to eight densities, or four in single precision, which are within 1e±9
            let mut product = [one; WIDEST];
            for b in 0..n / L::WIDTH {
                for i in 0..L::WIDTH {
                    lanes[0][i] += each.belonging[b * L::WIDTH + i];
                    lanes[1][i] += each.spread[b * L::WIDTH + i];
                    product[i] = product[i] * each.density[b * L::WIDTH + i];
                }
            }
            if COST {
                for i in 0..L::WIDTH {
                    lanes[2][i] = lanes[2][i] - product[i].ln::<FUSED>();
                }
            }
            if WEIGHTS {
                let from = g * TOGETHER;
                self.weights[from..from + n].copy_from_slice(&each.weight[..n]);
            }
        }
        let [belonging, spread, cost] = lanes.map(|l| l.iter().map(|x| x.wide()).sum());
        *self.out = Tally { belonging, spread, cost };
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
            let mut weights = Column::default();
            let Tally { cost, .. } = mixture.weigh(&d, 13, &mut weights);
            let expected: f64 =
                d[..13].iter().map(|d| -mixture.share::<false, f64>(*d).density.ln()).sum();
            assert!((cost - expected).abs() < 1e-12 && weights[13..] == [0.0; 3]);
            // the weight is the slope of the cost by half the squared distance
            for (d, w) in d[..13].iter().zip(&weights).filter(|(d, _)| d.abs() > 0.01) {
                let cost = |d: f64| mixture.cost(&[d; 8], 1);
                let slope = (cost(d + 1e-6) - cost(d - 1e-6)) / (2e-6 * d);
                assert!((slope - w).abs() < 1e-4 * (1.0 + w), "{slope} {w}");
                let slope = |d: f64| mixture.weight(d) * d;
                let curvature = (slope(d + 1e-6) - slope(d - 1e-6)) / 2e-6;
                let known = mixture.curvatures(&[*d])[0];
                assert!((curvature - known).abs() < 1e-4 * (1.0 + w));
            }
        }
    }
}
