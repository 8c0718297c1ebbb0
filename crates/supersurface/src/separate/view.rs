//! What the image tells of two pieces: where they meet, and whether something hides what is between them.

use std::collections::BTreeMap;
use std::ops::Range;

use crate::cloud::PointCloud;
use crate::fit::Fit;
use crate::measure::first_hit;
use crate::segment::hangs;
use crate::shape::{Plane, Ray};
use crate::{Direction, Point, Vector};

/// An organised cloud whose pixels belong to pieces.
pub(super) struct View<'a> {
    points: &'a [Point],
    width: usize,
    eye: Point,
    owner: Vec<u32>,
}

/// The owner of pixels that are in no piece.
const NOBODY: u32 = u32::MAX;
/// Two neighbouring pixels that are nearer than this, in metres, are one surface's.
const CONTACT: f64 = 0.01;
/// Pixels over which neighbours are sought.
const ACROSS: usize = 6;
/// Pixels of an outline that are looked at.
const OUTLINE: usize = 120;
/// Longest way between two pieces, as a share of the image's width.
const FARTHEST: f64 = 0.22;
/// Ways between two pieces that are looked at where the shortest is not hidden.
const SPREAD: usize = 12;
/// How much nearer or farther than the way between two pieces something hides it or shows that it is empty, in metres.
const NEARER: f64 = 0.006;
const FARTHER: f64 = 0.008;
/// Share of the way that must be hidden, and that may be empty.
const HIDDEN: f64 = 0.6;
const EMPTY: f64 = 0.15;
/// A surface that lies so far before what was seen, in metres, is contradicted there.
const BEFORE: f64 = 0.012;
/// Lines of sight by which a surface is tried.
const TRIED: usize = 300;
/// Ways from piece to piece that are looked at.
const WAYS: usize = 64;

/// Depth under the top of a wall, in metres, to which its rim may be cut off, and lines of sight over it that are looked at.
const RIM: f64 = 0.012;
const LOOKED: usize = 60;
/// Pixels beside a border where its bend is measured, how many are, and the pixels around one that give its normal.
const ASIDE: usize = 7;
const BENDS: usize = 60;
const AROUND: usize = 4;

/// Pairs of neighbouring pixels of two pieces.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Border {
    /// In the image.
    pub(super) beside: u32,
    /// In space too.
    pub(super) touching: u32,
}

