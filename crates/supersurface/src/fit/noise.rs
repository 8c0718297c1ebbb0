//! How points scatter about a surface: a Student-t with 3 degrees of freedom for what belongs to it, and a
//! constant density for what does not. Scale and outlier share are estimated, not given.

/// The mixture `(1 - w) t3(d; scale) + w density`, in normalised lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct Mixture {
    /// Scale of the t distribution.
    pub(super) scale: f64,
    /// Outlier share `w`.
    pub(super) outliers: f64,
    /// Density of outliers a unit of length.
    pub(super) density: f64,
}

/// Normalising constant of the t distribution with 3 degrees of freedom: 2/(π√3).
const T3: f64 = 0.367_552_596_947_861_4;

impl Mixture {
    /// `(probability of belonging, factor of the t kernel)` at distance `d`.
    #[inline]
    fn share(&self, d: f64) -> (f64, f64) {
        let q = 1.0 / (1.0 + d * d / (3.0 * self.scale * self.scale));
        let inlier = (1.0 - self.outliers) * T3 / self.scale * q * q;
        (inlier / (inlier + self.outliers * self.density), q)
    }

    /// Weight of a squared distance in the equivalent least squares problem, in 1/length².
    #[inline]
    pub(super) fn weight(&self, d: f64) -> f64 {
        let (inlier, q) = self.share(d);
        inlier * q * (4.0 / 3.0) / (self.scale * self.scale)
    }

    /// Probability that a point at distance `d` belongs to the surface.
    #[inline]
    pub(super) fn belongs(&self, d: f64) -> f64 {
        self.share(d).0
    }

    /// Negative log-likelihood of all distances.
    pub(super) fn cost(&self, distances: &[f64]) -> f64 {
        let c = (1.0 - self.outliers) * T3 / self.scale;
        let u = self.outliers * self.density;
        let k = 1.0 / (3.0 * self.scale * self.scale);
        let term = |d: &f64| {
            let q = 1.0 / (1.0 + k * d * d);
            -(c * q * q + u).ln()
        };
        distances.iter().map(term).sum()
    }

    /// `rounds` of expectation maximisation of scale (not under `floor`) and outlier share.
    pub(super) fn update(&mut self, distances: &[f64], floor: f64, rounds: usize) {
        let n = distances.len() as f64;
        for _ in 0..rounds {
            let (mut belonging, mut spread) = (1e-9, 0.0);
            for d in distances {
                let (inlier, q) = self.share(*d);
                belonging += inlier;
                spread += inlier * q * (4.0 / 3.0) * d * d;
            }
            self.scale = (spread / belonging).sqrt().min(1.0).max(floor);
            self.outliers = ((n - belonging + 0.5) / (n + 10.0)).clamp(1e-4, 0.9);
        }
    }
}
