//! What a scene is furnished with: further levels that things stand on, and walls beside and behind them.
//!
//! A facet of something too large for an object is furniture: level, and it is a support of its own (a desk over the
//! floor); upright, and it is a wall. What might be an object, by its size, must show that it is none: a board lets
//! the eye see beneath it, and the walls of a tote or a shelf meet in a corner that opens towards the eye, while the
//! faces of a parcel meet in edges and carry its top. What meets such a wall in a corner and rises as high is a wall too.

use std::collections::BTreeSet;

use crate::Point;
use crate::cloud::PointCloud;
use crate::numeric::random::Stream;
use crate::segment::SegmentOptions;
use crate::segment::facets::{CELL, Facet, Family, facets, lies_in};
use crate::segment::footprint::{Ground, Spot};
use crate::segment::sight::{Sight, seen};
use crate::segment::solids::{THICK, is_part};
use crate::segment::table::{Support, refine};

/// Size of a piece in which furniture is looked for, and length of a facet of it, at least, in metres.
const LARGE: f64 = 0.4;
/// Width of a level, and height of a wall, at least, in metres.
const DEEP: f64 = 0.08;
const TALL: f64 = 0.06;
/// Height between two levels, at least, in metres.
const STEP: f64 = 0.1;
/// Depth beneath the support from which a point may be of another one, in metres.
const BENEATH: f64 = 0.1;
/// Share of a board's middle under which something was seen, at least, and how far under it, in metres.
const OPEN: f64 = 0.1;
const CLEAR: f64 = 0.05;
/// How far beside its outline a wall goes on where its readings have no normal, in metres.
const EDGE: f64 = 0.01;
/// Walls that meet in a corner: how far apart they and their tops may be, in metres, and the cosine of their normals.
const CORNER: f64 = 0.05;
const SQUARE: f64 = 0.5;
/// Share of its length along which a wall carries a level top behind it when it is the face of a body, and how far from
/// its own top that may be, in metres.
const CARRIES: f64 = 0.3;
const RIM: f64 = 0.025;

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
            if size > LARGE {
                stock.points.extend(piece);
            }
            if size > options.largest_size {
                stock.vast.extend(piece);
            }
        }
        let beneath = |p: &Point| seen(p) && support.plane.height(p) < -BENEATH;
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
    Room {
        levels: levels(cloud, stock, support, sight, random),
        walls: walls(cloud, stock, support, sight, random),
    }
}

/// The level facets that are supports.
fn levels(
    cloud: &PointCloud,
    stock: &Stock,
    support: &Support,
    sight: &Sight,
    random: &mut Stream,
) -> Vec<Support> {
    let up = support.plane.normal();
    let mut levels: Vec<Support> = Vec::new();
    for facet in facets(cloud, &stock.points, Family::Level, &up, sight, random) {
        let [long, short] = facet.size(sight);
        let faces_up = facet.plane.normal().dot(&up) > 0.0 || sight.eye.is_none();
        if long < LARGE || short < DEEP || !faces_up {
            continue;
        }
        let middle = facet.middle();
        let differs = |other: &Support| other.plane.height(&middle).abs() > STEP;
        if !differs(support) || !levels.iter().all(differs) {
            continue;
        }
        if stock.is_vast(&facet) || is_open(cloud, &facet) {
            let found = refine(cloud, &facet.points, &facet.plane, sight, random);
            levels.extend(found.map(|level| level.upwards(&up)));
        }
    }
    levels
}

/// Whether the eye sees beneath a facet: not just beside it, but past it under its middle.
fn is_open(cloud: &PointCloud, facet: &Facet) -> bool {
    let ground = Ground::of(&facet.plane);
    let cell = |[x, y]: Spot| [(x / CELL).floor() as i64, (y / CELL).floor() as i64];
    let place = |p: &Point| cell(ground.spot(p));
    let point = |i: &u32| cloud.points.get(*i as usize);
    let own: BTreeSet<[i64; 2]> = facet.points.iter().filter_map(point).map(place).collect();
    let is_inner =
        |[x, y]: &[i64; 2]| (-1..=1).all(|dx| (-1..=1).all(|dy| own.contains(&[x + dx, y + dy])));
    let inner: BTreeSet<[i64; 2]> = own.iter().filter(|c| is_inner(c)).copied().collect();
    let beneath = |p: &&Point| seen(p) && facet.plane.height(p) < -CLEAR;
    let some = cloud.points.iter().step_by(3).filter(beneath);
    let seen: BTreeSet<[i64; 2]> = some.map(place).filter(|c| inner.contains(c)).collect();
    !inner.is_empty() && seen.len() as f64 > OPEN * inner.len() as f64
}

