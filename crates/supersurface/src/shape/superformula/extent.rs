//! How far a superformula reaches along a direction: the largest `r(φ) cos(φ - δ)` over an interval.
//!
//! Branch and bound: over an interval of angles both terms lie between powers of the least and the largest
//! cosine and sine, which bounds the radius from above for certain; an interval whose bound exceeds the best
//! value seen by more than 2 in a thousand is halved.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::{Superformula, Terms};

/// How far the bound may lie above a value that is reached.
const SLACK: f64 = 2e-3;
/// Intervals looked at, at most; beyond, what is left counts with its bound.
const BUDGET: usize = 20_000;

impl Superformula {
    /// An upper bound of `r(φ) cos(φ - direction)` for φ between `from` and `to`, never negative.
    pub(super) fn extent(&self, direction: f64, from: f64, to: f64) -> f64 {
        let reached = |phi: f64| self.radius(phi) * (phi - direction).cos();
        let pieces = (8.0 * self.m).ceil().max(64.0) as usize;
        let edge = |i: usize| from + (to - from) * i as f64 / pieces as f64;
        let mut best = (0..=pieces).map(edge).map(reached).fold(0.0, f64::max);
        let mut bound = 0.0f64;
        let mut open: Vec<[f64; 2]> = (0..pieces).map(|i| [edge(i), edge(i + 1)]).collect();
        let mut looked = 0;
        while let Some([low, high]) = open.pop() {
            looked += 1;
            let most =
                self.largest_radius(low, high) * range_cos(low - direction, high - direction)[1];
            if most <= best * (1.0 + SLACK) || looked > BUDGET {
                bound = bound.max(most);
                continue;
            }
            let middle = 0.5 * (low + high);
            best = best.max(reached(middle));
            open.extend([[low, middle], [middle, high]]);
        }
        // for the rounding of all this
        bound.max(best) * (1.0 + 1e-9)
    }

    /// An upper bound of the radius between two angles.
    fn largest_radius(&self, low: f64, high: f64) -> f64 {
        let (p, q) = (0.25 * self.m * low, 0.25 * self.m * high);
        let cos = range_abs(range_cos(p, q));
        let sin = range_abs(range_cos(p - FRAC_PI_2, q - FRAC_PI_2));
        let [n1, n2, n3] = self.n;
        let [a, b] = self.scales;
        // the larger the bracket, the smaller the radius (the other way round for a negative n1)
        let pick = |range: [f64; 2]| if n1 > 0.0 { range[0] } else { range[1] };
        let (cos, sin) = (pick(cos), pick(sin));
        let sum = if cos == 0.0 && sin == 0.0 {
            f64::NEG_INFINITY
        } else {
            let (log_first, log_second) = (n2 * (cos.ln() - a.ln()), n3 * (sin.ln() - b.ln()));
            Terms { cos, sin, log_first, log_second }.log_sum()
        };
        let [low, high] = self.log_radius_bounds();
        (-sum / n1).min(low.max(high)).exp()
    }
}

/// Least and largest cosine between two angles, `p <= q`.
fn range_cos(p: f64, q: f64) -> [f64; 2] {
    let holds = |target: f64| ((q - target) / TAU).floor() >= ((p - target) / TAU).ceil();
    let (a, b) = (p.cos(), q.cos());
    let low = if holds(PI) { -1.0 } else { a.min(b) };
    let high = if holds(0.0) { 1.0 } else { a.max(b) };
    [low, high]
}

/// Least and largest absolute value of a range; the least is 0 where rounding could hide a zero.
fn range_abs([low, high]: [f64; 2]) -> [f64; 2] {
    let least = if low <= 1e-12 && high >= -1e-12 { 0.0 } else { low.abs().min(high.abs()) };
    [least, low.abs().max(high.abs())]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn the_bound_holds_and_is_tight() {
        let mut random = Stream::new(3, 0);
        for case in 0..60 {
            let m = random.index(9) as f64;
            let n = [random.between(0.3, 8.0), random.between(0.3, 8.0), random.between(0.3, 8.0)];
            let scales = [random.between(0.6, 1.6), random.between(0.6, 1.6)];
            let curve = Superformula::new(m, n, scales).unwrap();
            let direction = random.between(-PI, PI);
            let bound = curve.extent(direction, -PI, PI);
            let seen = (0..100_000)
                .map(|i| -PI + TAU * (f64::from(i) + 0.5) / 1e5)
                // a term that vanishes can make a sharp tip between samples
                .chain((-8..=8).map(|k| f64::from(k) * TAU / m.max(1.0)).filter(|a| a.abs() <= PI))
                .map(|phi| curve.radius(phi) * (phi - direction).cos())
                .fold(0.0, f64::max);
            assert!(bound >= seen && bound <= 1.004 * seen, "{case}: {bound} {seen} {curve:?}");
        }
    }
}
