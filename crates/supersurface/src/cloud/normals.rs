//! Which way does the surface face? Normals of a cloud from each point's neighbourhood.
//!
//! The normal of a point is the eigenvector of the smallest eigenvalue of the covariance
//! sum (q - m)(q - m)^T of the points q within a radius, m their mean, turned towards the sensor
//! (or, without one, away from the cloud's centroid).

use nalgebra::Matrix3;

use crate::cloud::{PointCloud, VoxelGrid};
use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, WIDEST, dispatch};
use crate::numeric::symmetric::{least_axes, least_axis};
use crate::{Direction, Point, Vector};

/// Normals at the points named by `indices`, from neighbours within `radius` (metres) among the same
/// points. `None` where fewer than five neighbours are found or they lie on a line.
///
/// ```
/// use supersurface::{Point, cloud::{PointCloud, normals}};
/// let points = (0..100).map(|i| Point::new(0.01 * f64::from(i % 10), 0.01 * f64::from(i / 10), 0.5));
/// let mut cloud = PointCloud::from_points(points.collect());
/// cloud.viewpoint = Some(Point::origin());
/// let all: Vec<u32> = (0..100).collect();
/// assert!(normals(&cloud, &all, 0.03).iter().all(|n| n.is_some_and(|n| n.z < -0.999)));
/// ```
pub fn normals(cloud: &PointCloud, indices: &[u32], radius: f64) -> Vec<Option<Direction>> {
    let Some(grid) = VoxelGrid::new(&cloud.points, indices.iter().copied(), radius) else {
        return vec![None; indices.len()];
    };
    let all = indices.iter().filter_map(|i| cloud.points.get(*i as usize));
    let finite = all.filter(|p| p.coords.iter().all(|c| c.is_finite()));
    let (sum, count) = finite.fold((Vector::zeros(), 0.0), |(s, n), p| (s + p.coords, n + 1.0));
    let centroid = Point::from(sum / f64::max(count, 1.0));
    let at = |i: &u32| {
        let p = cloud.points.get(*i as usize)?;
        let mut near = Neighbourhood::default();
        grid.within(p, radius, |j, _| near.add(&(cloud.points[j as usize] - p)));
        near.normal(&cloud.viewpoint.map_or_else(|| p - centroid, |eye| eye - p))
    };
    indices.iter().map(at).collect()
}

/// Moments of what is about a point.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Neighbourhood {
    sum: [f64; 3],
    square: [f64; 3],
    mixed: [f64; 3],
    count: f64,
}

impl Neighbourhood {
    /// Adds a point, the middle one too, by its place beside that.
    pub(crate) fn add(&mut self, d: &Vector) {
        for k in 0..3 {
            self.sum[k] += d[k];
            self.square[k] += d[k] * d[k];
            self.mixed[k] += d[(k + 1) % 3] * d[(k + 2) % 3];
        }
        self.count += 1.0;
    }

    /// What is within a radius of a point; the places in their columns of those within another are appended to `near`.
    pub(crate) fn within(
        places: &Places,
        at: &Point,
        [radius, nearer]: [f64; 2],
        near: &mut Vec<u32>,
    ) -> Self {
        let mut found = Self::default();
        let limits = [radius, nearer].map(|r| (r * r) as f32);
        dispatch(Within { places, at, limits, near, found: &mut found });
        found
    }

    /// The normal that faces outward; `None` of fewer than five neighbours or where they lie on a line.
    pub(crate) fn normal(&self, outward: &Vector) -> Option<Direction> {
        if self.count < 6.0 {
            return None;
        }
        facing(smallest_axis(&self.covariance())?, outward)
    }

    /// The normals of many, by moments in single precision, each of which faces outward.
    pub(crate) fn normals(
        all: &[Self],
        outward: impl Fn(usize) -> Vector,
    ) -> Vec<Option<Direction>> {
        let scaled = |near: &Self| {
            let covariance = near.covariance();
            covariance / covariance.trace()
        };
        let covariances: Vec<Matrix3<f64>> = all.iter().map(scaled).collect();
        let each = all.iter().zip(least_axes(&covariances)).enumerate();
        let normal = |(i, (near, (values, axis))): (usize, (&Self, _))| match near.count < 6.0 {
            true => None,
            false => facing(sound_axis(values, axis, 1e-6)?, &outward(i)),
        };
        each.map(normal).collect()
    }

