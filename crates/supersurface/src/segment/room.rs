//! What a scene is furnished with: further levels that things stand on, and walls beside and behind them.
//!
//! A facet of something too large for an object is furniture: level, and it is a support of its own (a desk over the
//! floor); upright, and it is a wall. What might be an object, by its size, must show that it is none: a board lets
//! the eye see beneath it, and the walls of a tote or a shelf meet in a corner that opens towards the eye, while the
//! faces of a parcel meet in edges and carry its top. What meets such a wall in a corner and rises as high is a wall too.

use std::collections::BTreeSet;

use crate::cloud::PointCloud;
use crate::numeric::random::Stream;
use crate::segment::SegmentOptions;
use crate::segment::facets::{CELL, Facet, Family, facets, lies_in};
use crate::segment::footprint::{Ground, Outline, Spot, spot_on};
use crate::segment::sight::{Sight, seen};
use crate::segment::solids::{SIDE, THICK, is_part};
use crate::segment::table::{Support, refine};
use crate::{Direction, Point};

/// Size of a piece in which furniture is looked for, and length of a facet of it, at least, in metres.
const SPACIOUS: f64 = 0.5;
const LARGE: f64 = 0.4;
/// Length of a board that the eye sees beneath, at least, in metres.
const BOARD: f64 = 0.25;
/// Width of a level, and height of a wall, at least, in metres.
const DEEP: f64 = 0.08;
const TALL: f64 = 0.06;
/// Height between two levels, at least, in metres.
const STEP: f64 = 0.1;
/// Depth beneath the support from which a point may be of another one, in metres.
const BENEATH: f64 = 0.1;
/// Height of the bottom of a tote or a shelf over what it stands on, at least, in metres.
const LOW: f64 = 0.012;
/// Share of a board's middle under which something was seen, at least, and how far under it, in metres.
const OPEN: f64 = 0.3;
const CLEAR: f64 = 0.045;
/// Where the side of something thicker than a board would be seen: how far under its top, and beside its outline, in
/// metres.
const FACE: [f64; 2] = [0.08, 0.005];
const BESIDE: f64 = 0.02;
/// How far beside its outline a facet goes on where its readings have no normal of their own, in metres.
const EDGE: f64 = 0.02;
/// Walls that meet in a corner: how far apart they and their tops may be, in metres, and the cosine of their normals.
const CORNER: f64 = 0.05;
const SQUARE: f64 = 0.5;
/// How far from its own top what a wall carries may be, in metres.
const RIM: f64 = 0.025;
/// Length of a back, at least, in multiples of its board's.
const BACK: f64 = 0.7;

/// Levels and walls.
#[derive(Clone, Debug, Default)]
pub(crate) struct Room {
    pub(crate) levels: Vec<Support>,
    pub(crate) walls: Vec<Wall>,
}

/// An upright facet that is no object.
#[derive(Clone, Debug)]
pub(crate) struct Wall {
    pub(crate) facet: Facet,
    /// Heights of its lowest and highest point over the support, in metres.
    heights: [f64; 2],
    /// Some of its points.
    sample: Vec<Point>,
}

/// Where furniture is looked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stock {
    /// Points of large pieces, and beneath the support, in ascending order.
    points: Vec<u32>,
    /// Those of them that are of no object: of pieces too large for one, and beneath the support.
    vast: Vec<u32>,
}

impl Stock {
    pub(crate) fn of(
        cloud: &PointCloud,
        pieces: &[Vec<u32>],
        support: &Support,
        options: &SegmentOptions,
    ) -> Self {
        let size = |piece: &Vec<u32>| {
            let some = piece.iter().step_by(16).filter_map(|i| cloud.points.get(*i as usize));
            let bounds = some.fold(None, |b: Option<(Point, Point)>, p| {
                Some(b.map_or((*p, *p), |(l, h)| (l.inf(p), h.sup(p))))
            });
            bounds.map_or(0.0, |(low, high)| (high - low).norm())
        };
        let mut stock = Self::default();
        for piece in pieces {
            let size = size(piece);
            if size > SPACIOUS {
                stock.points.extend(piece);
            }
            if size > options.largest_size {
                stock.vast.extend(piece);
            }
        }
        let beneath = |p: &Point| support.plane.height(p) < -BENEATH && seen(p);
        let beneath = cloud.points.iter().zip(0u32..).filter(|(p, _)| beneath(p)).map(|(_, i)| i);
        for i in beneath {
            stock.points.push(i);
            stock.vast.push(i);
        }
        stock.points.sort_unstable();
        stock.vast.sort_unstable();
        stock
    }

