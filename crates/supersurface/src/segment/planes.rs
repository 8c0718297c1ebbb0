//! Which large planes are in the cloud? Random samples and consensus (RANSAC), one plane after another.
//!
//! A point belongs to the plane n·p + d = 0 when |n·p + d| < 3 sigma(r) |n·e| + floor: depth noise
//! sigma acts along the ray e, so it counts only as far as the ray is square to the plane. A fixed
//! width would pick one level of a far wall whose depths are quantised. A sample is scored by the sum of
//! 1 - (distance / width)^2 over the points inside (MSAC, Torr and Zisserman 2000).

use nalgebra::Matrix3;

use crate::cloud::{PointCloud, smallest_axis};
use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, WIDTH, dispatch, fused};
use crate::numeric::random::Stream;
use crate::segment::footprint::{Ground, Outline};
use crate::segment::sight::{Sight, depth_noise};
use crate::shape::Plane;
use crate::{Direction, Point, Vector};

/// Widths: this many standard deviations, plus a floor in metres.
pub(crate) const WIDTHS: f64 = 3.0;
pub(crate) const FLOOR: f64 = 0.0015;
/// Width where the sensor's place is unknown, in metres.
pub(crate) const BLIND: f64 = 0.006;

/// A reading as the search sees it: the vector from the eye (or the cloud's middle), and the width
/// that its noise allows per unit of n·vector.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reading {
    pub(crate) ray: Vector,
    pub(crate) slope: f64,
    pub(crate) floor: f64,
}

impl Reading {
    /// The reading of a point.
    pub(crate) fn new(p: &Point, sight: &Sight, middle: &Point) -> Self {
        match sight.eye {
            Some(eye) => {
                let ray = p - eye;
                let range = ray.norm().max(1e-6);
                Self { ray, slope: WIDTHS * depth_noise(range) / range, floor: FLOOR }
            }
            None => Self { ray: p - middle, slope: 0.0, floor: BLIND },
        }
    }
}

/// Readings side by side, padded with such as lie in no plane.
#[derive(Debug, Default)]
pub(crate) struct Columns {
    ray: [Column<f64>; 3],
    slope: Column<f64>,
    floor: Column<f64>,
    /// 1 where a reading counts, 0 where it does not: it has no width then, and lies in no plane.
    counts: Column<f64>,
    count: usize,
}

impl Columns {
    /// Those of some readings, all of which count.
    pub(crate) fn of<'a>(readings: impl Iterator<Item = &'a Reading>) -> Self {
        let Self { mut ray, mut slope, mut floor, mut counts, mut count } = Self::default();
        for r in readings {
            (0..3).for_each(|k| ray[k].push(r.ray[k]));
            slope.push(r.slope);
            floor.push(r.floor);
            counts.push(1.0);
            count += 1;
        }
        let padded = count.next_multiple_of(WIDTH);
        let columns = ray.iter_mut().chain([&mut slope, &mut floor, &mut counts]);
        columns.for_each(|column| column.resize(padded, 0.0));
        Self { ray, slope, floor, counts, count }
    }

    /// Lets those count whose feet are within an outline in a plane, where the rays begin at `origin`.
    pub(crate) fn count_within(&mut self, outline: &Outline, ground: &Ground, origin: &Vector) {
        let spot = ground.spot(&Point::from(*origin));
        dispatch(Within { columns: self, edges: outline.edges(), axes: ground.axes(), spot });
    }

    /// The columns by blocks: rays, slopes, floors, and what counts.
    #[inline(always)]
    fn blocks(&self) -> impl Iterator<Item = [&[f64]; 6]> {
        let [x, y, z] = self.ray.each_ref().map(|column| column.chunks_exact(WIDTH));
        let all = x.zip(y).zip(z).zip(self.slope.chunks_exact(WIDTH));
        let all = all.zip(self.floor.chunks_exact(WIDTH)).zip(self.counts.chunks_exact(WIDTH));
        all.map(|(((((x, y), z), slope), floor), counts)| [x, y, z, slope, floor, counts])
    }

    /// Heights over a plane of the readings that lie in it.
    pub(crate) fn near(&self, normal: &Direction, offset: f64) -> impl Iterator<Item = f64> + '_ {
        let normal = *normal;
        let reading = move |i: usize| {
            let ray = Vector::new(self.ray[0][i], self.ray[1][i], self.ray[2][i]);
            let [slope, floor] = [&self.slope, &self.floor].map(|c| c[i] * self.counts[i]);
            Reading { ray, slope, floor }
        };
        let heights = (0..self.count).map(move |i| height(&normal, offset, &reading(i)));
        heights.filter(|(h, width)| h.abs() < *width).map(|(h, _)| h)
    }

    /// Median of the distances from a plane in widths, of the readings that lie in it.
    pub(crate) fn deviation(
        &self,
        normal: &Direction,
        offset: f64,
        shares: &mut Column<f64>,
    ) -> Option<f64> {
        let plane = [normal.x, normal.y, normal.z, offset];
        dispatch(Shares { columns: self, plane, shares: &mut *shares });
        shares.resize(self.count, 0.0);
        // those out of the plane come after all in it
        let inside = shares.iter().filter(|s| **s < 1.0).count();
        (inside > 0).then(|| *shares.select_nth_unstable_by(inside / 2, f64::total_cmp).1)
    }

    /// The plane of least squares through the readings within `share` of their widths about a plane, each
    /// weighted by 1 / width^2.
    pub(crate) fn least_squares(
        &self,
        normal: &Direction,
        offset: f64,
        share: f64,
    ) -> Option<(Direction, f64)> {
        // Sums about one of the readings, so that a distant cloud loses no digits.
        let first = |column: &Column<f64>| column.first().copied().unwrap_or_default();
        let origin = Vector::from(self.ray.each_ref().map(first));
        let mut sums = [0.0; 10];
        let plane = [normal.x, normal.y, normal.z, offset];
        dispatch(Moments { columns: self, plane, share, origin: origin.into(), sums: &mut sums });
        let [weight, x, y, z, xx, yy, zz, yz, zx, xy] = sums;
        let mean = Vector::new(x, y, z) / weight;
        let squares = Matrix3::new(xx, xy, zx, xy, yy, yz, zx, yz, zz) / weight;
        let normal = smallest_axis(&(squares - mean * mean.transpose()))?;
        towards_eye(normal, mean + origin)
    }
}

