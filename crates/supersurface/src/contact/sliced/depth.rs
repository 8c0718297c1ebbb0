//! The shortest translation that parts two bodies that overlap.
//!
//! Locally it is found by `settle`: places where the bodies touch in one point, as well as those where one is
//! held at two or three, as a box in a round hole is, and which no common normal leads to. Which of these is
//! the shortest is decided over cells of directions: that no translation of a cell up to some length parts is shown by
//! `blocked`, and a cell where it cannot be shown leads to a shorter one, or is split in four.

use super::apart::nearest;
use super::blocked::Blocked;
use super::body::Sliced;
use super::directions::Cell;
use super::grid::Grid;
use super::settle::{Parting, Settling, TOUCHING};
use crate::contact::{Contact, WarmStart};
use crate::shape::InvalidShape;
use crate::{Direction, Point, Vector};

/// Slices of a body at first, if it alone is cut, and if both are; others are added where a body slips between them.
const SLICES: [usize; 2] = [64, 20];
/// Cells after which the bounds are what they are.
const MOST: usize = 300;
/// The depth is shown to be at least this share of what was found, if the cells last.
const CONTENT: f64 = 0.95;
/// Directions out of the bodies' hulls that are tried first.
const OUTWARD: usize = 3;
/// Directions that lead out after this many times the best length are followed at first.
const AROUND: f64 = 1.15;
/// A direction has led out where no more than this share of its length still overlaps.
const OUT: f64 = 1e-3;
/// How often one is settled again where slices still overlap.
const CHECKED: usize = 8;
/// Slices that overlap are looked for until there are none by more than this, relative to the bodies' size.
const CLEAR: f64 = 1e-6;
/// How often the best is taken up again.
const POLISHES: usize = 20;
/// Shorter translations have no direction, relative to the bodies' size.
const NONE: f64 = 1e-12;

/// The contact of two bodies that overlap, by a translation of the second.
pub(super) fn depth(bodies: [&Sliced; 2]) -> Result<Contact, InvalidShape> {
    let both = bodies.iter().all(|body| body.as_convex().is_none());
    let grid = Grid::new(bodies, SLICES[usize::from(both)])?;
    let size = bodies[0].size().min(bodies[1].size());
    let mut settling = Settling::new(bodies, &grid, size);
    let ways = || Cell::all().into_iter().flat_map(|c| c.quarters()).map(|c| c.way());
    let outward = |way: &Vector| (bodies[0].extent(way) + bodies[1].extent(&-way)).max(0.0);
    let mut hull: Vec<(f64, Vector)> = ways().map(|way| (outward(&way), way)).collect();
    hull.sort_by(|p, q| p.0.total_cmp(&q.0));
    let (sure, way) = hull[0];
    let best = settling.at(way * sure)?;
    let blocked = Blocked::new(&grid);
    let mut search = Search { bodies, size, sure, settling, blocked, known: Vec::new(), best };
    for (length, way) in &hull[..OUTWARD] {
        search.settle(way * *length)?;
    }
    // minima next to each other are told apart by where they lead, not by the directions' own lengths
    for way in ways() {
        search.follow(&way, 0.0, AROUND * search.best.by.norm())?;
    }
    let least = search.least()?;
    search.polish()?;
    search.contact(least)
}

struct Search<'a> {
    bodies: [&'a Sliced; 2],
    /// The smaller body's size.
    size: f64,
    /// The length of a translation out of the other's hull.
    sure: f64,
    settling: Settling<'a>,
    blocked: Blocked,
    /// Where searches led.
    known: Vec<Parting>,
    /// The shortest that parts.
    best: Parting,
}

