//! Plane facets: contiguous patches of the planes among some points.
//!
//! Planes are found by consensus, among those of a family (level or upright) alone. A reading is of a plane when it
//! lies in it and, in an image, its own normal agrees: the middle of a crowd of objects is no plane though many of
//! its readings have the same height.

use crate::cloud::{PointCloud, VoxelGrid};
use crate::numeric::random::Stream;
use crate::segment::footprint::{Ground, Outline, Rectangle, Spot, spot_on};
use crate::segment::planes::{Candidate, dominant, spread};
use crate::segment::reading::{Reading, readings};
use crate::segment::sight::{Sight, grid};
use crate::shape::Plane;
use crate::{Direction, Point};

/// Length of a facet at least, in metres.
const LEAST: f64 = 0.12;
/// Readings that the search sees, samples of three that it tries for a plane, planes that it looks for and patches of
/// each.
const SAMPLE: usize = 1500;
const TRIALS: usize = 80;
const MOST: usize = 8;
/// Readings of which patches are made, at most, nearly, and without which there are none.
const DENSE: usize = 20_000;
const FEWEST: usize = 400;
/// Gap that parts two patches of a plane, in metres.
const GAP: f64 = 0.05;
/// Share of a facet's middle that its readings cover, at least, and how much of it is the middle: a plane along the rim
/// of a tote covers none of it.
const COVERED: f64 = 0.2;
const MIDDLE: f64 = 0.6;
/// Side of the cells in which that is counted, in metres.
pub(crate) const CELL: f64 = 0.025;
/// Cosine to the support's normal: of a level plane from here on, of an upright one up to here (a tote's walls lean).
const LEVEL: f64 = 0.99;
const UPRIGHT: f64 = 0.3;
/// Half the distance over which a reading's normal is taken, in metres, and its cosine to that of its plane.
const AROUND: f64 = 0.02;
const ALIKE: f64 = 0.8;

/// A patch of a plane.
#[derive(Clone, Debug)]
pub(crate) struct Facet {
    /// The normal towards the sensor, where its place is known.
    pub(crate) plane: Plane,
    /// Its readings, by index, in ascending order.
    pub(crate) points: Vec<u32>,
    /// Its convex outline, up to which the plane goes.
    pub(crate) outline: Outline,
    /// The rectangle about that.
    pub(crate) rectangle: Rectangle,
}

/// Which way planes lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Family {
    Level,
    Upright,
}

impl Family {
    /// Whether a normal is one of the family's, where `up` is the support's.
    fn has(self, normal: &Direction, up: &Direction) -> bool {
        let leaning = up.dot(normal).abs();
        match self {
            Self::Level => leaning > LEVEL,
            Self::Upright => leaning < UPRIGHT,
        }
    }
}

/// Readings, thinned, with their normals where they are of an image; those without a normal there are left out.
pub(crate) struct Turned(Vec<(u32, Option<Direction>)>);

impl Turned {
    /// Those of the points named by `indices`.
    pub(crate) fn of(cloud: &PointCloud, indices: &[u32], sight: &Sight) -> Self {
        let rough = Rough::of(cloud, sight);
        let normal = |i: u32| match &rough {
            Some(rough) => rough.normal(i).map(Some),
            None => Some(None),
        };
        let thin = indices.iter().step_by(indices.len() / DENSE + 1);
        Self(thin.filter_map(|i| Some((*i, normal(*i)?))).collect())
    }
}

/// The facets of a family of planes among some readings.
pub(crate) fn facets(
    cloud: &PointCloud,
    turned: &Turned,
    family: Family,
    up: &Direction,
    sight: &Sight,
    random: &mut Stream,
) -> Vec<Facet> {
    // what faces another way is in no such plane
    let agrees = |n: &Direction| (up.dot(n).abs() > ALIKE) == (family == Family::Level);
    let free: Vec<(u32, Option<Direction>)> =
        turned.0.iter().filter(|(_, n)| n.is_none_or(|n| agrees(&n))).copied().collect();
    if free.len() < FEWEST {
        return Vec::new();
    }
    let named: Vec<u32> = free.iter().map(|(i, _)| *i).collect();
    let sample = spread(&named, SAMPLE, random);
    let all = readings(cloud, &sample, sight);
    let first = sample.first().and_then(|i| cloud.points.get(*i as usize)).zip(all.first());
    let Some(eye) = first.map(|(p, r)| p - r.ray) else { return Vec::new() };
    let found = dominant(&all, MOST, TRIALS, random, |n| family.has(n, up));
    let planes = found.iter().filter_map(|c: &Candidate| c.plane(&eye.coords));
    planes
        .filter(|plane| family.has(&plane.normal(), up))
        .flat_map(|plane| {
            let on = |(i, n): &&(u32, Option<Direction>)| {
                n.is_none_or(|n| n.dot(&plane.normal()).abs() > ALIKE)
                    && lies_in(cloud, *i, &plane, sight, &eye)
            };
            let near: Vec<u32> = free.iter().filter(on).map(|(i, _)| *i).collect();
            patches(cloud, &near, &plane)
        })
        .collect()
}

