//! What a scene is furnished with: further levels that things stand on, and walls beside and behind them.
//!
//! Planes are looked for among what is too large to be an object, and beneath the support. A contiguous patch of
//! one is furniture when it is larger than a face of an object would be: level, and it is a support of its own (a
//! shelf's board, a desk over the floor); upright, and it is a wall (of a room, a tote, a shelf). A smaller upright
//! patch that meets a wall in a corner and rises as high is a wall too: the short side of a tote.

use crate::cloud::{PointCloud, VoxelGrid};
use crate::measure::OrientedBox;
use crate::numeric::random::Stream;
use crate::segment::SegmentOptions;
use crate::segment::footprint::{Ground, Outline, Rectangle, Spot, spot_on};
use crate::segment::planes::{Reading, dominant, readings, spread};
use crate::segment::sight::{Sight, grid};
use crate::segment::table::{Support, refine};
use crate::shape::Plane;
use crate::{Direction, Point, Pose, Vector};
use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

/// Length of a patch from which it is no face of an object, in metres.
pub(crate) const LARGE: f64 = 0.4;
/// Length of a wall's neighbour in a corner, at least, in metres.
const SIDE: f64 = 0.12;
/// Width of a level, and height of a wall, at least, in metres.
const DEEP: f64 = 0.08;
const TALL: f64 = 0.06;
/// Height between two levels, at least, in metres.
const STEP: f64 = 0.1;
/// Share of a patch's middle that its readings cover, at least, and how much of it is the middle: a plane along the rim
/// of a tote covers none of it.
const COVERED: f64 = 0.2;
const MIDDLE: f64 = 0.6;
/// Side of the cells in which that is counted, and gap that parts two patches, in metres.
const CELL: f64 = 0.025;
const GAP: f64 = 0.05;
/// Cosine to the support's normal: of a level from here on, of a wall up to here (a tote's walls lean).
const LEVEL: f64 = 0.99;
const UPRIGHT: f64 = 0.3;
/// Half the distance over which a reading's normal is taken, in metres, and its cosine to that of its plane.
const AROUND: f64 = 0.02;
const ALIKE: f64 = 0.8;
/// How far beside its outline a wall goes on where its readings have no normal, in metres.
const EDGE: f64 = 0.01;
/// Walls that meet in a corner: how far apart they and their tops may be, in metres, and the cosine of their normals.
const CORNER: f64 = 0.05;
const SQUARE: f64 = 0.5;
/// Readings that the search sees, planes that it looks for, and readings without which it does not begin.
const SAMPLE: usize = 4000;
const MOST: usize = 8;
const LEAST: usize = 400;
/// How far behind its face, and beside it, what belongs to a wall or a board lies, in metres: its rim, its edge.
const THICK: f64 = 0.035;
const BESIDE: f64 = 0.03;
/// Share of a piece that lies there when it is a part of it.
const PART: f64 = 0.7;
/// How far under a level the top of a leg or a panel that carries it is, at most, in metres.
const UNDER: f64 = 0.05;

/// Levels and walls.
#[derive(Clone, Debug, Default)]
pub(crate) struct Room {
    pub(crate) levels: Vec<Support>,
    pub(crate) walls: Vec<Wall>,
}

/// A plane patch that is no object.
#[derive(Clone, Debug)]
pub(crate) struct Wall {
    /// The normal towards the sensor, where its place is known.
    pub(crate) plane: Plane,
    pub(crate) points: Vec<u32>,
    outline: Outline,
    /// Height of its top over the support, in metres.
    top: f64,
    /// Some of its points.
    sample: Vec<Point>,
}

