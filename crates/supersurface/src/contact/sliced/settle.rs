//! From a translation that parts two bodies to the locally shortest.
//!
//! The distance of two slices is a convex function of the translation, so that the planes that touch these
//! functions at any translations leave a polyhedron of such as part these slices. Its point nearest to zero is the next, if it parts the bodies;
//! else slices that overlap there add their planes, seen from the last that parts. Slices farther apart than the body moves
//! since they were last asked need not be asked.

use super::body::Sliced;
use super::foot::{Plane, foot};
use super::grid::Grid;
use super::lowest::lowest;
use super::slice::{FEW, Touch};
use crate::Vector;
use crate::contact::WarmStart;
use crate::shape::InvalidShape;

/// Questions to slices after which no search goes on.
const MOST_ASKED: usize = 40_000;
/// Steps before the search is content with what parts.
const STEPS: usize = 200;
/// At every so many steps that part it goes on to where they lead, if they shrink by a factor between these.
const EVERY: usize = 4;
const LONG: [f64; 2] = [0.3, 0.9999];
/// An overlap that is less than this of the step tells its own plane.
const LIGHT: f64 = 0.1;
/// Questions that a lowest pair is counted as.
const LOWEST: usize = 20;
/// Slices between the nodes whose planes are kept.
const BETWEEN: usize = 12;
/// Pushes out of slices that overlap before the start is given up.
const PUSHES: usize = 40;
/// A translation has settled where it moves by this at most, relative to the bodies' size: its length has by the square.
const SETTLED: f64 = 1e-8;
/// A search ends where a step that gains this at most, relative to the size, still meets slices that overlap.
const GAIN: f64 = 1e-12;
/// A settled one may leave an overlap of this, relative to the bodies' size.
pub(super) const TOUCHING: f64 = 1e-10;
/// A search that comes this near to a known translation, in its own steps, finds it again, once these are this short
/// relative to the bodies' size.
const KNOWN: f64 = 3.0;
const NEAR: f64 = 1e-3;

/// A translation, and the contact of the nearest slices after it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parting {
    pub(super) by: Vector,
    pub(super) touch: Touch,
}

/// The contact of a node when it was last asked, its plane, and how far the body moved since.
struct Node {
    touch: Touch,
    plane: Plane,
    since: f64,
}

/// What is known of the second body, moved, and both bodies' slices at equal intervals.
pub(super) struct Settling<'a> {
    bodies: [&'a Sliced; 2],
    grid: &'a Grid,
    size: f64,
    /// The longest way between the slices of a node and those half an interval away, twice.
    ways: Vec<f64>,
    nodes: Vec<Node>,
    /// Places between the nodes at which slices overlapped, though no node led there.
    missed: Vec<[f64; 2]>,
    starts: Vec<WarmStart>,
    /// The translation that was asked about last.
    by: Vector,
    /// How often slices were asked.
    asked: usize,
}

