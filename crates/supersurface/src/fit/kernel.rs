//! The hot loop: first-order distance `d = (g - 1)/|∇g|` of points with its complete derivative.
//!
//! It is the radial distance times the cosine between ray and normal, within second order of the Euclidean distance.
//! The derivative includes that of `|∇g|`: with that factor frozen the solver stops far from the optimum. As a
//! parameter's derivative commutes with that along the normal `n = ∇g/|∇g|`,
//!
//! ```text
//! ∂d/∂θ = (∂g/∂θ - d ∂(∂g/∂θ)/∂n)/|∇g| = (1/|∇g|) ∂G/∂θ - (g d/|∇g|) ∂(∂G/∂θ)/∂n,    G = ln g
//! ```
//!
//! so that beside the derivatives of `G` only their change along one direction is needed. In the weights of FORMULAS §0
//! both come without a further power: with `ρ = ‖(x/a1, y/a2)‖`, `τ = ρ - a4` (toroid) or `ρ` and
//! `G = ln ‖(τ, z/a3)‖`,
//!
//! ```text
//! dG = w1 d ln τ + (1 - w1) d ln|z/a3| + S1/2 dε1,    d ln τ = ρ/τ (w2 d ln|x/a1| + (1 - w2) d ln|y/a2| + S2/2 dε2)
//! dw = w (1 - w) ds,    dS = -s dw,    s = p (ln u - ln v) the layer's spread
//! ```
//!
//! Deformed bodies are evaluated at the point that [`super::pull_back`] finds.
//!
//! The loop waits for divisions longest, so inverses and logarithms share them where they can.

use super::parameters::{
    BEND, COUNT, EXPONENT, POSITION, Parameters, RING, ROTATION, TAPER, TWIST,
};
use super::pull_back::{
    Pair, Triple, dot, through_bend, through_taper, through_twist, unbend, untaper, untwist,
};
use crate::numeric::lanes::{Lane, WIDEST, inverses, log_and_inverse, logarithms};

/// One block of results, of which the first [`Lane::WIDTH`] are used.
pub(super) struct Block<L> {
    pub(super) distance: [L; WIDEST],
    pub(super) rows: [[L; WIDEST]; COUNT],
}

impl<L: Lane> Block<L> {
    pub(super) fn new() -> Self {
        let none = [L::of(0.0); WIDEST];
        Self { distance: none, rows: [none; COUNT] }
    }
}

/// What stands in for a distance that is not a number: far away.
const FAR: f64 = 10.0;
/// Larger distances are none.
const LARGEST: f64 = 1e18;

/// Flags of a family for compilation: which parts of the loop it needs.
pub(super) const RINGED: u8 = 1;
/// See [`RINGED`].
pub(super) const TAPERED: u8 = 2;
/// See [`RINGED`].
pub(super) const TWISTED: u8 = 4;
/// See [`RINGED`].
pub(super) const BENT: u8 = 8;

/// A layer of two arguments given by their logarithms: `ln ‖(u, v)‖_p`, the weights of both, the entropy `S` of the
/// weights and the spread.
#[derive(Clone, Copy)]
struct Layer<L> {
    log_norm: L,
    first: L,
    second: L,
    entropy: L,
    spread: L,
}

impl<L: Lane> Layer<L> {
    /// `r` is `1/p`.
    #[inline(always)]
    fn new<const FUSED: bool>(u: L, v: L, p: L, r: L) -> Self {
        let spread = p * (u - v);
        let t = (-spread.abs().least(L::LOST)).exp::<FUSED>();
        let (l, major) = log_and_inverse::<FUSED, L>(t);
        let minor = t * major;
        let (first, second) = if spread > L::of(0.0) { (major, minor) } else { (minor, major) };
        let log_norm = l.times_plus::<FUSED>(r, u.most(v));
        let entropy = spread.abs().times_plus::<FUSED>(minor, l);
        Self { log_norm, first, second, entropy, spread }
    }

    /// Changes of `(log norm, first weight, entropy)` when the logarithms change by `du` and `dv`.
    #[inline(always)]
    fn changes<const FUSED: bool>(&self, du: L, dv: L, p: L) -> (L, L, L) {
        let first = self.first * self.second * p * (du - dv);
        let norm = self.first.times_plus::<FUSED>(du, self.second * dv);
        (norm, first, -self.spread * first)
    }
}

/// Not nearer to a symmetry plane than 1e-7: the limits are the same.
#[inline(always)]
fn off_plane<L: Lane>(v: L) -> L {
    v.abs().most(L::of(1e-7)).copysign(v)
}

/// What is evaluated: distances alone, with unit normals, or with derivatives by all parameters of the family.
pub(super) const DISTANCES: u8 = 0;
/// See [`DISTANCES`]; normals stand, with their signs turned, where the derivatives by the position do.
pub(super) const NORMALS: u8 = 1;
/// See [`DISTANCES`].
pub(super) const DERIVATIVES: u8 = 2;

