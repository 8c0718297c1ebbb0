//! Depths and normals of a block of points, in stages without a branch.
//!
//! Superellipsoid and supertoroid have one gauge, two norms one in the other with `ρ̂ - a4` between them, where a
//! superellipsoid has `a4 = 0`. The norms are taken in logarithms: `s = p ln(u/v)`, `t = e^-|s|`, norm
//! `max(u, v) (1 + t)^(1/p)`, weights `1/(1 + t)` and `t/(1 + t)`. [`Indented::indentation`] is the reference.

use super::indentation::{BLOCK, Indentations, Indented};
use crate::Point;
use crate::numeric::lanes::{Job, dispatch, exp, fused, ln};
use crate::shape::{Superellipsoid, Supertoroid};

type Lanes = [f64; BLOCK];

pub(super) fn of_superellipsoid(
    solid: &Superellipsoid,
    points: &[Lanes; 3],
    out: &mut Indentations,
) {
    let layers = Layers::new(solid.semi_axes(), 0.0, solid.exponents());
    run(solid, layers, points, out);
}

pub(super) fn of_supertoroid(solid: &Supertoroid, points: &[Lanes; 3], out: &mut Indentations) {
    let layers = Layers::new(solid.semi_axes(), solid.ring_ratio(), solid.exponents());
    run(solid, layers, points, out);
}

fn run(solid: &impl Indented, layers: Option<Layers>, points: &[Lanes; 3], out: &mut Indentations) {
    match layers {
        Some(layers) => dispatch(Fill { layers, points, out }),
        None => one_by_one(solid, points, out),
    }
}

/// For numbers that logarithms of quotients cannot carry.
fn one_by_one(solid: &impl Indented, points: &[Lanes; 3], out: &mut Indentations) {
    for i in 0..BLOCK {
        let found = solid.indentation(&Point::new(points[0][i], points[1][i], points[2][i]));
        out.depths[i] = found.map_or(0.0, |f| f.depth);
        for (k, column) in out.normals.iter_mut().enumerate() {
            column[i] = found.map_or(0.0, |f| f.normal[k]);
        }
    }
}

struct Layers {
    axes: [f64; 3],
    inverse: [f64; 3],
    ring: f64,
    /// `2/ε`, and `ε/2`.
    p: [f64; 2],
    half: [f64; 2],
}

impl Layers {
    fn new(axes: [f64; 3], ring: f64, exponents: [f64; 2]) -> Option<Self> {
        let ordinary = axes.iter().all(|a| (1e-100..=1e100).contains(a))
            && exponents.iter().all(|e| *e >= 1e-3);
        ordinary.then(|| Self {
            axes,
            inverse: axes.map(|a| 1.0 / a),
            ring,
            p: exponents.map(|e| 2.0 / e),
            half: exponents.map(|e| 0.5 * e),
        })
    }
}

struct Fill<'a> {
    layers: Layers,
    points: &'a [Lanes; 3],
    out: &'a mut Indentations,
}

/// The norm of positive pairs with both weights.
struct Norm {
    norm: Lanes,
    first: Lanes,
    second: Lanes,
}

impl Norm {
    /// Of `(u, v)`, given with `1/v`.
    #[inline(always)]
    fn new<const FUSED: bool>(u: &Lanes, v: &Lanes, inverse: &Lanes, p: f64, half: f64) -> Self {
        let mut out = Self { norm: [0.0; BLOCK], first: [0.0; BLOCK], second: [0.0; BLOCK] };
        let mut spread = [0.0; BLOCK];
        for i in 0..BLOCK {
            spread[i] = p * ln::<FUSED>(u[i] * inverse[i]);
        }
        let mut t = [0.0; BLOCK];
        for i in 0..BLOCK {
            t[i] = exp::<FUSED>(-spread[i].abs());
        }
        for i in 0..BLOCK {
            let major = 1.0 / (1.0 + t[i]);
            let minor = t[i] * major;
            let larger = if u[i] > v[i] { u[i] } else { v[i] };
            out.first[i] = if spread[i] > 0.0 { major } else { minor };
            out.second[i] = if spread[i] > 0.0 { minor } else { major };
            out.norm[i] = larger * exp::<FUSED>(half * ln::<FUSED>(1.0 + t[i]));
        }
        out
    }
}

