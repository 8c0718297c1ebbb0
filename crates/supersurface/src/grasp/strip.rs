//! The places of an object along one approach, cut into strips as wide as the pads.
//!
//! The search turns the object more than a hundred times, so places are put into cells by counting, not by
//! comparing, in single precision about the object's middle: rows across the pads, three to a strip, and bins
//! along the closing axis. Each cell knows its highest place, so that a stretch of matter above the tips is
//! found without looking at places.

use nalgebra::Rotation3;

use super::surroundings::Spot;
use crate::numeric::lanes::{Job, dispatch};
use crate::{Point, Vector};

/// Rows of a strip: strips overlap by two of them.
pub(super) const ROWS: usize = 3;
/// Size of a bin, in metres; larger where an object needs more than `MOST` bins or rows.
const BIN: f32 = 0.0025;
const MOST: f32 = 400.0;
/// A place this far below the tips (along the approach) still counts as above them.
const UNDER: f32 = 0.001;

/// A place in the tool's directions about the object's middle, x along the closing axis and z along the approach.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Turned {
    pub(super) x: f32,
    pub(super) z: f32,
    /// Cosine between its normal and the closing axis.
    pub(super) cosine: f32,
    /// Its weight as evidence of a side: 0 where no normal is known.
    pub(super) evidence: f32,
    pub(super) seen: bool,
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

    #[inline(always)]
    fn cell_of(&self, value: f32) -> u32 {
        // half a cell less, rounded by the addition, and read from the low bits: a conversion has no vector
        // instruction that saturates
        const ROUND: f32 = 8_388_608.0;
        let place = (value - self.low) * (1.0 / self.size) - 0.5;
        let last = (self.cells - 1) as f32;
        let place = if place > 0.0 { place } else { 0.0 };
        let place = if place < last { place } else { last };
        (place + ROUND).to_bits() & 0x007F_FFFF
    }
}

/// Columns of numbers, one a place, padded with the first place to a multiple of [`BLOCK`].
type Column = Vec<f32>;
const BLOCK: usize = 16;

