//! Depths and normals of a block of points; [`Indented::indentation`] is the reference.

use super::gauge_columns::{Lanes, Layers, Stages};
use super::indentation::{BLOCK, Indentations};
use crate::numeric::lanes::{Job, dispatch, fused};

#[cfg(doc)]
use super::indentation::Indented;

pub(super) fn fill(layers: Layers, points: &[Lanes; 3], out: &mut Indentations) {
    dispatch(Fill { layers, points, out });
}

struct Fill<'a> {
    layers: Layers,
    points: &'a [Lanes; 3],
    out: &'a mut Indentations,
}

impl Job for Fill<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Stages { whole, gradient: [x, y, z], .. } =
            Stages::new::<FUSED>(&self.layers, self.points);
        let Indentations { depths, normals: [nx, ny, nz] } = self.out;
        for i in 0..BLOCK {
            let square = fused::<FUSED>(x[i], x[i], fused::<FUSED>(y[i], y[i], z[i] * z[i]));
            let slope = square.sqrt();
            let room = 1.0 - whole.norm[i];
            let inside = room > 0.0 && slope > 0.0;
            let unit = 1.0 / slope;
            depths[i] = if inside { room * unit } else { 0.0 };
            nx[i] = if inside { x[i] * unit } else { 0.0 };
            ny[i] = if inside { y[i] * unit } else { 0.0 };
            nz[i] = if inside { z[i] * unit } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::elastic::indentation::{Indented, one_by_one, point_of};
    use crate::numeric::random::Stream;
    use crate::shape::{Superellipsoid, Supertoroid};

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
            let at = point_of(&points, i);
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
