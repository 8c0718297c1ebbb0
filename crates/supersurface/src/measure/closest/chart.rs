//! The log-ratio chart of an octant (FORMULAS §0.2), smooth for every exponent, and Newton's method in it.
//!
//! With `t = ln (y/a2)/(x/a1)` and `u = ln (z/a3)/ρ̂` the unit superellipses are `X = (1 + e^(p2 t))^(-1/p2)`,
//! `Y = X e^t` and `C`, `S` likewise from `p1`, `u`; infinite `t`, `u` are the seams. The octant of a superellipsoid is
//! `(a1 C X, a2 C Y, a3 S)`, the outer and the inner half of a toroid have `a4 + C` and `a4 - C` for `C`. The squared
//! distance to a point is minimised with its exact second derivatives.

use crate::Vector;

/// One octant of a surface, or of the outer or inner half of a toroid.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chart {
    pub(super) semi_axes: [f64; 3],
    /// `2/ε`.
    pub(super) powers: [f64; 2],
    /// `a4` of a toroid, 0 otherwise; and the sign of `C`.
    pub(super) ring: f64,
    pub(super) side: f64,
}

/// A quarter of the unit superellipse at `t`: both coordinates with their first and second derivatives.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quarter {
    pub(super) x: [f64; 3],
    pub(super) y: [f64; 3],
}

impl Quarter {
    pub(super) fn new(t: f64, p: f64) -> Self {
        let far = (-p * t.abs()).exp();
        let l = far.ln_1p() / p;
        let (larger, smaller) = ((-l).exp(), (-l - t.abs()).exp());
        // weight of x: x^p
        let major = 1.0 / (1.0 + far);
        let minor = far * major;
        let (x, y, wx, wy) =
            if t < 0.0 { (larger, smaller, major, minor) } else { (smaller, larger, minor, major) };
        Self { x: [x, -x * wy, x * wy * (wy - p * wx)], y: [y, y * wx, y * wx * (wx - p * wy)] }
    }
}

/// A minimum of the distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Minimum {
    pub(super) place: [f64; 2],
    pub(super) point: Vector,
    pub(super) squared: f64,
}

/// Most stepsand the largest of one coordinate.
const STEPS: usize = 150;
const LONGEST: f64 = 3.0;
/// Steps after which Newton's method is taken to creep along a tail.
const PATIENCE: usize = 8;
/// Beyond this a coordinate is on its seam: what is left is under 1e-17 of the semi-axis.
const SEAM: f64 = 40.0;

impl Chart {
    /// The surface point of two quarters, along ω and along η.
    pub(super) fn assemble(&self, around: &Quarter, along: &Quarter) -> Vector {
        let [a1, a2, a3] = self.semi_axes;
        let r = self.ring + self.side * along.x[0];
        Vector::new(a1 * r * around.x[0], a2 * r * around.y[0], a3 * along.y[0])
    }

    /// The place whose direction is that of a point of the octant.
    pub(super) fn place(&self, p: &Vector) -> [f64; 2] {
        let [x, y, z] = [0, 1, 2].map(|k| p[k] / self.semi_axes[k]);
        let planar = crate::numeric::superellipse::norm(x, y, self.powers[1]);
        let across = (self.side * (planar - self.ring)).max(0.0);
        let ratio =
            |a: f64, b: f64| if a == b { 0.0 } else { (a.ln() - b.ln()).clamp(-SEAM, SEAM) };
        [ratio(y, x), ratio(z, across)]
    }

    /// The minimum of the distance to `p` that Newton's method finds from `start`. Infinite coordinates stay.
    pub(super) fn descend(&self, start: [f64; 2], p: &Vector) -> Minimum {
        let mut place = start;
        let mut now = self.expand(place, p);
        let mut damping = 0.0;
        for count in 0..STEPS {
            if count >= PATIENCE
                && let Some(next) = self.balanced(place, &now)
            {
                let trial = self.expand(next, p);
                if trial.squared < now.squared {
                    (place, now) = (next, trial);
                    continue;
                }
            }
            let [gt, gu] = now.gradient;
            let step = newton_step(now.gradient, now.hessian, damping);
            let expected = -(gt * step[0] + gu * step[1]);
            // a gain under rounding of the squared distance is none
            if expected <= 1e-17 * now.squared.max(1e-300) || !expected.is_finite() {
                break;
            }
            let next: [f64; 2] = std::array::from_fn(|k| place[k] + step[k]);
            let trial = self.expand(next, p);
            if trial.squared <= now.squared {
                (place, now) = (next, trial);
                damping *= 0.1;
            } else {
                let [[tt, _], [_, uu]] = now.hessian;
                damping = (damping * 8.0).max(1e-3 * (tt.abs() + uu.abs()));
                if damping > 1e12 * (tt.abs() + uu.abs()) {
                    break;
                }
            }
        }
        Minimum { place, point: now.point, squared: now.squared }
    }