/// A body as the loop needs it.
struct Body<L> {
    rotation: [Triple<L>; 3],
    position: Triple<L>,
    log_axes: Triple<L>,
    ring: L,
    height: L,
    /// `2/ε` and its inverse, of both exponents.
    powers: [L; 2],
    inverse_powers: [L; 2],
    taper: [L; 2],
    twist: L,
    bend: [L; 2],
}

impl<L: Lane> Body<L> {
    #[inline(always)]
    fn of(s: &Parameters) -> Self {
        let r = s.rotation.matrix();
        Self {
            rotation: [0, 1, 2].map(|i| [0, 1, 2].map(|j| L::of(r[(i, j)]))),
            position: [0, 1, 2].map(|k| L::of(s.position[k])),
            log_axes: s.log_axes.map(L::of),
            ring: L::of(s.ring),
            height: L::of(s.log_axes[2].exp()),
            powers: s.exponents.map(|e| L::of(2.0 / e)),
            inverse_powers: s.exponents.map(|e| L::of(0.5 * e)),
            taper: s.taper.map(L::of),
            twist: L::of(s.twist),
            bend: s.bend.map(L::of),
        }
    }

    /// A direction of the body's frame in the points'.
    #[inline(always)]
    fn outward<const FUSED: bool>(&self, v: &Triple<L>) -> Triple<L> {
        self.rotation.map(|row| dot::<FUSED, L>(&row, v))
    }
}

