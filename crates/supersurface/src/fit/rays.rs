//! Where do free lines of sight lie deepest in a body?
//!
//! Along a line the gauge of a superellipsoid has one valley, and the sign of its slope, which the normal tells, halves
//! the way to it; a toroid may have two, so samples choose the deeper one first. All lines are searched side by side.

use super::columns::{Evaluation, Sample};
use super::parameters::Parameters;
use crate::Vector;
use crate::numeric::lanes::Lane;

/// Samples of a line by which the deeper of two valleys is chosen, and halvings of what is left.
const SAMPLES: usize = 6;
const HALVINGS: usize = 6;

/// One line, and the stretch of it in which the deepest place is looked for.
#[derive(Clone, Copy, Debug)]
struct Line {
    way: Vector,
    low: f64,
    high: f64,
    deepest: f64,
    depth: f64,
}

impl Line {
    /// Takes a place that lies deeper than those before.
    fn take(&mut self, at: f64, depth: f64) {
        if depth < self.depth {
            (self.deepest, self.depth) = (at, depth);
        }
    }
}

/// Buffers of the search.
#[derive(Debug, Default)]
pub(super) struct Rays<L> {
    lines: Vec<Line>,
    places: Sample<L>,
    evaluation: Evaluation<L>,
}

impl<L: Lane> Rays<L> {
    /// Adds to `found` the place on each line from `from` that lies deepest in the body (least signed distance),
    /// for the lines that enter it.
    pub(super) fn deepest<'a>(
        &mut self,
        s: &Parameters,
        from: &Vector,
        ends: impl Iterator<Item = &'a Vector>,
        found: &mut Vec<Vector>,
    ) {
        let around = Around::new(s, from);
        self.lines.clear();
        self.lines.extend(ends.filter_map(|end| {
            let (low, high) = around.near(end)?;
            Some(Line { way: end - from, low, high, deepest: low, depth: f64::INFINITY })
        }));
        if self.lines.is_empty() {
            return;
        }
        let mut halvings = HALVINGS;
        if s.family.is_ring() || s.family.is_deformed() {
            self.choose_valleys(s, from);
            halvings -= 2;
        }
        for _ in 0..halvings {
            let middle = |l: &Line| 0.5 * (l.low + l.high);
            self.places.set(self.lines.iter().map(|l| from + l.way * middle(l)));
            self.evaluation.fill_normals(s, &self.places);
            for (i, line) in self.lines.iter_mut().enumerate() {
                let t = middle(line);
                line.take(t, self.evaluation.distances[i].wide());
                let slope = self.evaluation.outwards(i).dot(&line.way);
                if slope > 0.0 { line.high = t } else { line.low = t }
            }
        }
        let inside = self.lines.iter().filter(|l| l.depth < 0.0);
        found.extend(inside.map(|l| from + l.way * l.deepest));
    }

    /// Narrows each line to the neighbourhood of its deepest sample.
    fn choose_valleys(&mut self, s: &Parameters, from: &Vector) {
        let at = |l: &Line, k: usize| l.low + (l.high - l.low) * (k as f64 / SAMPLES as f64);
        let samples = |l| (0..=SAMPLES).map(move |k| (l, k));
        let samples = self.lines.iter().flat_map(samples);
        self.places.set(samples.map(|(l, k)| from + l.way * at(l, k)));
        self.evaluation.fill_distances(s, &self.places);
        let depths = self.evaluation.distances.chunks_exact(SAMPLES + 1);
        for (line, depths) in self.lines.iter_mut().zip(depths) {
            for (k, depth) in depths.iter().enumerate() {
                line.take(at(line, k), depth.wide());
            }
        }
        for line in &mut self.lines {
            let step = (line.high - line.low) / SAMPLES as f64;
            line.low = line.low.max(line.deepest - step);
            line.high = line.high.min(line.deepest + step);
        }
    }
}

/// Where a body's bounding ellipsoid is a ball about the origin.
struct Around<'a> {
    s: &'a Parameters,
    half: Vector,
    /// A place there.
    from: Vector,
}

impl<'a> Around<'a> {
    fn new(s: &'a Parameters, from: &Vector) -> Self {
        let mut around = Self { s, half: Vector::from(s.half_extents()), from: *from };
        around.from = around.inward(from);
        around
    }

    fn inward(&self, x: &Vector) -> Vector {
        let local = self.s.rotation.inverse_transform_vector(&(x - self.s.position));
        local.component_div(&self.half)
    }

    /// The stretch between the place and another, as shares, that runs through the ellipsoid.
    fn near(&self, to: &Vector) -> Option<(f64, f64)> {
        let a = self.from;
        let b = self.inward(to) - a;
        let squared = b.norm_squared();
        if squared == 0.0 {
            return None;
        }
        // a body of exponents >= 0.1 lies within √3 of its scaled centre
        let middle = -a.dot(&b) / squared;
        let nearest = (a + b * middle).norm_squared();
        if nearest >= 3.0 {
            return None;
        }
        let reach = ((3.0 - nearest) / squared).sqrt();
        let (low, high) = ((middle - reach).max(0.0), (middle + reach).min(1.0));
        (low < high).then_some((low, high))
    }
}
