//! Deformations undone, with all that the derivative of a first-order distance needs (FORMULAS §4, §7.3).
//!
//! A stage takes a point `q` back to `p = T⁻¹(q; k)` and knows `J = ∂p/∂q` and `c = ∂p/∂k`, and how both change along a
//! direction of `q`. All formulas are free of `1/k`, so that no deformation is no special case. Plain numbers in a
//! loop over a block become vector instructions.

use crate::numeric::lanes::{arc_tangent_ratio, sin_cos};

/// Three coordinates.
pub(super) type Triple = [f64; 3];

/// Least factor of a taper: beyond, the point comes from no solid and is far outside.
const LEAST_FACTOR: f64 = 0.1;

#[inline(always)]
pub(super) fn dot(a: &Triple, b: &Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// What one stage says about a point: where it comes from and the matrix `J` by rows.
#[derive(Clone, Copy)]
pub(super) struct Stage {
    pub(super) point: Triple,
    rows: [Triple; 3],
}

impl Stage {
    /// `J v`.
    #[inline(always)]
    pub(super) fn forward(&self, v: &Triple) -> Triple {
        self.rows.map(|row| dot(&row, v))
    }

    /// `Jᵀ v`.
    #[inline(always)]
    pub(super) fn back(&self, v: &Triple) -> Triple {
        transposed(&self.rows, v)
    }
}

#[inline(always)]
fn transposed(rows: &[Triple; 3], v: &Triple) -> Triple {
    let [a, b, c] = rows;
    let at = |k: usize| a[k] * v[0] + b[k] * v[1] + c[k] * v[2];
    [at(0), at(1), at(2)]
}

/// Two covectors at an undeformed point from which derivatives follow: `K`, which multiplies derivatives of the
/// point, and `B h`, which multiplies their change along the normal.
#[derive(Clone, Copy)]
pub(super) struct Pair {
    pub(super) whole: Triple,
    pub(super) change: Triple,
}

impl Pair {
    /// The derivative by a parameter that moves the undeformed point by `c`, which changes by `dc` along the normal.
    #[inline(always)]
    fn by(&self, c: &Triple, dc: &Triple) -> f64 {
        dot(&self.whole, c) - dot(&self.change, dc)
    }

    /// The pair before the stage, whose matrix changes by `d` along the normal.
    #[inline(always)]
    fn before(&self, stage: &Stage, d: &[Triple; 3]) -> Self {
        let (whole, lost) = (stage.back(&self.whole), transposed(d, &self.change));
        Self {
            whole: [whole[0] - lost[0], whole[1] - lost[1], whole[2] - lost[2]],
            change: stage.back(&self.change),
        }
    }
}

/// Equation 20 undone: `x/fx`, `y/fy` with `f = 1 + K z/a3`.
#[inline(always)]
pub(super) fn untaper(q: &Triple, slopes: &[f64; 2], height: f64) -> (Stage, [f64; 2]) {
    let rate = 1.0 / height;
    let inverse = |k: f64| {
        let f = 1.0 + k * q[2] * rate;
        1.0 / if f > LEAST_FACTOR { f } else { LEAST_FACTOR }
    };
    let [ix, iy] = [inverse(slopes[0]), inverse(slopes[1])];
    let point = [q[0] * ix, q[1] * iy, q[2]];
    let [ax, ay] = [slopes[0] * rate * ix, slopes[1] * rate * iy];
    let rows = [[ix, 0.0, -point[0] * ax], [0.0, iy, -point[1] * ay], [0.0, 0.0, 1.0]];
    (Stage { point, rows }, [ix, iy])
}

/// Derivatives by `[Kx, Ky]` and `ln a3`, and the pair before the taper; `n` is the direction in `q`, `u = J n`.
#[inline(always)]
pub(super) fn through_taper(
    (stage, [ix, iy]): &(Stage, [f64; 2]),
    slopes: &[f64; 2],
    height: f64,
    n: &Triple,
    u: &Triple,
    pair: &Pair,
) -> ([f64; 2], f64, Pair) {
    let rate = 1.0 / height;
    let [kx, ky] = slopes;
    let (p, zeta, dzeta) = (&stage.point, stage.point[2] * rate, n[2] * rate);
    // the factors grow by K dz/a3, so their inverses by -i² K dz/a3
    let (dix, diy) = (-ix * ix * kx * dzeta, -iy * iy * ky * dzeta);
    // p z/(a3 f) of both axes and its change
    let (wx, wy) = (p[0] * zeta * ix, p[1] * zeta * iy);
    let dwx = u[0] * zeta * ix + p[0] * (dzeta * ix + zeta * dix);
    let dwy = u[1] * zeta * iy + p[1] * (dzeta * iy + zeta * diy);
    let by_x = pair.by(&[wx, 0.0, 0.0], &[dwx, 0.0, 0.0]);
    let by_y = pair.by(&[0.0, wy, 0.0], &[0.0, dwy, 0.0]);
    let d = [
        [dix, 0.0, -kx * rate * (u[0] * ix + p[0] * dix)],
        [0.0, diy, -ky * rate * (u[1] * iy + p[1] * diy)],
        [0.0; 3],
    ];
    ([-by_x, -by_y], kx * by_x + ky * by_y, pair.before(stage, &d))
}

/// Equation 22 undone, counted from the middle: turned by `-n π z/a3`.
#[inline(always)]
pub(super) fn untwist<const FUSED: bool>(q: &Triple, turns: f64, height: f64) -> Stage {
    let rate = turns * std::f64::consts::PI / height;
    let (s, c) = sin_cos::<FUSED>(rate * q[2]);
    let point = [c * q[0] + s * q[1], c * q[1] - s * q[0], q[2]];
    let rows = [[c, s, rate * point[1]], [-s, c, -rate * point[0]], [0.0, 0.0, 1.0]];
    Stage { point, rows }
}

/// Derivatives by the turns and `ln a3`, and the pair before the twist.
#[inline(always)]
pub(super) fn through_twist(
    stage: &Stage,
    turns: f64,
    height: f64,
    n: &Triple,
    u: &Triple,
    pair: &Pair,
) -> (f64, f64, Pair) {
    let a_turn = std::f64::consts::PI / height;
    let rate = turns * a_turn;
    let p = &stage.point;
    let (z, dz) = (p[2], n[2]);
    let [c, s, _] = stage.rows[0];
    let (dc, ds) = (-s * rate * dz, c * rate * dz);
    let d = [[dc, ds, rate * u[1]], [-ds, dc, -rate * u[0]], [0.0; 3]];
    // by the angle over the height, z ∂p/∂θ
    let about = [z * p[1], -z * p[0], 0.0];
    let dabout = [dz * p[1] + z * u[1], -dz * p[0] - z * u[0], 0.0];
    let by_rate = pair.by(&about, &dabout);
    (by_rate * a_turn, -by_rate * rate, pair.before(stage, &d))
}

/// What [`unbend`] computes beside the stage.
#[derive(Clone, Copy)]
pub(super) struct Bending {
    /// `h = √(k² z² + B²)` with `B = 1 - b·q`.
    radius: f64,
    /// `σ = z²/(h + B)`.
    sag: f64,
}

/// The circular bend undone for a curvature vector `b = k (cos α, sin α)`.
///
/// With `B = 1 - b·(x, y)`, `h = √(k² z² + B²)`, `σ = z²/(h + B)`: `x' = x - bx σ`, `y' = y - by σ` and, as
/// `tan(γ/2) = k z/(h + B)`, `z' = γ/k = 2 z/(h + B) atan(m)/m` with `m = k z/(h + B)`. From these
/// `∂σ/∂x = σ bx/h`, `∂σ/∂z = z/h`, `∂z'/∂x = z bx/h²`, `∂z'/∂z = B/h²`.
#[inline(always)]
pub(super) fn unbend<const FUSED: bool>(q: &Triple, b: &[f64; 2]) -> (Stage, Bending) {
    let [x, y, z] = *q;
    let square = b[0] * b[0] + b[1] * b[1];
    let across = 1.0 - b[0] * x - b[1] * y;
    let h = (square * z * z + across * across).sqrt();
    let h = if h > 1e-6 { h } else { 1e-6 };
    let sum = h + across;
    let sum = if sum > 1e-6 { sum } else { 1e-6 };
    let (ratio, ih) = (z / sum, 1.0 / h);
    let sag = z * ratio;
    let arc = 2.0 * ratio * arc_tangent_ratio::<FUSED>(square * ratio * ratio);
    let (sh, zh) = (sag * ih, z * ih);
    let zhh = zh * ih;
    let rows = [
        [1.0 - b[0] * b[0] * sh, -b[0] * b[1] * sh, -b[0] * zh],
        [-b[0] * b[1] * sh, 1.0 - b[1] * b[1] * sh, -b[1] * zh],
        [b[0] * zhh, b[1] * zhh, across * ih * ih],
    ];
    let point = [x - b[0] * sag, y - b[1] * sag, arc];
    (Stage { point, rows }, Bending { radius: h, sag })
}

/// `(sin 2γ/2 - γ)/γ³` by `γ²`, for `|γ| <= π`.
#[inline(always)]
fn lag(square: f64) -> f64 {
    let square = if square < 10.0 { square } else { 10.0 };
    // (-1)^k 4^k γ^(2k - 2)/(2k + 1)!, backwards
    let mut sum = 0.0;
    let mut k = 16;
    while k >= 2 {
        let next = (2 * k) as f64 * (2 * k + 1) as f64;
        sum = -4.0 * square / next * (1.0 + sum);
        k -= 1;
    }
    -2.0 / 3.0 * (1.0 + sum)
}

/// Derivatives by the curvature vector and the pair before the bend; `q` is the bent point.
#[inline(always)]
pub(super) fn through_bend(
    (stage, bending): &(Stage, Bending),
    q: &Triple,
    b: &[f64; 2],
    n: &Triple,
    u: &Triple,
    pair: &Pair,
) -> ([f64; 2], Pair) {
    let [x, y, z] = *q;
    let (h, sag, p) = (bending.radius, bending.sag, &stage.point);
    let square = b[0] * b[0] + b[1] * b[1];
    let across = 1.0 - b[0] * x - b[1] * y;
    let ih = 1.0 / h;
    let (sh, zh) = (sag * ih, z * ih);
    let zhh = zh * ih;
    let towards = b[0] * n[0] + b[1] * n[1];
    // changes along the normal
    let dh = (square * z * n[2] - across * towards) * ih;
    let dlog = dh * ih;
    let dsag = zh * n[2] + sh * towards;
    let dsh = dsag * ih - sh * dlog;
    let dzh = n[2] * ih - zh * dlog;
    let dzhh = dzh * ih - zhh * dlog;
    let dacross = -towards * ih * ih - 2.0 * across * ih * ih * dlog;
    let d = [
        [-b[0] * b[0] * dsh, -b[0] * b[1] * dsh, -b[0] * dzh],
        [-b[0] * b[1] * dsh, -b[1] * b[1] * dsh, -b[1] * dzh],
        [b[0] * dzhh, b[1] * dzhh, dacross],
    ];
    // ∂σ/∂bx = σ x'/h, ∂z'/∂bx = bx E + z x/h² with E = (B z/h² - z')/k² and dE = -2 (z/h)² dz'
    let lag = p[2] * p[2] * p[2] * lag(square * p[2] * p[2]);
    let dlag = -2.0 * zh * zh * u[2];
    let along = |i: usize| {
        let (by, dby) = (sh * p[i], dsh * p[i] + sh * u[i]);
        let mut c = [-b[0] * by, -b[1] * by, b[i] * lag + zhh * q[i]];
        let mut dc = [-b[0] * dby, -b[1] * dby, b[i] * dlag + dzhh * q[i] + zhh * n[i]];
        c[i] -= sag;
        dc[i] -= dsag;
        pair.by(&c, &dc)
    };
    ([along(0), along(1)], pair.before(stage, &d))
}