impl<'a> View<'a> {
    /// The view of an organised cloud whose viewpoint is known.
    pub(super) fn new<'p>(
        cloud: &'a PointCloud,
        pieces: impl Iterator<Item = &'p [u32]>,
    ) -> Option<Self> {
        let [width, height] =
            cloud.grid.filter(|[w, h]| w.checked_mul(*h) == Some(cloud.points.len()))?;
        let mut owner = vec![NOBODY; width * height];
        for (k, piece) in pieces.enumerate() {
            piece.iter().for_each(|i| owner[*i as usize] = k as u32);
        }
        Some(Self { points: &cloud.points, width, eye: cloud.viewpoint?, owner })
    }

    fn range(&self, i: usize) -> f64 {
        (self.points[i] - self.eye).norm()
    }

    /// Where pieces meet, by pairs of their numbers (the smaller first).
    pub(super) fn borders(&self) -> BTreeMap<[usize; 2], Border> {
        let mut out = BTreeMap::<[usize; 2], Border>::new();
        for (i, own) in self.owner.iter().enumerate().filter(|(_, o)| **o != NOBODY) {
            let room = self.width - 1 - i % self.width;
            for (step, most) in [(1, room.min(ACROSS)), (self.width, ACROSS)] {
                // the next pixel with an owner
                let next = (1..=most).map(|k| i + k * step).take_while(|j| *j < self.owner.len());
                let Some(j) = next.into_iter().find(|j| self.owner[*j] != NOBODY) else { continue };
                let other = self.owner[j];
                if other != *own {
                    let pair = [*own.min(&other) as usize, *own.max(&other) as usize];
                    let border = out.entry(pair).or_default();
                    border.beside += 1;
                    border.touching +=
                        u32::from((self.points[i] - self.points[j]).norm() < CONTACT);
                }
            }
        }
        out
    }

    /// How the surface bends where two pieces touch: the mean of `(p - q)·(n - m)/|p - q|` for points on both sides of the border
    /// with their normals, negative at a concave edge; `None` where they hardly touch.
    pub(super) fn bend(&self, a: &[u32], b: &[u32]) -> Option<f64> {
        let (own, other) = (self.owner[*a.first()? as usize], self.owner[*b.first()? as usize]);
        let owned = |i: Option<usize>, by: u32| {
            i.filter(|i| self.owner.get(*i).is_some_and(|owner| *owner == by))
        };
        let (mut near, mut far) = (Vec::new(), Vec::new());
        for i in a.iter().map(|i| *i as usize) {
            for step in [1, self.width] {
                let ahead = |k: usize| i.checked_add(k * step);
                let back = |k: usize| i.checked_sub(k * step);
                let pairs = [
                    (owned(ahead(1), other), back(ASIDE), ahead(ASIDE)),
                    (owned(i.checked_sub(step), other), ahead(ASIDE), back(ASIDE)),
                ];
                for (next, here, there) in pairs {
                    let touches = |j: &usize| (self.points[i] - self.points[*j]).norm() < CONTACT;
                    if next.filter(touches).is_some()
                        && let (Some(p), Some(q)) = (owned(here, own), owned(there, other))
                    {
                        near.push(p);
                        far.push(q);
                    }
                }
            }
        }
        let step = near.len().div_ceil(BENDS).max(1);
        let some = near.into_iter().zip(far).step_by(step);
        let bends = some.filter_map(|(p, q)| {
            let apart = (self.points[p] - self.points[q]).try_normalize(1e-9)?;
            Some(apart.dot(&(self.normal(p)? - self.normal(q)?)))
        });
        let bends: Vec<f64> = bends.collect();
        (bends.len() >= 5).then(|| bends.iter().sum::<f64>() / bends.len() as f64)
    }

    /// The normal towards the eye at a pixel, by those around it of the same piece.
    fn normal(&self, i: usize) -> Option<Vector> {
        let owned = |j: Option<usize>| {
            j.filter(|j| self.owner.get(*j).is_some_and(|owner| *owner == self.owner[i]))
        };
        let across = |step: usize| {
            let (from, to) = (i.checked_sub(step), i.checked_add(step));
            Some(self.points[owned(to)?] - self.points[owned(from)?])
        };
        let normal = across(AROUND)?.cross(&across(AROUND * self.width)?).try_normalize(1e-12)?;
        Some(normal * (self.eye - self.points[i]).dot(&normal).signum())
    }

    /// The pixels at the border of a piece, not too many.
    pub(super) fn outline(&self, piece: &[u32]) -> Vec<u32> {
        let inside = |i: usize, j: Option<usize>| {
            j.and_then(|j| self.owner.get(j)).is_some_and(|o| *o == self.owner[i])
        };
        let edge = |i: &&u32| {
            let i = **i as usize;
            let w = self.width;
            ![i.checked_sub(1), Some(i + 1), i.checked_sub(w), Some(i + w)]
                .into_iter()
                .all(|j| inside(i, j))
        };
        let edge: Vec<u32> = piece.iter().filter(edge).copied().collect();
        edge.iter().step_by(edge.len().div_ceil(OUTLINE).max(1)).copied().collect()
    }

    /// True where something nearer hides what is between two pieces, given by their outlines: on the shortest way from one to
    /// the other, or on the whole of some ways, as that may lead along the foot of what hides them.
    pub(super) fn hides_between(&self, a: &[u32], b: &[u32]) -> bool {
        let farthest = FARTHEST * self.width as f64;
        let [places, others] =
            [a, b].map(|outline| outline.iter().map(|i| self.place(*i)).collect::<Vec<_>>());
        let boxes = [&places, &others].map(|places| {
            let by = |k: usize, f: fn(f64, f64) -> f64| places.iter().map(|p| p[k]).reduce(f);
            [0, 1].map(|k| [by(k, f64::min), by(k, f64::max)].map(Option::unwrap_or_default))
        });
        let gap = |k: usize| (boxes[1][k][0] - boxes[0][k][1]).max(boxes[0][k][0] - boxes[1][k][1]);
        if gap(0).max(gap(1)) > farthest {
            return false;
        }
        let outside = |p: &[f64; 2], k: usize| {
            (boxes[1][k][0] - p[k]).max(p[k] - boxes[1][k][1]).max(0.0).powi(2)
        };
        let shortest = |from: Range<usize>| {
            let (mut square, mut way) = (farthest * farthest, None);
            for i in from {
                let p = &places[i];
                // a place is passed over whose way to the other's box is longer
                if outside(p, 0) + outside(p, 1) < square {
                    for (j, q) in others.iter().enumerate() {
                        let apart = (p[0] - q[0]).powi(2) + (p[1] - q[1]).powi(2);
                        if apart < square {
                            (square, way) = (apart, Some([a[i], b[j]]));
                        }
                    }
                }
            }
            way
        };
        let Some(first) = shortest(0..a.len()) else { return false };
        let step = a.len().div_ceil(SPREAD).max(1);
        let all_over = (0..a.len()).step_by(step).filter_map(|i| shortest(i..i + 1));
        self.is_hidden(std::iter::once(first)) || self.is_hidden(all_over)
    }

    /// Whether of the places on some ways between two pixels enough are hidden and few are seen to be empty.
    fn is_hidden(&self, ways: impl Iterator<Item = [u32; 2]>) -> bool {
        let (mut hidden, mut empty, mut all) = (0.0, 0.0, 0.0);
        for ends in ways {
            let [from, to] = ends.map(|i| self.place(i));
            let ranges = ends.map(|i| self.range(i as usize).recip());
            let steps = (from[0] - to[0]).hypot(from[1] - to[1]) as usize;
            for k in 1..steps {
                let share = k as f64 / steps as f64;
                let [u, v] = [0, 1].map(|k| (from[k] + share * (to[k] - from[k])).round() as usize);
                let between = (ranges[0] + share * (ranges[1] - ranges[0])).recip();
                let seen = self.range(v * self.width + u);
                all += 1.0;
                if seen.is_nan() || seen < between - NEARER {
                    hidden += 1.0;
                } else if seen > between + FARTHER {
                    empty += 1.0;
                }
            }
        }
        all > 0.0 && hidden >= HIDDEN * all && empty < EMPTY * all
    }

    /// Column and row of a pixel.
    fn place(&self, pixel: u32) -> [f64; 2] {
        let i = pixel as usize;
        [(i % self.width) as f64, (i / self.width) as f64]
    }

    /// Share of the places between two pieces that are seen to be empty: what is convex and has both fills them.
    pub(super) fn empty_between(&self, a: &[u32], b: &[u32]) -> f64 {
        let some = |piece: &[u32], k: usize| piece[k * piece.len() / WAYS] as usize;
        let (mut empty, mut all) = (0.0, 0.0);
        for k in 0..WAYS {
            // each of one with a far one of the other's order
            let [i, j] = [some(a, k), some(b, (k * 37) % WAYS)];
            let ranges = [i, j].map(|i| self.range(i).recip());
            for share in [0.25, 0.5, 0.75] {
                let between = |from: usize, to: usize| {
                    (from as f64 + share * (to as f64 - from as f64)).round() as usize
                };
                let u = between(i % self.width, j % self.width);
                let v = between(i / self.width, j / self.width);
                let range = (ranges[0] + share * (ranges[1] - ranges[0])).recip();
                all += 1.0;
                empty += f64::from(u8::from(self.range(v * self.width + u) > range + BEFORE));
            }
        }
        empty / all
    }

    /// Share of the lines of sight that meet a surface which saw something behind it: those to other pixels than the
    /// pieces' own, in the box of these in the image.
    pub(super) fn contradicted(&self, fit: &Fit, pieces: [&[u32]; 2]) -> f64 {
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for i in pieces.iter().copied().flatten() {
            let at = [*i as usize % self.width, *i as usize / self.width];
            low = [0, 1].map(|k| low[k].min(at[k]));
            high = [0, 1].map(|k| high[k].max(at[k]));
        }
        let area = (high[0] - low[0] + 1) * (high[1] - low[1] + 1);
        let step = ((area / TRIED) as f64).sqrt().ceil().max(1.0) as usize;
        let (mut met, mut before) = (0.0, 0.0);
        let local = fit.surface.pose().inverse();
        let origin = local * self.eye;
        for v in (low[1]..=high[1]).step_by(step) {
            for u in (low[0]..=high[0]).step_by(step) {
                let i = v * self.width + u;
                let own = self.owner[i] != NOBODY && {
                    let inside = |p: &[u32]| {
                        p.first().is_some_and(|f| self.owner[*f as usize] == self.owner[i])
                    };
                    pieces.iter().any(|p| inside(p))
                };
                let Some(way) = Direction::try_new(local * (self.points[i] - self.eye), 1e-9)
                else {
                    continue;
                };
                let ray = Ray { origin, direction: way };
                let Some(hit) = first_hit(fit.surface.shape(), &ray, 1e3) else { continue };
                met += 1.0;
                before += f64::from(u8::from(!own && hit.distance < self.range(i) - BEFORE));
            }
        }
        if met > 0.0 { before / met } else { 0.0 }
    }

    /// True where most lines of sight to some points enter a body over the top of its near wall, as they do through the mouth
    /// of a cup: the top of something behind looks like an inside too, but would be seen through that wall.
    pub(super) fn over_rim(&self, fit: &Fit, points: &[u32], support: &Plane, top: f64) -> bool {
        let local = fit.surface.pose().inverse();
        let (mut entered, mut at_top) = (0, 0);
        for i in points.iter().step_by(points.len().div_ceil(LOOKED).max(1)) {
            let way = local * (self.points[*i as usize] - self.eye);
            let Some(direction) = Direction::try_new(way, 1e-9) else { continue };
            let ray = Ray { origin: local * self.eye, direction };
            if let Some(hit) = first_hit(fit.surface.shape(), &ray, 1e3) {
                entered += 1;
                at_top +=
                    usize::from(support.height(&(fit.surface.pose() * hit.point)) > top - RIM);
            }
        }
        entered > 0 && 10 * at_top > 7 * entered
    }

    /// Whether a piece hangs in the air, as the image tells.
    pub(super) fn hangs(&self, piece: &[u32], up: &Vector) -> bool {
        hangs(self.points, self.width, &self.eye, piece, up)
    }
}
