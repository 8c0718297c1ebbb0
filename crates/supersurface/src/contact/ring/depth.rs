//! The shortest translation that parts a ring from a body that it overlaps.
//!
//! Moved by `t`, the body is apart from the ring where its signed distance from every slice is at least zero. Each of
//! these distances is a convex function of `t`, so that the planes that touch them at one `t` leave a polyhedron of
//! translations that part; its point nearest to zero is the next `t`, until it moves no more (`settle`). That finds
//! places where the body touches the ring in one point as well as those where it is held by two or three, as a box in
//! a round hole is, and which no common normal leads to.
//!
//! Which of these is the shortest is decided over cells of directions. A slice that overlaps by more than the
//! cell is wide at two lengths of the translation does so at all between, as its distance is convex: a chain of slices
//! shows that no translation of the cell up to some length parts, and what cannot be shown is split in four, or
//! leads to a shorter one.

use super::apart::nearest;
use super::foot::{Plane, foot};
use super::size;
use super::slices::{Slice, Touch, minimum, way};
use crate::contact::{Contact, Convex, WarmStart};
use crate::shape::{InvalidShape, Posed, SupportMap, Supertoroid};
use crate::{Direction, Point, Pose, Vector};
use std::f64::consts::{PI, TAU};

/// Slices that block directions.
const SLICES: usize = 64;
/// Cells of the first level along an edge of the cube of directions.
const FIRST: usize = 3;
/// Cells after which the bounds are what they are.
const MOST: usize = 400;
/// The depth is shown to be at least this share of what was found, if the cells last.
const CONTENT: f64 = 0.98;
/// Steps of `settle`.
const STEPS: usize = 60;
/// A translation has settled where it moves by this at most, relative to the ring's size.
const SETTLED: f64 = 1e-13;
/// A settled one may leave an overlap of this, relative to the ring's size.
const TOUCHING: f64 = 1e-10;

/// A ring and a body that it overlaps.
struct Overlap<'a> {
    torus: &'a Posed<Supertoroid>,
    body: &'a Posed<Convex>,
    slices: Vec<Slice>,
    starts: Vec<WarmStart>,
    size: f64,
}

/// A translation after which the body touches the ring, and where it does.
#[derive(Clone, Copy)]
struct Parting {
    by: Vector,
    touch: Contact,
}

/// The contact of a ring with a body of which `touching` says that they overlap.
pub(super) fn depth(
    torus: &Posed<Supertoroid>,
    body: &Posed<Convex>,
    touching: Contact,
) -> Result<Contact, InvalidShape> {
    let slices = (0..SLICES).map(|k| Slice::new(torus, (k as f64 + 0.5) * TAU / SLICES as f64));
    let slices = slices.collect::<Result<Vec<_>, _>>()?;
    let starts = vec![WarmStart::default(); SLICES];
    let mut overlap = Overlap { torus, body, slices, starts, size: size(torus) };
    overlap.solve(touching)
}

/// A square on a face of the cube of directions.
#[derive(Clone, Copy)]
struct Cell {
    face: usize,
    middle: [f64; 2],
    half: f64,
}

impl Cell {
    fn first() -> impl Iterator<Item = Self> {
        let half = 1.0 / FIRST as f64;
        let place = move |k: usize| (2 * (k % FIRST) + 1) as f64 * half - 1.0;
        (0..6 * FIRST * FIRST).map(move |k| Self {
            face: k / (FIRST * FIRST),
            middle: [place(k / FIRST), place(k)],
            half,
        })
    }

    fn quarters(&self) -> [Self; 4] {
        let half = 0.5 * self.half;
        [(-half, -half), (-half, half), (half, -half), (half, half)].map(|(x, y)| {
            let middle = [self.middle[0] + x, self.middle[1] + y];
            Self { middle, half, ..*self }
        })
    }

    /// The unit direction of a point of the face.
    fn direction(&self, [x, y]: [f64; 2]) -> Vector {
        let side = if self.face < 3 { 1.0 } else { -1.0 };
        let mut along = [0.0; 3];
        along[self.face % 3] = side;
        along[(self.face + 1) % 3] = x;
        along[(self.face + 2) % 3] = y;
        Vector::from(along).normalize()
    }

