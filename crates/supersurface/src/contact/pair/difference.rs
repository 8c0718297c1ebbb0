//! The one function of a pair: the support function of the Minkowski difference.
//!
//! `φ(n) = h_A(n) + h_B(-n) - n·c` for a unit direction `n` from A to B and the centres `c` apart (FORMULAS §9). Its
//! least value over the sphere is minus the signed distance: positive depth where the bodies overlap, negative
//! where they do not. `φ` is convex and 1-homogeneous in `n`, and its gradient is the difference of the two support
//! points.
//!
//! Everything comes from shares. With `u_i = a_i |n_i|`, the inner norm `g = ‖(u1, u2)‖_q2` and `h = ‖(g, u3)‖_q1`,
//! `s1 = (u1/g)^q2 = 1 - s2` and `S = (g/h)^q1 = 1 - S3` are what each axis contributes: `h = Σ x_i |n_i|` with
//! `x_i |n_i| = w_i h`, `w = (S s1, S s2, S3)`. For directions `t`, `t'` and the relative rates `ρ_i = t_i/n_i`
//! the second derivative is
//! `h [ (q2 - 1) S s1 s2 (ρ1 - ρ2)(ρ1' - ρ2') + (q1 - 1) S S3 (s1 ρ1 + s2 ρ2 - ρ3)(s1 ρ1' + s2 ρ2' - ρ3') ]`.
//!
//! Lengths are divided by the pair's size, the mean of the largest semi-axes.

// loops over indices are what becomes vector instructions
#![allow(clippy::needless_range_loop)]

use super::Convex;
use crate::numeric::lanes::{Lane, fused};
use crate::numeric::superellipse::norm_of_logs;
use crate::shape::Posed;

/// A vector as the kernels have it.
pub(super) type Triple = [f64; 3];

/// Centres are no farther apart along an axis than this, in metres: squares overflow.
pub(super) const FARTHEST: f64 = 1e300;

/// Two bodies in A's frame, in units of their size.
#[derive(Clone, Debug)]
pub(super) struct Difference {
    pub(super) semi_axes: [Triple; 2],
    /// `[q1, q2]` of each body.
    pub(super) dual: [[f64; 2]; 2],
    inverse_dual: [[f64; 2]; 2],
    /// B's axes in A's frame are its columns.
    pub(super) turn: [Triple; 3],
    /// B's centre in A's frame.
    pub(super) centre: Triple,
    /// Radius of a ball that rolls inside along the whole surface of the sum.
    pub(super) rolling: f64,
    /// What a length is divided by, in metres.
    pub(super) size: f64,
}

/// `φ` with its derivatives along two tangents.
#[derive(Clone, Copy, Debug)]
pub(super) struct Expansion {
    pub(super) value: f64,
    /// Gradient in A's frame: the point of A less that of B that the direction touches.
    pub(super) gap: Triple,
    /// Support points in the bodies' own frames; B's as seen along `n`, so that it touches with minus this.
    pub(super) points: [Triple; 2],
    /// `[tt, tt', t't']`.
    pub(super) hessian: [f64; 3],
    /// The same of a quadratic that lies above `φ`, for exponents up to 1: weights `x_i/n_i`.
    pub(super) majorant: [f64; 3],
    compliance: [Compliance; 2],
}

/// The second derivative of a body's support function in factors.
#[derive(Clone, Copy, Debug)]
struct Compliance {
    /// `1/n_i`, and the shares `[s1, s2]`.
    inverse: Triple,
    shares: [f64; 2],
    /// What stands before the products of `inner` and of `outer` rates.
    weights: [f64; 2],
    /// `ρ1 - ρ2` and `s1 ρ1 + s2 ρ2 - ρ3` of the two tangents.
    inner: [f64; 2],
    outer: [f64; 2],
}

impl Compliance {
    const NONE: Self = Self {
        inverse: [0.0; 3],
        shares: [0.0; 2],
        weights: [0.0; 2],
        inner: [0.0; 2],
        outer: [0.0; 2],
    };

