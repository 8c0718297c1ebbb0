//! Interpolating cubic splines over uniform knots: natural on an interval, or periodic.
//!
//! With values `y_j` and second derivatives `m_j` at the knots, spacing `h` and `A + B = 1`,
//! `s = A y_j + B y_{j+1} + ((A³ - A) m_j + (B³ - B) m_{j+1}) h²/6`; continuity of the slope gives
//! `m_{j-1} + 4 m_j + m_{j+1} = 6 (y_{j-1} - 2 y_j + y_{j+1}) / h²`, a tridiagonal system.

/// A cubic spline with its value and slope anywhere.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    from: f64,
    spacing: f64,
    /// Value and second derivative at each knot; of a periodic spline the first knot stands again at
    /// the end.
    knots: Vec<[f64; 2]>,
    periodic: bool,
}

impl Spline {
    /// A spline through `values` at equal distances from `from` to `to`, straight at both ends (second
    /// derivative 0). One value is a constant, none is the constant 0.
    pub fn natural(values: &[f64], from: f64, to: f64) -> Self {
        let intervals = values.len().saturating_sub(1).max(1);
        let spacing = (to - from) / intervals as f64;
        let inner = right_sides(values, spacing);
        let mut second = vec![0.0; values.len()];
        let inside = solve_tridiagonal(4.0, 4.0, &inner);
        for (m, v) in second.iter_mut().skip(1).zip(inside) {
            *m = v;
        }
        let knots = values.iter().zip(second).map(|(y, m)| [*y, m]).collect();
        Self { from, spacing, knots, periodic: false }
    }

    /// A spline of period `period` through `values` at `from + j period / n`.
    pub fn periodic(values: &[f64], from: f64, period: f64) -> Self {
        let n = values.len();
        let spacing = period / n.max(1) as f64;
        let at = |j: usize| values.get(j % n.max(1)).copied().unwrap_or(0.0);
        let around: Vec<f64> = (0..n + 2).map(|j| at(j + n.saturating_sub(1))).collect();
        let second = solve_cyclic(&right_sides(&around, spacing));
        let knots = (0..n + usize::from(n > 0))
            .map(|j| [at(j), second.get(j % n).copied().unwrap_or(0.0)])
            .collect();
        Self { from, spacing, knots, periodic: true }
    }

    /// Value and slope at `t`, as [`Self::derivatives`] says them.
    pub fn value_and_slope(&self, t: f64) -> [f64; 2] {
        let [value, slope, _] = self.derivatives(t);
        [value, slope]
    }

    /// Value, slope and second derivative at `t`. Outside of its interval a natural spline goes on straight; at a
    /// `t` that is not finite it has the first value.
    pub fn derivatives(&self, t: f64) -> [f64; 3] {
        let [first, .., last] = self.knots.as_slice() else {
            return [self.knots.first().map_or(0.0, |k| k[0]), 0.0, 0.0];
        };
        let intervals = self.knots.len() - 1;
        let mut u = (t - self.from) / self.spacing;
        if !u.is_finite() {
            return [first[0], 0.0, 0.0];
        }
        if self.periodic {
            u = u.rem_euclid(intervals as f64);
        }
        let j = (u.max(0.0) as usize).min(intervals - 1);
        let (Some(left), Some(right)) = (self.knots.get(j), self.knots.get(j + 1)) else {
            return [last[0], 0.0, 0.0];
        };
        let b = (u - j as f64).clamp(0.0, 1.0);
        let a = 1.0 - b;
        let h = self.spacing;
        let curved = (a * a * a - a) * left[1] + (b * b * b - b) * right[1];
        let value = a * left[0] + b * right[0] + curved * h * h / 6.0;
        let bent = (3.0 * b * b - 1.0) * right[1] - (3.0 * a * a - 1.0) * left[1];
        let slope = (right[0] - left[0]) / h + bent * h / 6.0;
        let beyond = (u - j as f64 - b) * h;
        if beyond == 0.0 {
            [value, slope, a * left[1] + b * right[1]]
        } else {
            [value + slope * beyond, slope, 0.0]
        }
    }

    /// Number of values that it was made from.
    pub fn len(&self) -> usize {
        self.knots.len() - usize::from(self.periodic && !self.knots.is_empty())
    }

    /// True for the constant 0 made from no value.
    pub fn is_empty(&self) -> bool {
        self.knots.is_empty()
    }
}

/// `6 (y_{j-1} - 2 y_j + y_{j+1}) / h²` for the inner values.
fn right_sides(values: &[f64], spacing: f64) -> Vec<f64> {
    let scale = 6.0 / (spacing * spacing);
    values
        .windows(3)
        .map(|w| if let [a, b, c] = w { scale * ((c - b) - (b - a)) } else { 0.0 })
        .collect()
}