    fn way(&self) -> Vector {
        self.direction(self.middle)
    }

    /// The largest distance of its unit directions from that of its middle.
    fn spread(&self) -> f64 {
        let ([x, y], h) = (self.middle, self.half);
        let corners = [[x - h, y - h], [x - h, y + h], [x + h, y - h], [x + h, y + h]];
        let way = self.way();
        corners.map(|c| (self.direction(c) - way).norm()).into_iter().fold(0.0, f64::max)
    }
}

impl Overlap<'_> {
    fn solve(&mut self, touching: Contact) -> Result<Contact, InvalidShape> {
        let mut outward: Vec<(f64, Vector)> = Cell::first()
            .flat_map(|cell| cell.quarters())
            .map(|cell| (self.outward(&cell.way()), cell.way()))
            .collect();
        outward.sort_by(|p, q| p.0.total_cmp(&q.0));
        let (sure, way) = outward[0];
        let mut best = Parting { by: way * sure, touch: touching };
        for (length, way) in &outward[..3] {
            self.improve(&mut best, way * *length)?;
        }
        let mut order: Vec<usize> = (0..SLICES).collect();
        let mut open: Vec<(f64, Cell)> = Vec::new();
        let mut queue: Vec<Cell> = Cell::first().collect();
        let mut seen = 0;
        while let Some(cell) = queue.pop() {
            seen += 1;
            let way = cell.way();
            let goal = CONTENT * best.by.norm();
            let reach = self.blocked(&way, cell.spread(), goal, &mut order);
            if reach < goal {
                let length = best.by.norm();
                let exit = self.blocked(&way, 0.0, length, &mut order);
                if exit < length {
                    self.improve(&mut best, way * exit)?;
                }
                open.push((reach, cell));
            }
            let goal = CONTENT * best.by.norm();
            open.retain(|(reach, _)| *reach < goal);
            if queue.is_empty() && seen < MOST {
                let least = (0..open.len()).min_by(|i, j| open[*i].0.total_cmp(&open[*j].0));
                if let Some(least) = least {
                    queue.extend(open.swap_remove(least).1.quarters());
                }
            }
        }
        let length = best.by.norm();
        let least = open.iter().map(|(reach, _)| *reach).fold(CONTENT * length, f64::min);
        let most = self.most(&best)?.unwrap_or(sure).min(sure).max(length);
        let normal = Direction::try_new(best.by, TOUCHING * self.size).unwrap_or(best.touch.normal);
        let on_ring = best.touch.witnesses[0];
        let on_body = Point::from(on_ring.coords - best.by);
        Ok(Contact {
            distance: -length,
            bounds: [-most, -least],
            normal,
            witnesses: [on_ring, on_body],
        })
    }

    /// How far the body must move along a unit direction to leave the ring's convex hull by the plane across it.
    fn outward(&self, way: &Vector) -> f64 {
        let far = self.torus.support_point(way) - self.body.support_point(&-way);
        far.dot(way).max(0.0)
    }

    fn moved(&self, by: &Vector) -> Posed<Convex> {
        self.body.moved(&Pose::translation(by.x, by.y, by.z))
    }

    /// Replaces a parting by that to which a translation settles, if that is shorter.
    fn improve(&mut self, best: &mut Parting, from: Vector) -> Result<(), InvalidShape> {
        if let Some(found) = self.settle(from)?
            && found.by.norm() < best.by.norm()
        {
            *best = found;
        }
        Ok(())
    }

    /// The translation, locally the shortest, that parts; from one that nearly does.
    fn settle(&mut self, from: Vector) -> Result<Option<Parting>, InvalidShape> {
        let mut by = from;
        for _ in 0..STEPS {
            let touches = self.touches(&by)?;
            let planes: Vec<Plane> = touches
                .iter()
                .map(|touch| {
                    let normal = touch.contact.normal.into_inner();
                    Plane { normal, offset: normal.dot(&by) - touch.contact.distance }
                })
                .collect();
            let Some(next) = foot(&planes) else { return Ok(None) };
            let moved = (next - by).norm();
            by = next;
            if moved <= SETTLED * self.size {
                break;
            }
        }
        let touches = self.touches(&by)?;
        let distance = |t: &Touch| t.contact.distance;
        let least = touches.iter().min_by(|p, q| distance(p).total_cmp(&distance(q)));
        Ok(least
            .filter(|t| distance(t) >= -TOUCHING * self.size)
            .map(|t| Parting { by, touch: t.contact }))
    }

    /// The contacts of the moved body with all slices, and with those between that are nearest.
    fn touches(&mut self, by: &Vector) -> Result<Vec<Touch>, InvalidShape> {
        let body = self.moved(by);
        let mut touches: Vec<Touch> = (0..SLICES)
            .map(|k| self.slices[k].touch(self.torus, &body, &mut self.starts[k]))
            .collect();
        for k in 0..SLICES {
            let low = touches[k];
            let mut high = touches[(k + 1) % SLICES];
            high.angle = low.angle + TAU / SLICES as f64;
            let nearer = low.contact.distance.min(high.contact.distance);
            let apart = nearer - way(self.torus.shape(), low.angle + PI / SLICES as f64, PI / SLICES as f64);
            if low.slope < 0.0 && high.slope >= 0.0 && apart < 0.0 {
                touches.push(minimum(self.torus, &body, [&low, &high], &mut WarmStart::default())?);
            }
        }
        Ok(touches)
    }

    /// Up to which length of a translation, but no more than `limit`, the ring is shown to block all unit directions
    /// within `spread` of one. `order` has the slices in the order in which they are asked.
    fn blocked(&mut self, way: &Vector, spread: f64, limit: f64, order: &mut [usize]) -> f64 {
        let mut reach = 0.0;
        'further: while reach < limit {
            for place in 0..SLICES {
                let slice = order[place];
                if self.overlaps(slice, way, spread, reach) >= 0.0 {
                    continue;
                }
                let end = self.until(slice, way, spread, [reach, limit]);
                if end <= reach + 1e-6 * limit {
                    continue;
                }
                reach = end;
                order[..=place].rotate_right(1);
                continue 'further;
            }
            break;
        }
        reach
    }

    /// Negative where a slice blocks a translation and all as near as `spread` says: a convex function of the length.
    fn overlaps(&mut self, slice: usize, way: &Vector, spread: f64, length: f64) -> f64 {
        let body = self.moved(&(way * length));
        let touch = self.slices[slice].touch(self.torus, &body, &mut self.starts[slice]);
        let distance = if spread > 0.0 { touch.contact.bounds[1] } else { touch.contact.distance };
        distance + spread * length
    }

    /// Up to where a slice blocks that does so at the lower of two lengths: chords of a convex function fall short of
    /// its root.
    fn until(&mut self, slice: usize, way: &Vector, spread: f64, [low, high]: [f64; 2]) -> f64 {
        let mut low = (low, self.overlaps(slice, way, spread, low));
        let mut high = (high, self.overlaps(slice, way, spread, high));
        if high.1 < 0.0 {
            return high.0;
        }
        for _ in 0..12 {
            let chord = low.0 + (high.0 - low.0) * low.1 / (low.1 - high.1);
            let short = (chord, self.overlaps(slice, way, spread, chord));
            // rounding, or bounds that are not convex
            if !(short.1 < 0.0) {
                break;
            }
            if short.0 - low.0 <= 1e-4 * high.0 {
                return short.0;
            }
            low = short;
            let middle = 0.5 * (low.0 + high.0);
            let half = (middle, self.overlaps(slice, way, spread, middle));
            if half.1 < 0.0 { low = half } else { high = half }
        }
        low.0
    }

    /// A length of which it is shown that a translation as long parts the two, a little more than the parting's.
    fn most(&self, best: &Parting) -> Result<Option<f64>, InvalidShape> {
        let length = best.by.norm();
        let way = best.by.try_normalize(0.0).unwrap_or(best.touch.normal.into_inner());
        let more = 1e-3 * length.max(1e-2 * self.size);
        let body = self.moved(&(way * (length + more)));
        let content = 0.3 * more / self.size;
        let found = nearest(self.torus, &body, content, &mut WarmStart::default())?;
        Ok((found.bounds[0] > 0.0).then_some(length + more))
    }
}
