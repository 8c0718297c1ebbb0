//! The places of an object along one approach, cut into strips as wide as the pads.
//!
//! The search turns the object more than a hundred times, so places are put into rows across the pads and
//! bins along the closing axis by counting, not by comparing, and in single precision about the object's
//! middle. Each bin knows its highest place, so that a stretch of matter above the tips is found without
//! looking at places.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::surroundings::Spot;
use crate::{Point, Vector};

/// Size of rows and bins, in metres; larger where an object needs more than `MOST`.
const CELL: f32 = 0.002;
const MOST: f32 = 2000.0;
/// A place this far below the tips (along the approach) still counts as above them.
const UNDER: f32 = 0.001;

/// A place in the tool's directions about the object's middle: z along the approach.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turned {
    pub(super) x: f32,
    pub(super) y: f32,
    pub(super) z: f32,
    /// Cosine between its normal and the closing axis.
    pub(super) cosine: f32,
    /// Its weight as evidence of a side: 0 where no normal is known.
    pub(super) evidence: f32,
    pub(super) seen: bool,
    row: u16,
    bin: u16,
}

/// A place before it is turned.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: Vector3<f32>,
    normal: Vector3<f32>,
    evidence: f32,
    seen: bool,
}

/// The cells of one coordinate.
#[derive(Clone, Copy, Default)]
struct Axis {
    low: f32,
    high: f32,
    cell: f32,
    cells: usize,
}

impl Axis {
    fn new([low, high]: [f32; 2]) -> Self {
        let cell = CELL.max((high - low) / MOST);
        Self { low, high, cell, cells: ((high - low) / cell) as usize + 1 }
    }

    #[inline]
    fn cell_of(&self, value: f32) -> usize {
        // in i32, as a conversion to a wider integer costs more than all the rest
        let k = ((value - self.low) * (1.0 / self.cell)) as i32;
        (k.max(0) as usize).min(self.cells - 1)
    }
}

/// Places sorted by the cells of one axis: those of cell `k` are `starts[k]..starts[k + 1]`.
#[derive(Default)]
struct Sorted {
    places: Vec<Turned>,
    starts: Vec<u32>,
    axis: Axis,
}

impl Sorted {
    /// Takes the places that `places` gives (twice the same); `cell` names the cell of each.
    fn fill<'a>(
        &mut self,
        axis: Axis,
        places: impl Iterator<Item = &'a Turned> + Clone,
        cell: impl Fn(&Turned) -> u16,
    ) {
        self.axis = axis;
        self.starts.clear();
        self.starts.resize(axis.cells + 1, 0);
        for t in places.clone() {
            self.starts[usize::from(cell(t)) + 1] += 1;
        }
        let mut count = 0;
        for start in &mut self.starts {
            count += *start;
            *start = count;
        }
        if self.places.len() < count as usize {
            self.places.resize(count as usize, Turned::default());
        }
        // filling moves each start to the end of its cell, which is the start of the next
        for t in places {
            let start = &mut self.starts[usize::from(cell(t))];
            self.places[*start as usize] = *t;
            *start += 1;
        }
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    fn count(&self) -> usize {
        self.starts.last().map_or(0, |n| *n as usize)
    }

    /// The places of all cells that [from, to] touches.
    fn within(&self, from: f32, to: f32) -> &[Turned] {
        if self.count() == 0 {
            return &[];
        }
        let (a, b) = (self.axis.cell_of(from), self.axis.cell_of(to));
        &self.places[self.starts[a] as usize..self.starts[b + 1] as usize]
    }

    fn cell(&self, k: usize) -> &[Turned] {
        &self.places[self.starts[k] as usize..self.starts[k + 1] as usize]
    }
}

/// An object turned towards one approach, with one strip of it laid open.
#[derive(Default)]
pub(super) struct Strips {
    places: Vec<Place>,
    turned: Vec<Turned>,
    rows: Sorted,
    bins: Sorted,
    /// The cells along the closing axis.
    across: Axis,
    /// The highest place of each bin: its least z.
    tops: Vec<f32>,
}

