//! The kernel over many points: columns in, columns out, eight points at a time without a branch.
//!
//! The same formulas as [`super::kernel`], which is the reference in the test.

use super::parameters::{COUNT, EXPONENT, Family, Parameters, RING};
use crate::Vector;
use crate::numeric::lanes::{Job, WIDTH, dispatch, exp, ln};

/// Points as columns, padded with far points to a multiple of [`WIDTH`].
#[derive(Clone, Debug, Default)]
pub(super) struct Sample {
    columns: [Vec<f64>; 3],
    count: usize,
}

/// Where padding stands: far from any body in normalised coordinates.
const PADDING: f64 = 50.0;

impl Sample {
    pub(super) fn new(points: impl Iterator<Item = Vector>) -> Self {
        let mut sample = Self::default();
        sample.set(points);
        sample
    }

    /// Takes other points.
    pub(super) fn set(&mut self, points: impl Iterator<Item = Vector>) {
        let [x, y, z] = &mut self.columns;
        for column in [&mut *x, y, z] {
            column.clear();
        }
        for p in points {
            x.push(p.x);
            y.push(p.y);
            z.push(p.z);
        }
        self.count = x.len();
        let padded = self.count.next_multiple_of(WIDTH);
        for column in [x, y, z] {
            column.resize(padded, PADDING);
        }
    }

    /// Number of points without padding.
    pub(super) const fn len(&self) -> usize {
        self.count
    }

    pub(super) fn point(&self, i: usize) -> Vector {
        Vector::new(self.columns[0][i], self.columns[1][i], self.columns[2][i])
    }
}

/// First-order distances and their derivatives, a column a parameter; padded like the sample.
#[derive(Clone, Debug, Default)]
pub(super) struct Evaluation {
    pub(super) distances: Vec<f64>,
    pub(super) rows: [Vec<f64>; COUNT],
}

/// What stands in for a distance that is not a number: far away.
const FAR: f64 = 10.0;

impl Evaluation {
    /// Distances and derivatives of all points of `sample`.
    pub(super) fn fill(&mut self, s: &Parameters, sample: &Sample) {
        let padded = sample.columns[0].len();
        self.distances.resize(padded, 0.0);
        for row in &mut self.rows {
            row.resize(padded, 0.0);
        }
        match s.family {
            Family::Superellipsoid => dispatch(Fill::<false, true> { s, sample, out: self }),
            Family::Supertoroid => dispatch(Fill::<true, true> { s, sample, out: self }),
        }
    }

    /// Distances alone.
    pub(super) fn fill_distances(&mut self, s: &Parameters, sample: &Sample) {
        self.distances.resize(sample.columns[0].len(), 0.0);
        match s.family {
            Family::Superellipsoid => dispatch(Fill::<false, false> { s, sample, out: self }),
            Family::Supertoroid => dispatch(Fill::<true, false> { s, sample, out: self }),
        }
    }
}

struct Fill<'a, const TOROID: bool, const JACOBIAN: bool> {
    s: &'a Parameters,
    sample: &'a Sample,
    out: &'a mut Evaluation,
}

/// One block of results.
struct Block {
    distance: [f64; WIDTH],
    rows: [[f64; WIDTH]; COUNT],
}

impl<const TOROID: bool, const JACOBIAN: bool> Job for Fill<'_, TOROID, JACOBIAN> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [x, y, z] = &self.sample.columns;
        let blocks = x.as_chunks::<WIDTH>().0.iter().zip(y.as_chunks::<WIDTH>().0);
        let blocks = blocks.zip(z.as_chunks::<WIDTH>().0).enumerate();
        let mut block = Block { distance: [0.0; WIDTH], rows: [[0.0; WIDTH]; COUNT] };
        for (b, ((x, y), z)) in blocks {
            evaluate::<FUSED, TOROID, JACOBIAN>(self.s, [x, y, z], &mut block);
            let at = b * WIDTH..(b + 1) * WIDTH;
            self.out.distances[at.clone()].copy_from_slice(&block.distance);
            if !JACOBIAN {
                continue;
            }
            for (column, values) in self.out.rows.iter_mut().zip(&block.rows) {
                column[at.clone()].copy_from_slice(values);
            }
        }
    }
}

/// Weights of two arguments given by their logarithms, as [`crate::numeric::superellipse::log_layer`]:
/// `(log norm, first, second, entropy, spread)`.
#[inline(always)]
fn layer<const FUSED: bool>(u: f64, v: f64, p: f64) -> (f64, f64, f64, f64, f64) {
    let spread = p * (u - v);
    let t = exp::<FUSED>(-spread.abs());
    let l = ln::<FUSED>(1.0 + t);
    let major = 1.0 / (1.0 + t);
    let minor = t * major;
    let (first, second) = if spread > 0.0 { (major, minor) } else { (minor, major) };
    let larger = if u > v { u } else { v };
    (larger + l / p, first, second, l + spread.abs() * minor, spread)
}

/// Not nearer to a symmetry plane than 1e-7: the limits are the same.
#[inline(always)]
fn off_plane(v: f64) -> f64 {
    let floor = 1e-7f64.copysign(v);
    if v.abs() < 1e-7 { floor } else { v }
}

#[inline(always)]
fn finite(v: f64, otherwise: f64) -> f64 {
    if v.abs() < 1e100 { v } else { otherwise }
}

