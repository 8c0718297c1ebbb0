//! The rule of Gauss and Legendre on (0, 1), plain or with nodes drawn to both ends.
//!
//! Drawn by `x = 3t² - 2t³`, powers of the distance from an end and bends close to it do little harm.

/// Nodes and weights of a rule on (0, 1).
#[derive(Clone, Debug, PartialEq)]
pub struct Rule {
    /// Pairs `[node, weight]`, nodes increasing.
    pub nodes: Vec<[f64; 2]>,
}

impl Rule {
    /// Gauss and Legendre's rule of `count` nodes, exact to degree `2 count - 1`; `count` from 1 to 200.
    ///
    /// ```
    /// use supersurface::numeric::gauss::Rule;
    /// let cube: f64 = Rule::gauss(2).nodes.iter().map(|[x, w]| w * x * x * x).sum();
    /// assert!((cube - 0.25).abs() < 1e-15);
    /// ```
    pub fn gauss(count: usize) -> Self {
        let n = count.clamp(1, 200);
        let node = |i: usize| {
            // Tricomi's start, then Newton's method
            let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (n as f64 + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..10 {
                let [value, by_x] = legendre(n, x);
                slope = by_x;
                let step = value / slope;
                x -= step;
                if step.abs() < 1e-15 {
                    break;
                }
            }
            [0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope)]
        };
        Self { nodes: (0..n).map(node).collect() }
    }

    /// The same with nodes drawn to both ends.
    pub fn drawn_to_ends(count: usize) -> Self {
        let drawn = |[t, w]: [f64; 2]| [t * t * (3.0 - 2.0 * t), w * 6.0 * t * (1.0 - t)];
        Self { nodes: Self::gauss(count).nodes.into_iter().map(drawn).collect() }
    }
}

/// Legendre's polynomial and its derivative.
fn legendre(n: usize, x: f64) -> [f64; 2] {
    let (mut before, mut value) = (1.0, x);
    for k in 1..n {
        let k = k as f64;
        (before, value) = (value, ((2.0 * k + 1.0) * x * value - k * before) / (k + 1.0));
    }
    [value, n as f64 * (x * value - before) / (x * x - 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_exact_and_roots_are_near() {
        for n in [1, 2, 5, 16, 64] {
            let rule = Rule::gauss(n).nodes;
            for k in 0..2 * n.min(20) {
                let sum: f64 = rule.iter().map(|[x, w]| w * x.powi(k as i32)).sum();
                assert!((sum * (k as f64 + 1.0) - 1.0).abs() < 1e-13, "{n} {k}: {sum}");
            }
        }
        let root: f64 = Rule::drawn_to_ends(16).nodes.iter().map(|[x, w]| w * x.sqrt()).sum();
        assert!((root - 2.0 / 3.0).abs() < 1e-5, "{root}");
    }
}
