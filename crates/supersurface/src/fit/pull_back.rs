//! Deformations undone, with all that the derivative of a first-order distance needs (FORMULAS §4, §7.3).
//!
//! A stage takes a point `q` back to `p = T⁻¹(q; k)` and knows `J = ∂p/∂q` and `c = ∂p/∂k`, and how both change along a
//! direction of `q`. All formulas are free of `1/k`, so that no deformation is no special case. Plain numbers in a
//! loop over a block become vector instructions.

use crate::numeric::lanes::{Lane, arc_tangent_ratio};

/// Three coordinates.
pub(super) type Triple<L> = [L; 3];

/// Least factor of a taper: beyond, the point comes from no solid and is far outside.
const LEAST_FACTOR: f64 = 0.1;

#[inline(always)]
pub(super) fn dot<const FUSED: bool, L: Lane>(a: &Triple<L>, b: &Triple<L>) -> L {
    a[0].times_plus::<FUSED>(b[0], a[1].times_plus::<FUSED>(b[1], a[2] * b[2]))
}

/// What one stage says about a point: where it comes from and the matrix `J` by rows.
#[derive(Clone, Copy)]
pub(super) struct Stage<L> {
    pub(super) point: Triple<L>,
    rows: [Triple<L>; 3],
}

impl<L: Lane> Stage<L> {
    /// `J v`.
    #[inline(always)]
    pub(super) fn forward<const FUSED: bool>(&self, v: &Triple<L>) -> Triple<L> {
        self.rows.map(|row| dot::<FUSED, L>(&row, v))
    }

    /// `Jᵀ v`.
    #[inline(always)]
    pub(super) fn back<const FUSED: bool>(&self, v: &Triple<L>) -> Triple<L> {
        transposed::<FUSED, L>(&self.rows, v)
    }
}

#[inline(always)]
fn transposed<const FUSED: bool, L: Lane>(rows: &[Triple<L>; 3], v: &Triple<L>) -> Triple<L> {
    let [a, b, c] = rows;
    let at = |k: usize| a[k].times_plus::<FUSED>(v[0], b[k].times_plus::<FUSED>(v[1], c[k] * v[2]));
    [at(0), at(1), at(2)]
}

/// Two covectors at an undeformed point from which derivatives follow: `K`, which multiplies derivatives of the
/// point, and `B h`, which multiplies their change along the normal.
#[derive(Clone, Copy)]
pub(super) struct Pair<L> {
    pub(super) whole: Triple<L>,
    pub(super) change: Triple<L>,
}

impl<L: Lane> Pair<L> {
    /// The derivative by a parameter that moves the undeformed point by `c`, which changes by `dc` along the normal.
    #[inline(always)]
    fn by<const FUSED: bool>(&self, c: &Triple<L>, dc: &Triple<L>) -> L {
        dot::<FUSED, L>(&self.whole, c) - dot::<FUSED, L>(&self.change, dc)
    }

    /// The pair before the stage, whose matrix changes by `d` along the normal.
    #[inline(always)]
    fn before<const FUSED: bool>(&self, stage: &Stage<L>, d: &[Triple<L>; 3]) -> Self {
        let whole = stage.back::<FUSED>(&self.whole);
        let lost = transposed::<FUSED, L>(d, &self.change);
        Self {
            whole: [whole[0] - lost[0], whole[1] - lost[1], whole[2] - lost[2]],
            change: stage.back::<FUSED>(&self.change),
        }
    }
}

/// Equation 20 undone: `x/fx`, `y/fy` with `f = 1 + K z/a3`.
#[inline(always)]
pub(super) fn untaper<const FUSED: bool, L: Lane>(
    q: &Triple<L>,
    slopes: &[L; 2],
    height: L,
) -> (Stage<L>, [L; 2]) {
    let (zero, one) = (L::of(0.0), L::of(1.0));
    let rate = one / height;
    let factor = |k: L| k.times_plus::<FUSED>(q[2] * rate, one).most(L::of(LEAST_FACTOR));
    let factors = slopes.map(factor);
    let both = one / (factors[0] * factors[1]);
    let [ix, iy] = [both * factors[1], both * factors[0]];
    let point = [q[0] * ix, q[1] * iy, q[2]];
    let [ax, ay] = [slopes[0] * rate * ix, slopes[1] * rate * iy];
    let rows = [[ix, zero, -point[0] * ax], [zero, iy, -point[1] * ay], [zero, zero, one]];
    (Stage { point, rows }, [ix, iy])
}

