//! Points at equal distances along a superellipse `(a cos^ε θ, b sin^ε θ)` (FORMULAS §7.5).
//!
//! Exactly: in the chart `t = ln((y/b)/(x/a))`, with `p = 2/ε`, `w = 1/(1 + e^{-pt})`, the curve is
//! `(a X, b Y)` with `X = (1-w)^{1/p}`, `Y = w^{1/p}`, and `ds/dt = √(a² X² w² + b² Y² (1-w)²)` is smooth for every
//! exponent, with tails that decay exponentially: adaptive Gauss-Legendre panels integrate it, Newton's method
//! inverts it. Approximately: Pilu and Fisher's march, an explicit Euler step of the angle.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use crate::numeric::powers::{power, quadrant_cos_sin};
use crate::shape::InvalidShape;

/// Nodes and weights of the Gauss-Legendre rule with ten points on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.148_874_338_981_631_2, 0.295_524_224_714_752_9),
    (0.433_395_394_129_247_2, 0.269_266_719_309_996_35),
    (0.679_409_568_299_024_4, 0.219_086_362_515_982_04),
    (0.865_063_366_688_984_5, 0.149_451_349_150_580_6),
    (0.973_906_528_517_171_7, 0.066_671_344_308_688_14),
];

/// Below this angle (and above π/2 less it) Pilu and Fisher's step uses the power series of the curve.
const NEAR_AXIS: f64 = 1e-2;

/// A superellipse measured by its arc length.
///
/// ```
/// use supersurface::mesh::SuperellipseArc;
/// let circle = SuperellipseArc::new([2.0, 2.0], 1.0)?;
/// assert!((circle.quarter_length() - std::f64::consts::PI).abs() < 1e-13);
/// let [x, y] = circle.point_at(std::f64::consts::PI / 3.0);
/// assert!((x - 3f64.sqrt()).abs() < 1e-13 && (y - 1.0).abs() < 1e-13);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug)]
pub struct SuperellipseArc {
    semi_axes: [f64; 2],
    power: f64,
    /// Rising chart values, with the arc length from `(a, 0)` to each.
    panels: Vec<[f64; 2]>,
}

impl SuperellipseArc {
    /// Semi-axes `[a, b]` in metres, positive; exponent ε in (0, 10].
    pub fn new(semi_axes: [f64; 2], exponent: f64) -> Result<Self, InvalidShape> {
        check(semi_axes, exponent)?;
        let mut arc = Self { semi_axes, power: (2.0 / exponent).min(1e12), panels: Vec::new() };
        let [a, b] = semi_axes;
        let least = 1e-15 * a.max(b);
        // beyond `end` lies less than e^-40 of the curve; panels grow away from the bend at t = 0
        let end = 40.0 / arc.power.min(1.0);
        let mut edges = vec![0.0];
        let mut t = 1.0 / arc.power;
        while t < end {
            edges.extend([-t, t]);
            t *= 2.0;
        }
        edges.extend([-end, end]);
        edges.sort_by(f64::total_cmp);
        let mut sum = 0.0;
        arc.panels.push([-end, 0.0]);
        for pair in edges.windows(2) {
            if let [from, to] = *pair {
                arc.divide(from, to, least, &mut sum, 0);
            }
        }
        Ok(arc)
    }

    /// Adds panels over which halving changes nothing.
    fn divide(&mut self, from: f64, to: f64, least: f64, sum: &mut f64, depth: u32) {
        let middle = 0.5 * (from + to);
        let halves = self.integral(from, middle) + self.integral(middle, to);
        let settled = (self.integral(from, to) - halves).abs() <= least;
        if settled || depth == 30 {
            *sum += halves;
            self.panels.push([to, *sum]);
        } else {
            self.divide(from, middle, least, sum, depth + 1);
            self.divide(middle, to, least, sum, depth + 1);
        }
    }