    /// Whether most of a facet is of no object.
    fn is_vast(&self, facet: &Facet) -> bool {
        let vast = facet.points.iter().filter(|i| self.vast.binary_search(i).is_ok()).count();
        2 * vast > facet.points.len()
    }
}

/// The room that the stock shows.
pub(crate) fn furnish(
    cloud: &PointCloud,
    stock: &Stock,
    support: &Support,
    sight: &Sight,
    options: &SegmentOptions,
) -> Room {
    // a stream of its own: what is found of the table does not depend on it
    let random = &mut Stream::new(options.seed, 1);
    let up = support.plane.normal();
    let flat = facets(cloud, &stock.points, Family::Level, &up, sight, random);
    let mut levels: Vec<Support> = Vec::new();
    for facet in &flat {
        let middle = facet.middle();
        let differs = |other: &Support| other.plane.height(&middle).abs() > STEP;
        let long = facet.size(sight)[0];
        let is_level = facet.faces(&up, sight)
            && differs(support)
            && levels.iter().all(differs)
            && (long > LARGE && stock.is_vast(facet) || long > BOARD && is_board(cloud, facet));
        if is_level {
            let own = within(cloud, &stock.points, facet, sight);
            let found = refine(cloud, &own, &facet.plane, sight, random);
            levels.extend(found.map(|level| level.upwards(&up)));
        }
    }
    let upright = facets(cloud, &stock.points, Family::Upright, &up, sight, random);
    let mut tall: Vec<(Wall, bool)> = Vec::new();
    for facet in upright {
        let vast = stock.is_vast(&facet);
        let wall = Wall::new(cloud, &stock.points, facet, support, sight);
        let rise = wall.heights[1] - wall.heights[0];
        if rise > TALL && (vast || !flat.iter().any(|top| wall.carries(top, cloud, support))) {
            tall.push((wall, vast));
        }
    }
    let is_sure = |(wall, vast): &(Wall, bool)| {
        let long = wall.facet.size(sight)[0];
        let enclosed = || tall.iter().any(|(other, _)| wall.encloses(other));
        long > LARGE && (*vast || sight.eye.is_some() && enclosed())
            || levels.iter().any(|level| wall.backs(level, long))
    };
    let (sure, maybe): (Vec<_>, Vec<_>) = tall.iter().cloned().partition(is_sure);
    let mut walls: Vec<Wall> = sure.into_iter().map(|(wall, _)| wall).collect();
    let mut sides: Vec<Wall> = maybe.into_iter().map(|(wall, _)| wall).collect();
    let mut known = 0;
    while let Some(wall) = walls.get(known).cloned() {
        let (corners, rest): (Vec<Wall>, Vec<Wall>) =
            sides.into_iter().partition(|side| side.corners(&wall));
        walls.extend(corners);
        sides = rest;
        known += 1;
    }
    let mut floors: Vec<Support> = Vec::new();
    for facet in &flat {
        let middle = facet.middle();
        let low = support.plane.height(&middle);
        let bound = || walls.iter().filter(|wall| wall.bounds(facet)).map(Wall::length);
        let longest = bound().fold(0.0, f64::max);
        let is_floor = facet.faces(&up, sight)
            && (LOW..STEP).contains(&low)
            && floors.is_empty()
            && bound().count() > 1
            && facet.size(sight)[0] > BACK * longest;
        if is_floor {
            let own = within(cloud, &stock.points, facet, sight);
            let found = refine(cloud, &own, &facet.plane, sight, random);
            floors.extend(found.map(|level| level.upwards(&up)));
        }
    }
    levels.extend(floors);
    walls.iter_mut().for_each(|wall| wall.add_rim(cloud, &stock.points, support));
    Room { levels, walls }
}