impl<'a> Settling<'a> {
    /// `size` is a length of the bodies, in metres.
    pub(super) fn new(bodies: [&'a Sliced; 2], grid: &'a Grid, size: f64) -> Self {
        let way = |k: usize, at: f64| 2.0 * bodies[k].way(at, grid.half[k]);
        let ways = (0..grid.len()).map(|k| {
            let [a, b] = grid.node(k);
            way(0, a.at) + way(1, b.at)
        });
        let (nodes, starts) = (Vec::new(), vec![WarmStart::default(); grid.len()]);
        Self {
            bodies,
            grid,
            size,
            ways: ways.collect(),
            nodes,
            missed: Vec::new(),
            starts,
            by: Vector::zeros(),
            asked: 0,
        }
    }

    /// Where a translation settles, if some near it parts and where that leads is none of those that are `known`; how far it got
    /// once slices were asked too often.
    pub(super) fn settle(
        &mut self,
        from: Vector,
        known: &[Parting],
    ) -> Result<Option<Parting>, InvalidShape> {
        let Some(mut found) = self.parting(from)? else { return Ok(None) };
        // slices between the nodes, with their planes
        let mut between: Vec<([f64; 2], Plane)> = Vec::new();
        // planes seen from where slices overlap may contradict each other; what was found lies before all that are seen
        // from there
        let mut careful = false;
        let mut last: Option<Vector> = None;
        let mut parted = 0;
        for _ in 0..STEPS {
            if self.asked > MOST_ASKED {
                break;
            }
            let seen = self.nodes.iter().map(|node| node.plane);
            let mut planes: Vec<Plane> = seen.chain(between.iter().map(|(_, p)| *p)).collect();
            if careful {
                planes.iter_mut().for_each(|p| p.offset = p.offset.min(p.normal.dot(&found.by)));
            }
            let shorter = |next: &Vector| next.norm() < found.by.norm();
            let Some(next) = foot(&planes).filter(shorter) else {
                if careful {
                    break;
                }
                careful = true;
                self.see_from(&found.by, &mut between)?;
                continue;
            };
            let mut move_by = next - found.by;
            // steps that shrink by the same factor go on to where they lead
            let factor = last.map_or(0.0, |last| move_by.dot(&last) / last.norm_squared());
            if parted % EVERY == EVERY - 1 && (LONG[0]..LONG[1]).contains(&factor) {
                move_by /= 1.0 - factor;
                parted += 1;
            }
            let touches = self.touches_at(&(found.by + move_by))?;
            let over: Vec<Touch> = touches.iter().filter(|t| self.overlaps(t)).copied().collect();
            if !over.is_empty() {
                let gain = found.by.norm() - (found.by + move_by).norm();
                if careful && gain <= GAIN * self.size {
                    break;
                }
                for touch in over {
                    // of a deep overlap the normal may be another
                    let light = -touch.contact.distance < LIGHT * move_by.norm();
                    let plane = match light {
                        true => plane(&touch, &(found.by + move_by)),
                        false => self.plane_at(touch.at, &found.by)?,
                    };
                    between.push((touch.at, plane));
                }
                if careful {
                    self.see_from(&found.by, &mut between)?;
                }
                continue;
            }
            let moved = move_by.norm();
            found = self.parted(found.by + move_by, &touches);
            (parted, last, careful) = (parted + 1, Some(move_by), false);
            let again = |known: &Parting| (found.by - known.by).norm() <= KNOWN * moved;
            if moved <= NEAR * self.size && known.iter().any(again) {
                return Ok(None);
            }
            if moved <= SETTLED * self.size {
                break;
            }
            // those that could hold the next one back
            between.extend(touches.iter().map(|touch| (touch.at, plane(touch, &found.by))));
            between.sort_by(|p, q| q.1.missed(&found.by).total_cmp(&p.1.missed(&found.by)));
            between.truncate(BETWEEN);
            for (at, plane) in &mut between {
                *plane = self.plane_at(*at, &found.by)?;
            }
        }
        Ok(Some(found))
    }

    /// All planes as they are seen from a translation.
    fn see_from(
        &mut self,
        by: &Vector,
        between: &mut [([f64; 2], Plane)],
    ) -> Result<(), InvalidShape> {
        self.touches_at(by)?;
        for (at, plane) in between.iter_mut() {
            *plane = self.plane_at(*at, by)?;
        }
        Ok(())
    }

    /// A translation near one that parts, by pushes out of the slices that overlap most.
    fn parting(&mut self, from: Vector) -> Result<Option<Parting>, InvalidShape> {
        let mut by = from;
        for _ in 0..PUSHES {
            let touches = self.touches_at(&by)?;
            let Some(worst) = lowest_of(&touches).filter(|t| self.overlaps(t)) else {
                return Ok(Some(self.parted(by, &touches)));
            };
            let overlap = 0.5 * TOUCHING * self.size - worst.contact.distance;
            by += worst.contact.normal.into_inner() * overlap;
        }
        Ok(None)
    }

    fn overlaps(&self, touch: &Touch) -> bool {
        touch.contact.distance < -TOUCHING * self.size
    }

    /// Places that no node led to, and that are looked at from now on.
    pub(super) fn add(&mut self, at: [f64; 2]) {
        self.missed.push(at);
    }

    /// Lets the next searches ask as often as if they were the first.
    pub(super) const fn renew(&mut self) {
        self.asked = 0;
    }

    /// A translation with the contact that it leads to.
    pub(super) fn at(&mut self, by: Vector) -> Result<Parting, InvalidShape> {
        let touches = self.touches_at(&by)?;
        Ok(self.parted(by, &touches))
    }

    fn parted(&self, by: Vector, touches: &[Touch]) -> Parting {
        let near = self.nodes.iter().map(|node| node.touch);
        let all: Vec<Touch> = touches.iter().copied().chain(near).collect();
        Parting { by, touch: lowest_of(&all).unwrap_or(self.nodes[0].touch) }
    }

    /// The plane of two slices, seen after a translation.
    fn plane_at(&mut self, at: [f64; 2], by: &Vector) -> Result<Plane, InvalidShape> {
        let other = self.bodies[1].slice(at[1])?.moved(by);
        self.asked += 1;
        let touch = self.bodies[0].slice(at[0])?.touch(&other, &mut WarmStart::default(), FEW);
        Ok(plane(&touch, by))
    }

    /// The least contacts of the body after a translation, among all slices that may overlap: of nodes that do, and of
    /// slices between.
    fn touches_at(&mut self, by: &Vector) -> Result<Vec<Touch>, InvalidShape> {
        let moved = (by - self.by).norm();
        self.by = *by;
        let others: Vec<_> = self.grid.of[1].iter().map(|slice| slice.moved(by)).collect();
        let first = self.nodes.is_empty();
        for k in 0..self.grid.len() {
            if !first {
                let node = &mut self.nodes[k];
                node.since += moved;
                if node.since > 0.0 && node.touch.contact.distance - node.since > self.ways[k] {
                    continue;
                }
            }
            let slice = self.grid.node(k)[0];
            let touch = slice.touch(&others[k % others.len()], &mut self.starts[k], FEW);
            self.asked += 1;
            let node = Node { touch, plane: plane(&touch, by), since: 0.0 };
            if first { self.nodes.push(node) } else { self.nodes[k] = node }
        }
        let body = self.bodies[1].moved(by);
        let half = self.grid.half.map(|h| 2.0 * h);
        let mut found = Vec::new();
        for k in 0..self.grid.len() {
            let Node { touch, since, .. } = &self.nodes[k];
            if *since > 0.0 || touch.contact.distance >= self.ways[k] {
                continue;
            }
            let fresh = |k: usize| Some(&self.nodes[k]).filter(|n| n.since == 0.0).map(|n| n.touch);
            if self.grid.turns(k, fresh) {
                self.asked += LOWEST;
                found.push(lowest(
                    [self.bodies[0], &body],
                    touch,
                    half,
                    &mut WarmStart::default(),
                )?);
            } else if self.overlaps(touch) {
                found.push(*touch);
            }
        }
        for at in &self.missed {
            let (a, b) = (self.bodies[0].slice(at[0])?, body.slice(at[1])?);
            let touch = a.touch(&b, &mut WarmStart::default(), FEW);
            self.asked += LOWEST;
            found.push(lowest([self.bodies[0], &body], &touch, half, &mut WarmStart::default())?);
        }
        Ok(found)
    }
}

/// The touch of the least distance.
fn lowest_of(touches: &[Touch]) -> Option<Touch> {
    let distance = |t: &Touch| t.contact.distance;
    touches.iter().min_by(|p, q| distance(p).total_cmp(&distance(q))).copied()
}

/// The half space of the translations that part two slices at least as well as the plane between them does,
/// seen after one translation.
fn plane(touch: &Touch, by: &Vector) -> Plane {
    let normal = touch.contact.normal.into_inner();
    Plane { normal, offset: normal.dot(by) - touch.contact.distance }
}
