//! Dirichlet's integral: volumes and moments of everything that is bounded by a sum of powers.
//!
//! `∫ Π x_i^m_i` over `x_i >= 0`, `Σ x_i^k_i <= 1` is `Π Γ(s_i)/k_i / Γ(1 + Σ s_i)` with
//! `s_i = (m_i + 1)/k_i`. For two equal exponents `k = 2/ε` it is the `D2(ε; i, j)` of FORMULAS §2.1, for three
//! exponents an octant of equation (6).

/// The integral for terms `(k_i, m_i)`: exponents `k_i > 0` (infinite for a box) and powers `m_i >= 0`.
///
/// ```
/// use supersurface::numeric::dirichlet::dirichlet;
/// let quarter_disc = dirichlet(&[(2.0, 0.0), (2.0, 0.0)]);
/// assert!((quarter_disc - std::f64::consts::FRAC_PI_4).abs() < 1e-15);
/// assert_eq!(dirichlet(&[(f64::INFINITY, 1.0)]), 0.5);
/// ```
pub fn dirichlet(terms: &[(f64, f64)]) -> f64 {
    // Γ(s)/k = Γ(1 + s)/(m + 1): no pole for large exponents
    let mut log = 0.0;
    let mut sum = 1.0;
    let mut divisor = 1.0;
    for (k, m) in terms {
        let s = (m + 1.0) / k;
        log += libm::lgamma(1.0 + s);
        sum += s;
        divisor *= m + 1.0;
    }
    (log - libm::lgamma(sum)).exp() / divisor
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_simplex_and_the_ball() {
        // ∫ x over the unit tetrahedron is 1/24, ∫ x² over an octant of the unit ball π/30
        assert!((dirichlet(&[(1.0, 1.0), (1.0, 0.0), (1.0, 0.0)]) * 24.0 - 1.0).abs() < 1e-14);
        let ball = dirichlet(&[(2.0, 2.0), (2.0, 0.0), (2.0, 0.0)]);
        assert!((ball * 30.0 / std::f64::consts::PI - 1.0).abs() < 1e-14);
    }
}