/// The upright facets that are walls.
fn walls(
    cloud: &PointCloud,
    stock: &Stock,
    support: &Support,
    sight: &Sight,
    random: &mut Stream,
) -> Vec<Wall> {
    let up = support.plane.normal();
    let found = facets(cloud, &stock.points, Family::Upright, &up, sight, random);
    let tall: Vec<(Wall, bool)> = found
        .into_iter()
        .map(|facet| (stock.is_vast(&facet), facet))
        .map(|(vast, facet)| (Wall::new(cloud, &stock.points, facet, support, sight), vast))
        .filter(|(wall, _)| wall.heights[1] - wall.heights[0] > TALL)
        .filter(|(wall, vast)| *vast || !wall.is_face(cloud, &stock.points, support))
        .collect();
    let is_sure = |(wall, vast): &(Wall, bool)| {
        let enclosed = || tall.iter().any(|(other, _)| wall.encloses(other));
        wall.facet.size(sight)[0] > LARGE && (*vast || sight.eye.is_some() && enclosed())
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
    walls
}

impl Wall {
    fn new(
        cloud: &PointCloud,
        indices: &[u32],
        mut facet: Facet,
        support: &Support,
        sight: &Sight,
    ) -> Self {
        let (ground, eye) = (Ground::of(&facet.plane), facet.middle());
        let is_within = |i: &u32| {
            cloud.points.get(*i as usize).is_some_and(|p| {
                facet.outline.depth(&ground.spot(p)) > -EDGE
                    && lies_in(cloud, *i, &facet.plane, sight, &eye)
            })
        };
        facet.points = indices.iter().copied().filter(is_within).collect();
        let step = facet.points.len().div_ceil(500).max(1);
        let some = facet.points.iter().step_by(step).filter_map(|i| cloud.points.get(*i as usize));
        let sample: Vec<Point> = some.copied().collect();
        let range = sample.iter().map(|p| support.plane.height(p));
        let heights = range.fold([f64::MAX, f64::MIN], |r, h| [r[0].min(h), r[1].max(h)]);
        Self { facet, heights, sample }
    }

    /// Whether it is the face of a body, whose top goes on behind it.
    fn is_face(&self, cloud: &PointCloud, indices: &[u32], support: &Support) -> bool {
        let plane = &self.facet.plane;
        let along = support.plane.normal().cross(&plane.normal());
        let cell = |p: &Point| (along.dot(&p.coords) / CELL).floor() as i64;
        let own: BTreeSet<i64> = self.sample.iter().map(cell).collect();
        let behind = |p: &&Point| {
            let depth = -plane.height(p);
            depth > THICK
                && depth < 3.0 * THICK
                && (support.plane.height(p) - self.heights[1]).abs() < RIM
        };
        let points = indices.iter().filter_map(|i| cloud.points.get(*i as usize));
        let top: BTreeSet<i64> =
            points.filter(behind).map(cell).filter(|c| own.contains(c)).collect();
        top.len() as f64 > CARRIES * own.len() as f64
    }

    /// Whether it meets another wall.
    fn touches(&self, other: &Self) -> bool {
        let near =
            |p: &Point| other.sample.iter().any(|q| (p - q).norm_squared() < CORNER * CORNER);
        let normals = self.facet.plane.normal().dot(&other.facet.plane.normal());
        normals.abs() < SQUARE && self.sample.iter().any(near)
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

    /// Whether a point lies in its thickness.
    pub(crate) fn holds(&self, p: &Point) -> bool {
        is_part(p, &self.facet.plane, &self.facet.outline)
    }
}
