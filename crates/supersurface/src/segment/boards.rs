//! Which level facets are supports?
//!
//! One of something too large for an object is: a desk over the floor. So is a board, beneath which the eye sees, and
//! whose edge is low: a box that lies across others shows its side. And so is the bottom of a tote or a shelf, by the
//! walls that rise from its edges.

use std::collections::BTreeSet;

use crate::cloud::PointCloud;
use crate::numeric::random::Stream;
use crate::segment::facets::{CELL, Facet};
use crate::segment::footprint::{Ground, Spot};
use crate::segment::room::{LARGE, Scene};
use crate::segment::sight::seen;
use crate::segment::solids::THICK;
use crate::segment::table::{Support, refine};
use crate::segment::walls::Wall;

/// Length of a board that the eye sees beneath, and width of a level, at least, in metres.
const BOARD: f64 = 0.25;
const DEEP: f64 = 0.08;
/// Height between two levels, at least, and of a bottom over what it stands on, in metres.
const STEP: f64 = 0.1;
const LOW: f64 = 0.012;
/// Share of a board's middle under which something was seen, at least, and how far under it, in metres.
const OPEN: f64 = 0.3;
const CLEAR: f64 = 0.045;
/// Where the side of something thicker than a board would be seen: how far under its top, and beside its outline, in
/// metres.
const FACE: [f64; 2] = [0.08, 0.005];
const BESIDE: f64 = 0.02;
/// Length of a bottom, at least, in multiples of its longest wall's.
const SPAN: f64 = 0.7;

/// The supports among level facets.
pub(crate) fn levels(scene: &Scene<'_>, facets: &[Facet], random: &mut Stream) -> Vec<Support> {
    let mut levels: Vec<Support> = Vec::new();
    for facet in facets {
        let middle = facet.middle();
        let differs = |other: &Support| other.plane.height(&middle).abs() > STEP;
        let long = facet.size(scene.sight)[0];
        let is_level = faces_up(scene, facet)
            && differs(scene.support)
            && levels.iter().all(differs)
            && (long > LARGE && scene.stock.is_vast(facet)
                || long > BOARD && is_board(scene.cloud, facet));
        if is_level {
            levels.extend(support(scene, facet, random));
        }
    }
    levels
}

/// The bottom of a tote or a shelf among level facets: as long as two walls that rise from its edges, nearly.
pub(crate) fn bottom(
    scene: &Scene<'_>,
    facets: &[Facet],
    walls: &[Wall],
    random: &mut Stream,
) -> Option<Support> {
    let is_bottom = |facet: &&Facet| {
        let around: Vec<&Wall> = walls.iter().filter(|wall| wall.rises_from(facet)).collect();
        let longest = around.iter().map(|wall| wall.length()).fold(0.0, f64::max);
        faces_up(scene, facet)
            && (LOW..STEP).contains(&scene.support.plane.height(&facet.middle()))
            && around.len() > 1
            && facet.size(scene.sight)[0] > SPAN * longest
    };
    support(scene, facets.iter().find(is_bottom)?, random)
}

/// Whether a facet is wide and faces up.
fn faces_up(scene: &Scene<'_>, facet: &Facet) -> bool {
    let faces_up = facet.plane.normal().dot(&scene.support.plane.normal()) > 0.0;
    2.0 * facet.rectangle.half[1] > DEEP && (faces_up || scene.sight.eye.is_none())
}

/// The support that a facet is.
fn support(scene: &Scene<'_>, facet: &Facet, random: &mut Stream) -> Option<Support> {
    let found = refine(scene.cloud, &scene.within(facet), &facet.plane, scene.sight, random);
    Some(found?.upwards(&scene.support.plane.normal()))
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
        let (thin, thick) = (height > -THICK, height < -CLEAR && height > -FACE[0]);
        let beside = || facet.outline.holds(&spot, -BESIDE) && !facet.outline.holds(&spot, BESIDE);
        if (thin || thick) && beside() {
            if thin {
                edge.insert(cell(spot))
            } else {
                face.insert(cell(spot))
            };
        }
    }
    under.len() as f64 > OPEN * inner.len() as f64
        && 2 * edge.intersection(&face).count() <= edge.len()
}
