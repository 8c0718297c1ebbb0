//! How sure the parameters are: the covariance that the noise leaves.
//!
//! With residuals `d`, rows `J`, weights `w` of the equivalent least squares problem, `H = Σ w J Jᵀ` and
//! `G = Σ w² d² J Jᵀ`, the estimate scatters with `H⁻¹ G H⁻¹` (the sandwich of Huber and White): right also where the
//! noise is not the same everywhere, as at the rims of a view. What no point says, as the turn of a round tin, is held
//! by a wide prior.

use nalgebra::DMatrix;

use super::Effort;
use super::columns::Evaluation;
use super::parameters::{COUNT, EXPONENT, POSITION, RING, ROTATION, TAPER, TWIST};
use super::prepare::Normalised;
use super::sights::Sights;
use super::solver::Hypothesis;
use super::terms::Sight;

/// Precision of the prior of every parameter in normalised units: a deviation of 1.
const PRIOR: f64 = 1.0;

/// The parameters of a fit, in order, and their covariance.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Covariance {
    /// What each row and column is: `a1`, `a2`, `a3` (metres, of the tube for a toroid), `ring_ratio`, `e1`, `e2`, `x`,
    /// `y`, `z` (metres), `rx`, `ry`, `rz` (radians about the body's own axes), `taper_x`, `taper_y`, `twist` (turns),
    /// `bend_x`, `bend_y` (1/m, the curvature vector `k (cos α, sin α)`); those that the family has.
    pub names: Vec<&'static str>,
    /// The covariance in these units, symmetric.
    pub matrix: DMatrix<f64>,
}

impl Covariance {
    /// Standard deviation of a parameter by its name; `None` where the family lacks it.
    pub fn deviation(&self, name: &str) -> Option<f64> {
        let i = self.names.iter().position(|n| *n == name)?;
        Some(self.matrix[(i, i)].sqrt())
    }
}

const NAMES: [&str; COUNT] = [
    "a1",
    "a2",
    "a3",
    "ring_ratio",
    "e1",
    "e2",
    "x",
    "y",
    "z",
    "rx",
    "ry",
    "rz",
    "taper_x",
    "taper_y",
    "twist",
    "bend_x",
    "bend_y",
];

/// The covariance of a hypothesis; `None` where the points leave it without a finite one.
pub(super) fn covariance(cloud: &Normalised, h: &Hypothesis) -> Option<Covariance> {
    let s = &h.parameters;
    let mut at = Evaluation::default();
    match (cloud.terms.viewpoint, cloud.terms.sight, cloud.effort) {
        (Some(viewpoint), Sight::OneSide, Effort::Thorough) => {
            Sights::default().fill(s, &cloud.fine, &viewpoint, &mut at);
        }
        _ => at.fill(s, &cloud.fine),
    }
    let index: Vec<usize> = (0..NAMES.len()).filter(|k| s.family.has(*k)).collect();
    let n = index.len();
    let mut information = DMatrix::<f64>::zeros(n, n);
    let mut scatter = information.clone();
    let mut pull = vec![0.0; n];
    for i in 0..cloud.fine.len() {
        let d = at.distances[i];
        let w = h.mixture.weight(d);
        let c = h.mixture.curvature(d);
        for (j, row) in index.iter().enumerate() {
            let a = at.rows[*row][i];
            pull[j] += w * d * a;
            for (k, column) in index[..=j].iter().enumerate() {
                let product = a * at.rows[*column][i];
                information[(j, k)] += product * c;
                scatter[(j, k)] += product * w * w * d * d;
            }
        }
    }
    let drawn = matches!(cloud.terms.sight, Sight::AllAround { .. }) && h.mixture.scale > 0.018;
    let trust: f64 = std::env::var(if drawn { "RHO" } else { "RHOV" }).map_or(0.0, |v| v.parse().unwrap());
    // all points count, not only those that were looked at
    let more = cloud.total as f64 / cloud.fine.len() as f64;
    for j in 0..n {
        for k in 0..=j {
            information[(j, k)] *= more;
            scatter[(j, k)] = scatter[(j, k)] * more + trust * trust * pull[j] * pull[k] * more * more;
            information[(k, j)] = information[(j, k)];
            scatter[(k, j)] = scatter[(j, k)];
        }
        information[(j, j)] += PRIOR;
        scatter[(j, j)] += PRIOR;
    }
    if drawn {
        information = super::bias::information(h, &index) * (cloud.total as f64 * (1.0 - h.mixture.outliers));
        for j in 0..n {
            information[(j, j)] += PRIOR;
        }
    }
    let inverse = information.try_inverse()?;
    let mut matrix = &inverse * scatter * inverse.transpose();
    let units: Vec<f64> = index.iter().map(|k| unit(*k, h, cloud.scale)).collect();
    for j in 0..n {
        for k in 0..n {
            matrix[(j, k)] *= units[j] * units[k];
        }
    }
    let names = index.iter().map(|k| NAMES[*k]).collect();
    matrix.iter().all(|v| v.is_finite()).then_some(Covariance { names, matrix })
}

/// What a step of 1 in the solver's coordinates is in the units of the result.
fn unit(index: usize, h: &Hypothesis, scale: f64) -> f64 {
    match index {
        0..RING => h.parameters.log_axes[index].exp() * scale,
        RING | EXPONENT..POSITION | ROTATION..TAPER | TAPER..=TWIST => 1.0,
        POSITION..ROTATION => scale,
        _ => 1.0 / scale,
    }
}
