//! Pairs of pieces that one surface explains, where there is a reason to think that they are one object.

use std::cell::OnceCell;
use std::collections::BTreeMap;

use super::bodies::{Around, ROUGHLY};
use super::view::{Border, View};
use super::{Piece, Reason, each};
use crate::fit::Fit;

/// A pair of pieces that are one object.
#[derive(Clone, Copy, Debug)]
pub(super) struct Joint {
    pub(super) pieces: [usize; 2],
    pub(super) reason: Reason,
    /// How badly one surface explains both; 1 is the most.
    cost: f64,
}

/// Pieces that are looked at, the largest: more are noise.
const MOST: usize = 100;
/// How much worse than a piece's own surface that of both may explain it, up to which distance that does not matter, and
/// from which nothing is explained, in metres.
const WORSE: f64 = 1.1;
const SLIGHT: f64 = 0.0014;
const POOR: f64 = 0.003;
/// The same of the mean distance, in which what is off the surface counts.
const ROUGHER: f64 = 2.5;
/// Share of what is between two ends of a thing that may be seen to be empty.
const HOLES: f64 = 0.15;
/// Share of a piece that lies outside planes which touch the other from which nothing convex has both, and points of a
/// piece that tell how it is turned.
const OUTER: f64 = 0.25;
const TURNED: usize = 1000;
/// What contradicted lines of sight cost, as a multiple of their share.
const AGAINST: f64 = 3.3;
/// What a surface that goes on behind something may cost.
const BEHIND: f64 = 1.5;
/// Pairs of pixels up to which pieces do not touch.
const APART: u32 = 15;
/// Pairs of pixels from which an inside and an outside meet at a rim, and how few of them, one in so many, may touch.
const RIM: u32 = 50;
const JUMPS: u32 = 4;
/// Shares of points at which the surface faces the eye on the outside and on the inside.
const OUTSIDE: f64 = 0.8;
const INSIDE: f64 = 0.2;
/// Difference in height, in metres and as a share, up to which two pieces reach one rim.
const UNEVEN: f64 = 0.02;
const UNEVEN_SHARE: f64 = 0.15;
/// A piece half of which lies in this highest share of its height is the top of something, not an inside.
const LEVEL: f64 = 0.2;
/// Share of the larger piece's points up to which the smaller may be due to a dent.
const DENT: f64 = 0.3;
/// Distance of a piece from a larger one's surface, in metres, up to which both may be one.
const ON: f64 = 0.008;
/// What a surface over a dent or a seam may cost.
const SHALLOW: f64 = 0.8;

/// All pairs that hold, the best first.
pub(super) fn joints(
    scene: &Around<'_>,
    view: &View<'_>,
    pieces: &[Piece],
    borders: &BTreeMap<[usize; 2], Border>,
) -> Vec<Joint> {
    let outlines: Vec<Vec<u32>> = pieces.iter().map(|p| view.outline(&p.points)).collect();
    let mut largest: Vec<usize> = (0..pieces.len()).collect();
    largest.sort_by_key(|k| (std::cmp::Reverse(pieces[*k].points.len()), *k));
    largest.truncate(MOST);
    largest.sort_unstable();
    let after = |a: usize| largest.iter().filter(move |b| **b > a).map(move |b| [a, *b]);
    let pairs: Vec<[usize; 2]> = largest.iter().flat_map(|a| after(*a)).collect();
    let tried = each(pairs.len(), |k| {
        let [a, b] = pairs[k];
        let border = borders.get(&[a, b]).copied().unwrap_or_default();
        let pieces = [&pieces[a], &pieces[b]];
        let pair = Pair { scene, view, pieces, border, body: OnceCell::new() };
        let found = [
            pair.behind([&outlines[a], &outlines[b]]).map(|cost| (cost, Reason::Behind)),
            pair.hollow().map(|cost| (cost, Reason::Hollow)),
            pair.dent().map(|cost| (cost, Reason::Dent)),
            pair.unbroken().map(|cost| (cost, Reason::Unbroken)),
        ];
        let best = found.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0));
        best.map(|(cost, reason)| Joint { pieces: [a, b], reason, cost })
    });
    let mut joints: Vec<Joint> = tried.into_iter().flatten().collect();
    joints.sort_by(|a, b| a.cost.total_cmp(&b.cost));
    joints
}

/// True where one surface explains all of more than two pieces.
pub(super) fn is_one(scene: &Around<'_>, pieces: &[&Piece], hollow: bool) -> bool {
    if pieces.len() < 3 {
        return true;
    }
    let mut points: Vec<u32> = pieces.iter().flat_map(|p| &p.points).copied().collect();
    points.sort_unstable();
    let fit = if hollow { scene.fit_hollow(&points) } else { scene.fit(&points, &ROUGHLY) };
    fit.is_ok_and(|fit| pieces.iter().all(|p| scene.typical(&p.points, &fit) < POOR))
}

