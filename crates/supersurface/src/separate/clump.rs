//! A clump as pieces between its concave edges, or as one body where that explains them all.

use std::cell::{LazyCell, OnceCell};

use super::bodies::{AS_RING, Around, ROUGHLY, Seen};
use super::split::{is_better, split};
use super::{Piece, Reason};
use crate::fit::{Fit, FitOptions};
use crate::segment::convex_pieces;
use crate::surface::Surface;

/// Points of the least piece, and the share of its clump's.
const LEAST: usize = 150;
const SLIVER: f64 = 0.02;
/// Distance from the surface that a sliver joins, in metres.
const BESIDE: f64 = 0.006;
/// Points from which a careful fit of all of them is no matter of course.
const MUCH: usize = 10_000;
/// Pieces from which a clump is no single body.
const MANY: usize = 12;
/// How many times farther from one body than from their own the parts of a clump are at most, that is one.
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
    let trial = Trial { scene, points, rough: OnceCell::new() };
    let whole = LazyCell::new(|| Piece::new(scene, clump, points.to_vec(), options));
    let body = || whole.fit.as_ref().ok().filter(|fit| !scene.is_corner(points, fit));
    let as_one = |joined: Option<Reason>| {
        let joined = joined.into_iter().collect();
        vec![Piece { joined, fitted: true, ..whole.clone() }]
    };
    // of much a rough body tells whether a careful one is worth while
    let at_once = points.len() < MUCH || trial.is_plain();
    if at_once && body().is_some_and(|fit| scene.is_plain(points, fit)) {
        return as_one(None);
    }
    let least = LEAST.max((SLIVER * points.len() as f64) as usize);
    let pieces = convex_pieces(scene.cloud, points);
    let (large, mut slivers): (Vec<_>, Vec<_>) = pieces.into_iter().partition(|p| p.len() >= least);
    let rough = |points| Piece::new(scene, clump, points, &ROUGHLY);
    let parts: Vec<Piece> = if large.len() < 2 {
        let found = whole.fit.as_ref().ok().and_then(|fit| split(scene, points, fit));
        let Some(sides) = found else {
            return as_one((!slivers.is_empty()).then_some(Reason::Sliver));
        };
        slivers.clear();
        sides.map(rough).to_vec()
    } else {
        let parts: Vec<Piece> = large.into_iter().map(rough).collect();
        let is_alike = parts.len() < MANY && (at_once || trial.is_alike(&parts));
        if is_alike && body().is_some_and(|fit| explains(scene, fit, &parts)) {
            return as_one(Some(Reason::Whole));
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
struct Trial<'a> {
    scene: &'a Around<'a>,
    points: &'a [u32],
    rough: OnceCell<(Seen, Option<Fit>)>,
}

impl Trial<'_> {
    fn rough(&self) -> &(Seen, Option<Fit>) {
        self.rough.get_or_init(|| {
            let seen = self.scene.seen(self.points);
            let fit = seen.fit(&ROUGHLY).ok();
            (seen, fit)
        })
    }

    /// Whether it shows that there is nothing to cut.
    fn is_plain(&self) -> bool {
        self.rough().1.as_ref().is_some_and(|fit| self.scene.is_plain(self.points, fit))
    }

    /// Whether it, or a ring, is near to all parts.
    fn is_alike(&self, parts: &[Piece]) -> bool {
        let (seen, convex) = self.rough();
        let does = |fit: &Fit| does_as_well(self.scene, fit, parts);
        convex.as_ref().is_some_and(does) || seen.fit(&AS_RING).is_ok_and(|fit| does(&fit))
    }
}

/// Sum over all points of the parts of what their part has.
fn sum(parts: &[Piece], of: impl Fn(&Piece) -> f64) -> f64 {
    parts.iter().map(|p| of(p) * p.points.len() as f64).sum()
}

/// Whether a body is not much farther from the parts than their own are, nor are these plainly better.
fn does_as_well(scene: &Around<'_>, body: &Fit, parts: &[Piece]) -> bool {
    let count = sum(parts, |_| 1.0);
    let left = sum(parts, |p| scene.rough(&p.points, body)) / count;
    let own = sum(parts, |p| p.rough) / count;
    left < UNLIKE * own && !is_better(scene, left, own)
}

/// Whether one body explains all parts of a clump.
fn explains(scene: &Around<'_>, body: &Fit, parts: &[Piece]) -> bool {
    if !does_as_well(scene, body, parts) {
        return false;
    }
    let unexplained = |worse: f64, slight: f64| {
        let poorly = |p: &Piece| scene.typical(&p.points, body) > (worse * p.own).max(slight);
        sum(parts, |p| f64::from(u8::from(poorly(p))))
    };
    let hollow = matches!(body.surface.shape(), Surface::Supertoroid(_));
    unexplained(WORSE, SLIGHT) == 0.0
        || hollow && unexplained(HOLLOW_WORSE, HOLLOW_SLIGHT) < HANDLE * sum(parts, |_| 1.0)
}
