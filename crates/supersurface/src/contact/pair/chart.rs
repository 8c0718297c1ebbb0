//! Coordinates around a direction in which the support functions of flat faces are tame.
//!
//! Next to a face (ε < 1) the support point moves like `|t|^k`, `k = ε/(2 - ε)`, in a small component `t = p·n` of a
//! body's normal: at ε = 0.1 like `t^0.053`, and Newton's method in `n` overshoots the face. So up to two such
//! components, the smallest of both bodies, are coordinates; they move in `ξ = sgn(t)|t|^k`, which is where on the face
//! the body is touched: a Newton step `s` goes to `t' = t sgn(y)|y|^(1/k)`, `y = 1 + k s/t`. The tangents are
//! biorthogonal to the `p` and scaled by `t`, so that a second derivative of 1e19 in one does not wash out the other.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::difference::{Difference, Triple, cross, dot, scaled};
use crate::numeric::lanes::{exp, ln};

/// Components of `u/|u|` below this are small.
const SMALL: f64 = 0.35;
/// From this power on a component is tame as it is.
const TAME: f64 = 0.8;
/// No component is nearer to 0 than this.
const LEAST: f64 = 1e-290;
/// Only components below this may be too near to 0.
const SUSPECT: f64 = 2e-18;
/// Longest step, in radians.
pub(super) const LONGEST: f64 = 0.7;

/// A component of a body's normal that is a coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seam {
    body: usize,
    /// Component of the local normal; `None`: the distance from the body's z axis.
    axis: Option<usize>,
    value: f64,
    power: f64,
    /// The component in units of the body's support function, about.
    rank: f64,
    /// Which of `[q1, q2]` the power is of.
    which: usize,
}

impl Seam {
    fn power_in(&self, pair: &Difference) -> f64 {
        pair.dual[self.body][self.which] - 1.0
    }
}

/// Two tangents at a direction, in both frames.
#[derive(Clone, Copy, Debug)]
pub(super) struct Chart {
    /// `tangents[body][which]`.
    pub(super) tangents: [[Triple; 2]; 2],
    pub(super) lengths: [f64; 2],
    seams: [Option<Seam>; 2],
}

#[derive(Clone, Copy)]
struct Candidate {
    rank: f64,
    across: Triple,
    seam: Option<Seam>,
}

impl Chart {
    /// Before the first one.
    pub(super) const NONE: Self =
        Self { tangents: [[[0.0; 3]; 2]; 2], lengths: [0.0; 2], seams: [None, None] };

    #[inline(always)]
    pub(super) fn at(pair: &Difference, n: &[Triple; 2]) -> Self {
        let [first, second] = smallest(pair, n);
        let n = &n[0];
        let (mut tangents, mut seams) = (plain(n), [None, None]);
        if let Some(seam) = first.seam {
            seams[0] = Some(seam);
            let beside = cross(n, &first.across);
            let square = dot(&beside, &beside);
            tangents =
                [scaled(&cross(&beside, n), 1.0 / square), scaled(&beside, 1.0 / square.sqrt())];
            if let Some(seam) = second.seam {
                let other = cross(n, &second.across);
                let volume = dot(&other, &first.across);
                if volume.abs() > 0.2 {
                    seams[1] = Some(seam);
                    tangents = [scaled(&other, 1.0 / volume), scaled(&beside, -1.0 / volume)];
                }
            }
        }
        let mut lengths = [1.0; 2];
        for j in 0..2 {
            if let Some(seam) = seams[j] {
                tangents[j] = scaled(&tangents[j], seam.value);
                lengths[j] = seam.value.abs();
            }
        }
        let far = [pair.to_b(&tangents[0]), pair.to_b(&tangents[1])];
        let mut tangents = [tangents, far];
        for i in 0..2 {
            let Some(Seam { body, axis: Some(axis), value, .. }) = seams[i] else { continue };
            // exactly biorthogonal: rounding would be large against a tiny component
            tangents[body][i][axis] = value;
            if seams[1 - i].is_some() {
                tangents[body][1 - i][axis] = 0.0;
            }
        }
        Self { tangents, lengths, seams }
    }

    /// How far along the tangents a Newton step leads, `1` being the tangent itself.
    #[inline(always)]
    pub(super) fn bent<const FUSED: bool>(&self, step: &[f64; 2]) -> [f64; 2] {
        let mut bent = *step;
        for j in 0..2 {
            let Some(seam) = self.seams[j] else { continue };
            let y = 1.0 + (seam.power * step[j]).clamp(-1e19, 1e19);
            let raised = exp::<FUSED>(ln::<FUSED>(y.abs().max(LEAST)) / seam.power).copysign(y);
            let most = LONGEST / seam.value.abs();
            bent[j] = (raised - 1.0).clamp(-most, most);
        }
        bent
    }

    /// The direction that touches the same places of the faces once the powers of the bodies are other ones.
    pub(super) fn sharpened(
        &self,
        n: &[Triple; 2],
        from: &Difference,
        to: &Difference,
    ) -> [Triple; 2] {
        let mut by = [0.0; 2];
        for j in 0..2 {
            let Some(seam) = self.seams[j] else { continue };
            let ratio = seam.power_in(from) / seam.power_in(to);
            by[j] = ((ratio - 1.0) * seam.rank.ln()).exp() - 1.0;
        }
        self.moved(n, &by)
    }