    fn integral(&self, from: f64, to: f64) -> f64 {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let pair = |(x, w): &(f64, f64)| {
            w * (self.speed(middle - half * x) + self.speed(middle + half * x))
        };
        half * GAUSS.iter().map(pair).sum::<f64>()
    }

    /// `[X, Y]` and the weights `[w, 1 - w]` at the chart value.
    fn chart(&self, t: f64) -> ([f64; 2], [f64; 2]) {
        let s = self.power * t;
        let small = (-s.abs()).exp();
        let log = small.ln_1p();
        let (major, minor) = (1.0 / (1.0 + small), small / (1.0 + small));
        let root = |positive: f64| (-(positive + log) / self.power).exp();
        let weights = if s > 0.0 { [major, minor] } else { [minor, major] };
        ([root(s.max(0.0)), root((-s).max(0.0))], weights)
    }

    /// `ds/dt`.
    fn speed(&self, t: f64) -> f64 {
        let ([x, y], [w, rest]) = self.chart(t);
        let [a, b] = self.semi_axes;
        (a * x * w).hypot(b * y * rest)
    }

    /// Arc length of a quarter, from `(a, 0)` to `(0, b)`, in metres.
    pub fn quarter_length(&self) -> f64 {
        self.panels.last().map_or(0.0, |panel| panel[1])
    }

    /// The point at an arc length in metres from `(a, 0)`, counter-clockwise; it goes around any number of times.
    /// `(a, 0)` for a length that is not finite.
    pub fn point_at(&self, length: f64) -> [f64; 2] {
        let quarter = self.quarter_length();
        let around = length.rem_euclid(4.0 * quarter);
        if !around.is_finite() {
            return [self.semi_axes[0], 0.0];
        }
        let turns = (around / quarter).floor().min(3.0);
        let rest = around - turns * quarter;
        match turns as u8 {
            0 => self.in_quarter(rest),
            1 => {
                let [x, y] = self.in_quarter(quarter - rest);
                [-x, y]
            }
            2 => self.in_quarter(rest).map(|v| -v),
            _ => {
                let [x, y] = self.in_quarter(quarter - rest);
                [x, -y]
            }
        }
    }

    /// The point at an arc length in `[0, quarter_length]` from `(a, 0)`.
    fn in_quarter(&self, length: f64) -> [f64; 2] {
        let [a, b] = self.semi_axes;
        if length <= 0.0 {
            return [a, 0.0];
        }
        if length >= self.quarter_length() {
            return [0.0, b];
        }
        let after = self.panels.partition_point(|panel| panel[1] < length).max(1);
        let (Some([from, before]), Some([to, _])) =
            (self.panels.get(after - 1), self.panels.get(after))
        else {
            return [0.0, b];
        };
        let (mut low, mut high) = (*from, *to);
        let mut t = 0.5 * (low + high);
        for _ in 0..60 {
            let off = before + self.integral(*from, t) - length;
            if off > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let newton = t - off / self.speed(t);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            let done = (next - t).abs() <= 1e-16 * t.abs();
            t = next;
            if done {
                break;
            }
        }
        let ([x, y], _) = self.chart(t);
        [a * x, b * y]
    }

    /// Points that divide the whole curve into `count` equal arcs, counter-clockwise from `(a, 0)`.
    pub fn equal_arcs(&self, count: usize) -> Vec<[f64; 2]> {
        let whole = 4.0 * self.quarter_length();
        (0..count).map(|i| self.point_at(whole * (i as f64 / count as f64))).collect()
    }

    /// The `count + 1` points that divide the quarter from `(a, 0)` to `(0, b)` into equal arcs.
    pub fn quarter_arcs(&self, count: usize) -> Vec<[f64; 2]> {
        let step = |i: usize| self.quarter_length() * (i as f64 / count.max(1) as f64);
        (0..=count).map(|i| self.in_quarter(step(i))).collect()
    }
}