impl Job for Fill<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { layers: k, points, out } = self;
        let none = [[0.0; BLOCK]; 3];
        let (mut inverse, mut scaled, mut unscaled) = (none, none, none);
        for j in 0..3 {
            for i in 0..BLOCK {
                let c = off_zero(points[j][i]);
                inverse[j][i] = 1.0 / c;
                scaled[j][i] = c.abs() * k.inverse[j];
                unscaled[j][i] = inverse[j][i].abs() * k.axes[j];
            }
        }
        let ([u, v, w], [_, iv, iw]) = (&scaled, &unscaled);
        let planar = Norm::new::<FUSED>(u, v, iv, k.p[1], k.half[1]);
        let (mut offset, mut size) = ([0.0; BLOCK], [0.0; BLOCK]);
        for i in 0..BLOCK {
            offset[i] = off_zero(planar.norm[i] - k.ring);
            size[i] = offset[i].abs();
        }
        let whole = Norm::new::<FUSED>(&size, w, iw, k.p[0], k.half[0]);
        for i in 0..BLOCK {
            let g = whole.norm[i];
            // on the middle of the tube there is no gradient across
            let across = if size[i] > 1e-150 {
                g * whole.first[i] * planar.norm[i] / offset[i]
            } else {
                0.0
            };
            let shares = [across * planar.first[i], across * planar.second[i], g * whole.second[i]];
            // the limit on a symmetry plane
            let share =
                |j: usize| if points[j][i] == 0.0 { 0.0 } else { shares[j] * inverse[j][i] };
            let [x, y, z] = [share(0), share(1), share(2)];
            let slope = fused::<FUSED>(x, x, fused::<FUSED>(y, y, z * z)).sqrt();
            let inside = g < 1.0 && slope > 0.0;
            let unit = 1.0 / slope;
            out.depths[i] = if inside { (1.0 - g) * unit } else { 0.0 };
            out.normals[0][i] = if inside { x * unit } else { 0.0 };
            out.normals[1][i] = if inside { y * unit } else { 0.0 };
            out.normals[2][i] = if inside { z * unit } else { 0.0 };
        }
    }
}

/// Not nearer to 0 than 1e-150: there the limits are the same, and no quotient is 0/0.
#[inline(always)]
fn off_zero(v: f64) -> f64 {
    let floor = 1e-150f64.copysign(v);
    if v.abs() < 1e-150 { floor } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Vector;
    use crate::numeric::random::Stream;

    fn agrees(solid: &impl Indented, random: &mut Stream, case: usize) {
        let [low, high] = solid.bounds();
        let size = (high - low).amax();
        let mut points = [[0.0; BLOCK]; 3];
        for i in 0..BLOCK {
            for (k, column) in points.iter_mut().enumerate() {
                column[i] = random.between(low[k], high[k]);
                if (i + k) % 7 == 0 {
                    column[i] = 0.0;
                }
            }
        }
        let (mut found, mut plain) = (Indentations::default(), Indentations::default());
        solid.indentations(&points, &mut found);
        one_by_one(solid, &points, &mut plain);
        for i in 0..BLOCK {
            let off = (found.depths[i] - plain.depths[i]).abs();
            let at = Vector::new(points[0][i], points[1][i], points[2][i]);
            assert!(off < 1e-12 * size, "case {case} {at}: {off}");
            for k in 0..3 {
                let off = (found.normals[k][i] - plain.normals[k][i]).abs();
                let on = found.depths[i] > 1e-12 * size;
                assert!(!on || off < 1e-9, "case {case} {at}: {off}");
            }
        }
    }

    #[test]
    fn columns_agree_with_one_point_after_the_other() {
        let mut random = Stream::new(10, 0);
        for case in 0..300 {
            let axes = [0; 3].map(|_| random.between(-4.0, 1.0).exp());
            let e = [0; 2].map(|_| random.between(0.1, 2.5));
            agrees(&Superellipsoid::new(axes, e).unwrap(), &mut random, case);
            let ring = random.between(1.0, 5.0);
            agrees(&Supertoroid::new(axes, ring, e).unwrap(), &mut random, case);
        }
    }

    #[test]
    fn nothing_is_not_a_number() {
        let hard = [0.0, -0.0, 5e-324, 1e-160, 0.1, -0.3, 1.0, 1e200, f64::INFINITY, f64::NAN];
        let mut random = Stream::new(11, 0);
        let mut out = Indentations::default();
        for axes in [[0.1, 0.2, 0.3], [1e-300, 1.0, 1e300], [1e100, 1e-100, 1.0]] {
            for e in [[0.1, 2.5], [1e-300, 10.0], [1.0, 1.0]] {
                let (tin, ring) = (
                    Superellipsoid::new(axes, e).unwrap(),
                    Supertoroid::new(axes, 1.0, e).unwrap(),
                );
                for _ in 0..50 {
                    let mut any = || hard[random.index(hard.len())];
                    let points = [0; 3].map(|_| [0.0; BLOCK].map(|_| any()));
                    for wide in [true, false] {
                        match wide {
                            true => tin.indentations(&points, &mut out),
                            false => ring.indentations(&points, &mut out),
                        }
                        let all = out.depths.iter().chain(out.normals.iter().flatten());
                        assert!(all.into_iter().all(|v| v.is_finite()), "{axes:?} {e:?}");
                    }
                }
            }
        }
    }
}