#[inline(always)]
fn evaluate<const FUSED: bool, const TOROID: bool, const JACOBIAN: bool>(
    s: &Parameters,
    [x, y, z]: [&[f64; WIDTH]; 3],
    out: &mut Block,
) {
    let r = s.rotation.matrix();
    let t = s.position;
    let [l1, l2, l3] = s.log_axes;
    let [e1, e2] = s.exponents;
    let (p1, p2) = (2.0 / e1, 2.0 / e2);
    for i in 0..WIDTH {
        let (dx, dy, dz) = (x[i] - t.x, y[i] - t.y, z[i] - t.z);
        let qx = off_plane(r.m11 * dx + r.m21 * dy + r.m31 * dz);
        let qy = off_plane(r.m12 * dx + r.m22 * dy + r.m32 * dz);
        let qz = off_plane(r.m13 * dx + r.m23 * dy + r.m33 * dz);
        let (ix, iy, iz) = (1.0 / qx, 1.0 / qy, 1.0 / qz);
        let (log_planar, planar1, planar2, planar_entropy, planar_spread) =
            layer::<FUSED>(ln::<FUSED>(qx.abs()) - l1, ln::<FUSED>(qy.abs()) - l2, p2);
        let radius = if TOROID { exp::<FUSED>(log_planar) } else { 1.0 };
        let offset = if TOROID { off_plane(radius - s.ring) } else { 1.0 };
        let log_offset = if TOROID { ln::<FUSED>(offset.abs()) } else { log_planar };
        let (log_gauge, whole1, whole2, whole_entropy, whole_spread) =
            layer::<FUSED>(log_offset, ln::<FUSED>(qz.abs()) - l3, p1);
        let g = exp::<FUSED>(log_gauge);
        let slope = if TOROID { radius / offset } else { 1.0 };
        let across = g * whole1 * slope;
        let (vx, vy, vz) = (across * planar1 * ix, across * planar2 * iy, g * whole2 * iz);
        let square = vx * vx + vy * vy + vz * vz;
        let square = if square < 1e-18 { 1e-18 } else { square };
        let by_gauge = 1.0 / square.sqrt();
        let d = (g - 1.0) * by_gauge;
        let usable = d.abs() < 1e100;
        out.distance[i] = if usable { d } else { FAR };
        if !JACOBIAN {
            continue;
        }

        let inverse = by_gauge * by_gauge;
        let (bx, by, bz) = (vx * vx * inverse, vy * vy * inverse, vz * vz * inverse);
        let by_s1 = -d * ((bx + by) * whole2 - bz * whole1);
        let by_s2 = -d * (bx * planar2 - by * planar1);
        let by_ring = if TOROID { -d * (bx + by) } else { 0.0 };
        let by_offset = by_gauge * whole1 + by_s1 * p1 - by_ring;
        let by_radius = by_ring + by_offset * slope;
        let by_x = by_radius * planar1 + by_s2 * p2;
        let by_y = by_radius * planar2 - by_s2 * p2;
        let by_z = by_gauge * whole2 - by_s1 * p1;
        let (ux, uy, uz) = ((by_x + d * bx) * ix, (by_y + d * by) * iy, (by_z + d * bz) * iz);

        let keep = |v: f64| if usable { finite(v, 0.0) } else { 0.0 };
        out.rows[0][i] = keep(-by_x);
        out.rows[1][i] = keep(-by_y);
        out.rows[2][i] = keep(-by_z);
        out.rows[RING][i] = if TOROID { keep(-by_offset / offset) } else { 0.0 };
        out.rows[EXPONENT][i] = keep(0.5 * by_gauge * whole_entropy - by_s1 * whole_spread / e1);
        out.rows[EXPONENT + 1][i] =
            keep(0.5 * by_radius * planar_entropy - by_s2 * planar_spread / e2);
        out.rows[6][i] = keep(-(r.m11 * ux + r.m12 * uy + r.m13 * uz));
        out.rows[7][i] = keep(-(r.m21 * ux + r.m22 * uy + r.m23 * uz));
        out.rows[8][i] = keep(-(r.m31 * ux + r.m32 * uy + r.m33 * uz));
        out.rows[9][i] = keep(uy * qz - uz * qy);
        out.rows[10][i] = keep(uz * qx - ux * qz);
        out.rows[11][i] = keep(ux * qy - uy * qx);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::kernel::distance;
    use crate::numeric::random::Stream;
    use nalgebra::Rotation3;

    #[test]
    fn columns_agree_with_the_kernel() {
        let mut random = Stream::new(5, 0);
        let mut worst = 0.0f64;
        for case in 0..200 {
            let family = if case % 2 == 0 { Family::Superellipsoid } else { Family::Supertoroid };
            let s = Parameters {
                family,
                log_axes: std::array::from_fn(|_| random.between(-1.5, 0.5)),
                ring: random.between(1.2, 5.0),
                exponents: std::array::from_fn(|_| random.between(0.1, 1.9)),
                position: Vector::from_fn(|_, _| random.between(-0.3, 0.3)),
                rotation: Rotation3::new(Vector::from_fn(|_, _| random.normal())),
            };
            let points: Vec<Vector> =
                (0..21).map(|_| Vector::from_fn(|_, _| random.between(-2.0, 2.0))).collect();
            let mut all = Evaluation::default();
            all.fill(&s, &Sample::new(points.iter().copied()));
            for (i, x) in points.iter().enumerate() {
                let mut row = [0.0; COUNT];
                let d = distance::<true>(&s, x, &mut row);
                if !d.is_finite() || d.abs() > 5.0 {
                    continue;
                }
                let scale = 1.0 + row.iter().fold(0.0f64, |m, v| m.max(v.abs()));
                worst = worst.max((all.distances[i] - d).abs() / (1.0 + d.abs()));
                for (k, v) in row.iter().enumerate().filter(|(k, _)| s.is_active(*k)) {
                    worst = worst.max((all.rows[k][i] - v).abs() / scale);
                }
            }
        }
        assert!(worst < 1e-9, "{worst}");
    }
}
