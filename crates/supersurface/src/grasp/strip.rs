//! The places of an object along one approach, cut into strips as wide as the pads.
//!
//! The search turns the object more than a hundred times, so places are put into cells by counting, not by
//! comparing, in single precision about the object's middle: rows across the pads, three to a strip, and bins
//! along the closing axis. Each cell knows its highest place, so that a stretch of matter above the tips is
//! found without looking at places.

use nalgebra::Rotation3;

use super::surroundings::Spot;
use crate::{Point, Vector};

/// Rows of a strip: strips overlap by two of them.
pub(super) const ROWS: usize = 3;
/// Size of a bin, in metres; larger where an object needs more than `MOST` bins or rows.
const BIN: f32 = 0.0025;
const MOST: f32 = 400.0;
/// A place this far below the tips (along the approach) still counts as above them.
const UNDER: f32 = 0.001;

/// A place in the tool's directions about the object's middle: z along the approach.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turned {
    pub(super) x: f32,
    y: f32,
    pub(super) z: f32,
    /// Cosine between its normal and the closing axis.
    pub(super) cosine: f32,
    /// Its weight as evidence of a side: 0 where no normal is known.
    pub(super) evidence: f32,
    pub(super) seen: bool,
    cell: u32,
}

/// A place before it is turned.
#[derive(Clone, Copy, Debug)]
struct Place {
    at: [f32; 3],
    normal: [f32; 3],
    evidence: f32,
    seen: bool,
}

/// The cells of one coordinate.
#[derive(Clone, Copy, Default)]
struct Axis {
    low: f32,
    size: f32,
    cells: usize,
}

impl Axis {
    fn new([low, high]: [f32; 2], size: f32) -> Self {
        let size = size.max((high - low) / MOST);
        let cells = ((high - low) / size) as usize + 1;
        // centred, so that a strip may lie over the object's middle
        Self { low: 0.5 * (low + high - size * cells as f32), size, cells }
    }

    #[inline]
    fn cell_of(&self, value: f32) -> usize {
        // by way of i32, as a conversion to a wider integer costs more than all the rest
        let k = ((value - self.low) * (1.0 / self.size)) as i32;
        (k.max(0) as usize).min(self.cells - 1)
    }
}

/// An object turned towards one approach, with one strip of it laid open.
#[derive(Default)]
pub(super) struct Strips {
    places: Vec<Place>,
    turned: Vec<Turned>,
    rows: Axis,
    bins: Axis,
    /// Places by cell, row after row; those of cell `k` are `starts[k]..starts[k + 1]`.
    sorted: Vec<Turned>,
    starts: Vec<u32>,
    /// The highest place of each cell: its least z.
    heights: Vec<f32>,
    /// First row of the open strip, and the highest place of each of its bins.
    row: usize,
    tops: Vec<f32>,
}

impl Strips {
    /// Takes the places of an object; `middle` becomes the origin.
    pub(super) fn new(spots: &[Spot], middle: &Point) -> Self {
        let place = |s: &Spot| Place {
            at: (s.at - middle).cast().into(),
            normal: s.normal.cast().into(),
            evidence: match (s.seen, s.normal != Vector::zeros()) {
                (true, true) => 1.0,
                (false, true) => 0.6,
                _ => 0.0,
            },
            seen: s.seen,
        };
        Self { places: spots.iter().map(place).collect(), ..Self::default() }
    }

