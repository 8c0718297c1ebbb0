//! Readings side by side in registers: their heights over a plane, and the plane of least squares.

use nalgebra::Matrix3;

use crate::cloud::smallest_axis;
use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, WIDTH, dispatch, fused};
use crate::segment::footprint::{Ground, Outline};
use crate::segment::reading::{Reading, height};
use crate::{Direction, Point, Vector};

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

    /// How well they agree with a plane: the sum of 1 - (distance / width)^2 over those in it.
    pub(crate) fn score(&self, normal: &Direction, offset: f64) -> f64 {
        let (plane, mut score) = ([normal.x, normal.y, normal.z, offset], 0.0);
        dispatch(Score { columns: self, plane, score: &mut score });
        score
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

/// How well readings agree with a plane, see [`Columns::score`].
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

/// The plane through `point` with the given normal, turned so that the eye is above it.
pub(crate) fn towards_eye(normal: Direction, point: Vector) -> Option<(Direction, f64)> {
    let offset = -normal.dot(&point);
    let plane = if offset < 0.0 { (-normal, -offset) } else { (normal, offset) };
    plane.1.is_finite().then_some(plane)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::Plane;

    #[test]
    fn columns_are_as_one_reading_after_the_other() {
        let mut random = Stream::new(5, 0);
        let plane = Plane::new(Vector::new(0.1, -0.2, -1.0), 0.9).unwrap();
        let reading = |k: usize| {
            let [x, y] = [0; 2].map(|_| random.between(-0.5, 0.5));
            let foot = plane.project(&Point::new(x, y, 0.9));
            // every fifth is a stray one
            let off = if k.is_multiple_of(5) { 0.1 } else { 0.001 * random.normal() };
            let ray = foot.coords + plane.normal().into_inner() * off;
            Reading { ray, slope: 0.003, floor: 0.0015 }
        };
        let all: Vec<Reading> = (0..203).map(reading).collect();
        let mut columns = Columns::of(all.iter());
        let (normal, offset) = (plane.normal(), plane.offset());
        let heights = || all.iter().map(|r| height(&normal, offset, r));
        let inside: Vec<f64> =
            heights().filter(|(h, width)| h.abs() < *width).map(|(h, _)| h).collect();
        assert_eq!(columns.near(&normal, offset).collect::<Vec<f64>>(), inside);
        let score: f64 = heights().map(|(h, width)| (1.0 - (h / width).powi(2)).max(0.0)).sum();
        assert!((columns.score(&normal, offset) - score).abs() < 1e-9);
        let mut shares: Vec<f64> =
            heights().map(|(h, width)| h.abs() / width).filter(|s| *s < 1.0).collect();
        shares.sort_by(f64::total_cmp);
        let found = columns.deviation(&normal, offset, &mut Column::default()).unwrap();
        assert!((found - shares[shares.len() / 2]).abs() < 1e-12);
        let (found, away) = columns.least_squares(&normal, offset, 1.0).unwrap();
        assert!(found.dot(&normal) > 1.0 - 1e-6 && (away - offset).abs() < 5e-4);
        // what lies beside an outline does not count
        let ground = Ground::of(&plane);
        let spot = |r: &Reading| ground.spot(&Point::from(r.ray));
        let half = |r: &&Reading| spot(r)[0] > 0.0;
        let outline = Outline::around(&mut all.iter().filter(half).map(spot).collect());
        columns.count_within(&outline, &ground, &Vector::zeros());
        let within = all.iter().filter(|r| outline.holds(&spot(r), 0.0));
        let within = within.map(|r| height(&normal, offset, r));
        let within = within.filter(|(h, width)| h.abs() < *width).count();
        let counted = columns.near(&normal, offset).count();
        assert!(
            counted.abs_diff(within) < 3 && counted > 60 && counted < 100,
            "{counted} {within}"
        );
    }
}
