//! From a translation that parts a ring from a body to the locally shortest.
//!
//! The distance from a slice is a convex function of the translation, so that the planes that touch these
//! functions at one translation leave a polyhedron of such as part too; its point nearest to zero is the next, until it
//! moves no more. Slices farther away than the body moves since they were last asked need not be asked.

use super::foot::{Plane, foot};
use super::slices::{Slice, Touch, minimum, way};
use crate::contact::{Convex, WarmStart};
use crate::shape::{InvalidShape, Posed, Supertoroid};
use crate::{Pose, Vector};
use std::f64::consts::{PI, TAU};

/// Questions to slices after which no more settles.
const MOST_ASKED: usize = 40_000;
/// Steps before the search is content with what parts.
const STEPS: usize = 200;
/// At every so many steps it goes on to where they lead, if they shrink by a factor between these.
const EVERY: usize = 4;
const LONG: [f64; 2] = [0.3, 0.9999];
/// Pushes at the end out of a slice that still overlaps.
const PUSHES: usize = 8;
/// A translation has settled where it moves by this at most, relative to the ring's size: its length has by the square.
const SETTLED: f64 = 1e-8;
/// A settled one may leave an overlap of this, relative to the ring's size.
const TOUCHING: f64 = 1e-10;
/// A search that comes this near to a known translation, in its own steps, finds it again, once these are this short
/// relative to the ring's size.
const KNOWN: f64 = 3.0;
const NEAR: f64 = 1e-3;

/// A translation, and the contact with the nearest slice after it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Parting {
    pub(super) by: Vector,
    pub(super) touch: Touch,
}

/// What is known of the moved body and the ring's slices at equal angles.
pub(super) struct Settling<'a> {
    torus: &'a Posed<Supertoroid>,
    body: &'a Posed<Convex>,
    slices: &'a [Slice],
    size: f64,
    /// The longest way within half an interval, of each slice.
    ways: Vec<f64>,
    /// The contact with each slice when it was last asked, and how far the body moved since.
    touches: Vec<(Touch, f64)>,
    starts: Vec<WarmStart>,
    /// How often slices were asked.
    asked: usize,
}

impl<'a> Settling<'a> {
    /// `size` is a length of the ring, in metres.
    pub(super) fn new(
        torus: &'a Posed<Supertoroid>,
        body: &'a Posed<Convex>,
        slices: &'a [Slice],
        size: f64,
    ) -> Self {
        let half = PI / slices.len() as f64;
        let ways = slices.iter().map(|s| 2.0 * way(torus.shape(), s.angle, half)).collect();
        let starts = vec![WarmStart::default(); slices.len()];
        Self { torus, body, slices, size, ways, touches: Vec::new(), starts, asked: 0 }
    }

    /// The body after a translation.
    pub(super) fn moved(&self, by: &Vector) -> Posed<Convex> {
        self.body.moved(&Pose::translation(by.x, by.y, by.z))
    }

    /// Where a translation settles, if that parts and is none of those that are `known`. `None` as well once slices were
    /// asked too often.
    pub(super) fn settle(
        &mut self,
        from: Vector,
        known: &[Parting],
    ) -> Result<Option<Parting>, InvalidShape> {
        let mut by = from;
        let mut moved = f64::INFINITY;
        let mut last: Option<Vector> = None;
        for step in 0..STEPS {
            if self.asked > MOST_ASKED {
                return Ok(None);
            }
            let touches = self.touches_at(&by, moved)?;
            let planes: Vec<Plane> = touches.iter().map(|t| plane(t, &by)).collect();
            let mut move_by = match foot(&planes) {
                Some(next) => next - by,
                None => self.outward(&touches),
            };
            // steps that shrink by the same factor go on to where they lead
            if let Some(last) = last.filter(|_| step % EVERY == EVERY - 1) {
                let factor = move_by.dot(&last) / last.norm_squared();
                if (LONG[0]..LONG[1]).contains(&factor) {
                    move_by /= 1.0 - factor;
                }
            }
            moved = move_by.norm();
            by += move_by;
            last = Some(move_by);
            let again = |known: &Parting| (by - known.by).norm() <= KNOWN * moved;
            if moved <= NEAR * self.size && known.iter().any(again) {
                return Ok(None);
            }
            if moved <= SETTLED * self.size {
                break;
            }
        }
        let mut found = self.touched(by, moved)?;
        for _ in 0..PUSHES {
            if found.touch.contact.distance >= -TOUCHING * self.size {
                break;
            }
            let push = self.outward(&[found.touch]);
            found = self.touched(found.by + push, push.norm())?;
        }
        let parts = found.touch.contact.distance >= -TOUCHING * self.size;
        Ok(parts.then_some(found))
    }

    /// Out of the slice that overlaps most.
    fn outward(&self, touches: &[Touch]) -> Vector {
        let distance = |t: &Touch| t.contact.distance;
        let worst = touches.iter().min_by(|p, q| distance(p).total_cmp(&distance(q)));
        worst.map_or_else(Vector::zeros, |t| {
            t.contact.normal.into_inner() * (0.5 * TOUCHING * self.size - distance(t)).max(0.0)
        })
    }

    /// A translation with the contact that it leads to.
    pub(super) fn at(&mut self, by: Vector) -> Result<Parting, InvalidShape> {
        self.touched(by, f64::INFINITY)
    }

    fn touched(&mut self, by: Vector, moved: f64) -> Result<Parting, InvalidShape> {
        let found = self.touches_at(&by, moved)?;
        let distance = |t: &Touch| t.contact.distance;
        let mut touch = self.touches[0].0;
        for other in found {
            if distance(&other) < distance(&touch) {
                touch = other;
            }
        }
        Ok(Parting { by, touch })
    }

    /// The contacts of the body after a translation, with all slices that may overlap it and with those between
    /// that are nearest. It is `moved` from where it was before.
    fn touches_at(&mut self, by: &Vector, moved: f64) -> Result<Vec<Touch>, InvalidShape> {
        let body = self.moved(by);
        let count = self.slices.len();
        if !moved.is_finite() {
            self.asked += count;
            self.touches.clear();
            for (slice, start) in self.slices.iter().zip(&mut self.starts) {
                self.touches.push((slice.touch(self.torus, &body, start), 0.0));
            }
        } else {
            for k in 0..count {
                let (touch, since) = &mut self.touches[k];
                *since += moved;
                if touch.contact.distance - *since <= self.ways[k] {
                    *touch = self.slices[k].touch(self.torus, &body, &mut self.starts[k]);
                    *since = 0.0;
                    self.asked += 1;
                }
            }
        }
        let fresh = |(touch, since): &(Touch, f64)| (*since == 0.0).then_some(*touch);
        let mut found: Vec<Touch> = self.touches.iter().filter_map(fresh).collect();
        for k in 0..count {
            let after = (k + 1) % count;
            let [Some(low), Some(mut high)] = [k, after].map(|k| fresh(&self.touches[k])) else {
                continue;
            };
            high.angle = low.angle + TAU / count as f64;
            let nearer = low.contact.distance.min(high.contact.distance);
            if low.slope < 0.0 && high.slope >= 0.0 && nearer < self.ways[k] {
                found.push(minimum(self.torus, &body, [&low, &high], &mut WarmStart::default())?);
            }
        }
        Ok(found)
    }
}

/// The half space of the translations that part the body from a slice at least as well as the plane between them does,
/// seen after one translation.
fn plane(touch: &Touch, by: &Vector) -> Plane {
    let normal = touch.contact.normal.into_inner();
    Plane { normal, offset: normal.dot(by) - touch.contact.distance }
}