    /// The covariance of the points.
    pub(crate) fn covariance(&self) -> Matrix3<f64> {
        let mean = self.sum.map(|s| s / self.count);
        Matrix3::from_fn(|i, j| {
            let product = if i == j { self.square[i] } else { self.mixed[3 - i - j] };
            product / self.count - mean[i] * mean[j]
        })
    }
}

fn facing(normal: Direction, outward: &Vector) -> Option<Direction> {
    Some(if normal.dot(outward) < 0.0 { -normal } else { normal })
}

/// Points that are near each other side by side, by their places beside the first in single precision, padded with far ones.
#[derive(Debug, Default)]
pub(crate) struct Places {
    beside: [Column<f32>; 3],
    first: Point,
}

impl Places {
    /// Takes other points.
    pub(crate) fn set(&mut self, points: impl Iterator<Item = Point>) {
        let Self { beside, first } = self;
        beside.iter_mut().for_each(Column::clear);
        for p in points {
            if beside[0].is_empty() {
                *first = p;
            }
            (0..3).for_each(|k| beside[k].push((p[k] - first[k]) as f32));
        }
        let padded = beside[0].len().next_multiple_of(WIDEST);
        beside.iter_mut().for_each(|column| column.resize(padded, f32::INFINITY));
    }

    /// Square of the least distance to some other points; infinite where there is none.
    pub(crate) fn nearest(&self, points: &[Point]) -> f64 {
        let mut least = f64::INFINITY;
        dispatch(Nearest { places: self, points, least: &mut least });
        least
    }

    /// Where a point is beside the first.
    #[inline(always)]
    fn beside(&self, p: &Point) -> [f32; 3] {
        let beside = p - self.first;
        [beside.x as f32, beside.y as f32, beside.z as f32]
    }

    #[inline(always)]
    fn blocks(&self) -> impl Iterator<Item = [&[f32]; 3]> {
        let [x, y, z] = self.beside.each_ref().map(|column| column.chunks_exact(WIDEST));
        x.zip(y).zip(z).map(|((x, y), z)| [x, y, z])
    }
}

struct Nearest<'a> {
    places: &'a Places,
    points: &'a [Point],
    least: &'a mut f64,
}

impl Job for Nearest<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let mut least = [f32::INFINITY; WIDEST];
        for p in self.points {
            let at = self.places.beside(p);
            for [x, y, z] in self.places.blocks() {
                for i in 0..WIDEST {
                    let [dx, dy, dz] = [x[i] - at[0], y[i] - at[1], z[i] - at[2]];
                    let square = dx * dx + dy * dy + dz * dz;
                    least[i] = if square < least[i] { square } else { least[i] };
                }
            }
        }
        *self.least = f64::from(least.into_iter().fold(f32::INFINITY, f32::min));
    }
}

/// Moments of the places within one distance of a point, and which of them are within another.
struct Within<'a> {
    places: &'a Places,
    at: &'a Point,
    /// Squares of the distances.
    limits: [f32; 2],
    near: &'a mut Vec<u32>,
    found: &'a mut Neighbourhood,
}

impl Job for Within<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let at = self.places.beside(self.at);
        let mut sums = [[0.0f32; WIDEST]; 10];
        for (b, [x, y, z]) in self.places.blocks().enumerate() {
            let mut bits = [0u32; WIDEST];
            for i in 0..WIDEST {
                let [dx, dy, dz] = [x[i] - at[0], y[i] - at[1], z[i] - at[2]];
                let square = dx * dx + dy * dy + dz * dz;
                let within = square <= self.limits[0];
                let own = |v: f32| if within { v } else { 0.0 };
                let [dx, dy, dz] = [own(dx), own(dy), own(dz)];
                sums[0][i] += dx;
                sums[1][i] += dy;
                sums[2][i] += dz;
                sums[3][i] += dx * dx;
                sums[4][i] += dy * dy;
                sums[5][i] += dz * dz;
                sums[6][i] += dy * dz;
                sums[7][i] += dz * dx;
                sums[8][i] += dx * dy;
                sums[9][i] += own(1.0);
                bits[i] = if square < self.limits[1] { 1 << i } else { 0 };
            }
            let mut bits: u32 = bits.iter().sum();
            while bits != 0 {
                self.near.push((b * WIDEST) as u32 + bits.trailing_zeros());
                bits &= bits - 1;
            }
        }
        let mut total = [0.0; 10];
        for (total, lanes) in total.iter_mut().zip(&sums) {
            *total = lanes.iter().map(|v| f64::from(*v)).sum();
        }
        let [x, y, z, xx, yy, zz, yz, zx, xy, count] = total;
        *self.found =
            Neighbourhood { sum: [x, y, z], square: [xx, yy, zz], mixed: [yz, zx, xy], count };
    }
}