impl Strips {
    /// Takes the places of an object; `middle` becomes the origin.
    pub(super) fn new(spots: &[Spot], middle: &Point) -> Self {
        let place = |s: &Spot| Place {
            at: (s.at - middle).cast(),
            normal: s.normal.cast(),
            evidence: match (s.seen, s.normal != Vector::zeros()) {
                (true, true) => 1.0,
                (false, true) => 0.6,
                _ => 0.0,
            },
            seen: s.seen,
        };
        Self { places: spots.iter().map(place).collect(), ..Self::default() }
    }

    /// Turns all places.
    pub(super) fn turn(&mut self, rotation: &Rotation3<f64>) {
        let inverse: Matrix3<f32> = rotation.matrix().transpose().cast();
        let closing: Vector3<f32> = rotation.matrix().column(0).into_owned().cast();
        let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
        let Self { places, turned, rows, .. } = self;
        turned.clear();
        turned.extend(places.iter().map(|p| {
            let q = inverse * p.at;
            (low, high) =
                ([low[0].min(q.x), low[1].min(q.y)], [high[0].max(q.x), high[1].max(q.y)]);
            let Place { evidence, seen, .. } = *p;
            let cosine = closing.dot(&p.normal);
            Turned { x: q.x, y: q.y, z: q.z, cosine, evidence, seen, row: 0, bin: 0 }
        }));
        let [across, along] = [0, 1].map(|k| Axis::new([low[k], high[k]]));
        for t in turned.iter_mut() {
            (t.row, t.bin) = (along.cell_of(t.y) as u16, across.cell_of(t.x) as u16);
        }
        self.across = across;
        rows.fill(along, turned.iter(), |t| t.row);
    }

    /// Extent across the strips.
    pub(super) fn along(&self) -> [f32; 2] {
        [self.rows.axis.low, self.rows.axis.high]
    }

    /// Lays open the strip `half` to each side of `y`: how many places it has, and the highest.
    pub(super) fn open(&mut self, y: f32, half: f32) -> (usize, f32) {
        let Self { rows, bins, tops, across, .. } = self;
        let inside = rows.within(y - half, y + half).iter().filter(|t| (t.y - y).abs() <= half);
        bins.fill(*across, inside, |t| t.bin);
        tops.clear();
        tops.extend(
            (0..across.cells)
                .map(|k| bins.cell(k).iter().map(|t| t.z).fold(f32::INFINITY, f32::min)),
        );
        let top = tops.iter().copied().fold(f32::INFINITY, f32::min);
        (bins.count(), top)
    }

    /// Middle of the open strip's extent along the closing axis.
    pub(super) fn middle(&self) -> Option<f32> {
        let full = |k: &usize| !self.bins.cell(*k).is_empty();
        let Axis { low, cell, cells, .. } = self.across;
        let first = (0..cells).find(full)?;
        let last = (0..cells).rev().find(full)?;
        Some(low + 0.5 * cell * (first + last + 1) as f32)
    }

    /// Every stretch `[from, to]` of matter above the tips with more than `room` free on both sides.
    pub(super) fn stretches(&self, tip: f32, room: f32, mut found: impl FnMut(f32, f32)) {
        let mut open: Option<(f32, usize)> = None;
        for k in (0..self.tops.len()).filter(|k| self.tops[*k] < tip + UNDER) {
            open = match open {
                None => Some((self.ends(k, tip)[0], k)),
                Some((from, last)) if (k - last + 1) as f32 * self.across.cell <= room => {
                    Some((from, k))
                }
                Some((from, last)) => {
                    let (end, next) = (self.ends(last, tip)[1], self.ends(k, tip)[0]);
                    if next - end > room {
                        found(from, end);
                        Some((next, k))
                    } else {
                        Some((from, k))
                    }
                }
            };
        }
        if let Some((from, last)) = open {
            found(from, self.ends(last, tip)[1]);
        }
    }

    /// Least and largest x of a bin's places above the tips.
    fn ends(&self, k: usize, tip: f32) -> [f32; 2] {
        let above = self.bins.cell(k).iter().filter(|t| t.z < tip + UNDER);
        above.fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], t| [a.min(t.x), b.max(t.x)])
    }

    /// The open strip's places in the bins that [from, to] touches.
    pub(super) fn within(&self, from: f32, to: f32) -> &[Turned] {
        self.bins.within(from, to)
    }
}