fn check([a, b]: [f64; 2], exponent: f64) -> Result<(), InvalidShape> {
    for (v, what) in [(a, "semi-axis a"), (b, "semi-axis b")] {
        InvalidShape::check(v > 0.0 && v.is_finite(), what, v, "positive and finite")?;
    }
    InvalidShape::check(exponent > 0.0 && exponent <= 10.0, "exponent ε", exponent, "in (0, 10]")
}

/// Pilu and Fisher's step `Δθ` in radians that moves about `distance` metres along the superellipse with semi-axes
/// `[a, b]` in metres and exponent ε, from an angle `theta` in [0, π/2]:
/// `Δθ = (D/ε) cos θ sin θ/√(a² cos^{2ε}θ sin⁴θ + b² sin^{2ε}θ cos⁴θ)`, and by the power series next to the axes.
///
/// ```
/// use supersurface::mesh::pilu_fisher_step;
/// let step = pilu_fisher_step([2.0, 2.0], 1.0, 0.7, 0.02);
/// assert!((step - 0.01).abs() < 1e-15);
/// ```
pub fn pilu_fisher_step([a, b]: [f64; 2], exponent: f64, theta: f64, distance: f64) -> f64 {
    let next_to = |axis: f64, angle: f64| {
        power(distance / axis + power(angle, exponent), 1.0 / exponent) - angle
    };
    if theta <= NEAR_AXIS {
        return next_to(b, theta);
    }
    if FRAC_PI_2 - theta <= NEAR_AXIS {
        return next_to(a, FRAC_PI_2 - theta);
    }
    let (c, s) = quadrant_cos_sin(theta);
    let along = (a * power(c, exponent) * s * s).hypot(b * power(s, exponent) * c * c);
    distance / exponent * c * s / along
}

/// Points about `distance` metres apart along a whole superellipse, counter-clockwise from `(a, 0)`, by Pilu and
/// Fisher's march: from both axes to 45°, mirrored to the other quarters.
///
/// Neighbours are between 0.78 and 1.27 distances apart for ε in [0.1, 1.9] at 20 steps a quarter; closer where
/// two marches meet. [`SuperellipseArc`] is exact. Fails for semi-axes that are not positive, an exponent outside of
/// (0, 10], or a distance under 1e-5 of the larger semi-axis.
///
/// ```
/// use supersurface::mesh::pilu_fisher;
/// let points = pilu_fisher([1.0, 0.6], 0.4, 0.05)?;
/// let gaps = points.windows(2).map(|p| (p[1][0] - p[0][0]).hypot(p[1][1] - p[0][1]));
/// assert!(gaps.fold(0.0, f64::max) < 1.27 * 0.05);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn pilu_fisher(
    [a, b]: [f64; 2],
    exponent: f64,
    distance: f64,
) -> Result<Vec<[f64; 2]>, InvalidShape> {
    check([a, b], exponent)?;
    let fits = distance >= 1e-5 * a.max(b) && distance.is_finite();
    InvalidShape::check(fits, "distance of points", distance, "at least 1e-5 of the semi-axes")?;
    let lower = march([a, b], exponent, distance);
    let upper = march([b, a], exponent, distance).into_iter().rev().map(|[y, x]| [x, y]);
    let mut quarter: Vec<_> = lower.into_iter().chain(upper).collect();
    // the first and the last are on the axes, and belong to two quarters each
    let mut whole = quarter.clone();
    whole.extend(quarter.iter().rev().skip(1).map(|[x, y]| [-x, *y]));
    whole.extend(quarter.iter().skip(1).map(|[x, y]| [-x, -y]));
    quarter.reverse();
    let last = quarter.len().saturating_sub(1);
    whole.extend(quarter.iter().take(last).skip(1).map(|[x, y]| [*x, -y]));
    Ok(whole)
}

