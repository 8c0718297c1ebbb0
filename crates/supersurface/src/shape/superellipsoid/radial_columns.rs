//! The hot loop: radial distances of many points with all derivatives, in stages without a branch.
//!
//! The same mathematics as [`super::radial`], which is the reference in the test, in logarithms: per layer
//! `s = p (ln u - ln v)`, `t = e^-|s|`, `l = ln(1 + t)`, norm `e^(max + l/p)`, weights `1/(1 + t)` and `t/(1 + t)`, entropy
//! `l + |s| t/(1 + t)`. Columns in, the caller's columns out; nothing is allocated once these have their length.

use super::Superellipsoid;
use super::radial::PARAMETERS;
use crate::numeric::lanes::{Job, dispatch, exp, fused, ln};
use crate::shape::Posed;

/// Points as columns of the same length, in metres.
#[derive(Clone, Copy, Debug)]
pub struct Columns<'a> {
    /// First coordinates.
    pub x: &'a [f64],
    /// Second coordinates.
    pub y: &'a [f64],
    /// Third coordinates.
    pub z: &'a [f64],
}

/// Distances of many points with their derivatives, a column a parameter.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Jacobians {
    /// Signed distances in metres.
    pub residuals: Vec<f64>,
    /// Derivatives by `a1, a2, a3, ε1, ε2, tx, ty, tz, rx, ry, rz`.
    pub columns: [Vec<f64>; PARAMETERS],
}

impl Posed<Superellipsoid> {
    /// Radial distances of many world points with their derivatives, as [`Self::radial_jacobian`] defines them, up
    /// to rounding; points within 1e-150 m of a symmetry plane count as that far off it. The columns may differ in
    /// length: the shortest counts. A point that is not finite has a residual that is not finite.
    ///
    /// ```
    /// use supersurface::Pose;
    /// use supersurface::shape::{Posed, Superellipsoid, superellipsoid::{Columns, Jacobians}};
    /// let ball = Posed::new(Superellipsoid::new([1.0; 3], [1.0, 1.0])?, Pose::identity())?;
    /// let mut out = Jacobians::default();
    /// ball.radial_jacobians(&Columns { x: &[3.0, 0.5], y: &[0.0; 2], z: &[0.0; 2] }, &mut out);
    /// assert!((out.residuals[0] - 2.0).abs() < 1e-14 && (out.columns[5][1] + 1.0).abs() < 1e-14);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    pub fn radial_jacobians(&self, points: &Columns<'_>, out: &mut Jacobians) {
        let Columns { x, y, z } = *points;
        let count = x.len().min(y.len()).min(z.len());
        let points = &Columns { x: &x[..count], y: &y[..count], z: &z[..count] };
        out.residuals.resize(count, 0.0);
        for column in &mut out.columns {
            column.resize(count, 0.0);
        }
        dispatch(Fill { body: self, points, count, out });
    }
}

struct Fill<'a> {
    body: &'a Posed<Superellipsoid>,
    points: &'a Columns<'a>,
    count: usize,
    out: &'a mut Jacobians,
}

/// Points that go through the stages together: enough that the machine works on several registers' worth of a stage
/// at once instead of waiting for one, few enough that all stays in the first cache.
const BLOCK: usize = 64;
type Lanes = [f64; BLOCK];

impl Job for Fill<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let constants = Constants::of(self.body);
        let Columns { x, y, z } = *self.points;
        let chunks = x.as_chunks::<BLOCK>().0.iter().zip(y.as_chunks::<BLOCK>().0);
        let chunks = chunks.zip(z.as_chunks::<BLOCK>().0);
        let mut stages = Stages::new();
        for (b, ((x, y), z)) in chunks.enumerate() {
            stages.run::<FUSED>(&constants, [x, y, z]);
            stages.store(self.out, b * BLOCK, BLOCK);
        }
        let at = self.count / BLOCK * BLOCK;
        let rest = self.count - at;
        if rest > 0 {
            let load = |c: &[f64]| {
                let mut lanes = [c[at]; BLOCK];
                lanes[..rest].copy_from_slice(&c[at..at + rest]);
                lanes
            };
            stages.run::<FUSED>(&constants, [&load(x), &load(y), &load(z)]);
            stages.store(self.out, at, rest);
        }
    }
}

/// What is the same for all points.
struct Constants {
    /// Rows of the rotation matrix.
    r: [[f64; 3]; 3],
    t: [f64; 3],
    /// Semi-axes and their reciprocals.
    axes: [f64; 3],
    inverse: [f64; 3],
    /// `2/ε`, and `ε/2`.
    p: [f64; 2],
    half: [f64; 2],
}

