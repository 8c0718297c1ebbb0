//! Grasps inside holes (row T3 of the tables, found on the points): the closed jaw goes in from above and presses
//! outwards.
//!
//! A hole is a gap in the object's footprint that the object encloses. Across it the jaw opens where the two
//! edges are straightest over the pads' width, near the middle of the object.

use nalgebra::{Matrix3, Rotation3, UnitQuaternion};

use super::gripper::Jaw;
use super::quality::Candidate;
use super::surroundings::Local;
use crate::{Pose, Vector};

/// Side of a cell of the footprint, in metres.
const CELL: f64 = 0.003;
/// Most cells on a side.
const MOST: usize = 400;
/// Room between the closed jaw and the hole on each side.
const ROOM: f64 = 0.002;
/// Unevenness of the edges over the pads that is still pressed on.
const UNEVEN: f64 = 0.006;
/// Rows across the pads at which the hole is measured.
const ROWS: i32 = 4;

/// Candidates in all holes of the object; none for a jaw that cannot press outwards.
pub(super) fn holes(local: &Local, jaw: &Jaw) -> Vec<Candidate> {
    let Some(closed) = jaw.outer_width_closed else { return Vec::new() };
    let Some(footprint) = Footprint::of(local) else { return Vec::new() };
    let mut out: Vec<(f64, Candidate)> = Vec::new();
    for hole in footprint.enclosed() {
        let area = hole.len() as f64 * CELL * CELL;
        if area < closed * jaw.pad_width {
            continue;
        }
        let middle = hole.iter().fold(Vector::zeros(), |s, c| s + c) / hole.len() as f64;
        for k in 0..24 {
            let (s, c) = (std::f64::consts::PI * f64::from(k) / 24.0).sin_cos();
            let (across, along) = (Vector::new(c, s, 0.0), Vector::new(-s, c, 0.0));
            for shift in [0.0, 0.004, -0.004] {
                let centre = middle + along * shift;
                if let Some(found) = span(&hole, &centre, &across, &along, jaw, closed) {
                    out.extend(candidate(local, jaw, &centre, across, found));
                }
            }
        }
    }
    out.sort_by(|a, b| a.0.total_cmp(&b.0));
    out.truncate(40);
    out.into_iter().map(|(_, c)| c).collect()
}

/// A stretch across a hole: its ends along the opening direction and how uneven they are.
struct Span {
    ends: [f64; 2],
    uneven: f64,
}

/// The hole's free width along `across`, the same for all rows under the pads.
fn span(
    hole: &[Vector],
    centre: &Vector,
    across: &Vector,
    along: &Vector,
    jaw: &Jaw,
    closed: f64,
) -> Option<Span> {
    let (mut lows, mut highs) = ([0.0f64; 2], [0.0f64; 2]);
    for k in -ROWS..=ROWS {
        let row = 0.5 * jaw.pad_width * f64::from(k) / f64::from(ROWS);
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for cell in hole {
            let d = cell - centre;
            if (d.dot(along) - row).abs() < 0.75 * CELL {
                let u = d.dot(across);
                low = low.min(u - 0.5 * CELL);
                high = high.max(u + 0.5 * CELL);
            }
        }
        if low > high {
            return None;
        }
        if k == -ROWS {
            (lows, highs) = ([low; 2], [high; 2]);
        } else {
            lows = [lows[0].min(low), lows[1].max(low)];
            highs = [highs[0].min(high), highs[1].max(high)];
        }
    }
    // the narrowest row is what the jaw passes and presses on
    let ends = [lows[1], highs[0]];
    let width = ends[1] - ends[0];
    let uneven = 0.5 * (lows[1] - lows[0] + highs[1] - highs[0]);
    let fits = width > closed + 2.0 * ROOM && width < closed + jaw.max_opening - 0.006;
    (fits && uneven < UNEVEN).then_some(Span { ends, uneven })
}