/// Points from `(a, 0)` up to 45° of the angle.
fn march([a, b]: [f64; 2], exponent: f64, distance: f64) -> Vec<[f64; 2]> {
    let mut points = vec![[a, 0.0]];
    // next to the axis sin^ε θ = θ^ε grows by equal steps, even where θ itself underflows
    let (mut theta, mut share) = (0.0, 0.0);
    // a quarter is shorter than a + b, and steps are not much shorter than the distance
    let limit = (4.0 * (a + b) / distance) as usize + 16;
    while points.len() < limit {
        if theta <= NEAR_AXIS {
            share += distance / b;
            theta = power(share, 1.0 / exponent);
        } else {
            theta += pilu_fisher_step([a, b], exponent, theta, distance);
        }
        if theta.is_nan() || theta >= FRAC_PI_4 {
            break;
        }
        let (c, s) = quadrant_cos_sin(theta);
        let y = if theta <= NEAR_AXIS { share } else { power(s, exponent) };
        points.push([a * power(c, exponent), b * y]);
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::superellipse::norm;

    #[test]
    fn lengths_between_a_box_and_a_diamond() {
        let length = |a, b, e| SuperellipseArc::new([a, b], e).unwrap().quarter_length();
        assert!((length(3.0, 4.0, 2.0) - 5.0).abs() < 1e-13);
        assert!((length(3.0, 4.0, 1e-9) - 7.0).abs() < 1e-7);
        // the astroid's quarter is 3/2
        assert!((length(1.0, 1.0, 3.0) - 1.5).abs() < 1e-13);
        assert!((length(1e-300, 1e300, 10.0) - 1e300).abs() < 1e287);
        assert!(SuperellipseArc::new([1.0, 1.0], 5e-324).unwrap().quarter_length() > 1.9);
        assert!(SuperellipseArc::new([1.0, 0.0], 1.0).is_err());
    }

    #[test]
    fn chords_of_equal_arcs_are_equal_on_a_fine_division() {
        for e in [0.02, 0.3, 1.0, 1.6, 2.5] {
            let arc = SuperellipseArc::new([0.5, 1.3], e).unwrap();
            let points = arc.equal_arcs(4000);
            let step = 4.0 * arc.quarter_length() / 4000.0;
            let mut next = points.iter().cycle().skip(1);
            for [x, y] in &points {
                let [u, v] = next.next().unwrap();
                let chord = (u - x).hypot(v - y);
                assert!(chord < step * (1.0 + 1e-9) && chord > 0.7 * step, "{e}: {chord} {step}");
                assert!((norm(x.abs() / 0.5, y.abs() / 1.3, 2.0 / e) - 1.0).abs() < 1e-12);
            }
            assert_eq!(arc.quarter_arcs(3).first(), Some(&[0.5, 0.0]));
            assert_eq!(arc.quarter_arcs(3).last(), Some(&[0.0, 1.3]));
        }
    }

    #[test]
    fn the_march_keeps_its_distance() {
        for e in [0.1, 0.5, 1.0, 1.5, 1.9] {
            let quarter = SuperellipseArc::new([1.0, 0.7], e).unwrap().quarter_length();
            let distance = quarter / 20.0;
            let points = pilu_fisher([1.0, 0.7], e, distance).unwrap();
            assert!((70..=100).contains(&points.len()), "{e}: {}", points.len());
            let mut next = points.iter().cycle().skip(1);
            for [x, y] in &points {
                let [u, v] = next.next().unwrap();
                let chord = (u - x).hypot(v - y) / distance;
                assert!(chord > 0.0 && chord < 1.6, "{e}: {chord} at {x} {y}");
            }
        }
        assert!(pilu_fisher([1.0, 0.7], 0.005, 0.1).unwrap().len() > 20);
        assert!(pilu_fisher([1.0, 0.7], 1.0, 0.0).is_err());
        assert!(pilu_fisher([1.0, f64::NAN], 1.0, 0.1).is_err());
    }
}
