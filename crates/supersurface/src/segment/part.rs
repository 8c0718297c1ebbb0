//! Which support does a piece stand on, and which is part of the room?

use crate::Point;
use crate::cloud::PointCloud;
use crate::segment::class::{Class, Margins};
use crate::segment::clusters::pieces;
use crate::segment::footprint::Ground;
use crate::segment::image::Image;
use crate::segment::objects::gather;
use crate::segment::room::{Room, Scene, Stock, furnish};
use crate::segment::sight::{Sight, grid};
use crate::segment::solids::{SIDE, THICK, is_over, is_part};
use crate::segment::table::Support;
use crate::segment::walls::Wall;
use crate::segment::{DropReason, Dropped, SegmentOptions, Segmentation};

/// Depth beneath a support at which a point may still be its own, in metres.
const SLACK: f64 = 0.03;
/// Points of a piece without which it is none, and those of it that are looked at.
const LEAST: usize = 20;
const SOME: usize = 400;
/// Share of a piece that lies in the thickness of walls, or of a board, when it is a part of them.
const PART: f64 = 0.7;
/// How far under a level the top of a leg or a panel that carries it is, at most, in metres.
const UNDER: f64 = 0.04;

/// The objects over the supports, and what was left out.
pub(crate) fn part(
    cloud: &PointCloud,
    main: Support,
    sight: &Sight,
    options: &SegmentOptions,
) -> Segmentation {
    let mut class = Margins::of(&main, sight, options).classes(&cloud.points);
    let all = pieces(cloud, &class, sight, options.gap, LEAST);
    let stock = Stock::of(cloud, &all, &class, options);
    let scene = Scene { cloud, stock: &stock, support: &main, sight };
    let Room { levels, walls } = furnish(&scene, options);
    let supports: Vec<Support> = std::iter::once(main).chain(levels).collect();
    let (on, mut dropped) = if supports.len() == 1 && walls.is_empty() {
        (vec![all], Vec::new())
    } else {
        let below = standing(&cloud.points, &supports);
        let margins: Vec<Margins> =
            supports.iter().map(|s| Margins::of(s, sight, options)).collect();
        for ((class, p), k) in class.iter_mut().zip(&cloud.points).zip(&below) {
            if *k > 0 {
                *class = margins[*k as usize].class(p);
            }
        }
        let taken = walls.iter().flat_map(|wall| &wall.facet.points);
        taken.for_each(|i| class[*i as usize] = Class::Other);
        let pieces = pieces(cloud, &class, sight, options.gap, LEAST);
        allot(cloud, pieces, &supports, &below, &walls)
    };
    let mut objects: Vec<(Vec<u32>, usize)> = Vec::new();
    for (k, (support, pieces)) in supports.iter().zip(on).enumerate() {
        let image = match (grid(cloud), sight.eye) {
            (Some([width, _]), Some(eye)) => Image::new(&cloud.points, &class, width, eye),
            _ => None,
        };
        let (found, left) = gather(&cloud.points, pieces, support, sight, image, options);
        objects.extend(found.into_iter().map(|points| (points, k)));
        dropped.extend(left);
    }
    objects.sort_unstable_by_key(|(points, _)| points.first().copied());
    let (objects, stands_on) = objects.into_iter().unzip();
    Segmentation { supports, objects, stands_on, dropped, image: None }
}

/// The pieces on each support, and what is part of the room.
fn allot(
    cloud: &PointCloud,
    pieces: Vec<Vec<u32>>,
    supports: &[Support],
    below: &[u32],
    walls: &[Wall],
) -> (Vec<Vec<Vec<u32>>>, Vec<Dropped>) {
    let (mut on, mut dropped) = (vec![Vec::new(); supports.len()], Vec::new());
    // where two walls meet the first has the points
    let mut is_free = vec![true; cloud.points.len()];
    let mut own = |wall: &Wall| -> Vec<u32> {
        let mut points = wall.facet.points.clone();
        points.retain(|i| std::mem::take(&mut is_free[*i as usize]));
        points
    };
    let mut solid: Vec<Vec<u32>> = walls.iter().map(&mut own).collect();
    for piece in pieces {
        let some = piece.iter().step_by(piece.len().div_ceil(SOME).max(1));
        let some: Vec<Point> = some.map(|i| cloud.points[*i as usize]).collect();
        let owner = |p: &Point| walls.iter().position(|wall| wall.holds(p));
        let owners: Vec<usize> = some.iter().filter_map(owner).collect();
        if owners.len() as f64 > PART * some.len() as f64 {
            solid[most(&owners, walls.len())].extend(piece);
            continue;
        }
        let below: Vec<usize> = piece.iter().map(|i| below[*i as usize] as usize).collect();
        let k = most(&below, supports.len());
        if supports.iter().enumerate().any(|(j, s)| j != k && s.has_part(&some)) {
            let (reason, plane) = (DropReason::Fixture, &supports[k].plane);
            dropped.push(Dropped::new(&cloud.points, piece, reason, plane));
        } else {
            on[k].push(piece);
        }
    }
    for (mut points, wall) in solid.into_iter().zip(walls) {
        points.sort_unstable();
        dropped.push(Dropped::new(&cloud.points, points, DropReason::Wall, &wall.facet.plane));
    }
    (on, dropped)
}

/// The support that each point is over: the highest beneath it that was seen there, else the first beneath it.
fn standing(points: &[Point], supports: &[Support]) -> Vec<u32> {
    let grounds: Vec<Ground> = supports.iter().map(|s| Ground::of(&s.plane)).collect();
    let of = |p: &Point| {
        let heights = supports.iter().zip(&grounds).zip(0u32..).map(|((s, ground), k)| {
            let height = s.plane.height(p);
            (height, k, height > -SLACK && s.outline.holds(&ground.spot(p), -SIDE))
        });
        let under = heights.clone().filter(|(_, _, over)| *over);
        let nearest = under.min_by(|a, b| a.0.total_cmp(&b.0));
        nearest.or_else(|| heights.clone().find(|(h, _, _)| *h > -SLACK)).map_or(0, |(_, k, _)| k)
    };
    match supports.len() {
        1 => vec![0; points.len()],
        _ => points.iter().map(of).collect(),
    }
}

/// The value that comes most often; of several, the least. 0 for none.
fn most(values: &[usize], count: usize) -> usize {
    let mut votes = vec![0usize; count];
    values.iter().for_each(|k| votes[*k] += 1);
    let best = votes.iter().copied().max();
    votes.iter().position(|v| Some(*v) == best).unwrap_or(0)
}

impl Support {
    /// Whether a piece is a part of it, as its edge is, or reaches up to it from below, as a leg does.
    fn has_part(&self, sample: &[Point]) -> bool {
        let own = sample.iter().filter(|p| is_part(p, &self.plane, &self.outline, SIDE)).count();
        if own as f64 > PART * sample.len() as f64 {
            return true;
        }
        let mut heights: Vec<f64> = sample.iter().map(|p| self.plane.height(p)).collect();
        heights.sort_unstable_by(f64::total_cmp);
        // a few stray readings do not count
        let top = heights.iter().nth_back(heights.len() / 50).copied().unwrap_or(f64::MIN);
        let under = sample.iter().filter(|p| is_over(p, &self.plane, &self.outline)).count();
        top > -UNDER && top < 0.5 * THICK && 2 * under > sample.len()
    }
}
