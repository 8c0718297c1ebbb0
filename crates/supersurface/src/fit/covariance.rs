//! How sure the parameters are: the covariance that the noise leaves.
//!
//! With distances `d`, their derivatives `J`, the weights `w` of the equivalent least squares problem and the curvature `c`
//! of the likelihood, `H = Σ c J Jᵀ` and `G = Σ w² d² J Jᵀ`, the estimate scatters with `H⁻¹ G H⁻ᵀ` (the sandwich of
//! Huber and White): right also where the noise is not the same everywhere, as at the rims of a view. Weights in place
//! of curvatures would make it too small: a wide tail pulls less than it holds. Where the bias of noise was taken back,
//! `H` is what that says (`bias.rs`). What no point says, as the turn of a round tin, is held by a wide prior.
//!
//! Besides scatter there is what is not noise: the points' pull `p = Σ w d J` against priors, rays and limits, and that
//! against the bias that was taken back. `H⁻¹ p` is the way that either moved the body, and as nobody knows how rightly,
//! a share of it counts as doubt: `p pᵀ` joins `G`.

use nalgebra::{DMatrix, DVector};

use super::Effort;
use super::bias;
use super::columns::{Evaluation, Sample};
use super::finish::PRECISE;
use super::normal::Normal;
use super::parameters::{COUNT, EXPONENT, POSITION, RING, ROTATION, TAPER, TWIST};
use super::prepare::Normalised;
use super::sights::Sights;
use super::solver::Hypothesis;
use super::terms::Sight;
use crate::numeric::column::Column;
use crate::numeric::lanes::Lane;

/// Precision of the prior of every parameter in normalised units: a deviation of 1.
const PRIOR: f64 = 1.0;

/// Shares of the pull that count as doubt: of all that is beside the points, and of the bias.
const DOUBT: f64 = 1.0;
const DOUBT_OF_BIAS: f64 = 0.55;

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
    let index: Vec<usize> = (0..NAMES.len()).filter(|k| s.family.has(*k)).collect();
    let n = index.len();
    let [curved, squared, weighted] = match h.mixture.scale < PRECISE {
        true => sums(cloud, h, &cloud.exact()),
        false => sums(cloud, h, &cloud.fine),
    };
    let symmetric = |sums: &Normal| {
        DMatrix::from_fn(n, n, |j, k| sums.matrix[index[j.max(k)]][index[j.min(k)]])
    };
    let (mut information, mut scatter) = (symmetric(&curved), symmetric(&squared));
    let mut pull = DVector::from_fn(n, |j, _| weighted.gradient[index[j]]);
    // all points count, not only those that were looked at
    let total = cloud.total as f64;
    let more = total / cloud.fine.len() as f64;
    (information, scatter, pull) = (information * more, scatter * more, pull * more);
    if h.corrected {
        let belonging = total * (1.0 - h.mixture.outliers);
        let (by_point, bias) = bias::information(h, &index);
        (information, pull) = (by_point * belonging, bias * (belonging * DOUBT_OF_BIAS));
    } else {
        pull *= DOUBT;
    }
    scatter += &pull * pull.transpose();
    let prior = DMatrix::identity(n, n) * PRIOR;
    let inverse = (information + &prior).try_inverse()?;
    let scattered = &inverse * (scatter + prior) * inverse.transpose();
    let units: Vec<f64> = index.iter().map(|k| unit(*k, h, cloud.placement.scale)).collect();
    let mut outward = DMatrix::from_diagonal(&DVector::from_vec(units));
    if let Some(place) = index.iter().position(|k| *k == POSITION) {
        let turned = cloud.placement.axes.matrix() * cloud.placement.scale;
        outward.view_mut((place, place), (3, 3)).copy_from(&turned);
    }
    let matrix = &outward * scattered * outward.transpose();
    let matrix = 0.5 * (&matrix + matrix.transpose());
    let names = index.iter().map(|k| NAMES[*k]).collect();
    matrix.iter().all(|v| v.is_finite()).then_some(Covariance { names, matrix })
}

/// Normal equations of points by the curvatures of their likelihood, by the squares of their pulls and by their weights.
fn sums<L: Lane>(cloud: &Normalised, h: &Hypothesis, points: &Sample<L>) -> [Normal; 3] {
    let s = &h.parameters;
    let mut at = Evaluation::default();
    match (cloud.terms.sight, cloud.effort) {
        (Sight::OneSide, Effort::Thorough) => Sights::default().fill(s, points, &mut at),
        _ => at.fill(s, points),
    }
    let mut weights = Column::default();
    h.mixture.weigh(&at.distances, points.len(), &mut weights);
    let mut curvatures = h.mixture.curvatures(&at.distances);
    curvatures[points.len()..].fill(L::of(0.0));
    let square = |(d, w): (&L, &L)| (*w * *d) * (*w * *d);
    let squares: Vec<L> = at.distances.iter().zip(&weights).map(square).collect();
    let mut buffer = Vec::new();
    [&curvatures[..], &squares, &weights].map(|w| Normal::of_points(s.family, &at, w, &mut buffer))
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