/// Whether a reading is in a plane, up to its noise; `eye` is where the sensor is, or a point among the readings.
pub(crate) fn lies_in(
    cloud: &PointCloud,
    i: u32,
    plane: &Plane,
    sight: &Sight,
    eye: &Point,
) -> bool {
    cloud.points.get(i as usize).is_some_and(|p| {
        let r = Reading::new(p, sight, eye);
        let width = r.slope * plane.normal().dot(&r.ray).abs() + r.floor;
        plane.height(p).abs() < width
    })
}

/// The contiguous patches of the points of a plane that are large and no mere rim, the largest first.
fn patches(cloud: &PointCloud, points: &[u32], plane: &Plane) -> Vec<Facet> {
    let ground = Ground::of(plane);
    let spots = points.iter().filter_map(|i| cloud.points.get(*i as usize));
    let spots: Vec<Spot> = spots.map(|p| ground.spot(p)).collect();
    let feet: Vec<Point> = spots.iter().map(|[x, y]| Point::new(*x, *y, 0.0)).collect();
    let grid = VoxelGrid::new(&feet, 0..feet.len() as u32, 0.5 * GAP);
    let mut patches = grid.map(|grid| grid.components()).unwrap_or_default();
    patches.sort_by_key(|p| (std::cmp::Reverse(p.len()), p.first().copied()));
    patches.truncate(MOST);
    let facet = |patch: Vec<u32>| {
        let own: Vec<Spot> = patch.iter().map(|i| spots[*i as usize]).collect();
        let outline = Outline::around(&mut own.clone());
        let rectangle = outline.rectangle()?;
        let mut points: Vec<u32> = patch.iter().map(|i| points[*i as usize]).collect();
        points.sort_unstable();
        let large = 2.0 * rectangle.half[0] > LEAST && covered(&own, &rectangle) > COVERED;
        large.then_some(Facet { plane: *plane, points, outline, rectangle })
    };
    patches.into_iter().filter_map(facet).collect()
}

/// Share of the middle of a rectangle that some spots cover.
fn covered(spots: &[Spot], r: &Rectangle) -> f64 {
    let turned = |s: &Spot| {
        let [x, y] = [s[0] - r.middle[0], s[1] - r.middle[1]];
        [x * r.along[0] + y * r.along[1], y * r.along[0] - x * r.along[1]]
    };
    let [long, short] = r.half.map(|h| MIDDLE * h);
    let inside = spots.iter().map(turned).filter(|s| s[0].abs() < long && s[1].abs() < short);
    let feet: Vec<Point> = inside.map(|[x, y]| Point::new(x, y, 0.0)).collect();
    let cells = VoxelGrid::new(&feet, 0..feet.len() as u32, CELL).map_or(0, |g| g.occupied());
    cells as f64 * CELL * CELL / (4.0 * long * short).max(1e-9)
}

impl Facet {
    /// Middle of its rectangle.
    pub(crate) fn middle(&self) -> Point {
        spot_on(&self.plane, &self.rectangle.middle)
    }

    /// Length and width as an eye sees them, in metres: where normals are known those along its edges are others'.
    pub(crate) fn size(&self, sight: &Sight) -> [f64; 2] {
        let lost = if sight.pixel.is_some() { 2.0 * AROUND } else { 0.0 };
        self.rectangle.half.map(|h| 2.0 * h + lost)
    }
}

/// The normals of an image's readings by those about a finger's breadth around.
struct Rough<'a> {
    points: &'a [Point],
    width: usize,
    height: usize,
    pixel: f64,
    eye: Point,
}

impl<'a> Rough<'a> {
    /// `None` for clouds that are no image.
    fn of(cloud: &'a PointCloud, sight: &Sight) -> Option<Self> {
        let [width, height] = grid(cloud)?;
        Some(Self { points: &cloud.points, width, height, pixel: sight.pixel?, eye: sight.eye? })
    }

    fn normal(&self, i: u32) -> Option<Direction> {
        let i = i as usize;
        let range = (self.points.get(i)? - self.eye).norm();
        let step = (AROUND / (self.pixel * range)).clamp(2.0, 40.0) as usize;
        let (u, v) = (i % self.width, i / self.width);
        let (left, right) = (u.saturating_sub(step), (u + step).min(self.width - 1));
        let (above, below) = (v.saturating_sub(step), (v + step).min(self.height - 1));
        let at = |u: usize, v: usize| self.points.get(v * self.width + u);
        let across = at(right, v)? - at(left, v)?;
        let down = at(u, below)? - at(u, above)?;
        Direction::try_new(across.cross(&down), 1e-12).filter(|n| n.x.is_finite())
    }
}
