//! The image that an unorganised cloud was taken as.
//!
//! A cloud from one view without its rows and columns (cropped, thinned out, or from a file that lost
//! them) is put into pixels again: a point p in the camera's axes lies at (p.x, p.y) / (p.z a), where the
//! pixel's width a follows the angle between neighbouring points. Each pixel holds its nearest point;
//! points that are near that one go with it. Clouds from several views do not fit: too many of their
//! points are behind others.

use crate::cloud::PointCloud;
use crate::numeric::random::Stream;
use crate::segment::planes::spread;
use crate::segment::sight::Sight;
use crate::{Direction, Point, Vector};

/// An organised cloud that stands for another.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Raster {
    /// The organised cloud.
    pub(crate) cloud: PointCloud,
    /// Its width of a pixel, in radians.
    pub(crate) pixel: f64,
    /// Each point of the other cloud that a pixel stands for: (pixel, point), sorted.
    members: Vec<(u32, u32)>,
}

/// Width of a pixel, in distances between neighbouring points.
const WIDTH: f64 = 1.2;
/// Points from which that distance is taken.
const PROBES: usize = 48;
/// Pixels at most, in multiples of the number of points.
const SPARSE: f64 = 8.0;
/// Distance from the point of a pixel up to which others go with it: metres, and pixels at its range.
const NEAR: f64 = 0.01;
const NEAR_PIXELS: f64 = 4.0;

impl Raster {
    /// The image of the points named by `seen`, with the direction `up` upright; `None` when the cloud
    /// was not seen from one place, or too widely.
    pub(crate) fn of(
        cloud: &PointCloud,
        seen: &[u32],
        sight: &Sight,
        up: &Vector,
        random: &mut Stream,
    ) -> Option<Self> {
        let eye = sight.eye?;
        let forward = sight.forward;
        let upright = |v: &Vector| v - *forward * forward.dot(v);
        let down = Direction::try_new(-upright(up), 0.05)
            .or_else(|| Direction::try_new(-upright(&sight.up?.into_inner()), 0.05))?;
        let right = down.cross(&forward);
        // Image coordinates at depth 1; points beside the camera have none.
        let place = |i: &u32| {
            let v = cloud.points.get(*i as usize)? - eye;
            let depth = forward.dot(&v);
            (depth > 0.3 * v.norm()).then(|| [right.dot(&v) / depth, down.dot(&v) / depth])
        };
        let places: Vec<([f64; 2], u32)> =
            seen.iter().filter_map(|i| Some((place(i)?, *i))).collect();
        if 20 * places.len() < 19 * seen.len() {
            return None;
        }
        let (mut low, mut high) = ([f64::MAX; 2], [f64::MIN; 2]);
        for (p, _) in &places {
            for k in 0..2 {
                low[k] = low[k].min(p[k]);
                high[k] = high[k].max(p[k]);
            }
        }
        let (across, along) = (high[0] - low[0], high[1] - low[1]);
        // No finer than what leaves the image mostly full.
        let finest = (across * along / (SPARSE * places.len() as f64)).sqrt();
        let pixel = (WIDTH * spacing(&places, random)?).max(finest).max(1e-5);
        let [width, height] = [across, along].map(|size| (size / pixel) as usize + 1);
        let index = |p: &[f64; 2]| {
            let [u, v] = [0, 1].map(|k| ((p[k] - low[k]) / pixel) as usize);
            v.min(height - 1) * width + u.min(width - 1)
        };
        let range = |i: u32| cloud.points.get(i as usize).map_or(f64::MAX, |p| (p - eye).norm());
        let mut nearest: Vec<Option<u32>> = vec![None; width.checked_mul(height)?];
        for (p, i) in &places {
            let first = &mut nearest[index(p)];
            if first.is_none_or(|j| range(*i) < range(j)) {
                *first = Some(*i);
            }
        }
        let mut members = Vec::with_capacity(places.len());
        for (p, i) in &places {
            let at = index(p);
            let (Some(a), Some(b)) = (cloud.points.get(*i as usize), nearest[at]) else { continue };
            let reach = NEAR + NEAR_PIXELS * pixel * range(b);
            if cloud.points.get(b as usize).is_some_and(|b| (a - b).norm() < reach) {
                members.push((at as u32, *i));
            }
        }
        if 10 * members.len() < 9 * seen.len() {
            return None;
        }
        members.sort_unstable();
        let nowhere = Point::new(f64::NAN, f64::NAN, f64::NAN);
        let point = |i: &Option<u32>| {
            i.and_then(|i| cloud.points.get(i as usize)).copied().unwrap_or(nowhere)
        };
        let image = PointCloud {
            points: nearest.iter().map(point).collect(),
            grid: Some([width, height]),
            viewpoint: Some(eye),
            ..PointCloud::default()
        };
        Some(Self { cloud: image, pixel, members })
    }

    /// The pixels that stand for points, both in ascending order.
    pub(crate) fn pixels(&self, points: &[u32]) -> Vec<u32> {
        let of = |m: &&(u32, u32)| points.binary_search(&m.1).is_ok();
        let mut pixels: Vec<u32> = self.members.iter().filter(of).map(|m| m.0).collect();
        pixels.dedup();
        pixels
    }

    /// The points that stand behind pixels, in ascending order.
    pub(crate) fn back(&self, pixels: &[u32]) -> Vec<u32> {
        let mut points = Vec::with_capacity(pixels.len());
        for p in pixels {
            let start = self.members.partition_point(|m| m.0 < *p);
            let own = self.members[start..].iter().take_while(|m| m.0 == *p);
            points.extend(own.map(|m| m.1));
        }
        points.sort_unstable();
        points
    }
}

/// Median distance in the image from a point to its nearest neighbour.
fn spacing(places: &[([f64; 2], u32)], random: &mut Stream) -> Option<f64> {
    let all: Vec<u32> = (0..places.len() as u32).collect();
    let probes = spread(&all, PROBES, random);
    let nearest = |k: &u32| {
        let (p, _) = places[*k as usize];
        let d = places.iter().map(|(q, _)| (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2));
        // The point itself, and copies of it, are no neighbours.
        d.filter(|d| *d > 1e-14).fold(f64::INFINITY, f64::min)
    };
    let mut distances: Vec<f64> = probes.iter().map(nearest).collect();
    let middle = distances.len() / 2;
    if distances.is_empty() {
        return None;
    }
    let squared = *distances.select_nth_unstable_by(middle, f64::total_cmp).1;
    squared.is_finite().then(|| squared.sqrt())
}