/// The room among the points named by `indices`.
pub(crate) fn furnish(
    cloud: &PointCloud,
    indices: &[u32],
    support: &Support,
    sight: &Sight,
    options: &SegmentOptions,
) -> Room {
    // a stream of its own: what is found of the table does not depend on it
    let random = &mut Stream::new(options.seed, 1);
    let mut room = Room::default();
    if indices.len() < LEAST {
        return room;
    }
    let up = support.plane.normal();
    let normals = rough_normals(cloud, indices, sight);
    let mut sides = Vec::new();
    for level in [true, false] {
        let leans = |n: &Direction| up.dot(n).abs();
        let allowed = |n: &Direction| if level { leans(n) > LEVEL } else { leans(n) < UPRIGHT };
        // what has no normal, or another, is no part of such a plane
        let fits = |n: &Option<Direction>| {
            n.is_none_or(|n| n.norm() > 0.5 && (leans(&n) > ALIKE) == level)
        };
        let some = indices.iter().zip(&normals).filter(|(_, n)| fits(n));
        let mut free: Vec<(u32, Option<Direction>)> = some.map(|(i, n)| (*i, *n)).collect();
        let named: Vec<u32> = free.iter().map(|f| f.0).collect();
        let sample = spread(&named, SAMPLE, random);
        let all = readings(cloud, &sample, sight);
        let point = |i: &u32| cloud.points.get(*i as usize);
        let origin = sample.first().and_then(point).zip(all.first()).map(|(p, r)| p.coords - r.ray);
        let Some(origin) = origin.filter(|_| free.len() >= LEAST) else { continue };
        let eye = Point::from(origin);
        for candidate in dominant(&all, MOST, random, allowed) {
            let Some(plane) = candidate.plane(&origin).filter(|p| allowed(&p.normal())) else {
                continue;
            };
            let inside = |i: &u32| {
                point(i).is_some_and(|p| {
                    let r = Reading::new(p, sight, &eye);
                    let width = r.slope * plane.normal().dot(&r.ray).abs() + r.floor;
                    plane.height(p).abs() < width
                })
            };
            let ground = Ground::of(&plane);
            let faces =
                |n: &Option<Direction>| n.is_none_or(|n| n.dot(&plane.normal()).abs() > ALIKE);
            let near = free
                .iter()
                .filter(|(i, n)| faces(n) && inside(i))
                .map(|f| f.0)
                .collect::<Vec<u32>>();
            let mut taken = Vec::new();
            for points in patches(cloud, &near, &ground) {
                let spots: Vec<Spot> =
                    points.iter().filter_map(point).map(|p| ground.spot(p)).collect();
                let outline = Outline::around(&mut spots.clone());
                let Some(rectangle) = outline.rectangle() else { continue };
                let [long, short] = rectangle.half.map(|h| 2.0 * h);
                if long < SIDE || covered(&spots, &rectangle) < COVERED {
                    continue;
                }
                let middle = spot_on(&plane, &rectangle.middle);
                let faces_up = plane.normal().dot(&up) > 0.0 || sight.eye.is_none();
                if level && faces_up {
                    let differs = |l: &Support| l.plane.height(&middle).abs() > STEP;
                    let apart = differs(support) && room.levels.iter().all(differs);
                    if long > LARGE && short > DEEP && apart {
                        let found = refine(cloud, &points, &plane, sight, random);
                        let found = found.map(|l| l.upwards(&up));
                        room.levels.extend(found.filter(|l| allowed(&l.plane.normal())));
                        taken.extend(points);
                    }
                    continue;
                }
                let all = indices.iter().copied().filter(|i| {
                    inside(i) && point(i).is_some_and(|p| outline.depth(&ground.spot(p)) > -EDGE)
                });
                let wall = Wall::new(cloud, all.collect(), plane, outline, support);
                let tall = level || wall.rise(support) > TALL;
                if tall && long > LARGE {
                    taken.extend(&wall.points);
                    room.walls.push(wall);
                } else if tall && !level {
                    sides.push(wall);
                }
            }
            taken.sort_unstable();
            free.retain(|(i, _)| taken.binary_search(i).is_err());
        }
    }
    let mut known = 0;
    while known < room.walls.len() {
        let wall = room.walls[known].clone();
        let (corners, rest): (Vec<Wall>, Vec<Wall>) =
            sides.into_iter().partition(|side| side.corners(&wall));
        room.walls.extend(corners);
        sides = rest;
        known += 1;
    }
    room.walls.iter_mut().for_each(|w| w.points.sort_unstable());
    room
}