struct Pair<'a> {
    scene: &'a Around<'a>,
    view: &'a View<'a>,
    pieces: [&'a Piece; 2],
    border: Border,
    /// The convex body of both, where there is one, once it was asked for.
    body: OnceCell<Option<Fit>>,
}

impl Pair<'_> {
    fn fit(&self) -> Option<&Fit> {
        self.body.get_or_init(|| self.scene.fit(&self.union(), &ROUGHLY).ok()).as_ref()
    }

    fn union(&self) -> Vec<u32> {
        let mut points = self.pieces.map(|p| &p.points[..]).concat();
        points.sort_unstable();
        points
    }

    /// How badly a surface explains the worse of both.
    fn cost(&self, fit: &Fit) -> f64 {
        let cost = |piece: &&Piece| {
            let off = self.scene.off(&piece.points, fit);
            if off.mean() > ROUGHER * piece.rough {
                return f64::INFINITY;
            }
            let distance = off.median();
            let most = (WORSE * piece.own).max(SLIGHT);
            if distance > POOR { f64::INFINITY } else { distance / most }
        };
        self.pieces.iter().map(cost).fold(0.0, f64::max)
    }

    /// False where one piece lies outside planes that touch the other's surface; a small one hardly tells how it is turned.
    fn may_be_convex(&self) -> bool {
        let [a, b] = self.pieces;
        let outside = |own: &Piece, other: &Piece| {
            let tells = own.points.len() >= TURNED.min(other.points.len());
            let fit = own.fit.as_ref().ok().filter(|_| tells);
            fit.is_some_and(|fit| self.scene.share_beyond(&own.points, fit, &other.points) > OUTER)
        };
        !outside(a, b) && !outside(b, a)
    }

    /// Two ends of what something nearer hides.
    fn behind(&self, outlines: [&[u32]; 2]) -> Option<f64> {
        if self.border.touching > APART || !self.view.hides_between(outlines[0], outlines[1]) {
            return None;
        }
        let [a, b] = self.pieces.map(|p| &p.points[..]);
        if self.view.empty_between(a, b) > HOLES {
            return None;
        }
        if !self.may_be_convex() {
            return None;
        }
        let fit = self.fit()?;
        let cost = self.cost(fit);
        if cost > 1.0 {
            return None;
        }
        let against = self.view.contradicted(fit, [a, b]);
        let cost = cost + AGAINST * against;
        (cost < BEHIND).then_some(cost / BEHIND)
    }

    /// The inside and the outside of a thing, at whose rim the depth jumps.
    fn hollow(&self) -> Option<f64> {
        // both reach the rim
        let [a, b] = self.pieces.map(|p| p.heights[2]);
        if (a - b).abs() > UNEVEN + UNEVEN_SHARE * a.max(b) {
            return None;
        }
        // in one clump, pieces that do not touch were taken for the two sides of a cup
        let [a, b] = self.pieces;
        let sides = a.clump == b.clump && self.border.touching <= APART;
        if !sides && (self.border.beside < RIM || self.border.touching * JUMPS > self.border.beside)
        {
            return None;
        }
        let fit = self.scene.fit_hollow(&self.union()).ok()?;
        let cost = self.cost(&fit);
        let [a, b] = self.pieces.map(|p| self.scene.facing(&p.points, &fit));
        let [inside, outside] = if a < b { self.pieces } else { [self.pieces[1], self.pieces[0]] };
        let seen = a.max(b) >= OUTSIDE && a.min(b) <= INSIDE;
        let [low, middle, high] = inside.heights;
        let is_level = high - middle < LEVEL * (high - low);
        let over_rim = |s| self.view.over_rim(&fit, &inside.points, &s, outside.heights[2]);
        let holds = cost < 1.0 && seen && !is_level && self.scene.support.is_some_and(over_rim);
        holds.then_some(cost)
    }

    /// A piece that a dent parts from a larger one.
    fn dent(&self) -> Option<f64> {
        let [a, b] = self.pieces.map(|p| p.points.len());
        if self.border.touching <= APART || a.min(b) as f64 > DENT * a.max(b) as f64 {
            return None;
        }
        // the larger goes on about where the smaller is
        let [small, large] = if a < b { self.pieces } else { [self.pieces[1], self.pieces[0]] };
        let on = large.fit.as_ref().is_ok_and(|f| self.scene.typical(&small.points, f) < ON);
        if !on {
            return None;
        }
        let fit = self.fit()?;
        Some(self.cost(fit)).filter(|cost| *cost < SHALLOW)
    }

    /// Pieces of one surface that noise parted: it goes on from one to the other, and one body explains both.
    fn unbroken(&self) -> Option<f64> {
        if self.border.touching <= APART {
            return None;
        }
        let [a, b] = self.pieces.map(|p| &p.points[..]);
        if self.view.bend(a, b)? < 0.0 {
            return None;
        }
        let fit = self.fit()?;
        Some(self.cost(fit)).filter(|cost| *cost < SHALLOW)
    }
}