    /// The place to which Newton's method leads for the logarithms of the conditions of a minimum,
    /// `(p2-1) t = ln (a2 e_y)/(a1 e_x)` and `(p1-1) u = ln (a3 e_z)/e_ρ` with the offset `e` of the surface point: next to
    /// a seam the distance falls exponentially, and these are nearly linear. A coordinate whose two forces do not
    /// balance anywhere near goes on to the seam.
    fn balanced(&self, [t, u]: [f64; 2], now: &Expansion) -> Option<[f64; 2]> {
        let [p1, p2] = self.powers;
        let (e, [x, y, z], r) = (now.offset, [now.x, now.y, now.z], now.r);
        let across = x[0] * e.x + y[0] * e.y;
        let across_t = x[1] * e.x + y[1] * e.y + r[0] * (x[0] * x[1] + y[0] * y[1]);
        let across_u = r[1] * (x[0] * x[0] + y[0] * y[0]);
        let [a1, a2, a3] = self.semi_axes;
        let ft = (p2 - 1.0) * t + (a1 * e.x / (a2 * e.y)).ln();
        let fu = (p1 - 1.0) * u + (self.side * across / (a3 * e.z)).ln();
        let tt = (p2 - 1.0) + r[0] * (x[1] / e.x - y[1] / e.y);
        let tu = r[1] * (x[0] / e.x - y[0] / e.y);
        let ut = across_t / across;
        let uu = (p1 - 1.0) + across_u / across - z[1] / e.z;
        let onward = |v: f64, g: f64| v - LONGEST.copysign(g);
        let [gt, gu] = now.gradient;
        let (t_balances, u_balances) = (ft.is_finite(), fu.is_finite());
        let step = match (t_balances, u_balances) {
            (true, true) => {
                let det = tt * uu - tu * ut;
                [t + (tu * fu - uu * ft) / det, u + (ut * ft - tt * fu) / det]
            }
            (true, false) => [t - ft / tt, onward(u, gu)],
            (false, true) => [onward(t, gt), u - fu / uu],
            (false, false) => [onward(t, gt), onward(u, gu)],
        };
        let place = step.map(|v| v.clamp(-SEAM, SEAM));
        let place = [
            if t.is_infinite() { t } else { place[0] },
            if u.is_infinite() { u } else { place[1] },
        ];
        place.iter().all(|v| !v.is_nan()).then_some(place)
    }

    /// The squared distance at a place with half its derivatives.
    fn expand(&self, [t, u]: [f64; 2], p: &Vector) -> Expansion {
        let (around, along) = (Quarter::new(t, self.powers[1]), Quarter::new(u, self.powers[0]));
        let [a1, a2, a3] = self.semi_axes;
        let r =
            [self.ring + self.side * along.x[0], self.side * along.x[1], self.side * along.x[2]];
        let (x, y) = (around.x.map(|v| a1 * v), around.y.map(|v| a2 * v));
        let z = along.y.map(|v| a3 * v);
        let point = Vector::new(r[0] * x[0], r[0] * y[0], z[0]);
        let e = point - p;
        let by_t = Vector::new(r[0] * x[1], r[0] * y[1], 0.0);
        let by_u = Vector::new(r[1] * x[0], r[1] * y[0], z[1]);
        let tt = by_t.norm_squared() + r[0] * (e.x * x[2] + e.y * y[2]);
        let tu = by_t.dot(&by_u) + r[1] * (e.x * x[1] + e.y * y[1]);
        let uu = by_u.norm_squared() + r[2] * (e.x * x[0] + e.y * y[0]) + e.z * z[2];
        Expansion {
            point,
            offset: e,
            r,
            x,
            y,
            z,
            squared: e.norm_squared(),
            gradient: [e.dot(&by_t), e.dot(&by_u)],
            hessian: [[tt, tu], [tu, uu]],
        }
    }
}

struct Expansion {
    point: Vector,
    /// From the point to the surface point.
    offset: Vector,
    r: [f64; 3],
    x: [f64; 3],
    y: [f64; 3],
    z: [f64; 3],
    squared: f64,
    gradient: [f64; 2],
    hessian: [[f64; 2]; 2],
}

/// The step `-(|H| + damping)⁻¹ g` with the magnitudes of the eigenvalues, so that it always leads down, no longer than
/// [`LONGEST`] in either coordinate.
fn newton_step(g: [f64; 2], [[a, b], [_, c]]: [[f64; 2]; 2], damping: f64) -> [f64; 2] {
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let radius = half.hypot(b);
    let (s, k) = if radius > 0.0 { (b / radius, half / radius) } else { (0.0, 1.0) };
    // unit eigenvectors by half angles of (k, s)
    let cosine = (0.5 * (1.0 + k)).max(0.0).sqrt();
    let sine = (0.5 * (1.0 - k)).max(0.0).sqrt().copysign(s);
    let floor = 1e-9 * (mean.abs() + radius) + f64::MIN_POSITIVE;
    let weak = |value: f64| 1.0 / (value.abs().max(floor) + damping);
    let (first, second) = (weak(mean + radius), weak(mean - radius));
    let along = (cosine * g[0] + sine * g[1]) * first;
    let across = (cosine * g[1] - sine * g[0]) * second;
    let step = [-(cosine * along - sine * across), -(sine * along + cosine * across)];
    let longest = step[0].abs().max(step[1].abs());
    let cut = if longest > LONGEST { LONGEST / longest } else { 1.0 };
    step.map(|s| s * cut)
}