impl Facet {
    /// Whether it is wide and faces up.
    fn faces(&self, up: &Direction, sight: &Sight) -> bool {
        let faces_up = self.plane.normal().dot(up) > 0.0 || sight.eye.is_none();
        faces_up && 2.0 * self.rectangle.half[1] > DEEP
    }
}

/// Whether a facet is the top of a board: the eye sees beneath it, past it under its middle and not just beside it,
/// and its edge is no taller than a board's.
fn is_board(cloud: &PointCloud, facet: &Facet) -> bool {
    let ground = Ground::of(&facet.plane);
    let cell = |[x, y]: Spot| [(x / CELL).floor() as i64, (y / CELL).floor() as i64];
    let own = facet.points.iter().filter_map(|i| cloud.points.get(*i as usize));
    let own: BTreeSet<[i64; 2]> = own.map(|p| cell(ground.spot(p))).collect();
    let is_inner =
        |[x, y]: &[i64; 2]| (-1..=1).all(|dx| (-1..=1).all(|dy| own.contains(&[x + dx, y + dy])));
    let inner: BTreeSet<[i64; 2]> = own.iter().filter(|c| is_inner(c)).copied().collect();
    let (mut under, mut edge, mut face) = (BTreeSet::new(), BTreeSet::new(), BTreeSet::new());
    for p in cloud.points.iter().step_by(2).filter(|p| seen(p)) {
        let height = facet.plane.height(p);
        if height > -FACE[1] {
            continue;
        }
        let spot = ground.spot(p);
        if height < -CLEAR && inner.contains(&cell(spot)) {
            under.insert(cell(spot));
        }
        if facet.outline.depth(&spot).abs() < BESIDE {
            if height > -THICK {
                edge.insert(cell(spot));
            } else if height < -CLEAR && height > -FACE[0] {
                face.insert(cell(spot));
            }
        }
    }
    under.len() as f64 > OPEN * inner.len() as f64
        && 2 * edge.intersection(&face).count() <= edge.len()
}

/// The readings in the plane of a facet, up to its edges.
fn within(cloud: &PointCloud, indices: &[u32], facet: &Facet, sight: &Sight) -> Vec<u32> {
    let (ground, eye) = (Ground::of(&facet.plane), facet.middle());
    let is_within = |i: &u32| {
        let near = |p: &Point| facet.outline.depth(&ground.spot(p)) > -EDGE;
        cloud.points.get(*i as usize).is_some_and(near)
            && lies_in(cloud, *i, &facet.plane, sight, &eye)
    };
    indices.iter().copied().filter(is_within).collect()
}

/// The outline of an upright facet down to the support: what hides its foot does not end it.
fn grounded(facet: &Facet, support: &Support) -> Outline {
    let (up, normal) = (support.plane.normal(), facet.plane.normal());
    let down = normal.into_inner() * normal.dot(&up) - up.into_inner();
    let ground = Ground::of(&facet.plane);
    let mut spots = facet.outline.corners().to_vec();
    for corner in facet.outline.corners() {
        let corner = spot_on(&facet.plane, corner);
        let foot = corner + down * (support.plane.height(&corner) / down.norm_squared());
        spots.push(ground.spot(&foot));
    }
    Outline::around(&mut spots)
}

impl Wall {
    fn new(
        cloud: &PointCloud,
        indices: &[u32],
        mut facet: Facet,
        support: &Support,
        sight: &Sight,
    ) -> Self {
        facet.outline = grounded(&facet, support);
        facet.points = within(cloud, indices, &facet, sight);
        let step = facet.points.len().div_ceil(500).max(1);
        let some = facet.points.iter().step_by(step).filter_map(|i| cloud.points.get(*i as usize));
        let sample: Vec<Point> = some.copied().collect();
        let range = sample.iter().map(|p| support.plane.height(p));
        let heights = range.fold([f64::MAX, f64::MIN], |r, h| [r[0].min(h), r[1].max(h)]);
        Self { facet, heights, sample }
    }