/// The contiguous patches of the points of a plane, the largest first.
fn patches(cloud: &PointCloud, points: &[u32], ground: &Ground) -> Vec<Vec<u32>> {
    let foot = |i: &u32| {
        let [x, y] = ground.spot(&cloud.points[*i as usize]);
        Point::new(x, y, 0.0)
    };
    let feet: Vec<Point> = points.iter().map(foot).collect();
    let Some(grid) = VoxelGrid::new(&feet, 0..feet.len() as u32, 0.5 * GAP) else {
        return Vec::new();
    };
    let mut patches = grid.components();
    patches.sort_by_key(|p| std::cmp::Reverse(p.len()));
    patches.truncate(MOST);
    patches.iter_mut().for_each(|p| p.iter_mut().for_each(|i| *i = points[*i as usize]));
    patches
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

/// The normals of some points of an image by the readings about a hand's breadth around; `None` for other clouds.
fn rough_normals(cloud: &PointCloud, indices: &[u32], sight: &Sight) -> Vec<Option<Direction>> {
    let known = grid(cloud).zip(sight.pixel).zip(sight.eye);
    let normal = |i: &u32| {
        let (([width, height], pixel), eye) = known?;
        let i = *i as usize;
        let step =
            (AROUND / (pixel * (cloud.points.get(i)? - eye).norm())).clamp(2.0, 40.0) as usize;
        let (u, v) = (i % width, i / width);
        let (left, right) = (u.saturating_sub(step), (u + step).min(width - 1));
        let (above, below) = (v.saturating_sub(step), (v + step).min(height - 1));
        let across = cloud.points[v * width + right] - cloud.points[v * width + left];
        let down = cloud.points[below * width + u] - cloud.points[above * width + u];
        Direction::try_new(across.cross(&down), 1e-12).filter(|n| n.x.is_finite())
    };
    let nothing = Direction::new_unchecked(Vector::zeros());
    indices
        .iter()
        .map(|i| if known.is_some() { normal(i).or(Some(nothing)) } else { None })
        .collect()
}

impl Wall {
    fn new(
        cloud: &PointCloud,
        points: Vec<u32>,
        plane: Plane,
        outline: Outline,
        support: &Support,
    ) -> Self {
        let step = points.len().div_ceil(500).max(1);
        let some = points.iter().step_by(step).filter_map(|i| cloud.points.get(*i as usize));
        let sample: Vec<Point> = some.copied().collect();
        let top = sample.iter().map(|p| support.plane.height(p)).fold(f64::MIN, f64::max);
        Self { plane, points, outline, top, sample }
    }

    /// Whether most of a piece is a part of it, as the rim of a tote is.
    pub(crate) fn has_part(&self, sample: &[Point]) -> bool {
        is_part(sample, &self.plane, &self.outline, 0.5 * THICK)
    }

    /// Height from its lowest to its highest point, in metres.
    fn rise(&self, support: &Support) -> f64 {
        let lowest = self.sample.iter().map(|p| support.plane.height(p)).fold(f64::MAX, f64::min);
        self.top - lowest
    }

    /// Whether it meets another wall in a corner and rises as high.
    fn corners(&self, other: &Self) -> bool {
        let near =
            |p: &Point| other.sample.iter().any(|q| (p - q).norm_squared() < CORNER * CORNER);
        self.plane.normal().dot(&other.plane.normal()).abs() < SQUARE
            && (self.top - other.top).abs() < CORNER
            && self.sample.iter().any(near)
    }
}

/// Whether most of a piece lies in the thickness of a plane patch.
fn is_part(sample: &[Point], plane: &Plane, outline: &Outline, front: f64) -> bool {
    let ground = Ground::of(plane);
    let inside = |p: &&Point| {
        let h = plane.height(p);
        h > -THICK && h < front && outline.depth(&ground.spot(p)) > -BESIDE
    };
    sample.iter().filter(inside).count() as f64 > PART * sample.len() as f64
}

impl Support {
    fn upwards(self, up: &Direction) -> Self {
        if self.plane.normal().dot(up) > 0.0 {
            return self;
        }
        // the same spots by the other normal's axes
        let corners = self.corners();
        let plane = self.plane.flipped();
        let ground = Ground::of(&plane);
        let outline = Outline::around(&mut corners.iter().map(|p| ground.spot(p)).collect());
        Self { plane, outline, ..self }
    }

    /// Whether a spot over which a point is belongs to what was seen of it, or nearly.
    pub(crate) fn is_under(&self, p: &Point) -> bool {
        self.outline.depth(&Ground::of(&self.plane).spot(p)) > -BESIDE
    }

    /// Whether a piece is a part of it, as its edge is, or reaches up to it from below, as a leg does.
    pub(crate) fn has_part(&self, sample: &[Point]) -> bool {
        is_part(sample, &self.plane, &self.outline, 0.5 * THICK) || {
            let mut heights: Vec<f64> = sample.iter().map(|p| self.plane.height(p)).collect();
            heights.sort_unstable_by(f64::total_cmp);
            let top = heights.iter().nth_back(heights.len() / 50).copied().unwrap_or(f64::MIN);
            let under = sample.iter().filter(|p| self.is_under(p)).count();
            top > -UNDER && top < 0.5 * THICK && 2 * under > sample.len()
        }
    }

    /// The board that it is as seen from below: its outline's rectangle, a few centimetres thick, in metres.
    pub(crate) fn board(&self) -> Option<OrientedBox> {
        let rectangle = self.outline.rectangle()?;
        flat_box(&self.plane, &rectangle, [-0.5 * THICK, 0.0])
    }
}

/// The box over a rectangle in a plane, between two heights.
fn flat_box(plane: &Plane, r: &Rectangle, [low, high]: [f64; 2]) -> Option<OrientedBox> {
    let [u, v] = plane.tangents();
    let (z, x) = (plane.normal().into_inner(), *u * r.along[0] + *v * r.along[1]);
    let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, z.cross(&x), z]));
    let middle = spot_on(plane, &r.middle) + z * (0.5 * (low + high));
    let pose = Pose::from_parts(middle.into(), UnitQuaternion::from_rotation_matrix(&turn));
    OrientedBox::new(pose, [r.half[0], r.half[1], 0.5 * (high - low)]).ok()
}

/// The least box around some points one of whose faces is parallel to a plane; `None` where they have no area.
pub(crate) fn box_about(cloud: &[Point], points: &[u32], plane: &Plane) -> Option<OrientedBox> {
    let ground = Ground::of(plane);
    let step = points.len().div_ceil(5000).max(1);
    let some = || points.iter().step_by(step).filter_map(|i| cloud.get(*i as usize));
    let outline = Outline::around(&mut some().map(|p| ground.spot(p)).collect());
    let heights = some().map(|p| plane.height(p));
    let range = heights.fold([f64::MAX, f64::MIN], |r, h| [r[0].min(h), r[1].max(h)]);
    flat_box(plane, &outline.rectangle()?, range)
}