    /// How the support point moves with the normal along the tangents, and how much farther back it lies along the old
    /// normal, of second order.
    #[inline(always)]
    fn moved(&self, by: &[f64; 2]) -> (Triple, f64) {
        let inner = by[0] * self.inner[0] + by[1] * self.inner[1];
        let outer = by[0] * self.outer[0] + by[1] * self.outer[1];
        let [p, q] = [self.weights[0] * inner, self.weights[1] * outer];
        let [s1, s2] = self.shares;
        let x = &self.inverse;
        let moved = [x[0] * (q * s1 + p), x[1] * (q * s2 - p), -x[2] * q];
        (moved, 0.5 * (p * inner + q * outer))
    }
}

impl Expansion {
    /// Before the first evaluation: everything is lower.
    pub(super) const NONE: Self = Self {
        value: f64::INFINITY,
        gap: [0.0; 3],
        points: [[0.0; 3]; 2],
        hessian: [0.0; 3],
        majorant: [0.0; 3],
        compliance: [Compliance::NONE; 2],
    };

    /// After a small move of the normal along the tangents, by the second derivatives: all but the derivatives, to
    /// third order. `gain` is what the value loses.
    #[inline(always)]
    pub(super) fn advance(&mut self, pair: &Difference, n: &[Triple; 2], by: &[f64; 2], gain: f64) {
        for b in 0..2 {
            let (moved, back) = self.compliance[b].moved(by);
            for k in 0..3 {
                self.points[b][k] += moved[k] - back * n[b][k];
            }
        }
        self.gap = pair.gap(&self.points);
        self.value -= gain;
    }
}

/// `φ` and its gradient in A's frame for a block of directions.
#[derive(Clone, Copy, Debug)]
pub(super) struct Values<T, const N: usize> {
    pub(super) value: [T; N],
    pub(super) gradient: [[T; N]; 3],
}

/// Support functions and shares of `N` bodies or directions.
struct Shares<T, const N: usize> {
    support: [T; N],
    inner: [[T; N]; 2],
    outer: [[T; N]; 2],
}

/// From `u`; `q` and `r = 1/q` as `[q1, q2]`.
#[inline(always)]
fn shares<const FUSED: bool, T: Lane, const N: usize>(
    u: &[[T; N]; 3],
    q: &[[T; N]; 2],
    r: &[[T; N]; 2],
) -> Shares<T, N> {
    let log = |k: usize| lanes(|i| u[k][i].ln::<FUSED>());
    let (norm, inner) = norm_of_logs::<FUSED, T, N>(&log(0), &log(1), &q[1], &r[1]);
    let (log_support, outer) = norm_of_logs::<FUSED, T, N>(&norm, &log(2), &q[0], &r[0]);
    Shares { support: lanes(|i| log_support[i].exp::<FUSED>()), inner, outer }
}

impl Difference {
    pub(super) fn new(a: &Posed<Convex>, b: &Posed<Convex>) -> Self {
        let axes = [a, b].map(|body| body.shape().shape().semi_axes());
        let [largest_a, largest_b] = axes.map(|a| a[0].max(a[1]).max(a[2]));
        let back = a.pose().rotation.inverse();
        let turn = (back * b.pose().rotation).to_rotation_matrix();
        // the difference first: bodies far from the origin
        let apart = b.pose().translation.vector - a.pose().translation.vector;
        let apart = back * apart.map(|v| v.clamp(-FARTHEST, FARTHEST));
        // bodies far apart are points, whose size would overflow what is divided by it
        let size = (0.5 * largest_a + 0.5 * largest_b).max(1e-100 * apart.amax());
        let m = turn.matrix();
        let by_size = |a: Triple| [a[0] / size, a[1] / size, a[2] / size];
        Self {
            semi_axes: [by_size(axes[0]), by_size(axes[1])],
            dual: [a.shape().dual, b.shape().dual],
            inverse_dual: [a.shape().inverse_dual, b.shape().inverse_dual],
            turn: [[m.m11, m.m12, m.m13], [m.m21, m.m22, m.m23], [m.m31, m.m32, m.m33]],
            centre: by_size(apart.into()),
            rolling: (a.shape().rolling + b.shape().rolling) / size,
            size,
        }
    }

    /// The largest `k = q - 1` or `1/k` of the bodies.
    pub(super) fn sharpness(&self) -> f64 {
        self.dual.iter().flatten().map(|q| (q - 1.0).max(1.0 / (q - 1.0))).fold(1.0, f64::max)
    }