    /// Length of a move along the tangents, in radians.
    #[inline(always)]
    pub(super) fn length(&self, by: &[f64; 2]) -> f64 {
        let [t, s] = &self.tangents[0];
        let step: Triple =
            [by[0] * t[0] + by[1] * s[0], by[0] * t[1] + by[1] * s[1], by[0] * t[2] + by[1] * s[2]];
        dot(&step, &step).sqrt()
    }

    /// The direction after a move along the tangents, in both frames.
    #[inline(always)]
    pub(super) fn moved(&self, n: &[Triple; 2], by: &[f64; 2]) -> [Triple; 2] {
        let mut steps = [[0.0; 3]; 2];
        for (step, [t, s]) in steps.iter_mut().zip(&self.tangents) {
            for k in 0..3 {
                step[k] = by[0] * t[k] + by[1] * s[k];
            }
        }
        let length = dot(&steps[0], &steps[0]).sqrt();
        let shrink = if length > LONGEST { LONGEST / length } else { 1.0 };
        let mut to = *n;
        for (to, step) in to.iter_mut().zip(&steps) {
            for k in 0..3 {
                to[k] += shrink * step[k];
            }
        }
        for j in 0..2 {
            let Some(seam) = self.seams[j] else { continue };
            let Some(axis) = seam.axis else { continue };
            // what rounding of the other frame's numbers would bury
            to[seam.body][axis] = seam.value * (1.0 + shrink * by[j]);
        }
        let shorter = 1.0 / dot(&to[0], &to[0]).sqrt();
        [scaled(&to[0], shorter), scaled(&to[1], shorter)]
    }
}

/// The two smallest components that are not tame.
#[inline(always)]
fn smallest(pair: &Difference, n: &[Triple; 2]) -> [Candidate; 2] {
    let none = Candidate { rank: SMALL, across: [0.0; 3], seam: None };
    let mut best = [none; 2];
    for (body, l) in n.iter().enumerate() {
        let [outer, inner] = [pair.dual[body][0] - 1.0, pair.dual[body][1] - 1.0];
        if outer >= TAME && inner >= TAME {
            continue;
        }
        let a = &pair.semi_axes[body];
        let u = [a[0] * l[0].abs(), a[1] * l[1].abs(), a[2] * l[2].abs()];
        let planar = (u[0] * u[0] + u[1] * u[1]).sqrt();
        let whole = 1.0 / (planar * planar + u[2] * u[2]).sqrt();
        let cap = planar <= u[2];
        let axis_of = |k: usize| -> Triple {
            if body == 1 {
                return [pair.turn[0][k], pair.turn[1][k], pair.turn[2][k]];
            }
            let mut axis = [0.0; 3];
            axis[k] = 1.0;
            axis
        };
        let mut offer =
            |rank: f64, across: Triple, axis: Option<usize>, value: f64, which: usize| {
                let power = pair.dual[body][which] - 1.0;
                if power >= TAME || rank >= best[1].rank {
                    return;
                }
                let value = if value.abs() < SUSPECT { from_floor(value, power) } else { value };
                let candidate = Candidate {
                    rank,
                    across,
                    seam: Some(Seam { body, axis, value, power, rank, which }),
                };
                let apart = |c: &Candidate| dot(&c.across, &across).powi(2) < 0.9;
                if rank < best[0].rank {
                    if apart(&best[0]) {
                        best[1] = best[0];
                    }
                    best[0] = candidate;
                } else if apart(&best[0]) {
                    best[1] = candidate;
                }
            };
        if !cap {
            offer(u[2] * whole, axis_of(2), Some(2), l[2], 0);
        }
        if inner < TAME {
            let (less, more) = if u[0] < u[1] { (0, 1) } else { (1, 0) };
            offer(u[less] * whole, axis_of(less), Some(less), l[less], 1);
            if cap {
                offer(u[more] * whole, axis_of(more), Some(more), l[more], 0);
            }
        } else if cap {
            let radius = (l[0] * l[0] + l[1] * l[1]).sqrt();
            if radius > 0.0 {
                let across = [l[0] / radius, l[1] / radius, 0.0];
                let across = if body == 0 { across } else { pair.to_a(&across) };
                offer(planar * whole, across, None, radius, 0);
            }
        }
    }
    best
}

/// A component no nearer to 0 than where `|t|^k` is 1e-18, if numbers reach so far.
#[inline(always)]
fn from_floor(value: f64, power: f64) -> f64 {
    let floor = LEAST.max((-41.0 / power).exp());
    if value.abs() < floor { floor.copysign(value) } else { value }
}

/// Two orthonormal tangents (Duff and others, *Building an Orthonormal Basis, Revisited*, 2017).
#[inline(always)]
fn plain(n: &Triple) -> [Triple; 2] {
    let sign = 1f64.copysign(n[2]);
    let a = -1.0 / (sign + n[2]);
    let b = n[0] * n[1] * a;
    [[1.0 + sign * n[0] * n[0] * a, sign * b, -sign * n[0]], [b, sign + n[1] * n[1] * a, -n[1]]]
}