    /// Whether it is the face of a body: whether a level facet, its top, goes on behind it.
    fn carries(&self, top: &Facet, cloud: &PointCloud, support: &Support) -> bool {
        let middle = top.middle();
        let step = top.points.len().div_ceil(500).max(1);
        let some = top.points.iter().step_by(step).filter_map(|i| cloud.points.get(*i as usize));
        (support.plane.height(&middle) - self.heights[1]).abs() < RIM
            && self.facet.plane.height(&middle) < -THICK
            && self.is_near(some)
    }

    /// Whether it is the back of a board: rises from behind its middle and is as long, nearly.
    fn backs(&self, level: &Support, long: f64) -> bool {
        let Some(board) = level.board() else { return false };
        let foot = self.sample.iter().map(|p| level.plane.height(p)).fold(f64::MAX, f64::min);
        let middle = board.pose().translation.vector.into();
        long > BACK * 2.0 * board.half_extents()[0]
            && foot < CORNER
            && self.facet.plane.height(&middle) > 0.0
            && self.is_near(&level.corners())
    }

    /// Whether it meets another wall.
    fn touches(&self, other: &Self) -> bool {
        let normals = self.facet.plane.normal().dot(&other.facet.plane.normal());
        normals.abs() < SQUARE && self.is_near(&other.sample)
    }

    /// Whether it rises from the edge of a level facet.
    fn bounds(&self, level: &Facet) -> bool {
        let corners = level.outline.corners().iter().map(|s| spot_on(&level.plane, s));
        let rises = self.sample.iter().any(|p| level.plane.height(p) > TALL);
        rises && self.is_near(&corners.collect::<Vec<Point>>())
    }

    /// Its length, in metres.
    fn length(&self) -> f64 {
        2.0 * self.facet.rectangle.half[0]
    }

    /// Whether one of some points is near.
    fn is_near<'a>(&self, points: impl IntoIterator<Item = &'a Point>) -> bool {
        let near = |p: &Point| self.sample.iter().any(|q| (p - q).norm_squared() < CORNER * CORNER);
        points.into_iter().any(near)
    }

    /// Whether it meets another wall in a corner that opens towards the eye.
    fn encloses(&self, other: &Self) -> bool {
        let before = |a: &Facet, b: &Facet| a.plane.height(&b.middle()) > 0.0;
        before(&self.facet, &other.facet)
            && before(&other.facet, &self.facet)
            && self.touches(other)
    }

    /// Whether it meets another wall in a corner of any kind and rises as high.
    fn corners(&self, other: &Self) -> bool {
        (self.heights[1] - other.heights[1]).abs() < CORNER && self.touches(other)
    }

    /// Adds the readings of its rim.
    fn add_rim(&mut self, cloud: &PointCloud, indices: &[u32], support: &Support) {
        let point = |i: &u32| cloud.points.get(*i as usize);
        let is_rim = |i: &&u32| point(i).is_some_and(|p| self.is_rim(p, support));
        let rim: Vec<u32> = indices.iter().filter(is_rim).copied().collect();
        self.facet.points.extend(rim);
        self.facet.points.sort_unstable();
        self.facet.points.dedup();
    }

    /// Whether a point lies on its rim, which what stands before it may hide from the rest.
    fn is_rim(&self, p: &Point, support: &Support) -> bool {
        (support.plane.height(p) - self.heights[1]).abs() < RIM
            && is_part(p, &self.facet.plane, &self.facet.outline, 2.0 * CORNER)
    }

    /// Whether a point lies in its thickness.
    pub(crate) fn holds(&self, p: &Point) -> bool {
        is_part(p, &self.facet.plane, &self.facet.outline, SIDE)
    }
}
