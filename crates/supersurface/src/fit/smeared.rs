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
use crate::numeric::lanes::{Job, Lane, WIDTH, dispatch};
use crate::numeric::random::Stream;

/// Exponent from which a Gaussian's value may be left out: `e^-16` of its peak.
const NEGLIGIBLE: f32 = 16.0;
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
    let surface = Blocks::new(&surface);
    let peak = (1.0 - mixture.outliers)
        / (surface.len() as f64 * (std::f64::consts::TAU * sigma * sigma).powi(3).sqrt());
    let uniform = mixture.outliers.max(1e-3) / volume;
    let (mut cost, mut slope) = (0.0, 0.0);
    let precision = 0.5 / (sigma * sigma);
    for p in points {
        let (mut sums, p) = ([0.0; 2], [p.x as f32, p.y as f32, p.z as f32]);
        dispatch(Smear { surface: &surface, p, precision: precision as f32, sums: &mut sums });
        let density = peak * sums[0] + uniform;
        cost -= density.ln();
        // by ln σ: the kernel's mean square distance over σ², less its dimensions
        slope += peak * (2.0 * precision * sums[1] - 3.0 * sums[0]) / density;
    }
    // the best noise by the curvature of a Gaussian's likelihood, 2 a point
    let inliers = (1.0 - mixture.outliers) * points.len() as f64;
    cost - slope * slope / (4.0 * inliers.max(1.0))
}

/// Samples of a surface, eight neighbours in a block with a ball around them, in single precision.
struct Blocks {
    samples: Vec<[[f32; WIDTH]; 3]>,
    /// Coordinates of the balls' middles and their radii, padded with balls of nothing that are far.
    balls: [Vec<f32>; 4],
}

impl Blocks {
    fn new(samples: &[Vector]) -> Self {
        let blocks = samples.as_chunks::<WIDTH>().0;
        let mut balls = [(); 4].map(|()| Vec::with_capacity(blocks.len() + WIDTH));
        for block in blocks {
            let middle = block.iter().sum::<Vector>() / WIDTH as f64;
            let radius = block.iter().map(|p| (p - middle).norm_squared()).fold(0.0, f64::max);
            let ball = [middle.x, middle.y, middle.z, radius.sqrt()];
            balls.iter_mut().zip(ball).for_each(|(column, value)| column.push(value as f32));
        }
        for (column, far) in balls.iter_mut().zip([1e6, 1e6, 1e6, 0.0]) {
            column.resize(blocks.len().next_multiple_of(WIDTH), far);
        }
        let columns = |block: &[Vector; WIDTH]| [0, 1, 2].map(|k| block.map(|p| p[k] as f32));
        Self { samples: blocks.iter().map(columns).collect(), balls }
    }

    const fn len(&self) -> usize {
        self.samples.len() * WIDTH
    }
}

/// `Σ exp(-d²/2σ²)` and `Σ d² exp(-d²/2σ²)` over the samples that are not too far.
struct Smear<'a> {
    surface: &'a Blocks,
    p: [f32; 3],
    precision: f32,
    sums: &'a mut [f64; 2],
}

impl Job for Smear<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let ([px, py, pz], reach) = (self.p, (NEGLIGIBLE / self.precision).sqrt());
        let [x, y, z, radius] = self.surface.balls.each_ref().map(|c| c.as_chunks::<WIDTH>().0);
        let mut lanes = [[0.0f32; WIDTH]; 2];
        for (b, samples) in self.surface.samples.chunks(WIDTH).enumerate() {
            let mut beyond = [0.0; WIDTH];
            for i in 0..WIDTH {
                let (dx, dy, dz) = (x[b][i] - px, y[b][i] - py, z[b][i] - pz);
                let within = reach + radius[b][i];
                beyond[i] = dx * dx + dy * dy + dz * dz - within * within;
            }
            for (samples, beyond) in samples.iter().zip(&beyond) {
                if *beyond > 0.0 {
                    continue;
                }
                let [x, y, z] = samples;
                for i in 0..WIDTH {
                    let (dx, dy, dz) = (x[i] - px, y[i] - py, z[i] - pz);
                    let square = dx * dx + dy * dy + dz * dz;
                    let kernel = Lane::exp::<FUSED>(-self.precision * square);
                    lanes[0][i] += kernel;
                    lanes[1][i] += kernel * square;
                }
            }
        }
        *self.sums = lanes.map(|l| l.iter().map(|x| f64::from(*x)).sum());
    }
}
