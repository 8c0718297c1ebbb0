//! Where do free lines of sight lie deepest in a body?
//!
//! Along a line the gauge of a superellipsoid has one valley, and the sign of its slope, which the normal tells, halves
//! the way to it; a toroid may have two, so samples choose the deeper one first. All lines are searched side by side.

use super::columns::{Evaluation, Sample};
use super::parameters::{POSITION, Parameters};
use crate::Vector;
use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, Lane, dispatch};

/// Samples of a line by which the deeper of two valleys is chosen, and halvings of what is left.
const SAMPLES: usize = 4;
const HALVINGS: usize = 6;

/// Lines, the stretch of each in which its deepest place is looked for, and buffers.
#[derive(Debug, Default)]
pub(super) struct Rays<L> {
    /// From the sensor along whole ways to their ends.
    lines: Sample<L>,
    low: Column<L>,
    high: Column<L>,
    /// The deepest place so far, as a share of the way, and the signed distance there.
    deepest: Column<L>,
    depth: Column<L>,
    /// Where each is looked at.
    at: Column<L>,
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
        self.low.clear();
        self.high.clear();
        let (low, high) = (&mut self.low, &mut self.high);
        self.lines.set_seen(ends.filter_map(|end| {
            let stretch = around.near(end)?;
            low.push(L::of(stretch.0));
            high.push(L::of(stretch.1));
            Some((*from, end - from))
        }));
        let count = self.lines.len();
        if count == 0 {
            return;
        }
        let padded = self.lines.columns()[0].len();
        for (column, value) in [(&mut self.low, 0.0), (&mut self.high, 0.0), (&mut self.at, 0.0)] {
            column.resize(padded, L::of(value));
        }
        self.depth.clear();
        self.depth.resize(padded, L::of(f64::from(f32::MAX)));
        self.deepest.clear();
        self.deepest.resize(padded, L::of(0.0));
        let mut halvings = HALVINGS;
        if s.family.is_ring() || s.family.is_deformed() {
            self.choose_valleys(s);
            halvings -= 2;
        }
        for _ in 0..halvings {
            self.place(0.5);
            self.evaluation.fill_normals(s, &self.places);
            self.take();
            let gradient = [0, 1, 2].map(|k| &*self.evaluation.rows[POSITION + k]);
            let ways = self.lines.rays();
            let (low, high) = (&mut self.low, &mut self.high);
            dispatch(Halve { gradient, ways, at: &self.at, low, high });
        }
        let inside = (0..count).filter(|i| self.depth[*i] < L::of(0.0));
        found.extend(inside.map(|i| from + self.lines.ray(i) * self.deepest[i].wide()));
    }

    /// Looks at each line at this share of its stretch.
    fn place(&mut self, share: f64) {
        let share = L::of(share);
        for ((at, low), high) in self.at.iter_mut().zip(&self.low).zip(&self.high) {
            *at = *low + (*high - *low) * share;
        }
        self.places.set_along(&self.lines, &self.at);
    }

    /// Takes the places that lie deeper than those before.
    fn take(&mut self) {
        let best = self.deepest.iter_mut().zip(self.depth.iter_mut());
        for (((deepest, depth), at), d) in best.zip(&self.at).zip(&self.evaluation.distances) {
            *deepest = if *d < *depth { *at } else { *deepest };
            *depth = depth.least(*d);
        }
    }

    /// Narrows each line to the neighbourhood of its deepest sample.
    fn choose_valleys(&mut self, s: &Parameters) {
        for k in 0..=SAMPLES {
            self.place(k as f64 / SAMPLES as f64);
            self.evaluation.fill_distances(s, &self.places);
            self.take();
        }
        let share = L::of(1.0 / SAMPLES as f64);
        for ((low, high), deepest) in
            self.low.iter_mut().zip(self.high.iter_mut()).zip(&self.deepest)
        {
            let step = (*high - *low) * share;
            (*low, *high) = (low.most(*deepest - step), high.least(*deepest + step));
        }
    }
}

/// Leaves the half of each stretch in which the valley lies, by the slope at its middle.
struct Halve<'a, L> {
    /// Derivatives of the distances by the body's place, which are those by a point's but for the sign.
    gradient: [&'a [L]; 3],
    ways: &'a [Column<L>; 3],
    at: &'a [L],
    low: &'a mut [L],
    high: &'a mut [L],
}

impl<L: Lane> Job for Halve<'_, L> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let ([gx, gy, gz], [wx, wy, wz]) = (self.gradient, self.ways);
        let n = self.at.len();
        let (gx, gy, gz, wx, wy, wz) = (&gx[..n], &gy[..n], &gz[..n], &wx[..n], &wy[..n], &wz[..n]);
        let (low, high) = (&mut self.low[..n], &mut self.high[..n]);
        for i in 0..n {
            let falls = gx[i] * wx[i] + gy[i] * wy[i] + gz[i] * wz[i] >= L::of(0.0);
            let at = self.at[i];
            low[i] = if falls { at } else { low[i] };
            high[i] = if falls { high[i] } else { at };
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::parameters::Family;

    fn deepest<L: Lane>(s: &Parameters, ends: &[Vector]) -> Vec<Vector> {
        let mut found = Vec::new();
        Rays::<L>::default().deepest(s, &Vector::new(0.0, 0.0, -8.0), ends.iter(), &mut found);
        found
    }

    #[test]
    fn lines_lie_deepest_next_to_the_middle_of_a_ball() {
        let ball = Parameters::ball(Family::Superellipsoid);
        let size = ball.half_extents()[0];
        let ends: Vec<Vector> =
            (0..40).map(|i| Vector::new(0.1 * f64::from(i) * size, 0.0, 8.0)).collect();
        let from = Vector::new(0.0, 0.0, -8.0);
        let nearest = |end: &Vector| {
            from - (end - from) * (from.dot(&(end - from)) / (end - from).norm_squared())
        };
        let known: Vec<Vector> =
            ends.iter().map(nearest).filter(|p| p.norm() < 0.99 * size).collect();
        for found in [deepest::<f64>(&ball, &ends), deepest::<f32>(&ball, &ends)] {
            assert!(found.len() == known.len() || found.len() == known.len() + 1);
            for (p, q) in found.iter().zip(&known) {
                assert!(p.norm() < q.norm() + 0.05 * size, "{p} instead of {q}");
            }
        }
    }

    /// Through the near wall, the hole and the far wall.
    #[test]
    fn of_the_two_walls_of_a_ring_one_is_found() {
        let ring = Parameters { ring: 3.0, ..Parameters::ball(Family::Supertoroid) };
        let tube = ring.half_extents()[2];
        let across = [Vector::new(0.0, 0.0, 8.0)];
        let turned = Parameters {
            rotation: nalgebra::Rotation3::new(Vector::x() * std::f64::consts::FRAC_PI_2),
            ..ring
        };
        // along the axis nothing is met; from the side a wall's middle is
        assert!(deepest::<f32>(&ring, &across).is_empty());
        let found = deepest::<f32>(&turned, &across);
        assert!(
            found.len() == 1 && (found[0].z.abs() - 3.0 * tube).abs() < 0.4 * tube,
            "{found:?}"
        );
    }
}
