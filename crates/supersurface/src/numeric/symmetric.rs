//! Eigenvalues of symmetric 3 × 3 matrices in closed form, and the axis of the least, for neighbourhoods by the thousand.
//!
//! With `q = tr A/3`, `6p² = tr (A - qI)²` and `cos 3φ = det(A - qI)/2p³`, the eigenvalues are `q + 2p cos(φ + 2πk/3)`
//! (Smith, Communications of the ACM 4, 1961). With `t = acos |cos 3φ|` the one that stands apart is `q ± 2p cos(t/3)`, by
//! the sign of `cos 3φ`. Its eigenvector is the largest cross product of two rows of `A - λI`; the other two turn in the
//! plane across it.

use nalgebra::Matrix3;

use crate::Vector;
use crate::numeric::lanes::{Job, WIDTH, arc_tangent_ratio, dispatch, sin_cos};

/// The eigenvalues of a finite symmetric matrix, rising, and a unit eigenvector of the least.
pub(crate) fn least_axis(m: &Matrix3<f64>) -> ([f64; 3], Vector) {
    let (values, axis) = eigen::<false>(&parts(m));
    (values, axis.into())
}

/// The same of many matrices, side by side in registers.
pub(crate) fn least_axes(matrices: &[Matrix3<f64>]) -> Vec<([f64; 3], Vector)> {
    let mut out = Vec::with_capacity(matrices.len());
    dispatch(LeastAxes { matrices, out: &mut out });
    out
}

struct LeastAxes<'a> {
    matrices: &'a [Matrix3<f64>],
    out: &'a mut Vec<([f64; 3], Vector)>,
}

impl Job for LeastAxes<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        for block in self.matrices.chunks(WIDTH) {
            let mut columns = [[0.0; WIDTH]; 6];
            for (i, m) in block.iter().enumerate() {
                columns.iter_mut().zip(parts(m)).for_each(|(column, part)| column[i] = part);
            }
            let mut found = [[0.0; WIDTH]; 6];
            for i in 0..WIDTH {
                let [a, b, c, d, e, f] = &columns;
                let (values, axis) = eigen::<FUSED>(&[a[i], b[i], c[i], d[i], e[i], f[i]]);
                (found[0][i], found[1][i], found[2][i]) = (values[0], values[1], values[2]);
                (found[3][i], found[4][i], found[5][i]) = (axis[0], axis[1], axis[2]);
            }
            let of = |i: usize, from: usize| [0, 1, 2].map(|k| found[from + k][i]);
            self.out.extend((0..block.len()).map(|i| (of(i, 0), of(i, 3).into())));
        }
    }
}

/// The diagonal, and what is off it in the planes across the three axes.
#[inline(always)]
fn parts(m: &Matrix3<f64>) -> [f64; 6] {
    [m[(0, 0)], m[(1, 1)], m[(2, 2)], m[(2, 1)], m[(2, 0)], m[(1, 0)]]
}

type Triple = [f64; 3];

