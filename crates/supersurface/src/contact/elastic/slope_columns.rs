//! Derivatives of the indentations of a block of points; [`SmoothlyIndented::slope`] is the reference.
//!
//! The gauge is a norm of a norm, so its second derivatives are two outer products: with `d = (1/x, -1/y, 0)` and
//! `e = (∇ρ̂/τ, -1/z)`
//!
//! ```text
//! H = (p1 - 1) g w1 (1 - w1) e eᵀ + g w1/τ (p2 - 1) ρ̂ w2 (1 - w2) d dᵀ
//! ```

use super::gauge_columns::{Lanes, Layers, NEAR, Stages};
use super::indentation::BLOCK;
use super::indentation_slope::IndentationSlopes;
use crate::numeric::lanes::{Job, dispatch, fused};

#[cfg(doc)]
use super::indentation_slope::SmoothlyIndented;

pub(super) fn fill(layers: Layers, points: &[Lanes; 3], out: &mut IndentationSlopes) {
    dispatch(Fill { layers, points, out });
}

struct Fill<'a> {
    layers: Layers,
    points: &'a [Lanes; 3],
    out: &'a mut IndentationSlopes,
}

impl Job for Fill<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Self { layers, points: [px, py, pz], out } = self;
        let stages = Stages::new::<FUSED>(&layers, self.points);
        let Stages { inverse: [ix, iy, iz], planar, offset, whole, gradient: [x, y, z] } = &stages;
        let [p1, p2] = layers.powers;
        // at a pole the curvature is 0 or that of an ellipsoid, or there is none
        let no_pole = p1 < 2.0 || (p1 == 2.0 && p2 != 2.0);
        for i in 0..BLOCK {
            let (g, w, v) = (whole.norm[i], whole.first[i], planar.first[i]);
            let (rest, other) = (whole.second[i], planar.second[i]);
            let across = 1.0 / offset[i];
            let rise = planar.norm[i] * across;
            let e = [rise * v * ix[i], rise * other * iy[i], -iz[i]];
            let d = [ix[i], -iy[i], 0.0];
            let square = fused::<FUSED>(x[i], x[i], fused::<FUSED>(y[i], y[i], z[i] * z[i]));
            let room = 1.0 - g;
            let inside = room > 0.0 && square > 0.0;
            let scale = room / square;
            let unit = 1.0 / square.sqrt();
            let n = [x[i] * unit, y[i] * unit, z[i] * unit];
            let (no_x, no_y) = (px[i] == 0.0, py[i] == 0.0);
            let pole = no_x && no_y;
            let planar_plane = (no_x || no_y) && !pole;
            let whole_plane = pz[i] == 0.0 || offset[i].abs() <= NEAR || pole;
            let seam = if pole { no_pole } else { planar_plane && p2 < 2.0 }
                || (whole_plane && !pole && p1 < 2.0);
            // flat across a symmetry plane
            let flat_e = whole_plane && p1 > 2.0;
            let flat_d = (planar_plane && p2 > 2.0) || (pole && p1 > 2.0);
            let by_e = scale * (p1 - 1.0) * g * w * rest;
            let by_d = scale * g * w * across * (p2 - 1.0) * planar.norm[i] * v * other;
            let by_e = if seam || flat_e { 0.0 } else { by_e };
            let by_d = if seam || flat_d { 0.0 } else { by_d };
            let (en, dn) = (dot::<FUSED>(e, n), dot::<FUSED>(d, n));
            for r in 0..3 {
                let left_e = by_e * fused::<FUSED>(-2.0 * en, n[r], e[r]);
                let left_d = by_d * fused::<FUSED>(-2.0 * dn, n[r], d[r]);
                out.vectors[r][i] = if inside { n[r] * room * unit } else { 0.0 };
                for c in 0..3 {
                    let bent = fused::<FUSED>(left_e, e[c], left_d * d[c]);
                    let slope = fused::<FUSED>(-n[r], n[c], bent);
                    out.by_point[r][c][i] = if inside { slope } else { 0.0 };
                }
            }
            out.without_curvature[i] = if inside && seam { 1.0 } else { 0.0 };
        }
    }
}

#[inline(always)]
fn dot<const FUSED: bool>(a: [f64; 3], b: [f64; 3]) -> f64 {
    fused::<FUSED>(a[2], b[2], fused::<FUSED>(a[1], b[1], a[0] * b[0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::elastic::indentation::point_of;
    use crate::contact::elastic::indentation_slope::{SmoothlyIndented, one_by_one};
    use crate::numeric::random::Stream;
    use crate::shape::{Superellipsoid, Supertoroid};

    fn agrees(solid: &impl SmoothlyIndented, random: &mut Stream, case: usize) -> usize {
        let [low, high] = solid.bounds();
        let mut points = [[0.0; BLOCK]; 3];
        for i in 0..BLOCK {
            for (k, column) in points.iter_mut().enumerate() {
                column[i] = random.between(low[k], high[k]);
                if (i + k) % 7 == 0 || (i % 13 == 0 && k < 2) {
                    column[i] = 0.0;
                }
            }
        }
        let (mut found, mut plain) = (IndentationSlopes::default(), IndentationSlopes::default());
        solid.slopes(&points, &mut found);
        one_by_one(solid, &points, &mut plain);
        assert_eq!(found.without_curvature, plain.without_curvature, "case {case}");
        for i in 0..BLOCK {
            let at = point_of(&points, i);
            let size = plain.by_point.iter().flatten().fold(1.0f64, |m, c| m.max(c[i].abs()));
            for r in 0..3 {
                let off = (found.vectors[r][i] - plain.vectors[r][i]).abs();
                assert!(off < 1e-12 * (high - low).amax(), "case {case} {at}: {off}");
                for c in 0..3 {
                    let off = (found.by_point[r][c][i] - plain.by_point[r][c][i]).abs();
                    assert!(off < 1e-9 * size, "case {case} {at} {r}{c}: {off} of {size}");
                }
            }
        }
        plain.without_curvature.iter().filter(|v| **v > 0.0).count()
    }

    #[test]
    fn columns_agree_with_one_point_after_the_other() {
        let mut random = Stream::new(12, 0);
        let mut seams = 0;
        for case in 0..300 {
            let axes = [0; 3].map(|_| random.between(-4.0, 1.0).exp());
            let mut e = [0; 2].map(|_| random.between(0.1, 1.95));
            if case % 5 == 0 {
                e[case % 2] = 1.0;
            }
            seams += agrees(&Superellipsoid::new(axes, e).unwrap(), &mut random, case);
            let ring = random.between(1.0, 5.0);
            seams += agrees(&Supertoroid::new(axes, ring, e).unwrap(), &mut random, case);
        }
        assert!(seams > 100, "{seams}");
    }
}