impl Constants {
    fn of(body: &Posed<Superellipsoid>) -> Self {
        let m = body.pose().rotation.to_rotation_matrix().into_inner();
        let shape = body.shape();
        Self {
            r: std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)])),
            t: body.pose().translation.vector.into(),
            axes: shape.semi_axes,
            inverse: shape.semi_axes.map(|a| 1.0 / a),
            p: shape.exponents.map(|e| 2.0 / e),
            half: shape.exponents.map(|e| 0.5 * e),
        }
    }
}

/// One layer of a gauge.
struct Layer {
    norm: Lanes,
    first: Lanes,
    second: Lanes,
    entropy: Lanes,
}

impl Layer {
    const fn new() -> Self {
        Self {
            norm: [0.0; BLOCK],
            first: [0.0; BLOCK],
            second: [0.0; BLOCK],
            entropy: [0.0; BLOCK],
        }
    }

    /// The layer of positive pairs `(u, v)`, given with `1/v`.
    #[inline(always)]
    fn run<const FUSED: bool>(&mut self, u: &Lanes, v: &Lanes, inverse: &Lanes, p: f64, half: f64) {
        let mut spread = [0.0; BLOCK];
        for i in 0..BLOCK {
            spread[i] = p * ln::<FUSED>(u[i] * inverse[i]);
        }
        let mut t = [0.0; BLOCK];
        for i in 0..BLOCK {
            t[i] = exp::<FUSED>(-spread[i].abs());
        }
        let mut l = [0.0; BLOCK];
        for i in 0..BLOCK {
            l[i] = ln::<FUSED>(1.0 + t[i]);
        }
        for i in 0..BLOCK {
            let major = 1.0 / (1.0 + t[i]);
            let minor = t[i] * major;
            let larger = if u[i] > v[i] { u[i] } else { v[i] };
            self.first[i] = if spread[i] > 0.0 { major } else { minor };
            self.second[i] = if spread[i] > 0.0 { minor } else { major };
            self.entropy[i] = fused::<FUSED>(spread[i].abs(), minor, l[i]);
            self.norm[i] = larger * exp::<FUSED>(l[i] * half);
        }
    }
}

/// What a block of points goes through.
struct Stages {
    /// Points in the body's frame, their reciprocals, and their magnitudes over the semi-axes with the
    /// reciprocals of these.
    q: [Lanes; 3],
    inverse: [Lanes; 3],
    scaled: [Lanes; 3],
    unscaled: [Lanes; 3],
    planar: Layer,
    whole: Layer,
    residuals: Lanes,
    columns: [Lanes; PARAMETERS],
}

impl Stages {
    const fn new() -> Self {
        let none = [[0.0; BLOCK]; 3];
        Self {
            q: none,
            inverse: none,
            scaled: none,
            unscaled: none,
            planar: Layer::new(),
            whole: Layer::new(),
            residuals: [0.0; BLOCK],
            columns: [[0.0; BLOCK]; PARAMETERS],
        }
    }

    #[inline(always)]
    fn run<const FUSED: bool>(&mut self, k: &Constants, [x, y, z]: [&Lanes; 3]) {
        for j in 0..3 {
            for i in 0..BLOCK {
                let d = [x[i] - k.t[0], y[i] - k.t[1], z[i] - k.t[2]];
                let q = off_plane(dot::<FUSED>([k.r[0][j], k.r[1][j], k.r[2][j]], d));
                let inverse = 1.0 / q;
                self.q[j][i] = q;
                self.inverse[j][i] = inverse;
                self.scaled[j][i] = q.abs() * k.inverse[j];
                self.unscaled[j][i] = inverse.abs() * k.axes[j];
            }
        }
        let ([u, v, w], [_, iv, iw]) = (&self.scaled, &self.unscaled);
        self.planar.run::<FUSED>(u, v, iv, k.p[1], k.half[1]);
        self.whole.run::<FUSED>(&self.planar.norm, w, iw, k.p[0], k.half[0]);
        let Self { q, inverse, planar, whole, residuals, columns, .. } = self;
        for i in 0..BLOCK {
            let q = [q[0][i], q[1][i], q[2][i]];
            let length = dot::<FUSED>(q, q).sqrt();
            let beta = 1.0 / whole.norm[i];
            let scale = length * beta;
            let along = (1.0 - beta) / length;
            let across = scale * whole.first[i];
            let shares =
                [across * planar.first[i], across * planar.second[i], scale * whole.second[i]];
            let by_q = [
                fused::<FUSED>(shares[0], inverse[0][i], q[0] * along),
                fused::<FUSED>(shares[1], inverse[1][i], q[1] * along),
                fused::<FUSED>(shares[2], inverse[2][i], q[2] * along),
            ];
            residuals[i] = length - scale;
            columns[0][i] = -shares[0] * k.inverse[0];
            columns[1][i] = -shares[1] * k.inverse[1];
            columns[2][i] = -shares[2] * k.inverse[2];
            columns[3][i] = 0.5 * scale * whole.entropy[i];
            columns[4][i] = 0.5 * across * planar.entropy[i];
            columns[5][i] = -dot::<FUSED>(k.r[0], by_q);
            columns[6][i] = -dot::<FUSED>(k.r[1], by_q);
            columns[7][i] = -dot::<FUSED>(k.r[2], by_q);
            columns[8][i] = by_q[1] * q[2] - by_q[2] * q[1];
            columns[9][i] = by_q[2] * q[0] - by_q[0] * q[2];
            columns[10][i] = by_q[0] * q[1] - by_q[1] * q[0];
        }
    }