/// Height of a reading of columns over a plane, and its width.
#[inline(always)]
fn height_at<const FUSED: bool>(ray: [f64; 3], width: [f64; 3], plane: &[f64; 4]) -> (f64, f64) {
    let ([x, y, z], [slope, floor, counts]) = (ray, width);
    let along = fused::<FUSED>(plane[0], x, fused::<FUSED>(plane[1], y, plane[2] * z));
    (along + plane[3], counts * fused::<FUSED>(slope, along.abs(), floor))
}

/// Moments of readings about a plane, weighted by 1 / width^2: those of order 0, 1 and 2.
struct Moments<'a> {
    columns: &'a Columns,
    plane: [f64; 4],
    share: f64,
    origin: [f64; 3],
    sums: &'a mut [f64; 10],
}

impl Job for Moments<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let mut sums = [[0.0; WIDTH]; 10];
        for [x, y, z, slope, floor, counts] in self.columns.blocks() {
            for i in 0..WIDTH {
                let width = [slope[i], floor[i], counts[i]];
                let (h, width) = height_at::<FUSED>([x[i], y[i], z[i]], width, &self.plane);
                let w = if h.abs() < self.share * width { 1.0 / (width * width) } else { 0.0 };
                let v = [x[i] - self.origin[0], y[i] - self.origin[1], z[i] - self.origin[2]];
                let wv = [w * v[0], w * v[1], w * v[2]];
                sums[0][i] += w;
                for k in 0..3 {
                    sums[1 + k][i] += wv[k];
                    sums[4 + k][i] = fused::<FUSED>(wv[k], v[k], sums[4 + k][i]);
                }
                sums[7][i] = fused::<FUSED>(wv[1], v[2], sums[7][i]);
                sums[8][i] = fused::<FUSED>(wv[2], v[0], sums[8][i]);
                sums[9][i] = fused::<FUSED>(wv[0], v[1], sums[9][i]);
            }
        }
        *self.sums = sums.map(|lanes| lanes.iter().sum());
    }
}

/// Distances from a plane in widths.
struct Shares<'a> {
    columns: &'a Columns,
    plane: [f64; 4],
    shares: &'a mut Column<f64>,
}

impl Job for Shares<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        self.shares.resize(self.columns.slope.len(), 0.0);
        let shares = self.shares.chunks_exact_mut(WIDTH);
        for ([x, y, z, slope, floor, counts], out) in self.columns.blocks().zip(shares) {
            for i in 0..WIDTH {
                let width = [slope[i], floor[i], counts[i]];
                let (h, width) = height_at::<FUSED>([x[i], y[i], z[i]], width, &self.plane);
                out[i] = h.abs() / width;
            }
        }
    }
}

/// Which readings' feet are within an outline.
struct Within<'a> {
    columns: &'a mut Columns,
    edges: &'a [[f64; 3]],
    axes: [Direction; 2],
    /// The foot of where the rays begin.
    spot: [f64; 2],
}