    /// The same pair with every `k = q - 1` kept in `[1/limit, limit]`.
    pub(super) fn rounded(&self, limit: f64) -> Self {
        let dual = self.dual.map(|q| q.map(|q| 1.0 + (q - 1.0).clamp(1.0 / limit, limit)));
        Self { dual, inverse_dual: dual.map(|q| q.map(f64::recip)), ..self.clone() }
    }

    /// `φ` at one direction.
    pub(super) fn value(&self, n: &[Triple; 2]) -> f64 {
        self.expand::<false>(n, &[[[0.0; 3]; 2]; 2]).value
    }

    /// A vector of A's frame in B's.
    #[inline(always)]
    pub(super) fn to_b(&self, v: &Triple) -> Triple {
        let [r, s, t] = &self.turn;
        [
            r[0] * v[0] + s[0] * v[1] + t[0] * v[2],
            r[1] * v[0] + s[1] * v[1] + t[1] * v[2],
            r[2] * v[0] + s[2] * v[1] + t[2] * v[2],
        ]
    }

    /// A vector of B's frame in A's.
    #[inline(always)]
    pub(super) fn to_a(&self, v: &Triple) -> Triple {
        [dot(&self.turn[0], v), dot(&self.turn[1], v), dot(&self.turn[2], v)]
    }

    /// `φ` at a unit direction, given in both frames, with its derivatives along two tangents, given in both too.
    #[inline(always)]
    pub(super) fn expand<const FUSED: bool>(
        &self,
        n: &[Triple; 2],
        tangents: &[[Triple; 2]; 2],
    ) -> Expansion {
        let mut u = [[0.0; 2]; 3];
        for (b, n) in n.iter().enumerate() {
            for k in 0..3 {
                u[k][b] = (self.semi_axes[b][k] * n[k].abs()).max(f64::TINY);
            }
        }
        let by_body = |v: &[[f64; 2]; 2]| [[v[0][0], v[1][0]], [v[0][1], v[1][1]]];
        let found = shares::<FUSED, f64, 2>(&u, &by_body(&self.dual), &by_body(&self.inverse_dual));
        let mut points = [[0.0; 3]; 2];
        let (mut hessian, mut majorant) = ([0.0; 3], [0.0; 3]);
        let mut compliance = [Compliance::NONE; 2];
        for b in 0..2 {
            let [s1, s2] = [found.inner[0][b], found.inner[1][b]];
            let [whole, s3] = [found.outer[0][b], found.outer[1][b]];
            let h = found.support[b];
            let weights = [whole * s1, whole * s2, s3];
            // a_i/u_i with n's sign, so that ρ_i = t_i scaled_i
            let mut scaled = [0.0; 3];
            let mut rates = [[0.0; 3]; 2];
            for k in 0..3 {
                scaled[k] = (self.semi_axes[b][k] / u[k][b]).copysign(n[b][k]);
                points[b][k] = h * weights[k] * scaled[k];
                rates[0][k] = tangents[b][0][k] * scaled[k];
                rates[1][k] = tangents[b][1][k] * scaled[k];
            }
            let inner = [rates[0][0] - rates[0][1], rates[1][0] - rates[1][1]];
            let outer = [
                fused::<FUSED>(s1, rates[0][0], s2 * rates[0][1]) - rates[0][2],
                fused::<FUSED>(s1, rates[1][0], s2 * rates[1][1]) - rates[1][2],
            ];
            let c2 = h * (self.dual[b][1] - 1.0) * whole * s1 * s2;
            let c1 = h * (self.dual[b][0] - 1.0) * whole * s3;
            compliance[b] =
                Compliance { inverse: scaled, shares: [s1, s2], weights: [c2, c1], inner, outer };
            for (m, (i, j)) in [(0, 0), (0, 1), (1, 1)].into_iter().enumerate() {
                hessian[m] += c2 * inner[i] * inner[j] + c1 * outer[i] * outer[j];
                majorant[m] += h
                    * (weights[0] * rates[i][0] * rates[j][0]
                        + weights[1] * rates[i][1] * rates[j][1]
                        + weights[2] * rates[i][2] * rates[j][2]);
            }
        }
        let gap = self.gap(&points);
        let value = found.support[0] + found.support[1] - dot(&n[0], &self.centre);
        Expansion { value, gap, points, hessian, majorant, compliance }
    }