/// Evaluates a block of [`Lane::WIDTH`] points.
#[inline(always)]
pub(super) fn evaluate<const FUSED: bool, const PARTS: u8, const WHAT: u8, L: Lane>(
    s: &Parameters,
    [x, y, z]: [&[L]; 3],
    out: &mut Block<L>,
) {
    let ringed = PARTS & RINGED != 0;
    let (tapered, twisted, bent) = (PARTS & TAPERED != 0, PARTS & TWISTED != 0, PARTS & BENT != 0);
    let body = Body::<L>::of(s);
    let [r0, r1, r2] = body.rotation;
    let [l1, l2, l3] = body.log_axes;
    let ([p1, p2], [r_1, r_2]) = (body.powers, body.inverse_powers);
    let (zero, one) = (L::of(0.0), L::of(1.0));
    for i in 0..L::WIDTH {
        let [dx, dy, dz] =
            [x[i] - body.position[0], y[i] - body.position[1], z[i] - body.position[2]];
        let across =
            |k: usize| r0[k].times_plus::<FUSED>(dx, r1[k].times_plus::<FUSED>(dy, r2[k] * dz));
        let q: Triple<L> = [off_plane(across(0)), off_plane(across(1)), off_plane(across(2))];
        // back to the undeformed body
        let straight = bent.then(|| unbend::<FUSED, L>(&q, &body.bend));
        let upright = straight.map_or(q, |(stage, _)| stage.point);
        let untwisted = twisted.then(|| untwist::<FUSED, L>(&upright, body.twist, body.height));
        let even = untwisted.map_or(upright, |stage| stage.point);
        let untapered = tapered.then(|| untaper::<FUSED, L>(&even, &body.taper, body.height));
        let p = untapered.map_or(even, |(stage, _)| stage.point);
        let p = if PARTS > RINGED { p.map(off_plane) } else { p };

        // the gauge and its gradient
        let inverse = inverses(p);
        let [lx, ly, lz] = logarithms::<FUSED, L>(p.map(Lane::abs));
        let planar = Layer::new::<FUSED>(lx - l1, ly - l2, p2, r_2);
        let radius = if ringed { planar.log_norm.exp::<FUSED>() } else { one };
        let offset = if ringed { off_plane(radius - body.ring) } else { one };
        let log_offset = if ringed { offset.abs().ln::<FUSED>() } else { planar.log_norm };
        let by_offset = if ringed { one / offset } else { one };
        let whole = Layer::new::<FUSED>(log_offset, lz - l3, p1, r_1);
        // 1/g
        let ig = (-whole.log_norm).exp::<FUSED>();
        let slope = if ringed { radius * by_offset } else { one };
        let across = whole.first * slope;
        let by_logs = [across * planar.first, across * planar.second, whole.second];
        let gradient: Triple<L> = std::array::from_fn(|k| by_logs[k] * inverse[k]);
        let mut normal = gradient;
        if let Some((stage, _)) = &untapered {
            normal = stage.back::<FUSED>(&normal);
        }
        if let Some(stage) = &untwisted {
            normal = stage.back::<FUSED>(&normal);
        }
        if let Some((stage, _)) = &straight {
            normal = stage.back::<FUSED>(&normal);
        }
        // 1/|∇G|, and 1/|∇g| = steady/g
        let steady = dot::<FUSED, L>(&normal, &normal).most(L::of(1e-18)).inverse_sqrt::<FUSED>();
        let d = (one - ig) * steady;
        let sound = d.abs() < L::of(LARGEST);
        out.distance[i] = if sound { d } else { L::of(FAR) };
        if WHAT == DISTANCES {
            continue;
        }
        let n = normal.map(|v| v * steady);
        if WHAT == NORMALS {
            let [nx, ny, nz] = body.outward::<FUSED>(&n);
            out.rows[POSITION][i] = if sound { -nx } else { zero };
            out.rows[POSITION + 1][i] = if sound { -ny } else { zero };
            out.rows[POSITION + 2][i] = if sound { -nz } else { zero };
            continue;
        }

        // along the normal
        let straightened = straight.as_ref().map_or(n, |(stage, _)| stage.forward::<FUSED>(&n));
        let turned =
            untwisted.as_ref().map_or(straightened, |stage| stage.forward::<FUSED>(&straightened));
        let u = untapered.as_ref().map_or(turned, |(stage, _)| stage.forward::<FUSED>(&turned));
        let logs: Triple<L> = std::array::from_fn(|k| u[k] * inverse[k]);
        let (dplanar, dw2, ds2) = planar.changes::<FUSED>(logs[0], logs[1], p2);
        let doffset = if ringed { slope * dplanar } else { dplanar };
        let dslope = if ringed { slope * (dplanar - doffset) } else { zero };
        let (_, dw1, ds1) = whole.changes::<FUSED>(doffset, logs[2], p1);
        let dacross =
            if ringed { dw1.times_plus::<FUSED>(slope, whole.first * dslope) } else { dw1 };
        let dlogs = [
            dacross.times_plus::<FUSED>(planar.first, across * dw2),
            dacross.times_plus::<FUSED>(planar.second, -across * dw2),
            -dw1,
        ];
        // ∂d/∂θ = a ∂G/∂θ - b ∂(∂G/∂θ)/∂n
        let (a, b) = (steady * ig, d * steady);
        let (a, b) = if sound { (a, b) } else { (zero, zero) };
        let by_axis: Triple<L> =
            std::array::from_fn(|k| b.times_plus::<FUSED>(dlogs[k], -a * by_logs[k]));
        out.rows[0][i] = by_axis[0];
        out.rows[1][i] = by_axis[1];
        let mut by_height = by_axis[2];
        if ringed {
            let by_ring = whole.first * by_offset;
            let dring = dw1 * by_offset - by_ring * doffset;
            out.rows[RING][i] = b.times_plus::<FUSED>(dring, -a * by_ring);
        }
        let half = L::of(0.5);
        out.rows[EXPONENT][i] = half * a.times_plus::<FUSED>(whole.entropy, -b * ds1);
        let change = dacross.times_plus::<FUSED>(planar.entropy, across * ds2);
        out.rows[EXPONENT + 1][i] =
            half * (a * across).times_plus::<FUSED>(planar.entropy, -b * change);

        let change: Triple<L> = gradient.map(|v| b * v);
        let whole_of =
            |k: usize| (b * logs[k]).times_plus::<FUSED>(by_logs[k], -by_axis[k]) * inverse[k];
        let mut pair = Pair { whole: std::array::from_fn(whole_of), change };
        if let Some(untapered) = &untapered {
            let (by, by_a3, before) =
                through_taper::<FUSED, L>(untapered, &body.taper, body.height, &turned, &u, &pair);
            out.rows[TAPER][i] = by[0];
            out.rows[TAPER + 1][i] = by[1];
            by_height += by_a3;
            pair = before;
        }
        if let Some(stage) = &untwisted {
            let (by, by_a3, before) = through_twist::<FUSED, L>(
                stage,
                body.twist,
                body.height,
                &straightened,
                &turned,
                &pair,
            );
            out.rows[TWIST][i] = by;
            by_height += by_a3;
            pair = before;
        }
        if let Some(straight) = &straight {
            let (by, before) =
                through_bend::<FUSED, L>(straight, &q, &body.bend, &n, &straightened, &pair);
            out.rows[BEND][i] = by[0];
            out.rows[BEND + 1][i] = by[1];
            pair = before;
        }
        out.rows[2][i] = by_height;
        let [kx, ky, kz] = pair.whole;
        let [tx, ty, tz] = body.outward::<FUSED>(&pair.whole);
        out.rows[POSITION][i] = -tx;
        out.rows[POSITION + 1][i] = -ty;
        out.rows[POSITION + 2][i] = -tz;
        out.rows[ROTATION][i] = ky.times_plus::<FUSED>(q[2], -kz * q[1]);
        out.rows[ROTATION + 1][i] = kz.times_plus::<FUSED>(q[0], -kx * q[2]);
        out.rows[ROTATION + 2][i] = kx.times_plus::<FUSED>(q[1], -ky * q[0]);
    }
}