impl Job for Within<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let Columns { ray: [x, y, z], slope, counts, count, .. } = self.columns;
        let [a, b] = self.axes;
        let rays = x.chunks_exact(WIDTH).zip(y.chunks_exact(WIDTH)).zip(z.chunks_exact(WIDTH));
        for (((x, y), z), counts) in rays.zip(counts.chunks_exact_mut(WIDTH)) {
            let (mut u, mut v) = ([0.0; WIDTH], [0.0; WIDTH]);
            for i in 0..WIDTH {
                u[i] = self.spot[0] + a.x * x[i] + a.y * y[i] + a.z * z[i];
                v[i] = self.spot[1] + b.x * x[i] + b.y * y[i] + b.z * z[i];
            }
            let mut depth = [f64::INFINITY; WIDTH];
            for [along, across, offset] in self.edges {
                for i in 0..WIDTH {
                    let d = along * u[i] + across * v[i] + offset;
                    depth[i] = if d < depth[i] { d } else { depth[i] };
                }
            }
            for i in 0..WIDTH {
                counts[i] = if depth[i] >= 0.0 { 1.0 } else { 0.0 };
            }
        }
        counts.resize(*count, 0.0);
        counts.resize(slope.len(), 0.0);
    }
}

/// How well readings agree with a plane: the sum of 1 - (distance / width)^2 over those in it.
struct Score<'a> {
    columns: &'a Columns,
    plane: [f64; 4],
    score: &'a mut f64,
}

impl Job for Score<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let mut sums = [0.0; WIDTH];
        for [x, y, z, slope, floor, counts] in self.columns.blocks() {
            for i in 0..WIDTH {
                let width = [slope[i], floor[i], counts[i]];
                let (h, width) = height_at::<FUSED>([x[i], y[i], z[i]], width, &self.plane);
                let share = h / width;
                let own = 1.0 - share * share;
                // a padded reading has no width: its share is no number or infinite
                sums[i] += if own > 0.0 { own } else { 0.0 };
            }
        }
        *self.score = sums.iter().sum();
    }
}

/// A plane n·v + d = 0 in vectors from the eye, and the readings of the sample that lie in it.
#[derive(Clone, Debug)]
pub(crate) struct Candidate {
    /// Unit normal, towards the eye (d > 0) where the eye is known.
    pub(crate) normal: Direction,
    /// Height of the eye over the plane.
    pub(crate) offset: f64,
    /// Places in the sample of the readings in the plane.
    pub(crate) members: Vec<u32>,
}

impl Candidate {
    /// The plane in the cloud's frame, where the eye is at `origin`.
    pub(crate) fn plane(&self, origin: &Vector) -> Option<Plane> {
        Plane::new(self.normal.into_inner(), self.offset - self.normal.dot(origin)).ok()
    }

    /// Signed height of a reading over the plane, and the width that its noise allows.
    #[inline]
    pub(crate) fn height(&self, r: &Reading) -> (f64, f64) {
        height(&self.normal, self.offset, r)
    }
}

/// Signed height of a reading over a plane, and the width that its noise allows.
#[inline]
pub(crate) fn height(normal: &Vector, offset: f64, r: &Reading) -> (f64, f64) {
    let along = normal.dot(&r.ray);
    (along + offset, r.slope * along.abs() + r.floor)
}

/// A spread of at most `count` points of the cloud, by index, one at random from each of `count`
/// equal stretches of the list: no stride that could run along a column of the image.
pub(crate) fn spread(indices: &[u32], count: usize, random: &mut Stream) -> Vec<u32> {
    if indices.len() <= count {
        return indices.to_vec();
    }
    let bound = |k: usize| k * indices.len() / count;
    (0..count)
        .filter_map(|k| indices.get(bound(k) + random.index(bound(k + 1) - bound(k))).copied())
        .collect()
}

/// The readings of the points named in `sample`.
pub(crate) fn readings(cloud: &PointCloud, sample: &[u32], sight: &Sight) -> Vec<Reading> {
    let points = || sample.iter().filter_map(|i| cloud.points.get(*i as usize));
    let sum: Vector = points().map(|p| p.coords).sum();
    let middle = Point::from(sum / sample.len().max(1) as f64);
    points().map(|p| Reading::new(p, sight, &middle)).collect()
}