/// An object turned towards one approach, with one strip of it laid open.
#[derive(Default)]
pub(super) struct Strips {
    count: usize,
    at: [Column; 3],
    normal: [Column; 3],
    evidence: Vec<(f32, bool)>,
    /// The same, turned: x, y, z, and the cosine of the normal.
    turned: [Column; 4],
    cells: Vec<u32>,
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
        let evidence = |s: &Spot| match (s.seen, s.normal != Vector::zeros()) {
            (true, true) => 1.0,
            (false, true) => 0.6,
            _ => 0.0,
        };
        let column = |value: &dyn Fn(&Spot) -> f64| {
            let mut column: Column = spots.iter().map(|s| value(s) as f32).collect();
            let first = column.first().copied().unwrap_or(0.0);
            column.resize(spots.len().next_multiple_of(BLOCK), first);
            column
        };
        Self {
            count: spots.len(),
            at: [0, 1, 2].map(|k| column(&|s| s.at[k] - middle[k])),
            normal: [0, 1, 2].map(|k| column(&|s| s.normal[k])),
            evidence: spots.iter().map(|s| (evidence(s), s.seen)).collect(),
            ..Self::default()
        }
    }

    /// Turns all places and sorts them into strips of a width.
    pub(super) fn turn(&mut self, rotation: &Rotation3<f64>, width: f32) {
        let none = [f32::INFINITY, f32::NEG_INFINITY];
        let mut extents = [none; 2];
        for column in &mut self.turned {
            column.resize(self.at[0].len(), 0.0);
        }
        let axes = rotation.matrix().cast().into();
        dispatch(Rotate {
            axes,
            at: &self.at,
            normal: &self.normal,
            turned: &mut self.turned,
            extents: &mut extents,
        });
        self.bins = Axis::new(extents[0], BIN);
        self.rows = Axis::new(extents[1], width / ROWS as f32);
        self.cells.resize(self.at[0].len(), 0);
        dispatch(Cells {
            turned: &self.turned,
            axes: [self.bins, self.rows],
            cells: &mut self.cells,
        });
        self.sort();
    }

    fn sort(&mut self) {
        let Self { turned, cells, sorted, starts, heights, rows, bins, evidence, .. } = self;
        let [x, _, z, cosine] = turned;
        let count = rows.cells * bins.cells;
        starts.clear();
        starts.resize(count + 1, 0);
        heights.clear();
        heights.resize(count, f32::INFINITY);
        for (cell, z) in cells.iter().zip(z.iter()).take(self.count) {
            let k = *cell as usize;
            starts[k + 1] += 1;
            heights[k] = heights[k].min(*z);
        }
        let mut sum = 0;
        for start in starts.iter_mut() {
            sum += *start;
            *start = sum;
        }
        sorted.resize(self.count, Turned::default());
        // filling moves each start to the end of its cell, which is the start of the next
        let places = cells.iter().zip(x.iter().zip(z.iter().zip(cosine.iter())));
        for ((cell, (x, (z, cosine))), (evidence, seen)) in places.zip(evidence.iter()) {
            let start = &mut starts[*cell as usize];
            sorted[*start as usize] =
                Turned { x: *x, z: *z, cosine: *cosine, evidence: *evidence, seen: *seen };
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
        self.in_bins(self.bins.cell_of(from) as usize, self.bins.cell_of(to) as usize)
    }

    fn in_bins(&self, first: usize, last: usize) -> impl Iterator<Item = &[Turned]> {
        let bins = self.bins.cells;
        (self.row..(self.row + ROWS).min(self.rows.cells)).map(move |row| {
            let [a, b] = [row * bins + first, row * bins + last + 1];
            &self.sorted[self.starts[a] as usize..self.starts[b] as usize]
        })
    }
}

/// Turns places and normals, and finds the extents along x and y.
struct Rotate<'a> {
    /// The tool's axes, one after the other.
    axes: [[f32; 3]; 3],
    at: &'a [Column; 3],
    normal: &'a [Column; 3],
    turned: &'a mut [Column; 4],
    extents: &'a mut [[f32; 2]; 2],
}

impl Job for Rotate<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [x, y, z] = self.axes;
        let rows = [(x, self.at), (y, self.at), (z, self.at), (x, self.normal)];
        for (out, (axis, [px, py, pz])) in self.turned.iter_mut().zip(rows) {
            let places = px.iter().zip(py).zip(pz);
            for (out, ((px, py), pz)) in out.iter_mut().zip(places) {
                *out = axis[0] * px + axis[1] * py + axis[2] * pz;
            }
        }
        for (extent, column) in self.extents.iter_mut().zip(self.turned.iter()) {
            let (mut low, mut high) = ([f32::INFINITY; BLOCK], [f32::NEG_INFINITY; BLOCK]);
            for block in column.as_chunks::<BLOCK>().0 {
                for i in 0..BLOCK {
                    low[i] = if block[i] < low[i] { block[i] } else { low[i] };
                    high[i] = if block[i] > high[i] { block[i] } else { high[i] };
                }
            }
            *extent = [
                low.into_iter().fold(f32::INFINITY, f32::min),
                high.into_iter().fold(f32::NEG_INFINITY, f32::max),
            ];
        }
    }
}

/// Finds the cell of each place.
struct Cells<'a> {
    turned: &'a [Column; 4],
    /// Bins and rows.
    axes: [Axis; 2],
    cells: &'a mut [u32],
}

impl Job for Cells<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [x, y, ..] = self.turned;
        let [bins, rows] = self.axes;
        for (cell, (x, y)) in self.cells.iter_mut().zip(x.iter().zip(y)) {
            *cell = rows.cell_of(*y) * bins.cells as u32 + bins.cell_of(*x);
        }
    }
}