/// Derivatives by `[Kx, Ky]` and `ln a3`, and the pair before the taper; `n` is the direction in `q`, `u = J n`.
#[inline(always)]
pub(super) fn through_taper<const FUSED: bool, L: Lane>(
    (stage, [ix, iy]): &(Stage<L>, [L; 2]),
    slopes: &[L; 2],
    height: L,
    n: &Triple<L>,
    u: &Triple<L>,
    pair: &Pair<L>,
) -> ([L; 2], L, Pair<L>) {
    let zero = L::of(0.0);
    let rate = L::of(1.0) / height;
    let ([kx, ky], [ix, iy]) = (*slopes, [*ix, *iy]);
    let (p, zeta, dzeta) = (&stage.point, stage.point[2] * rate, n[2] * rate);
    // the factors grow by K dz/a3, so their inverses by -i² K dz/a3
    let (dix, diy) = (-ix * ix * kx * dzeta, -iy * iy * ky * dzeta);
    // p z/(a3 f) of both axes and its change
    let (wx, wy) = (p[0] * zeta * ix, p[1] * zeta * iy);
    let dwx = u[0] * zeta * ix + p[0] * (dzeta * ix + zeta * dix);
    let dwy = u[1] * zeta * iy + p[1] * (dzeta * iy + zeta * diy);
    let by_x = pair.whole[0] * wx - pair.change[0] * dwx;
    let by_y = pair.whole[1] * wy - pair.change[1] * dwy;
    let d = [
        [dix, zero, -kx * rate * (u[0] * ix + p[0] * dix)],
        [zero, diy, -ky * rate * (u[1] * iy + p[1] * diy)],
        [zero; 3],
    ];
    ([-by_x, -by_y], kx * by_x + ky * by_y, pair.before::<FUSED>(stage, &d))
}

/// Equation 22 undone, counted from the middle: turned by `-n π z/a3`.
#[inline(always)]
pub(super) fn untwist<const FUSED: bool, L: Lane>(q: &Triple<L>, turns: L, height: L) -> Stage<L> {
    let (zero, one) = (L::of(0.0), L::of(1.0));
    let rate = turns * L::of(std::f64::consts::PI) / height;
    let (s, c) = (rate * q[2]).sin_cos::<FUSED>();
    let point =
        [c.times_plus::<FUSED>(q[0], s * q[1]), c.times_plus::<FUSED>(q[1], -s * q[0]), q[2]];
    let rows = [[c, s, rate * point[1]], [-s, c, -rate * point[0]], [zero, zero, one]];
    Stage { point, rows }
}

/// Derivatives by the turns and `ln a3`, and the pair before the twist.
#[inline(always)]
pub(super) fn through_twist<const FUSED: bool, L: Lane>(
    stage: &Stage<L>,
    turns: L,
    height: L,
    n: &Triple<L>,
    u: &Triple<L>,
    pair: &Pair<L>,
) -> (L, L, Pair<L>) {
    let zero = L::of(0.0);
    let a_turn = L::of(std::f64::consts::PI) / height;
    let rate = turns * a_turn;
    let p = &stage.point;
    let (z, dz) = (p[2], n[2]);
    let [c, s, _] = stage.rows[0];
    let (dc, ds) = (-s * rate * dz, c * rate * dz);
    let d = [[dc, ds, rate * u[1]], [-ds, dc, -rate * u[0]], [zero; 3]];
    // by the angle over the height, z ∂p/∂θ
    let about = [z * p[1], -z * p[0], zero];
    let dabout =
        [dz.times_plus::<FUSED>(p[1], z * u[1]), (-dz).times_plus::<FUSED>(p[0], -z * u[0]), zero];
    let by_rate = pair.by::<FUSED>(&about, &dabout);
    (by_rate * a_turn, -by_rate * rate, pair.before::<FUSED>(stage, &d))
}

/// What [`unbend`] computes beside the stage.
#[derive(Clone, Copy)]
pub(super) struct Bending<L> {
    /// `1/h` of `h = √(k² z² + B²)` with `B = 1 - b·q`.
    inverse: L,
    /// `σ = z²/(h + B)`.
    sag: L,
}

