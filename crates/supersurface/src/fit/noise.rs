//! How points scatter about a surface, and the constant density of those that do not belong to it. Scale and
//! outlier share are estimated, not given.
//!
//! Seen from all around, noise is taken as Gaussian: a heavy tail would swallow outliers that the density
//! should explain. On single views, whose noise acts along the rays and grows at edges, it is a Student-t
//! with 3 degrees of freedom.

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
            Self::Gaussian => 1.0,
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

impl Mixture {
    /// `(density of the law, equivalent weight of d² over scale²)` at distance `d`.
    #[inline]
    fn law(&self, d: f64) -> (f64, f64) {
        let t = d * d / (self.scale * self.scale);
        match self.law {
            Law::Gaussian => (GAUSS / self.scale * (-0.5 * t).exp(), 1.0),
            Law::StudentT => {
                let q = 1.0 / (1.0 + t / 3.0);
                (T3 / self.scale * q * q, 4.0 / 3.0 * q)
            }
        }
    }

    /// `(probability of belonging, equivalent weight)` at distance `d`.
    #[inline]
    fn share(&self, d: f64) -> (f64, f64) {
        let (density, weight) = self.law(d);
        let inlier = (1.0 - self.outliers) * density;
        (inlier / (inlier + self.outliers * self.density), weight)
    }

    /// Weight of a squared distance in the equivalent least squares problem, in 1/length².
    #[inline]
    pub(super) fn weight(&self, d: f64) -> f64 {
        let (inlier, weight) = self.share(d);
        inlier * weight / (self.scale * self.scale)
    }

    /// Probability that a point at distance `d` belongs to the surface.
    #[inline]
    pub(super) fn belongs(&self, d: f64) -> f64 {
        self.share(d).0
    }

    /// By how much the cost rises when a point at distance `d` is an outlier after all.
    pub(super) fn price_of_leaving(&self, d: f64) -> f64 {
        let uniform = self.outliers * self.density;
        ((1.0 - self.outliers) * self.law(d).0 / uniform).ln_1p()
    }

    /// Negative log-likelihood of all distances. One logarithm serves eight of them.
    pub(super) fn cost(&self, distances: &[f64]) -> f64 {
        let uniform = self.outliers * self.density;
        let density = |d: &f64| (1.0 - self.outliers) * self.law(*d).0 + uniform;
        distances.chunks(8).map(|eight| -eight.iter().map(density).product::<f64>().ln()).sum()
    }

    /// `rounds` of expectation maximisation of scale (not under `floor`) and outlier share.
    pub(super) fn update(&mut self, distances: &[f64], floor: f64, rounds: usize) {
        let n = distances.len() as f64;
        for _ in 0..rounds {
            let (mut belonging, mut spread) = (1e-9, 0.0);
            for d in distances {
                let (inlier, weight) = self.share(*d);
                belonging += inlier;
                spread += inlier * weight * d * d;
            }
            self.scale = (spread / belonging).sqrt().min(self.law.largest_scale()).max(floor);
            self.outliers = ((n - belonging + 0.5) / (n + 10.0)).clamp(1e-4, 0.9);
        }
    }
}
