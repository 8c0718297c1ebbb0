//! Moments of solids whose surface is a product of two curves: `(C X, C Y, S)` with `(X, Y)` around z and `(C, S)` from
//! pole to pole.
//!
//! With the points `r (C X, C Y, S)`, `0 <= r <= 1`, each moment is a product of two integrals over one angle:
//! `∫ x^i y^j z^k dV = ∫ X^i Y^j (X Y' - X' Y) dω · ∫ C^(n+1) S^k (C S' - C' S) dη / (n+k+3)` with `n = i + j`.

use nalgebra::Matrix3;

use super::{MassEstimate, Moments};
use crate::Vector;
use crate::numeric::tanh_sinh::Integral;

/// Both integrals, each with the factors 1, a, b, a², ab, b² of its curve's coordinates.
pub(super) struct ProductMoments {
    /// `∫ … (X Y' - X' Y) dω`.
    pub(super) around: Integral<6>,
    /// `∫ … C (C S' - C' S) dη`, without the division.
    pub(super) along: Integral<6>,
}

impl ProductMoments {
    /// Volume of the solid in the unit of the curves.
    pub(super) fn volume(&self) -> f64 {
        self.around.value[0] * self.along.value[0] / 3.0
    }

    /// Estimated relative error.
    pub(super) fn error(&self) -> f64 {
        relative(&self.around) + relative(&self.along)
    }

    /// The mass of the solid whose coordinates are multiplied by `scale`.
    pub(super) fn mass(&self, scale: [f64; 3], density: f64) -> MassEstimate {
        let [l, lx, ly, lxx, lxy, lyy] = self.around.value;
        let [p, pu, pz, puu, puz, pzz] = self.along.value;
        let scale = Vector::from(scale);
        let volume = scale.product();
        let first = Vector::new(lx * pu, ly * pu, l * pz) / 4.0;
        let (xy, xz, yz) = (lxy * puu, lx * puz, ly * puz);
        let second = Matrix3::new(lxx * puu, xy, xz, xy, lyy * puu, yz, xz, yz, l * pzz) / 5.0;
        let moments = Moments {
            volume: volume * (l * p / 3.0),
            first: first.component_mul(&scale) * volume,
            second: second.component_mul(&(scale * scale.transpose())) * volume,
        };
        MassEstimate { mass: moments.mass(density), error: self.error() }
    }
}

/// The largest error, each in units of what bounds its integral (Cauchy and Schwarz).
fn relative(found: &Integral<6>) -> f64 {
    let [one, .., aa, _, bb] = found.value;
    let sizes = [one * one, one * aa, one * bb, aa * aa, aa * bb, bb * bb];
    let shares = found.error.iter().zip(sizes).map(|(e, size)| e / size.abs().sqrt());
    shares.fold(0.0, |m, share| crate::numeric::powers::larger(share, m))
}