#[inline(always)]
fn dot(a: &Triple, b: &Triple) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline(always)]
fn cross(a: &Triple, b: &Triple) -> Triple {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// One of two without a branch.
#[inline(always)]
fn either(first: bool, a: &Triple, b: &Triple) -> Triple {
    let one = |a: f64, b: f64| if first { a } else { b };
    [one(a[0], b[0]), one(a[1], b[1]), one(a[2], b[2])]
}

/// In the direction of a vector; where that is zero, of another.
#[inline(always)]
fn unit(v: &Triple, other: &Triple) -> Triple {
    let length = dot(v, v).sqrt();
    let inverse = 1.0 / length;
    either(length > 0.0, &[v[0] * inverse, v[1] * inverse, v[2] * inverse], other)
}

#[inline(always)]
fn eigen<const FUSED: bool>(m: &[f64; 6]) -> (Triple, Triple) {
    let [xx, yy, zz, yz, zx, xy] = *m;
    let x_axis = [1.0, 0.0, 0.0];
    let product = |v: &Triple| {
        [
            xx * v[0] + xy * v[1] + zx * v[2],
            xy * v[0] + yy * v[1] + yz * v[2],
            zx * v[0] + yz * v[1] + zz * v[2],
        ]
    };
    let q = (xx + yy + zz) / 3.0;
    let (a, b, c) = (xx - q, yy - q, zz - q);
    let p = ((a * a + b * b + c * c + 2.0 * (yz * yz + zx * zx + xy * xy)) / 6.0).sqrt();
    let is_ball = p <= f64::EPSILON * q.abs() || p < f64::MIN_POSITIVE;
    let unit_of = 1.0 / if is_ball { 1.0 } else { p };
    let (a, b, c) = (a * unit_of, b * unit_of, c * unit_of);
    let (d, e, f) = (yz * unit_of, zx * unit_of, xy * unit_of);
    let cosine = 0.5 * (a * (b * c - d * d) - f * (f * c - d * e) + e * (f * d - b * e));
    let is_least = cosine < 0.0;
    let size = if cosine.abs() < 1.0 { cosine.abs() } else { 1.0 };
    // acos x = 2 atan √((1 - x)/(1 + x))
    let square = (1.0 - size) / (1.0 + size);
    let third = 2.0 / 3.0 * square.sqrt() * arc_tangent_ratio::<FUSED, f64>(square);
    let out = 2.0 * p * sin_cos::<FUSED>(third).1;
    let value = q + if is_least { -out } else { out };
    let rows = [[xx - value, xy, zx], [xy, yy - value, yz], [zx, yz, zz - value]];
    let [first, second, last] =
        [cross(&rows[0], &rows[1]), cross(&rows[1], &rows[2]), cross(&rows[2], &rows[0])];
    let best = either(dot(&first, &first) > dot(&second, &second), &first, &second);
    let best = either(dot(&best, &best) > dot(&last, &last), &best, &last);
    let apart = unit(&best, &x_axis);
    // the other two by the block in the plane across it, which keeps their digits where they are alike
    let helper = either(apart[0].abs() < 0.7, &x_axis, &[0.0, 1.0, 0.0]);
    let along = dot(&apart, &helper);
    let across: Triple =
        [helper[0] - apart[0] * along, helper[1] - apart[1] * along, helper[2] - apart[2] * along];
    let u = unit(&across, &x_axis);
    let w = cross(&apart, &u);
    let (mu, mw, out) = (product(&u), product(&w), product(&apart));
    let (uu, ww, mixed) = (dot(&u, &mu), dot(&w, &mw), dot(&u, &mw));
    let (middle, half) = (0.5 * (uu + ww), 0.5 * (uu - ww));
    let spread = (half * half + mixed * mixed).sqrt();
    // of the block's two rows the one that keeps its digits
    let (s, t) = if half > 0.0 { (-mixed, half + spread) } else { (spread - half, -mixed) };
    let lower = unit(&[s * u[0] + t * w[0], s * u[1] + t * w[1], s * u[2] + t * w[2]], &u);
    let value = dot(&apart, &out);
    let pair = [middle - spread, middle + spread];
    let values = either(is_least, &[value, pair[0], pair[1]], &[pair[0], pair[1], value]);
    let axis = either(is_least, &apart, &lower);
    (either(is_ball, &[q; 3], &values), either(is_ball, &x_axis, &axis))
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, SymmetricEigen};

    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn agrees_with_iteration() {
        let mut random = Stream::new(4, 0);
        let kinds = [
            [1.0, 2.0, 3.0],
            [1e-8, 1.0, 1.0],
            [1e-9, 1e-3, 1.0],
            [0.2, 0.2, 1.0],
            [0.3, 1.0, 1.0 + 1e-9],
        ];
        for k in 0..500 {
            let turn = Rotation3::new(Vector::from_fn(|_, _| random.between(-3.0, 3.0)));
            let values = Vector::from(kinds[k % kinds.len()]) * 10f64.powi(k as i32 % 7 - 3);
            let m = turn.matrix() * Matrix3::from_diagonal(&values) * turn.matrix().transpose();
            let m = 0.5 * (m + m.transpose());
            let (found, axis) = least_axis(&m);
            let many = least_axes(&[m; WIDTH + 1]);
            let (same, beside) = many[WIDTH];
            assert!((0..3).all(|i| (same[i] - found[i]).abs() < 1e-13 * values.max()));
            assert!((m * beside - beside * same[0]).norm() < 1e-13 * values.max(), "{values}");
            let mut known: Vec<f64> = SymmetricEigen::new(m).eigenvalues.iter().copied().collect();
            known.sort_by(f64::total_cmp);
            for i in 0..3 {
                assert!((found[i] - known[i]).abs() < 1e-13 * values.max(), "{found:?} {known:?}");
            }
            assert!((m * axis - axis * known[0]).norm() < 1e-13 * values.max(), "{values}");
            assert!((axis.norm() - 1.0).abs() < 1e-12);
        }
        for m in [Matrix3::zeros(), Matrix3::identity() * 1e-300, Matrix3::identity() * 4.0] {
            let (values, axis) = least_axis(&m);
            assert!(axis.norm() == 1.0 && values == [m[0]; 3]);
        }
    }
}