/// The candidate in a span, as deep as the wider part of the fingers allows.
fn candidate(
    local: &Local,
    jaw: &Jaw,
    centre: &Vector,
    across: Vector,
    span: Span,
) -> Option<(f64, Candidate)> {
    let width = span.ends[1] - span.ends[0];
    let at = centre + across * (0.5 * (span.ends[0] + span.ends[1]));
    let along = Vector::new(-across.y, across.x, 0.0);
    let mut rim = f64::NEG_INFINITY;
    let mut touched = 0;
    for spot in local.spots.iter().filter(|s| s.seen) {
        let d = spot.at.coords - at;
        let beside = d.dot(&along).abs() < 0.5 * jaw.pad_width;
        if beside && (d.dot(&across).abs() - 0.5 * width).abs() < 0.008 {
            rim = rim.max(spot.at.z);
            touched += 1;
        }
    }
    if touched < 6 {
        return None;
    }
    let deep = rim + jaw.tip_beyond_tcp - jaw.pad_length + 0.001;
    let lowest = if local.has_table { jaw.tip_beyond_tcp + 0.003 } else { f64::NEG_INFINITY };
    let z = deep.max(lowest);
    let axes = Matrix3::from_columns(&[across, (-Vector::z()).cross(&across), -Vector::z()]);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes));
    let pose = Pose::from_parts(Vector::new(at.x, at.y, z).into(), turn);
    let arm = (at - local.centre.coords).xy().norm();
    let cost = 30.0 * span.uneven + 4.0 * arm;
    Some((cost, Candidate { pose, width, inside: true, source: "T3 on points" }))
}

/// The object from above.
struct Footprint {
    corner: [f64; 2],
    size: [usize; 2],
    taken: Vec<bool>,
}

impl Footprint {
    fn of(local: &Local) -> Option<Self> {
        let seen = || local.spots.iter().filter(|s| s.seen).map(|s| s.at);
        let first = seen().next()?;
        let (low, high) = seen().fold((first, first), |(l, h), p| (l.inf(&p), h.sup(&p)));
        let corner = [low.x - 3.0 * CELL, low.y - 3.0 * CELL];
        let side = |k: usize| ((high[k] - low[k]) / CELL) as usize + 7;
        let size = [side(0), side(1)];
        if size[0] > MOST || size[1] > MOST {
            return None;
        }
        let mut footprint = Self { corner, size, taken: vec![false; size[0] * size[1]] };
        for p in seen() {
            let u = ((p.x - corner[0]) / CELL) as usize;
            let v = ((p.y - corner[1]) / CELL) as usize;
            footprint.taken[v * size[0] + u] = true;
        }
        footprint.close();
        Some(footprint)
    }

    fn neighbours(&self, c: usize) -> impl Iterator<Item = usize> {
        let [w, h] = self.size;
        let (u, v) = (c % w, c / w);
        let inside = u > 0 && v > 0 && u + 1 < w && v + 1 < h;
        [c.wrapping_sub(1), c + 1, c.wrapping_sub(w), c + w].into_iter().filter(move |_| inside)
    }

    /// Closes gaps of one cell between readings: one dilation, one erosion.
    fn close(&mut self) {
        let grown: Vec<bool> = (0..self.taken.len())
            .map(|c| self.taken[c] || self.neighbours(c).any(|n| self.taken[n]))
            .collect();
        let closed = (0..grown.len())
            .map(|c| self.taken[c] || (grown[c] && self.neighbours(c).all(|n| grown[n])))
            .collect();
        self.taken = closed;
    }

    /// The middles of the cells of each enclosed gap, on the table.
    fn enclosed(&self) -> Vec<Vec<Vector>> {
        let mut seen = self.taken.clone();
        let [w, h] = self.size;
        let border = (0..seen.len())
            .filter(|c| c % w == 0 || c % w == w - 1 || c / w == 0 || c / w == h - 1);
        let outside: Vec<usize> = border.collect();
        for c in outside {
            seen[c] = true;
            // the border's inner neighbours are the first cells of the outside
            let (u, v) = ((c % w).clamp(1, w - 2), (c / w).clamp(1, h - 2));
            self.flood(v * w + u, &mut seen);
        }
        let mut gaps = Vec::new();
        for c in 0..seen.len() {
            if !seen[c] {
                let cells = self.flood(c, &mut seen);
                gaps.push(cells.into_iter().map(|c| self.middle(c)).collect());
            }
        }
        gaps
    }

    fn flood(&self, from: usize, seen: &mut [bool]) -> Vec<usize> {
        let mut open = vec![from];
        let mut cells = Vec::new();
        while let Some(c) = open.pop() {
            if !std::mem::replace(&mut seen[c], true) {
                cells.push(c);
                open.extend(self.neighbours(c));
            }
        }
        cells
    }

    fn middle(&self, c: usize) -> Vector {
        let (u, v) = ((c % self.size[0]) as f64, (c / self.size[0]) as f64);
        Vector::new(self.corner[0] + (u + 0.5) * CELL, self.corner[1] + (v + 0.5) * CELL, 0.0)
    }
}