    /// The gradient of `φ` from the support points in the bodies' own frames.
    #[inline(always)]
    fn gap(&self, [own, other]: &[Triple; 2]) -> Triple {
        difference(&sum(own, &self.to_a(other)), &self.centre)
    }

    /// `φ` and its gradient for a block of unit directions of A's frame.
    #[inline(always)]
    pub(super) fn values<const FUSED: bool, T: Lane, const N: usize>(
        &self,
        n: &[[T; N]; 3],
    ) -> Values<T, N> {
        let turn: [[T; 3]; 3] =
            [narrow(&self.turn[0]), narrow(&self.turn[1]), narrow(&self.turn[2])];
        let centre: [T; 3] = narrow(&self.centre);
        let seen_by_b = |k: usize| {
            lanes(|i| turn[0][k] * n[0][i] + turn[1][k] * n[1][i] + turn[2][k] * n[2][i])
        };
        let (on_a, a) = self.support::<FUSED, T, N>(0, n);
        let (on_b, b) = self.support::<FUSED, T, N>(1, &[seen_by_b(0), seen_by_b(1), seen_by_b(2)]);
        let gradient = |k: usize| {
            lanes(|i| {
                let x = turn[k][0] * b[0][i] + turn[k][1] * b[1][i] + turn[k][2] * b[2][i];
                a[k][i] - centre[k] + x
            })
        };
        let along = |i: usize| n[0][i] * centre[0] + n[1][i] * centre[1] + n[2][i] * centre[2];
        Values {
            value: lanes(|i| on_a[i] + on_b[i] - along(i)),
            gradient: [gradient(0), gradient(1), gradient(2)],
        }
    }

    /// Support function and support points of a body for a block of directions of its own frame.
    #[inline(always)]
    fn support<const FUSED: bool, T: Lane, const N: usize>(
        &self,
        body: usize,
        n: &[[T; N]; 3],
    ) -> ([T; N], [[T; N]; 3]) {
        let semi_axes: [T; 3] = narrow(&self.semi_axes[body]);
        let u = |k: usize| lanes(|i| (semi_axes[k] * n[k][i].abs()).most(T::TINY));
        let u = [u(0), u(1), u(2)];
        let spread = |q: &[f64; 2]| [[T::of(q[0]); N], [T::of(q[1]); N]];
        let (q, r) = (spread(&self.dual[body]), spread(&self.inverse_dual[body]));
        let of = shares::<FUSED, T, N>(&u, &q, &r);
        let planar: [T; N] = lanes(|i| of.support[i] * of.outer[0][i]);
        let point = |k: usize, along: [T; N]| {
            lanes(|i| (semi_axes[k] * along[i] / u[k][i]).copysign(n[k][i]))
        };
        let points = [
            point(0, lanes(|i| planar[i] * of.inner[0][i])),
            point(1, lanes(|i| planar[i] * of.inner[1][i])),
            point(2, lanes(|i| of.support[i] * of.outer[1][i])),
        ];
        (of.support, points)
    }
}

/// A block of numbers. Loops over one block alone become vector instructions; those over several were seen to become
/// gathers and scatters.
#[inline(always)]
fn lanes<T: Lane, const N: usize>(of: impl Fn(usize) -> T) -> [T; N] {
    let mut block = [T::of(0.0); N];
    for i in 0..N {
        block[i] = of(i);
    }
    block
}

/// Three numbers in a kernel's precision.
#[inline(always)]
pub(super) fn narrow<T: Lane>(v: &Triple) -> [T; 3] {
    [T::of(v[0]), T::of(v[1]), T::of(v[2])]
}

#[inline(always)]
pub(super) fn dot(a: &Triple, b: &Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
pub(super) fn cross(a: &Triple, b: &Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
pub(super) fn scaled(a: &Triple, factor: f64) -> Triple {
    [a[0] * factor, a[1] * factor, a[2] * factor]
}

#[inline(always)]
pub(super) fn sum(a: &Triple, b: &Triple) -> Triple {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The unit vector along one that is not zero.
#[inline(always)]
pub(super) fn unit(a: &Triple) -> Triple {
    scaled(a, 1.0 / dot(a, a).sqrt())
}

#[inline(always)]
pub(super) fn difference(a: &Triple, b: &Triple) -> Triple {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}
