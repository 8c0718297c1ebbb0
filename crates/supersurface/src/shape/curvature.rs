//! How a surface bends: fundamental forms and curvatures, positive where it is convex.

/// First and second fundamental form of a surface by its two angles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FundamentalForms {
    /// `[E, F, G]`: scalar products of the tangents, in m².
    pub first: [f64; 3],
    /// `[L, M, N]`, positive where the surface is convex, in metres.
    pub second: [f64; 3],
}

/// Curvatures of a surface at a point, in 1/m, positive where it is convex (a ball of radius R has 1/R).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// Principal curvatures, the larger first.
    pub principal: [f64; 2],
}

impl Curvature {
    /// From any two perpendicular normal curvatures that are principal; `None` unless both are finite.
    pub(crate) fn of_principal(a: f64, b: f64) -> Option<Self> {
        (a.is_finite() && b.is_finite()).then(|| Self { principal: [a.max(b), a.min(b)] })
    }

    /// From mean and Gaussian curvature: `κ = H ± √(H² - K)`, the one of larger magnitude first and the other
    /// as `K/κ`, so that neither cancels.
    pub(crate) fn of_mean_and_gaussian(mean: f64, gaussian: f64) -> Option<Self> {
        let root = (mean * mean - gaussian).max(0.0).sqrt();
        let large = mean + root.copysign(mean);
        let small = if large == 0.0 { 0.0 } else { gaussian / large };
        Self::of_principal(large, small)
    }

    /// Mean curvature `H = (κ1 + κ2)/2`.
    pub fn mean(&self) -> f64 {
        0.5 * (self.principal[0] + self.principal[1])
    }

    /// Gaussian curvature `K = κ1 κ2`, in 1/m².
    pub fn gaussian(&self) -> f64 {
        self.principal[0] * self.principal[1]
    }
}