/// The circular bend undone for a curvature vector `b = k (cos α, sin α)`.
///
/// With `B = 1 - b·(x, y)`, `h = √(k² z² + B²)`, `σ = z²/(h + B)`: `x' = x - bx σ`, `y' = y - by σ` and, as
/// `tan(γ/2) = k z/(h + B)`, `z' = γ/k = 2 z/(h + B) atan(m)/m` with `m = k z/(h + B)`. From these
/// `∂σ/∂x = σ bx/h`, `∂σ/∂z = z/h`, `∂z'/∂x = z bx/h²`, `∂z'/∂z = B/h²`.
#[inline(always)]
pub(super) fn unbend<const FUSED: bool, L: Lane>(
    q: &Triple<L>,
    b: &[L; 2],
) -> (Stage<L>, Bending<L>) {
    let [x, y, z] = *q;
    let (one, least) = (L::of(1.0), L::of(1e-6));
    let square = b[0] * b[0] + b[1] * b[1];
    let across = one - b[0] * x - b[1] * y;
    let h = (square * z * z + across * across).sqrt().most(least);
    let sum = (h + across).most(least);
    let both = one / (h * sum);
    let (ratio, ih) = (z * both * h, both * sum);
    let sag = z * ratio;
    let arc = L::of(2.0) * ratio * arc_tangent_ratio::<FUSED, L>(square * ratio * ratio);
    let (sh, zh) = (sag * ih, z * ih);
    let zhh = zh * ih;
    let rows = [
        [one - b[0] * b[0] * sh, -b[0] * b[1] * sh, -b[0] * zh],
        [-b[0] * b[1] * sh, one - b[1] * b[1] * sh, -b[1] * zh],
        [b[0] * zhh, b[1] * zhh, across * ih * ih],
    ];
    let point = [x - b[0] * sag, y - b[1] * sag, arc];
    (Stage { point, rows }, Bending { inverse: ih, sag })
}

/// `(sin 2γ/2 - γ)/γ³` by `γ²`, for `|γ| <= π`.
#[inline(always)]
fn lag<const FUSED: bool, L: Lane>(square: L) -> L {
    let square = square.least(L::of(10.0));
    // (-1)^k 4^k γ^(2k - 2)/(2k + 1)!, backwards
    let mut sum = L::of(0.0);
    let mut k = 16;
    while k >= 2 {
        let next = (2 * k) as f64 * (2 * k + 1) as f64;
        let term = square * L::of(-4.0 / next);
        sum = term.times_plus::<FUSED>(sum, term);
        k -= 1;
    }
    L::of(-2.0 / 3.0) * (L::of(1.0) + sum)
}

/// Derivatives by the curvature vector and the pair before the bend; `q` is the bent point.
#[inline(always)]
pub(super) fn through_bend<const FUSED: bool, L: Lane>(
    (stage, bending): &(Stage<L>, Bending<L>),
    q: &Triple<L>,
    b: &[L; 2],
    n: &Triple<L>,
    u: &Triple<L>,
    pair: &Pair<L>,
) -> ([L; 2], Pair<L>) {
    let [x, y, z] = *q;
    let (ih, sag, p) = (bending.inverse, bending.sag, &stage.point);
    let square = b[0] * b[0] + b[1] * b[1];
    let across = L::of(1.0) - b[0] * x - b[1] * y;
    let (sh, zh) = (sag * ih, z * ih);
    let zhh = zh * ih;
    let towards = b[0] * n[0] + b[1] * n[1];
    // changes along the normal
    let dh = (square * z * n[2] - across * towards) * ih;
    let dlog = dh * ih;
    let dsag = zh.times_plus::<FUSED>(n[2], sh * towards);
    let dsh = dsag.times_plus::<FUSED>(ih, -sh * dlog);
    let dzh = n[2].times_plus::<FUSED>(ih, -zh * dlog);
    let dzhh = dzh.times_plus::<FUSED>(ih, -zhh * dlog);
    let dacross = -towards * ih * ih - L::of(2.0) * across * ih * ih * dlog;
    let d = [
        [-b[0] * b[0] * dsh, -b[0] * b[1] * dsh, -b[0] * dzh],
        [-b[0] * b[1] * dsh, -b[1] * b[1] * dsh, -b[1] * dzh],
        [b[0] * dzhh, b[1] * dzhh, dacross],
    ];
    // ∂σ/∂bx = σ x'/h, ∂z'/∂bx = bx E + z x/h² with E = (B z/h² - z')/k² and dE = -2 (z/h)² dz'
    let lag = p[2] * p[2] * p[2] * lag::<FUSED, L>(square * p[2] * p[2]);
    let dlag = L::of(-2.0) * zh * zh * u[2];
    let along = |i: usize| {
        let (by, dby) = (sh * p[i], dsh.times_plus::<FUSED>(p[i], sh * u[i]));
        let mut c = [-b[0] * by, -b[1] * by, b[i] * lag + zhh * q[i]];
        let mut dc = [-b[0] * dby, -b[1] * dby, b[i] * dlag + dzhh * q[i] + zhh * n[i]];
        c[i] = c[i] - sag;
        dc[i] = dc[i] - dsag;
        pair.by::<FUSED>(&c, &dc)
    };
    ([along(0), along(1)], pair.before::<FUSED>(stage, &d))
}