impl Search<'_> {
    /// No translation is shorter than this: shown over cells of directions, while shorter ones are found. More than
    /// `CONTENT` of the best is not shown.
    fn least(&mut self) -> Result<f64, InvalidShape> {
        let mut queue = Cell::all();
        let mut open: Vec<(f64, Cell)> = Vec::new();
        let mut seen = 0;
        while let Some(cell) = queue.pop() {
            seen += 1;
            let (way, goal) = (cell.way(), CONTENT * self.best.by.norm());
            let reach = self.blocked.until(&way, cell.spread(), 0.0, goal);
            if reach < goal {
                self.follow(&way, reach, self.best.by.norm())?;
                open.push((reach, cell));
            }
            let goal = CONTENT * self.best.by.norm();
            open.retain(|(reach, _)| *reach < goal);
            if queue.is_empty() && seen < MOST && !self.blocked.exhausted(true) {
                let least = (0..open.len()).min_by(|i, j| open[*i].0.total_cmp(&open[*j].0));
                queue.extend(least.map(|k| open.swap_remove(k).1.quarters()).into_iter().flatten());
            }
        }
        let goal = CONTENT * self.best.by.norm();
        Ok(open.iter().map(|(reach, _)| *reach).fold(goal, f64::min))
    }

    /// Takes up the best again: slow searches were not at their end.
    fn polish(&mut self) -> Result<(), InvalidShape> {
        self.settling.renew();
        for _ in 0..POLISHES {
            let length = self.best.by.norm();
            let Some(found) = self.settling.settle(self.best.by, &[])? else { break };
            self.take(found)?;
            if length - self.best.by.norm() <= NONE * self.size {
                break;
            }
        }
        Ok(())
    }

    fn contact(&self, least: f64) -> Result<Contact, InvalidShape> {
        let Parting { by, touch } = self.best;
        let length = by.norm();
        let most = self.longest()?.max(length);
        let normal = Direction::try_new(by, NONE * self.size).unwrap_or(touch.contact.normal);
        let on_first = touch.contact.witnesses[0];
        Ok(Contact {
            distance: -length,
            bounds: [-most, -least.min(length)],
            normal,
            witnesses: [on_first, Point::from(on_first.coords - by)],
        })
    }

    /// Where a translation settles is known from now on.
    fn settle(&mut self, from: Vector) -> Result<(), InvalidShape> {
        match self.settling.settle(from, &self.known)? {
            Some(found) => self.take(found),
            None => Ok(()),
        }
    }

    /// Makes one that is shorter the best. If slices between those that were asked still overlap after it, then where it
    /// settles with them, if they are clear within a few rounds.
    fn take(&mut self, found: Parting) -> Result<(), InvalidShape> {
        let mut found = found;
        for _ in 0..CHECKED {
            self.known.push(found);
            if found.by.norm() >= self.best.by.norm() {
                break;
            }
            let moved = self.bodies[1].moved(&found.by);
            let bodies = [self.bodies[0], &moved];
            let touch = nearest(bodies, CLEAR, -2.0 * TOUCHING, &mut WarmStart::default())?;
            if touch.contact.distance > -2.0 * TOUCHING * self.size {
                self.best = found;
                break;
            }
            self.settling.add(touch.at);
            match self.settling.settle(found.by, &[])? {
                Some(next) => found = next,
                None => break,
            }
        }
        Ok(())
    }

    /// Follows a direction that is blocked up to `reach` out of the first body, if that takes less than `limit`.
    fn follow(&mut self, way: &Vector, reach: f64, limit: f64) -> Result<(), InvalidShape> {
        match self.exit(way, reach, limit)? {
            Some(length) => self.settle(way * length),
            None => Ok(()),
        }
    }

    /// The length, less than `limit`, at which a direction first leads out of the first body; slices are added where only
    /// those between block.
    fn exit(&mut self, way: &Vector, reach: f64, limit: f64) -> Result<Option<f64>, InvalidShape> {
        let (mut reach, mut added) = (reach, false);
        loop {
            let before = reach;
            reach = self.blocked.until(way, 0.0, reach, limit);
            if reach >= limit || self.blocked.exhausted(false) {
                return Ok(None);
            }
            let touch = self.settling.at(way * reach)?.touch;
            if touch.contact.distance >= -OUT * limit {
                return Ok(Some(reach));
            }
            // a slice that was added and leads no farther was not what blocks
            if self.blocked.full() || (added && reach <= before) {
                return Ok(None);
            }
            let [a, b] = touch.at;
            self.blocked.add([self.bodies[0].slice(a)?, self.bodies[1].slice(b)?]);
            added = true;
        }
    }

    /// A length of which it is shown that a translation as long parts: little more than the best's, or out of the hull.
    fn longest(&self) -> Result<f64, InvalidShape> {
        let (Parting { by, touch }, size) = (self.best, self.size);
        let length = by.norm();
        let way = by.try_normalize(0.0).unwrap_or(touch.contact.normal.into_inner());
        let more = 1e-3 * length.max(1e-2 * size);
        let moved = self.bodies[1].moved(&(way * (length + more)));
        let content = 0.3 * more / size;
        let bodies = [self.bodies[0], &moved];
        let found = nearest(bodies, content, 0.0, &mut WarmStart::default())?.contact;
        Ok(if found.bounds[0] > 0.0 { self.sure.min(length + more) } else { self.sure })
    }
}