/// The eigenvector of the smallest eigenvalue of a covariance; `None` when the two smallest are the
/// same to rounding (points on a line) or a number is not finite.
pub(crate) fn smallest_axis(covariance: &Matrix3<f64>) -> Option<Direction> {
    let scale = covariance.trace();
    if !(scale > 0.0 && scale.is_finite()) {
        return None;
    }
    let (values, axis) = least_axis(&(covariance / scale));
    sound_axis(values, axis, 1e-9)
}

/// An axis, unless the middle eigenvalue is no more than rounding.
fn sound_axis(values: [f64; 3], axis: Vector, rounding: f64) -> Option<Direction> {
    (values[1] >= rounding).then(|| Direction::new_normalize(axis))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;

    #[test]
    fn many_places_are_as_one_after_the_other() {
        let mut random = Stream::new(3, 0);
        let points: Vec<Point> =
            (0..61).map(|_| Point::from([0; 3].map(|_| random.between(-0.1, 0.1)))).collect();
        let mut places = Places::default();
        places.set(points.iter().copied());
        let (at, [radius, nearer]) = (points[7], [0.1, 0.06]);
        let mut near = Vec::new();
        let found = Neighbourhood::within(&places, &at, [radius, nearer], &mut near);
        let mut known = Neighbourhood::default();
        let apart = |p: &Point| (p - at).norm();
        points.iter().filter(|p| apart(p) <= radius).for_each(|p| known.add(&(p - at)));
        assert!(found.count == known.count && known.count > 6.0);
        assert!((found.covariance() - known.covariance()).norm() < 1e-8);
        let among: Vec<u32> = (0..61).filter(|i| apart(&points[*i as usize]) < nearer).collect();
        assert_eq!(near, among);
        let far = at + Vector::new(0.0, 0.3, 0.0);
        let least = points.iter().map(|p| (p - far).norm_squared()).fold(f64::INFINITY, f64::min);
        assert!((places.nearest(&[far, far * 2.0]) - least).abs() < 1e-8);
        let outward = |_: usize| Vector::x();
        let [normal, none] =
            [0, 1].map(|k| Neighbourhood::normals(&[found, Neighbourhood::default()], outward)[k]);
        assert!(
            none.is_none()
                && normal.unwrap().dot(&known.normal(&Vector::x()).unwrap()) > 1.0 - 1e-6
        );
    }

    #[test]
    fn a_ball_faces_outwards_and_a_line_nowhere() {
        let n = 2000;
        let ball = (0..n).map(|i| {
            let z = 1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(n);
            let (a, r) = (2.399_963_229_728_653 * f64::from(i), (1.0 - z * z).sqrt());
            Point::new(0.05 * r * a.cos(), 0.05 * r * a.sin(), 0.05 * z)
        });
        let cloud = PointCloud::from_points(ball.collect());
        let all: Vec<u32> = (0..n as u32).collect();
        for (p, normal) in cloud.points.iter().zip(normals(&cloud, &all, 0.01)) {
            assert!(normal.unwrap().dot(&p.coords) > 0.05 * 0.99);
        }
        let line = (0..50).map(|i| Point::new(0.001 * f64::from(i), 0.0, 0.0)).collect();
        let line = PointCloud::from_points(line);
        assert!(normals(&line, &[0, 9, 999], 0.01).iter().all(Option::is_none));
    }
}
