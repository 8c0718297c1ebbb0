//! A clump as pieces between its concave edges, or as one body where that explains them all.

use std::cell::OnceCell;

use super::bodies::{AS_RING, Around, ROUGHLY, Seen};
use super::split::{is_better, split};
use super::{Piece, Reason};
use crate::fit::{Fit, FitOptions};
use crate::segment::convex_pieces;
use crate::surface::Surface;

/// Points of the least piece, and the share of its clump's.
const LEAST: usize = 150;
const SLIVER: f64 = 0.02;
/// Points from which it is worth while to ask first whether there is anything to cut.
const LARGE: usize = 4000;
/// Distance from the surface that a sliver joins, in metres.
const BESIDE: f64 = 0.006;
/// Pieces from which a clump is no single body.
const MANY: usize = 12;
/// How many times farther from a rough convex body than from their own the parts of a clump are at most, that is one body
/// or a ring.
const UNLIKE: f64 = 4.5;
/// How much worse than a piece's own surface that of the whole clump may explain it, and up to which distance in metres
/// that does not matter.
const WORSE: f64 = 1.3;
const SLIGHT: f64 = 0.0012;
/// The same for a body whose hole is seen: its inside is concave and cut at random. A handle, which it leaves out, has at
/// most this share of its points.
const HOLLOW_WORSE: f64 = 1.8;
const HOLLOW_SLIGHT: f64 = 0.0023;
const HANDLE: f64 = 0.2;

/// The pieces of clump number `clump`; one where there is nothing to cut, fitted as its object will be.
pub(super) fn clumped(
    scene: &Around<'_>,
    clump: usize,
    points: &[u32],
    options: &FitOptions,
) -> Vec<Piece> {
    let whole = |joined: Option<Reason>| {
        let piece = Piece::new(scene, clump, points.to_vec(), options);
        vec![Piece { joined: joined.into_iter().collect(), fitted: true, ..piece }]
    };
    let convex = Convex { scene, points, found: OnceCell::new() };
    if points.len() > LARGE && convex.is_plain() {
        return whole(None);
    }
    let least = LEAST.max((SLIVER * points.len() as f64) as usize);
    let pieces = convex_pieces(scene.cloud, points);
    let (large, mut slivers): (Vec<_>, Vec<_>) = pieces.into_iter().partition(|p| p.len() >= least);
    let whole = |joined: Option<Reason>| {
        let piece = Piece::new(scene, clump, points.to_vec(), options);
        vec![Piece { joined: joined.into_iter().collect(), fitted: true, ..piece }]
    };
    let rough = |points| Piece::new(scene, clump, points, &ROUGHLY);
    let parts: Vec<Piece> = if large.len() < 2 {
        let all = whole((!slivers.is_empty()).then_some(Reason::Sliver));
        let found = all[0].fit.as_ref().ok().and_then(|fit| split(scene, &all[0].points, fit));
        let Some(sides) = found else { return all };
        slivers.clear();
        sides.map(rough).to_vec()
    } else {
        let parts: Vec<Piece> = large.into_iter().map(rough).collect();
        if parts.len() < MANY && convex.is_alike(&parts) {
            let all = whole(Some(Reason::Whole));
            if all[0].fit.as_ref().is_ok_and(|fit| explains(scene, points, fit, &parts)) {
                return all;
            }
        }
        parts
    };
    let mut parts = cut(scene, parts, rough);
    parts.sort_by_key(|part| part.points[0]);
    for sliver in slivers {
        let distance =
            |part: &Piece| part.fit.as_ref().map_or(f64::INFINITY, |f| scene.typical(&sliver, f));
        let nearest = parts.iter_mut().map(|part| (distance(part), part));
        if let Some((distance, part)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0))
            && distance < BESIDE
        {
            part.points.extend(sliver);
            part.points.sort_unstable();
            part.joined = vec![Reason::Sliver];
        }
    }
    parts
}

/// The parts, those cut that two bodies explain and one does not.
fn cut(scene: &Around<'_>, mut parts: Vec<Piece>, rough: impl Fn(Vec<u32>) -> Piece) -> Vec<Piece> {
    let mut whole = Vec::with_capacity(parts.len());
    while let Some(part) = parts.pop() {
        match part.fit.as_ref().ok().and_then(|fit| split(scene, &part.points, fit)) {
            Some(sides) => parts.extend(sides.map(&rough)),
            None => whole.push(part),
        }
    }
    whole
}

/// A rough convex body for all points of a clump, once it was asked for.
struct Convex<'a> {
    scene: &'a Around<'a>,
    points: &'a [u32],
    found: OnceCell<(Seen, Option<Fit>)>,
}

impl Convex<'_> {
    fn found(&self) -> &(Seen, Option<Fit>) {
        self.found.get_or_init(|| {
            let seen = self.scene.seen(self.points);
            let fit = seen.fit(&ROUGHLY).ok();
            (seen, fit)
        })
    }

    /// Whether it shows that there is nothing to cut.
    fn is_plain(&self) -> bool {
        self.found().1.as_ref().is_some_and(|fit| self.scene.is_plain(self.points, fit))
    }

    /// Whether a careful fit of one body to all parts is worth while, by this one or a ring.
    fn is_alike(&self, parts: &[Piece]) -> bool {
        let all = |of: &dyn Fn(&Piece) -> f64| {
            parts.iter().map(|p| of(p) * p.points.len() as f64).sum::<f64>()
        };
        let own = all(&|p| p.rough);
        let alike = |fit: &Fit| all(&|p| self.scene.rough(&p.points, fit)) < UNLIKE * own;
        let (seen, convex) = self.found();
        convex.as_ref().is_some_and(alike) || seen.fit(&AS_RING).is_ok_and(|fit| alike(&fit))
    }
}

/// Whether one body explains all parts of a clump.
fn explains(scene: &Around<'_>, points: &[u32], whole: &Fit, parts: &[Piece]) -> bool {
    let hollow = matches!(whole.surface.shape(), Surface::Supertoroid(_));
    if scene.is_corner(points, whole) {
        return false;
    }
    let unexplained = |worse: f64, slight: f64| {
        let poorly = |p: &&Piece| scene.typical(&p.points, whole) > (worse * p.own).max(slight);
        parts.iter().filter(poorly).map(|p| p.points.len()).sum::<usize>() as f64
    };
    let all = parts.iter().map(|p| p.points.len()).sum::<usize>() as f64;
    let mean = |of: &dyn Fn(&Piece) -> f64| {
        parts.iter().map(|p| of(p) * p.points.len() as f64).sum::<f64>() / all
    };
    if is_better(scene, mean(&|p| scene.rough(&p.points, whole)), mean(&|p| p.rough)) {
        return false;
    }
    unexplained(WORSE, SLIGHT) == 0.0
        || hollow && unexplained(HOLLOW_WORSE, HOLLOW_SLIGHT) < HANDLE * all
}