/// Solves `x_{j-1} + d_j x_j + x_{j+1} = r_j` with diagonal 4 but `first` and `last` at its ends
/// (Thomas's algorithm; the matrix is diagonally dominant, so no pivots are needed).
fn solve_tridiagonal(first: f64, last: f64, right: &[f64]) -> Vec<f64> {
    let n = right.len();
    let mut steps: Vec<[f64; 2]> = Vec::with_capacity(n);
    let mut before = [0.0, 0.0];
    for (j, r) in right.iter().enumerate() {
        let mut diagonal = if j == 0 { first } else { 4.0 };
        if j + 1 == n && n > 1 {
            diagonal = last;
        }
        let pivot = diagonal - if j == 0 { 0.0 } else { before[0] };
        before = [1.0 / pivot, (r - if j == 0 { 0.0 } else { before[1] }) / pivot];
        steps.push(before);
    }
    let mut x = vec![0.0; n];
    let mut after = 0.0;
    for (x, [factor, value]) in x.iter_mut().zip(&steps).rev() {
        after = value - factor * after;
        *x = after;
    }
    x
}

/// The same system closed to a ring, by the formula of Sherman and Morrison: two ordinary solutions.
fn solve_cyclic(right: &[f64]) -> Vec<f64> {
    let n = right.len();
    match right {
        [] => Vec::new(),
        // both neighbours are the unknown itself
        [r] => vec![r / 6.0],
        // both neighbours are the other one
        [r, s] => vec![(4.0 * r - 2.0 * s) / 12.0, (4.0 * s - 2.0 * r) / 12.0],
        [.., _] => {
            // the corners are γ u vᵀ with u = (γ, 0, …, 1), v = (1, 0, …, 1/γ), γ = -4
            let gamma = -4.0;
            let (first, last) = (4.0 - gamma, 4.0 - 1.0 / gamma);
            let mut u = vec![0.0; n];
            if let [a, .., b] = u.as_mut_slice() {
                (*a, *b) = (gamma, 1.0);
            }
            let (y, z) =
                (solve_tridiagonal(first, last, right), solve_tridiagonal(first, last, &u));
            let along = |w: &[f64]| match w {
                [a, .., b] => a + b / gamma,
                _ => 0.0,
            };
            let factor = along(&y) / (1.0 + along(&z));
            y.iter().zip(&z).map(|(y, z)| y - factor * z).collect()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn knots_are_met_and_slopes_agree_with_differences() {
        let values = [0.3, 1.1, 0.7, 1.9, 0.2];
        let natural = Spline::natural(&values, -1.0, 1.0);
        let ring = Spline::periodic(&values, -PI, TAU);
        assert_eq!((natural.len(), ring.len()), (5, 5));
        for (j, y) in values.iter().enumerate() {
            let at = natural.value_and_slope(-1.0 + 0.5 * j as f64);
            assert!((at[0] - y).abs() < 1e-14);
            let at = ring.value_and_slope(-PI + TAU / 5.0 * j as f64);
            assert!((at[0] - y).abs() < 1e-13);
        }
        for s in [&natural, &ring] {
            for i in -30..30 {
                let t = f64::from(i) * 0.0999 + 0.0123;
                let h = 1e-5;
                let difference =
                    (s.value_and_slope(t + h)[0] - s.value_and_slope(t - h)[0]) / (2.0 * h);
                let slope = s.value_and_slope(t)[1];
                assert!((slope - difference).abs() < 1e-5, "{t}: {slope} {difference}");
            }
        }
        // one turn later it is the same, also in its slope
        let (a, b) = (ring.value_and_slope(0.4), ring.value_and_slope(0.4 - TAU));
        assert!((a[0] - b[0]).abs() < 1e-13 && (a[1] - b[1]).abs() < 1e-12);
    }

    #[test]
    fn few_values_and_odd_arguments_are_answered() {
        for n in 0..4 {
            let values = vec![2.0; n];
            let expected = if n == 0 { 0.0 } else { 2.0 };
            for s in [Spline::natural(&values, 0.0, 1.0), Spline::periodic(&values, 0.0, 1.0)] {
                for t in [0.0, 0.3, 1.0, -7.0, f64::NAN, f64::INFINITY, 1e308] {
                    let [v, slope] = s.value_and_slope(t);
                    assert!((v - expected).abs() < 1e-15 && slope == 0.0, "{n} {t}: {v} {slope}");
                }
            }
        }
    }
}
