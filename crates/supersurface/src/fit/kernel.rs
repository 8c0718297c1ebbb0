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

use super::parameters::{
    BEND, COUNT, EXPONENT, POSITION, Parameters, RING, ROTATION, TAPER, TWIST,
};
use super::pull_back::{
    Pair, Triple, dot, through_bend, through_taper, through_twist, unbend, untaper, untwist,
};
use crate::numeric::lanes::{WIDTH, exp, ln};

/// One block of results.
pub(super) struct Block {
    pub(super) distance: [f64; WIDTH],
    pub(super) rows: [[f64; WIDTH]; COUNT],
}

impl Block {
    pub(super) const fn new() -> Self {
        Self { distance: [0.0; WIDTH], rows: [[0.0; WIDTH]; COUNT] }
    }
}

/// What stands in for a distance that is not a number: far away.
const FAR: f64 = 10.0;

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
struct Layer {
    log_norm: f64,
    first: f64,
    second: f64,
    entropy: f64,
    spread: f64,
}

impl Layer {
    #[inline(always)]
    fn new<const FUSED: bool>(u: f64, v: f64, p: f64) -> Self {
        let spread = p * (u - v);
        let t = exp::<FUSED>(-spread.abs());
        let l = ln::<FUSED>(1.0 + t);
        let major = 1.0 / (1.0 + t);
        let minor = t * major;
        let (first, second) = if spread > 0.0 { (major, minor) } else { (minor, major) };
        let larger = if u > v { u } else { v };
        Self { log_norm: larger + l / p, first, second, entropy: l + spread.abs() * minor, spread }
    }

    /// Changes of `(log norm, first weight, entropy)` when the logarithms change by `du` and `dv`.
    #[inline(always)]
    fn changes(&self, du: f64, dv: f64, p: f64) -> (f64, f64, f64) {
        let first = self.first * self.second * p * (du - dv);
        (self.first * du + self.second * dv, first, -self.spread * first)
    }
}

/// Not nearer to a symmetry plane than 1e-7: the limits are the same.
#[inline(always)]
fn off_plane(v: f64) -> f64 {
    let floor = 1e-7f64.copysign(v);
    if v.abs() < 1e-7 { floor } else { v }
}

#[inline(always)]
fn usable(v: f64) -> f64 {
    if v.abs() < 1e100 { v } else { 0.0 }
}

/// What is evaluated: distances alone, with unit normals, or with derivatives by all parameters of the family.
pub(super) const DISTANCES: u8 = 0;
/// See [`DISTANCES`]; normals stand, with their signs turned, where the derivatives by the position do.
pub(super) const NORMALS: u8 = 1;
/// See [`DISTANCES`].
pub(super) const DERIVATIVES: u8 = 2;