    /// Turns all places and sorts them into strips of a width.
    pub(super) fn turn(&mut self, rotation: &Rotation3<f64>, width: f32) {
        let [x, y, z]: [[f32; 3]; 3] = rotation.matrix().cast().into();
        let dot = |a: &[f32; 3], b: &[f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let none = [f32::INFINITY, f32::NEG_INFINITY];
        let (mut across, mut along) = (none, none);
        self.turned.clear();
        self.turned.extend(self.places.iter().map(|p| {
            let (qx, qy) = (dot(&x, &p.at), dot(&y, &p.at));
            across = [across[0].min(qx), across[1].max(qx)];
            along = [along[0].min(qy), along[1].max(qy)];
            let (z, cosine) = (dot(&z, &p.at), dot(&x, &p.normal));
            Turned { x: qx, y: qy, z, cosine, evidence: p.evidence, seen: p.seen, cell: 0 }
        }));
        self.rows = Axis::new(along, width / ROWS as f32);
        self.bins = Axis::new(across, BIN);
        self.sort();
    }

    fn sort(&mut self) {
        let Self { turned, sorted, starts, heights, rows, bins, .. } = self;
        let cells = rows.cells * bins.cells;
        starts.clear();
        starts.resize(cells + 1, 0);
        heights.clear();
        heights.resize(cells, f32::INFINITY);
        for t in turned.iter_mut() {
            let k = rows.cell_of(t.y) * bins.cells + bins.cell_of(t.x);
            t.cell = k as u32;
            starts[k + 1] += 1;
            heights[k] = heights[k].min(t.z);
        }
        let mut count = 0;
        for start in starts.iter_mut() {
            count += *start;
            *start = count;
        }
        sorted.resize(turned.len(), Turned::default());
        // filling moves each start to the end of its cell, which is the start of the next
        for t in turned.iter() {
            let start = &mut starts[t.cell as usize];
            sorted[*start as usize] = *t;
            *start += 1;
        }
        starts.rotate_right(1);
        starts[0] = 0;
    }

    /// How many strips the object has along y.
    pub(super) fn count(&self) -> usize {
        self.rows.cells.saturating_sub(ROWS - 1).max(1)
    }

    /// Lays open a strip: its middle along y, how many places it has, and the highest.
    pub(super) fn open(&mut self, strip: usize) -> (f32, usize, f32) {
        self.row = strip;
        let bins = self.bins.cells;
        let rows = strip..(strip + ROWS).min(self.rows.cells);
        self.tops.clear();
        self.tops.resize(bins, f32::INFINITY);
        for row in rows.clone() {
            let heights = &self.heights[row * bins..(row + 1) * bins];
            for (top, height) in self.tops.iter_mut().zip(heights) {
                *top = top.min(*height);
            }
        }
        let count = self.starts[rows.end * bins] - self.starts[rows.start * bins];
        let highest = self.tops.iter().copied().fold(f32::INFINITY, f32::min);
        let middle = 0.5 * (rows.start + rows.end) as f32 * self.rows.size + self.rows.low;
        (middle, count as usize, highest)
    }

    /// Middle of the open strip's extent along the closing axis.
    pub(super) fn middle(&self) -> Option<f32> {
        let first = self.tops.iter().position(|t| t.is_finite())?;
        let last = self.tops.iter().rposition(|t| t.is_finite())?;
        Some(self.bins.low + 0.5 * self.bins.size * (first + last + 1) as f32)
    }

    /// Every stretch `[from, to]` of matter above the tips with more than `room` free on both sides.
    pub(super) fn stretches(&self, tip: f32, room: f32, mut found: impl FnMut(f32, f32)) {
        let mut open: Option<(f32, usize)> = None;
        for k in (0..self.tops.len()).filter(|k| self.tops[*k] < tip + UNDER) {
            open = match open {
                None => Some((self.ends(k, tip)[0], k)),
                Some((from, last)) if (k - last + 1) as f32 * self.bins.size <= room => {
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
    fn ends(&self, bin: usize, tip: f32) -> [f32; 2] {
        let above = self.in_bins(bin, bin).flatten().filter(|t| t.z < tip + UNDER);
        above.fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], t| [a.min(t.x), b.max(t.x)])
    }

    /// The open strip's places in the bins that [from, to] touches, row by row.
    pub(super) fn within(&self, from: f32, to: f32) -> impl Iterator<Item = &[Turned]> {
        self.in_bins(self.bins.cell_of(from), self.bins.cell_of(to))
    }

    fn in_bins(&self, first: usize, last: usize) -> impl Iterator<Item = &[Turned]> {
        let bins = self.bins.cells;
        (self.row..(self.row + ROWS).min(self.rows.cells)).map(move |row| {
            let [a, b] = [row * bins + first, row * bins + last + 1];
            &self.sorted[self.starts[a] as usize..self.starts[b] as usize]
        })
    }
}
