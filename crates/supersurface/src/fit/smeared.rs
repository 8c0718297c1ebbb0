//! The likelihood of points as even samples of a surface, smeared by isotropic noise:
//!
//! ```text
//! p(x) = (1 - w) (1/N) Σ_k N(x; s_k, σ² I) + w/V
//! ```
//!
//! At single points the distance alone says less: where the noise is as wide as an edge is sharp, a body with other axis
//! roles may have smaller distances. Used to choose among bodies that were found, not to find them.

use super::noise::Mixture;
use super::parameters::Parameters;
use super::samples::sample;
use crate::Vector;
use crate::numeric::lanes::{Job, WIDTH, dispatch, exp};
use crate::numeric::random::Stream;

/// Exponent from which a Gaussian's value is left out: `e^-16` of its peak.
const NEGLIGIBLE: f64 = 16.0;
/// Least and most samples of a surface.
const SAMPLES: [f64; 2] = [600.0, 3000.0];

/// Negative log-likelihood of points for a body, with the noise that suits it best near `sigma`; `volume` is that in
/// which outliers are spread.
pub(super) fn smeared_cost(
    s: &Parameters,
    mixture: &Mixture,
    points: &[Vector],
    sigma: f64,
    volume: f64,
) -> f64 {
    let count = (0.9 * s.area() / (sigma * sigma)).clamp(SAMPLES[0], SAMPLES[1]) as usize;
    let mut surface = Vec::with_capacity(count);
    // the same strata for every body, so that chance does not choose between them
    sample(s, count.next_multiple_of(WIDTH), &mut Stream::new(7, 1), &mut surface);
    let columns: [Vec<f64>; 3] = std::array::from_fn(|k| surface.iter().map(|p| p[k]).collect());
    let peak = (1.0 - mixture.outliers)
        / (surface.len() as f64 * (std::f64::consts::TAU * sigma * sigma).powi(3).sqrt());
    let uniform = mixture.outliers.max(1e-3) / volume;
    let (mut cost, mut slope) = (0.0, 0.0);
    for p in points {
        let mut sums = [0.0; 2];
        let precision = 0.5 / (sigma * sigma);
        dispatch(Smear { columns: &columns, p, precision, sums: &mut sums });
        let density = peak * sums[0] + uniform;
        cost -= density.ln();
        // by ln σ: the kernel's mean square distance over σ², less its dimensions
        slope += peak * (2.0 * precision * sums[1] - 3.0 * sums[0]) / density;
    }
    // the best noise by the curvature of a Gaussian's likelihood, 2 a point
    let inliers = (1.0 - mixture.outliers) * points.len() as f64;
    cost - slope * slope / (4.0 * inliers.max(1.0))
}

/// `Σ exp(-d²/2σ²)` and `Σ d² exp(-d²/2σ²)`.
struct Smear<'a> {
    columns: &'a [Vec<f64>; 3],
    p: &'a Vector,
    precision: f64,
    sums: &'a mut [f64; 2],
}

impl Job for Smear<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [x, y, z] = self.columns;
        let blocks = x.as_chunks::<WIDTH>().0.iter().zip(y.as_chunks::<WIDTH>().0);
        let mut lanes = [[0.0; WIDTH]; 2];
        for ((x, y), z) in blocks.zip(z.as_chunks::<WIDTH>().0) {
            let squares: [f64; WIDTH] = std::array::from_fn(|i| {
                let (dx, dy, dz) = (x[i] - self.p.x, y[i] - self.p.y, z[i] - self.p.z);
                dx * dx + dy * dy + dz * dz
            });
            // neighbours in the list are neighbours on the surface: most blocks are far
            if squares.iter().all(|s| self.precision * s > NEGLIGIBLE) {
                continue;
            }
            for (i, square) in squares.iter().enumerate() {
                let kernel = exp::<FUSED>(-self.precision * square);
                lanes[0][i] += kernel;
                lanes[1][i] += kernel * square;
            }
        }
        *self.sums = lanes.map(|l| l.iter().sum());
    }
}