/// Evaluates a block of points.
#[inline(always)]
pub(super) fn evaluate<const FUSED: bool, const PARTS: u8, const WHAT: u8>(
    s: &Parameters,
    [x, y, z]: [&[f64; WIDTH]; 3],
    out: &mut Block,
) {
    let ringed = PARTS & RINGED != 0;
    let (tapered, twisted, bent) = (PARTS & TAPERED != 0, PARTS & TWISTED != 0, PARTS & BENT != 0);
    let r = s.rotation.matrix();
    let t = s.position;
    let [l1, l2, l3] = s.log_axes;
    let height = l3.exp();
    let [e1, e2] = s.exponents;
    let (p1, p2) = (2.0 / e1, 2.0 / e2);
    for i in 0..WIDTH {
        let (dx, dy, dz) = (x[i] - t.x, y[i] - t.y, z[i] - t.z);
        let q: Triple = [
            off_plane(r.m11 * dx + r.m21 * dy + r.m31 * dz),
            off_plane(r.m12 * dx + r.m22 * dy + r.m32 * dz),
            off_plane(r.m13 * dx + r.m23 * dy + r.m33 * dz),
        ];
        // back to the undeformed body
        let straight = bent.then(|| unbend::<FUSED>(&q, &s.bend));
        let upright = straight.map_or(q, |(stage, _)| stage.point);
        let untwisted = twisted.then(|| untwist::<FUSED>(&upright, s.twist, height));
        let even = untwisted.map_or(upright, |stage| stage.point);
        let untapered = tapered.then(|| untaper(&even, &s.taper, height));
        let p = untapered.map_or(even, |(stage, _)| stage.point);
        let p = if PARTS > RINGED { p.map(off_plane) } else { p };

        // the gauge and its gradient
        let inverse = p.map(|v| 1.0 / v);
        let planar =
            Layer::new::<FUSED>(ln::<FUSED>(p[0].abs()) - l1, ln::<FUSED>(p[1].abs()) - l2, p2);
        let radius = if ringed { exp::<FUSED>(planar.log_norm) } else { 1.0 };
        let offset = if ringed { off_plane(radius - s.ring) } else { 1.0 };
        let log_offset = if ringed { ln::<FUSED>(offset.abs()) } else { planar.log_norm };
        let whole = Layer::new::<FUSED>(log_offset, ln::<FUSED>(p[2].abs()) - l3, p1);
        let g = exp::<FUSED>(whole.log_norm);
        let slope = if ringed { radius / offset } else { 1.0 };
        let across = whole.first * slope;
        let by_logs = [across * planar.first, across * planar.second, whole.second];
        let gradient: Triple = std::array::from_fn(|k| by_logs[k] * inverse[k]);
        let mut normal = gradient;
        if let Some((stage, _)) = &untapered {
            normal = stage.back(&normal);
        }
        if let Some(stage) = &untwisted {
            normal = stage.back(&normal);
        }
        if let Some((stage, _)) = &straight {
            normal = stage.back(&normal);
        }
        let square = dot(&normal, &normal);
        let square = if square < 1e-18 { 1e-18 } else { square };
        // 1/|∇G|, and 1/|∇g| = steady/g
        let steady = 1.0 / square.sqrt();
        let ig = 1.0 / g;
        let d = (1.0 - ig) * steady;
        out.distance[i] = if d.abs() < 1e100 { d } else { FAR };
        if WHAT == DISTANCES {
            continue;
        }
        let n = normal.map(|v| v * steady);
        if WHAT == NORMALS {
            let [nx, ny, nz] = n;
            out.rows[POSITION][i] = usable(-(r.m11 * nx + r.m12 * ny + r.m13 * nz));
            out.rows[POSITION + 1][i] = usable(-(r.m21 * nx + r.m22 * ny + r.m23 * nz));
            out.rows[POSITION + 2][i] = usable(-(r.m31 * nx + r.m32 * ny + r.m33 * nz));
            continue;
        }

        // along the normal
        let straightened = straight.as_ref().map_or(n, |(stage, _)| stage.forward(&n));
        let turned = untwisted.as_ref().map_or(straightened, |stage| stage.forward(&straightened));
        let u = untapered.as_ref().map_or(turned, |(stage, _)| stage.forward(&turned));
        let logs: Triple = std::array::from_fn(|k| u[k] * inverse[k]);
        let (dplanar, dw2, ds2) = planar.changes(logs[0], logs[1], p2);
        let doffset = if ringed { slope * dplanar } else { dplanar };
        let dslope = if ringed { slope * (dplanar - doffset) } else { 0.0 };
        let (_, dw1, ds1) = whole.changes(doffset, logs[2], p1);
        let dacross = dw1 * slope + whole.first * dslope;
        let dlogs =
            [dacross * planar.first + across * dw2, dacross * planar.second - across * dw2, -dw1];
        // ∂d/∂θ = a ∂G/∂θ - b ∂(∂G/∂θ)/∂n
        let (a, b) = (steady * ig, d * steady);
        let by_axis: Triple = std::array::from_fn(|k| b * dlogs[k] - a * by_logs[k]);
        out.rows[0][i] = usable(by_axis[0]);
        out.rows[1][i] = usable(by_axis[1]);
        let mut by_height = by_axis[2];
        if ringed {
            let by_ring = whole.first / offset;
            let dring = dw1 / offset - by_ring * doffset;
            out.rows[RING][i] = usable(b * dring - a * by_ring);
        }
        out.rows[EXPONENT][i] = usable(0.5 * (a * whole.entropy - b * ds1));
        out.rows[EXPONENT + 1][i] = usable(
            0.5 * (a * across * planar.entropy - b * (dacross * planar.entropy + across * ds2)),
        );

        let change: Triple = gradient.map(|v| b * v);
        let mut pair = Pair {
            whole: std::array::from_fn(|k| (b * logs[k] * by_logs[k] - by_axis[k]) * inverse[k]),
            change,
        };
        if let Some(untapered) = &untapered {
            let (by, by_a3, before) =
                through_taper(untapered, &s.taper, height, &turned, &u, &pair);
            out.rows[TAPER][i] = usable(by[0]);
            out.rows[TAPER + 1][i] = usable(by[1]);
            by_height += by_a3;
            pair = before;
        }
        if let Some(stage) = &untwisted {
            let (by, by_a3, before) =
                through_twist(stage, s.twist, height, &straightened, &turned, &pair);
            out.rows[TWIST][i] = usable(by);
            by_height += by_a3;
            pair = before;
        }
        if let Some(straight) = &straight {
            let (by, before) = through_bend(straight, &q, &s.bend, &n, &straightened, &pair);
            out.rows[BEND][i] = usable(by[0]);
            out.rows[BEND + 1][i] = usable(by[1]);
            pair = before;
        }
        out.rows[2][i] = usable(by_height);
        let [kx, ky, kz] = pair.whole;
        out.rows[POSITION][i] = usable(-(r.m11 * kx + r.m12 * ky + r.m13 * kz));
        out.rows[POSITION + 1][i] = usable(-(r.m21 * kx + r.m22 * ky + r.m23 * kz));
        out.rows[POSITION + 2][i] = usable(-(r.m31 * kx + r.m32 * ky + r.m33 * kz));
        out.rows[ROTATION][i] = usable(ky * q[2] - kz * q[1]);
        out.rows[ROTATION + 1][i] = usable(kz * q[0] - kx * q[2]);
        out.rows[ROTATION + 2][i] = usable(kx * q[1] - ky * q[0]);
    }
}
