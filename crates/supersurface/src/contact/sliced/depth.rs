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
use super::settle::{Parting, Settling};
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
/// How often the best is taken up again.
const POLISHES: usize = 20;
/// Shorter translations have no direction, relative to the bodies' size.
const NONE: f64 = 1e-12;

/// The contact of two bodies that overlap, by a translation of the second.
pub(super) fn depth(bodies: [&Sliced; 2]) -> Result<Contact, InvalidShape> {
    let both = bodies.iter().all(|body| body.as_convex().is_none());
    let grid = Grid::new(bodies, SLICES[usize::from(both)])?;
    let size = bodies[0].size().min(bodies[1].size());
    let settling = Settling::new(bodies, &grid, size);
    Search { bodies, size, settling, blocked: Blocked::new(&grid) }.solve()
}

struct Search<'a> {
    bodies: [&'a Sliced; 2],
    /// The smaller body's size.
    size: f64,
    settling: Settling<'a>,
    blocked: Blocked,
}

impl Search<'_> {
    fn solve(&mut self) -> Result<Contact, InvalidShape> {
        let ways = || Cell::all().into_iter().flat_map(|c| c.quarters()).map(|c| c.way());
        let mut outward: Vec<(f64, Vector)> = ways().map(|way| (self.outward(&way), way)).collect();
        outward.sort_by(|p, q| p.0.total_cmp(&q.0));
        let (sure, way) = outward[0];
        let mut known = Vec::new();
        for (length, way) in &outward[..OUTWARD] {
            known.extend(self.settling.settle(way * *length, &known)?);
        }
        let mut best = self.settling.at(way * sure)?;
        let shorter = |best: &mut Parting, known: &[Parting]| {
            for found in known {
                if found.by.norm() < best.by.norm() {
                    *best = *found;
                }
            }
        };
        shorter(&mut best, &known);
        // minima next to each other are told apart by where they lead, not by the directions' own lengths
        for way in ways() {
            self.follow(&mut known, &way, 0.0, AROUND * best.by.norm())?;
            shorter(&mut best, &known);
        }
        let mut queue = Cell::all();
        let mut open: Vec<(f64, Cell)> = Vec::new();
        let mut seen = 0;
        while let Some(cell) = queue.pop() {
            seen += 1;
            let (way, goal) = (cell.way(), CONTENT * best.by.norm());
            let reach = self.blocked.until(&way, cell.spread(), 0.0, goal);
            if reach < goal {
                self.follow(&mut known, &way, reach, best.by.norm())?;
                shorter(&mut best, &known);
                open.push((reach, cell));
            }
            let goal = CONTENT * best.by.norm();
            open.retain(|(reach, _)| *reach < goal);
            if queue.is_empty() && seen < MOST && !self.blocked.exhausted() {
                let least = (0..open.len()).min_by(|i, j| open[*i].0.total_cmp(&open[*j].0));
                queue.extend(least.map(|k| open.swap_remove(k).1.quarters()).into_iter().flatten());
            }
        }
        // slow ones were not at their end
        for _ in 0..POLISHES {
            let length = best.by.norm();
            match self.settling.settle(best.by, &[])? {
                Some(found) if found.by.norm() < length => best = found,
                _ => break,
            }
            if length - best.by.norm() <= NONE * self.size {
                break;
            }
        }
        let length = best.by.norm();
        let least = open.iter().map(|(reach, _)| *reach).fold(CONTENT * length, f64::min);
        let most = self.longest(&best, sure)?.max(length);
        let shortest = NONE * self.size;
        let normal = Direction::try_new(best.by, shortest).unwrap_or(best.touch.contact.normal);
        let on_first = best.touch.contact.witnesses[0];
        Ok(Contact {
            distance: -length,
            bounds: [-most, -least],
            normal,
            witnesses: [on_first, Point::from(on_first.coords - best.by)],
        })
    }

    /// How far the second body must move along a unit direction to leave the first's hull by the plane across it.
    fn outward(&self, way: &Vector) -> f64 {
        (self.bodies[0].extent(way) + self.bodies[1].extent(&-way)).max(0.0)
    }

    /// Follows a direction that is blocked up to `reach` out of the first body, if that takes less than `limit`, and adds to
    /// what is known where that settles.
    fn follow(
        &mut self,
        known: &mut Vec<Parting>,
        way: &Vector,
        reach: f64,
        limit: f64,
    ) -> Result<(), InvalidShape> {
        if let Some(length) = self.exit(way, reach, limit)? {
            known.extend(self.settling.settle(way * length, known)?);
        }
        Ok(())
    }

    /// The length, less than `limit`, at which a direction first leads out of the first body; slices are added where only
    /// those between block.
    fn exit(&mut self, way: &Vector, reach: f64, limit: f64) -> Result<Option<f64>, InvalidShape> {
        let (mut reach, mut added) = (reach, false);
        loop {
            let before = reach;
            reach = self.blocked.until(way, 0.0, reach, limit);
            if reach >= limit || self.blocked.exhausted() {
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

    /// A length of which it is shown that a translation as long parts: little more than the best's, or `sure`.
    fn longest(&self, best: &Parting, sure: f64) -> Result<f64, InvalidShape> {
        let (length, size) = (best.by.norm(), self.size);
        let way = best.by.try_normalize(0.0).unwrap_or(best.touch.contact.normal.into_inner());
        let more = 1e-3 * length.max(1e-2 * size);
        let moved = self.bodies[1].moved(&(way * (length + more)));
        let content = 0.3 * more / size;
        let found = nearest([self.bodies[0], &moved], content, &mut WarmStart::default())?;
        Ok(if found.bounds[0] > 0.0 { sure.min(length + more) } else { sure })
    }
}
