//! What a scene is furnished with: further levels that things stand on, and walls beside and behind them.
//!
//! A facet of something too large for an object is furniture: level, and it is a support of its own (a desk over the
//! floor); upright, and it is a wall. What might be an object, by its size, must show that it is none: see
//! [`boards`](super::boards) and [`walls`](super::walls).

use crate::Point;
use crate::cloud::PointCloud;
use crate::numeric::random::Stream;
use crate::segment::SegmentOptions;
use crate::segment::boards::{bottom, levels};
use crate::segment::class::Class;
use crate::segment::facets::{Facet, Family, Turned, facets, lies_in};
use crate::segment::footprint::Ground;
use crate::segment::sight::Sight;
use crate::segment::table::Support;
use crate::segment::walls::{Wall, walls};

/// Size of a piece in which furniture is looked for, in metres.
const SPACIOUS: f64 = 0.5;
/// Length of a facet of something too large for an object, or of a tote's longer wall, at least, in metres.
pub(crate) const LARGE: f64 = 0.4;
/// How far beside its outline a facet goes on where its readings have no normal of their own, in metres.
const EDGE: f64 = 0.02;

/// Levels and walls.
#[derive(Clone, Debug, Default)]
pub(crate) struct Room {
    pub(crate) levels: Vec<Support>,
    pub(crate) walls: Vec<Wall>,
}

/// Where furniture is looked for.
#[derive(Clone, Debug, Default)]
pub(crate) struct Stock {
    /// Points of large pieces, and beneath the support, in ascending order.
    pub(crate) points: Vec<u32>,
    /// Those of them that are of no object: of pieces too large for one, and beneath the support.
    vast: Vec<u32>,
}

impl Stock {
    pub(crate) fn of(
        cloud: &PointCloud,
        pieces: &[Vec<u32>],
        class: &[Class],
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
        let beneath = class.iter().zip(0u32..).filter(|(c, _)| **c == Class::Beneath);
        for (_, i) in beneath {
            stock.points.push(i);
            stock.vast.push(i);
        }
        stock.points.sort_unstable();
        stock.vast.sort_unstable();
        stock
    }

    /// Whether most of a facet is of no object.
    pub(crate) fn is_vast(&self, facet: &Facet) -> bool {
        let vast = facet.points.iter().filter(|i| self.vast.binary_search(i).is_ok()).count();
        2 * vast > facet.points.len()
    }
}

/// A scene in which furniture is looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene<'a> {
    pub(crate) cloud: &'a PointCloud,
    pub(crate) stock: &'a Stock,
    pub(crate) support: &'a Support,
    pub(crate) sight: &'a Sight,
}

/// The room that the stock shows.
pub(crate) fn furnish(scene: &Scene<'_>, options: &SegmentOptions) -> Room {
    // a stream of its own: what is found of the table does not depend on it
    let random = &mut Stream::new(options.seed, 1);
    let (up, points) = (scene.support.plane.normal(), &scene.stock.points);
    let turned = Turned::of(scene.cloud, points, scene.sight);
    let level = facets(scene.cloud, &turned, Family::Level, &up, scene.sight, random);
    let mut levels = levels(scene, &level, random);
    let upright = facets(scene.cloud, &turned, Family::Upright, &up, scene.sight, random);
    let walls = walls(scene, upright, &level, &levels);
    levels.extend(bottom(scene, &level, &walls, random));
    Room { levels, walls }
}

impl Scene<'_> {
    /// The readings of the stock in the plane of a facet, up to its edges.
    pub(crate) fn within(&self, facet: &Facet) -> Vec<u32> {
        let (ground, eye) = (Ground::of(&facet.plane), facet.middle());
        let near = |p: &Point| facet.outline.holds(&ground.spot(p), -EDGE);
        let is_within = |i: &u32| {
            self.cloud.points.get(*i as usize).is_some_and(near)
                && lies_in(self.cloud, *i, &facet.plane, self.sight, &eye)
        };
        self.stock.points.iter().copied().filter(is_within).collect()
    }

    /// Some of the points of a list.
    pub(crate) fn some(&self, indices: &[u32]) -> Vec<Point> {
        let step = indices.len().div_ceil(500).max(1);
        let some = indices.iter().step_by(step).filter_map(|i| self.cloud.points.get(*i as usize));
        some.copied().collect()
    }
}