    fn store(&self, out: &mut Jacobians, at: usize, count: usize) {
        out.residuals[at..at + count].copy_from_slice(&self.residuals[..count]);
        for (column, values) in out.columns.iter_mut().zip(&self.columns) {
            column[at..at + count].copy_from_slice(&values[..count]);
        }
    }
}

#[inline(always)]
fn dot<const FUSED: bool>(a: [f64; 3], b: [f64; 3]) -> f64 {
    fused::<FUSED>(a[2], b[2], fused::<FUSED>(a[1], b[1], a[0] * b[0]))
}

/// Not nearer to a symmetry plane than 1e-150: there the limits are the same, and no quotient is 0/0.
#[inline(always)]
fn off_plane(v: f64) -> f64 {
    let floor = 1e-150f64.copysign(v);
    if v.abs() < 1e-150 { floor } else { v }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::{Point, Pose, Vector};

    #[test]
    fn columns_agree_with_the_plain_version() {
        let mut random = Stream::new(9, 0);
        let mut out = Jacobians::default();
        for case in 0..400 {
            let mut between = |low: f64, high: f64| random.between(low, high);
            let axes = std::array::from_fn(|_| between(-4.0, 0.0).exp());
            let shape = Superellipsoid::new(axes, [between(0.1, 2.5), between(0.1, 2.5)]).unwrap();
            let mut vector = |size: f64| Vector::from([0; 3].map(|_| between(-size, size)));
            let body = Posed::new(shape, Pose::new(vector(1.0), vector(3.0))).unwrap();
            let count = case % 133 + 1;
            let points: Vec<Point> = (0..count).map(|_| Point::from(vector(2.0))).collect();
            let column = |k: usize| points.iter().map(|p| p[k]).collect::<Vec<f64>>();
            let (x, y, z) = (column(0), column(1), column(2));
            body.radial_jacobians(&Columns { x: &x, y: &y, z: &z }, &mut out);
            assert_eq!(out.residuals.len(), count);
            for (i, p) in points.iter().enumerate() {
                let (residual, row) = body.radial_jacobian(p);
                let size = residual.abs().max(1.0);
                assert!((out.residuals[i] - residual).abs() < 1e-12 * size, "case {case}");
                let largest = row.iter().fold(0.0f64, |m, v| m.max(v.abs()));
                for (k, v) in row.iter().enumerate() {
                    let error = (out.columns[k][i] - v).abs();
                    assert!(error < 1e-10 * largest, "case {case} parameter {k}: {error}");
                }
            }
        }
    }

    #[test]
    fn nothing_is_not_a_number_for_finite_points() {
        let shape = Superellipsoid::new([0.1, 0.2, 0.3], [0.1, 2.5]).unwrap();
        let body = Posed::new(shape, Pose::identity()).unwrap();
        let hard = [0.0, -0.0, 1e-320, 1e-160, 1e-9, 0.1, -0.2, 1e9, 1e100];
        let mut out = Jacobians::default();
        for x in hard {
            for y in hard {
                let columns = Columns { x: &[x; 9], y: &[y; 9], z: &hard };
                body.radial_jacobians(&columns, &mut out);
                let all = out.residuals.iter().chain(out.columns.iter().flatten());
                assert!(all.into_iter().all(|v| v.is_finite()), "{x} {y} {out:?}");
            }
        }
    }
}
