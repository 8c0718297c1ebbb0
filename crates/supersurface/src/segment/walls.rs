//! Which upright facets are walls?
//!
//! One of something too large for an object is. What might be an object must show that it is none: the walls of a tote
//! or a shelf meet in a corner that opens towards the eye, while the faces of a parcel meet in edges and carry its top;
//! and the back of a board is as long as that. What meets a wall in a corner and rises as high is a wall too.

use crate::Point;
use crate::segment::facets::Facet;
use crate::segment::footprint::{Ground, Outline, spot_on};
use crate::segment::room::{LARGE, Scene};
use crate::segment::solids::{SIDE, THICK, is_part};
use crate::segment::table::Support;

/// Height of a wall, at least, in metres.
const TALL: f64 = 0.06;
/// Walls that meet in a corner: how far apart they and their tops may be, in metres, and the cosine of their normals.
const CORNER: f64 = 0.05;
const SQUARE: f64 = 0.5;
/// How far from its own top what a wall carries may be, in metres.
const RIM: f64 = 0.025;
/// Length of a back, at least, in multiples of its board's.
const BACK: f64 = 0.7;

/// An upright facet that is no object.
#[derive(Clone, Debug)]
pub(crate) struct Wall {
    pub(crate) facet: Facet,
    /// Heights of its lowest and highest point over the support, in metres.
    heights: [f64; 2],
    /// Some of its points.
    sample: Vec<Point>,
}

/// The walls among upright facets, by what lies level and the further supports.
pub(crate) fn walls(
    scene: &Scene<'_>,
    upright: Vec<Facet>,
    level: &[Facet],
    boards: &[Support],
) -> Vec<Wall> {
    if boards.is_empty() && upright.iter().all(|facet| facet.size(scene.sight)[0] < LARGE) {
        return Vec::new();
    }
    let mut tall: Vec<(Wall, bool)> = Vec::new();
    for facet in upright {
        let vast = scene.stock.is_vast(&facet);
        let wall = Wall::new(scene, facet);
        let rise = wall.heights[1] - wall.heights[0];
        if rise > TALL && (vast || !level.iter().any(|top| wall.carries(top, scene))) {
            tall.push((wall, vast));
        }
    }
    let is_sure = |(wall, vast): &(Wall, bool)| {
        let long = wall.facet.size(scene.sight)[0];
        let enclosed = || tall.iter().any(|(other, _)| wall.encloses(other));
        long > LARGE && (*vast || scene.sight.eye.is_some() && enclosed())
            || boards.iter().any(|board| wall.backs(board, long))
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
    walls.iter_mut().for_each(|wall| wall.add_rim(scene));
    walls
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
    fn new(scene: &Scene<'_>, mut facet: Facet) -> Self {
        facet.outline = grounded(&facet, scene.support);
        facet.points = scene.within(&facet);
        let sample = scene.some(&facet.points);
        let range = sample.iter().map(|p| scene.support.plane.height(p));
        let heights = range.fold([f64::MAX, f64::MIN], |r, h| [r[0].min(h), r[1].max(h)]);
        Self { facet, heights, sample }
    }

    /// Whether it is the face of a body: whether a level facet, its top, goes on behind it.
    fn carries(&self, top: &Facet, scene: &Scene<'_>) -> bool {
        let middle = top.middle();
        (scene.support.plane.height(&middle) - self.heights[1]).abs() < RIM
            && self.facet.plane.height(&middle) < -THICK
            && self.is_near(&scene.some(&top.points))
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
    pub(crate) fn rises_from(&self, level: &Facet) -> bool {
        let corners = level.outline.corners().iter().map(|s| spot_on(&level.plane, s));
        let rises = self.sample.iter().any(|p| level.plane.height(p) > TALL);
        rises && self.is_near(&corners.collect::<Vec<Point>>())
    }

    /// Its length, in metres.
    pub(crate) fn length(&self) -> f64 {
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
    fn add_rim(&mut self, scene: &Scene<'_>) {
        let point = |i: &u32| scene.cloud.points.get(*i as usize);
        let is_rim = |i: &&u32| point(i).is_some_and(|p| self.is_rim(p, scene.support));
        let rim: Vec<u32> = scene.stock.points.iter().filter(is_rim).copied().collect();
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