/// The planes that hold the most readings, each with those that no earlier plane holds, until one
/// holds under 3 % of all or `most` are found, each by so many `trials`. Only normals that `allowed` lets pass are tried.
pub(crate) fn dominant(
    all: &[Reading],
    most: usize,
    trials: usize,
    random: &mut Stream,
    allowed: impl Fn(&Direction) -> bool,
) -> Vec<Candidate> {
    let mut free: Vec<u32> = (0..all.len() as u32).collect();
    let least = (all.len() / 33).max(20);
    let mut planes = Vec::new();
    while planes.len() < most && free.len() >= least {
        let Some(found) = best(all, &free, trials, random, &allowed) else { break };
        if found.members.len() < least {
            break;
        }
        free.retain(|i| {
            let (h, width) = found.height(&all[*i as usize]);
            h.abs() > 1.5 * width
        });
        planes.push(found);
    }
    planes
}

/// Samples that find a plane among much else.
pub(crate) const TRIALS: usize = 240;
/// Readings on which they are scored.
const JURY: usize = 1500;

/// The plane that most of the free readings agree with.
fn best(
    all: &[Reading],
    free: &[u32],
    trials: usize,
    random: &mut Stream,
    allowed: impl Fn(&Direction) -> bool,
) -> Option<Candidate> {
    let jury: Vec<Reading> = spread(free, JURY, random).iter().map(|i| all[*i as usize]).collect();
    let columns = Columns::of(jury.iter());
    let mut best: Option<(f64, Direction, f64)> = None;
    for trial in 0..trials {
        let Some((normal, offset)) = sample(&jury, trial % 2 == 0, random) else { continue };
        if !allowed(&normal) {
            continue;
        }
        let mut score = 0.0;
        let plane = [normal.x, normal.y, normal.z, offset];
        dispatch(Score { columns: &columns, plane, score: &mut score });
        if best.is_none_or(|b| score > b.0) {
            best = Some((score, normal, offset));
        }
    }
    let (_, mut normal, mut offset) = best?;
    let columns = Columns::of(free.iter().map(|i| &all[*i as usize]));
    for _ in 0..3 {
        (normal, offset) = columns.least_squares(&normal, offset, 1.0)?;
    }
    let inside = |i: &&u32| {
        let (h, width) = height(&normal, offset, &all[**i as usize]);
        h.abs() < width
    };
    let members = free.iter().filter(inside).copied().collect();
    Some(Candidate { normal, offset, members })
}

/// A plane through three readings; when `near`, the second and third are the nearest to the first of
/// eight, which finds small planes among many things.
fn sample(jury: &[Reading], near: bool, random: &mut Stream) -> Option<(Direction, f64)> {
    let mut draw = || jury.get(random.index(jury.len())).map(|r| r.ray);
    let a = draw()?;
    let mut other = || {
        let mut chosen = draw()?;
        for _ in 1..if near { 8 } else { 1 } {
            let next = draw()?;
            if (next - a).norm_squared() < (chosen - a).norm_squared() {
                chosen = next;
            }
        }
        Some(chosen)
    };
    let (b, c) = (other()?, other()?);
    let (ab, ac) = (b - a, c - a);
    let cross = ab.cross(&ac);
    // Slim triangles say nothing.
    let slim = cross.norm() <= 0.1 * ab.norm() * ac.norm();
    if slim {
        return None;
    }
    towards_eye(Direction::try_new(cross, 1e-300)?, a)
}

/// The plane through `point` with the given normal, turned so that the eye is above it.
fn towards_eye(normal: Direction, point: Vector) -> Option<(Direction, f64)> {
    let offset = -normal.dot(&point);
    let plane = if offset < 0.0 { (-normal, -offset) } else { (normal, offset) };
    plane.1.is_finite().then_some(plane)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_quantised_wall_is_one_plane() {
        // Depths of a wall 5 m away come in steps of 70 mm; a table is in front of it.
        let mut random = Stream::new(1, 0);
        let mut points = Vec::new();
        for k in 0..6000 {
            let (x, y) = (random.between(-0.5, 0.5), random.between(-0.4, 0.4));
            let wall: f64 = 5.0 + 0.6 * x;
            let z =
                if k % 3 == 0 { 0.5 / (0.7 * y.abs() + 0.5) } else { (wall / 0.07).round() * 0.07 };
            points.push(if k % 3 == 0 {
                Point::new(x * z, y.abs() * z, z + 0.001 * random.normal())
            } else {
                Point::new(x * z, -y.abs() * z, z)
            });
        }
        let cloud =
            PointCloud { viewpoint: Some(Point::origin()), ..PointCloud::from_points(points) };
        let indices: Vec<u32> = (0..6000).collect();
        let sight = Sight::of(&cloud, &indices);
        let planes =
            dominant(&readings(&cloud, &indices, &sight), 4, TRIALS, &mut random, |_| true);
        assert_eq!(planes.len(), 2);
        assert!(planes[0].members.len() > 3800);
        let table = Vector::new(0.0, -0.7, -0.5).normalize();
        assert!(planes[1].normal.dot(&table) > 0.9999);
    }
}
