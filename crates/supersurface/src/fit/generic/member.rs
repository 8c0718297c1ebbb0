//! A member of the family as the generic fitter sees it: numbers in, logarithm of the gauge out.

use nalgebra::{Matrix3, Rotation3};

use super::GenericShape;
use super::jet::{Jet, LANES};
use crate::Vector;
use crate::shape::InvalidShape;

/// Steepness below which a gauge counts as flat.
const FLAT: f64 = 1e-9;
/// Distance that stands in for one that is not a number.
pub(super) const FAR: f64 = 10.0;

/// Logarithms of semi-axes stay between those of 0.02 and 4: the cloud has a root mean square of 1.
pub(super) const AXES: [f64; 2] = [-3.91, 1.386];

/// A form with free numbers, in normalised coordinates: unit root mean square about the cloud's mean.
pub(super) trait Member: Clone + Send + Sync {
    /// False where the numbers hold the pose, as planes do.
    const POSED: bool;

    /// Scale of the noise in the first round of a start: some share of how thick the body is.
    const START_SCALE: f64 = 0.12;

    /// The range in which a number stays, and the longest step that it takes at once.
    fn range(&self, number: usize) -> Range;

    /// Logarithm of the gauge at a point of the body's frame.
    fn log_gauge(&self, numbers: &[Jet], point: &[Jet; 3]) -> Jet;

    /// The shape in the body's frame, `scale` times as large.
    fn shape(&self, numbers: &[f64], scale: f64) -> Result<GenericShape, InvalidShape>;
}

#[derive(Clone, Copy, Debug)]
pub(super) struct Range {
    pub(super) low: f64,
    pub(super) high: f64,
    pub(super) step: f64,
}

/// Shorthand for a [`Range`].
pub(super) const fn range(low: f64, high: f64, step: f64) -> Range {
    Range { low, high, step }
}

/// A member with its numbers and pose.
#[derive(Clone, Debug)]
pub(super) struct Body<M> {
    pub(super) member: M,
    pub(super) numbers: Vec<f64>,
    pub(super) position: Vector,
    pub(super) rotation: Rotation3<f64>,
}

impl<M: Member> Body<M> {
    /// How many parameters move: the numbers, then position and rotation vector (about the body's own axes).
    pub(super) fn count(&self) -> usize {
        self.numbers.len() + if M::POSED { 6 } else { 0 }
    }

    /// The body after a step, kept in its ranges; long steps are cut, so that one bad linearisation cannot throw it
    /// away.
    pub(super) fn stepped(&self, step: &[f64]) -> Self {
        let mut next = self.clone();
        let held = next.numbers.len();
        for (k, (v, by)) in next.numbers.iter_mut().zip(step).enumerate() {
            let r = self.member.range(k);
            *v = (*v + by.clamp(-r.step, r.step)).clamp(r.low, r.high);
        }
        if let Some([x, y, z, a, b, c]) = step.get(held..).filter(|_| M::POSED) {
            next.position += Vector::new(*x, *y, *z).cap_magnitude(1.0);
            next.rotation *= Rotation3::new(Vector::new(*a, *b, *c).cap_magnitude(0.5));
        }
        next
    }

    /// True when a downhill step along a parameter would leave its range.
    pub(super) fn is_held(&self, index: usize, gradient: f64) -> bool {
        let Some(v) = self.numbers.get(index) else { return false };
        let r = self.member.range(index);
        (*v <= r.low + 1e-9 && gradient > 0.0) || (*v >= r.high - 1e-9 && gradient < 0.0)
    }

    fn local(&self, p: &Vector) -> Vector {
        self.rotation.inverse_transform_vector(&(p - self.position))
    }

    /// Logarithm of the gauge and its gradient in the body's frame.
    fn slope(&self, numbers: &[Jet], q: &Vector) -> (f64, Vector) {
        let point: [Jet; 3] = std::array::from_fn(|i| {
            let mut jet = Jet::constant(q[i]);
            jet.lanes[i] = 1.0;
            jet
        });
        let log = self.member.log_gauge(numbers, &point);
        (log.value, Vector::new(log.lanes[0], log.lanes[1], log.lanes[2]))
    }

    fn constants(&self) -> Vec<Jet> {
        self.numbers.iter().map(|v| Jet::constant(*v)).collect()
    }

    /// First-order distances of points.
    pub(super) fn distances(&self, points: &[Vector]) -> Vec<f64> {
        let constants = self.constants();
        points
            .iter()
            .map(|p| {
                let (log, slope) = self.slope(&constants, &self.local(p));
                distance(log, slope.norm())
            })
            .collect()
    }

    /// First-order distances and their derivatives, a row of [`Self::count`] numbers a point.
    pub(super) fn rows(&self, points: &[Vector]) -> (Vec<f64>, Vec<f64>) {
        let (count, held) = (self.count(), self.numbers.len());
        let constants = self.constants();
        let feet: Vec<(Vector, f64, Vector)> = points
            .iter()
            .map(|p| {
                let q = self.local(p);
                let (log, slope) = self.slope(&constants, &q);
                (q, log, slope)
            })
            .collect();
        let mut rows = vec![0.0; points.len() * count];
        let to_body: Matrix3<f64> = self.rotation.matrix().transpose();
        let mut numbers = constants;
        for first in (0..count).step_by(LANES) {
            let last = (first + LANES).min(count);
            for (k, jet) in numbers.iter_mut().enumerate() {
                jet.lanes = [0.0; LANES];
                if (first..last).contains(&k) {
                    jet.lanes[k - first] = 1.0;
                }
            }
            for ((q, log, slope), row) in feet.iter().zip(rows.chunks_exact_mut(count)) {
                let steep = slope.norm();
                if !distance(*log, steep).is_finite() || steep <= FLAT {
                    continue;
                }
                let normal = slope / steep;
                let moves = |k: usize| match k.checked_sub(held) {
                    None => Vector::zeros(),
                    Some(k) if k < 3 => -Vector::from(to_body.column(k)),
                    Some(k) => q.cross(&Vector::ith(k - 3, 1.0)),
                };
                let mut point: [Jet; 3] = std::array::from_fn(|i| {
                    let mut jet = Jet::constant(q[i]);
                    jet.along = normal[i];
                    jet
                });
                for k in first.max(held)..last {
                    let by = moves(k);
                    for (i, jet) in point.iter_mut().enumerate() {
                        jet.lanes[k - first] = by[i];
                    }
                }
                let jet = self.member.log_gauge(&numbers, &point);
                let rest = (-log).exp();
                let (by_log, by_steep) = (rest / steep, -(1.0 - rest) / (steep * steep));
                for (k, entry) in row[first..last].iter_mut().enumerate() {
                    let v = by_log * jet.lanes[k] + by_steep * jet.mixed[k];
                    *entry = if v.abs() < 1e6 { v } else { 0.0 };
                }
            }
        }
        let distances = feet.iter().map(|(_, log, slope)| distance(*log, slope.norm())).collect();
        (distances, rows)
    }
}

/// `(g - 1)/|∇g| = (1 - e^-l)/|∇l|` with `l = ln g`.
fn distance(log: f64, steep: f64) -> f64 {
    let d = -(-log).exp_m1() / steep.max(FLAT);
    if d.is_finite() { d.clamp(-FAR, FAR) } else { FAR }
}

#[cfg(test)]
mod tests {
    use super::super::extended::Extended;
    use super::super::hyperquadric::Terms;
    use super::super::supershape::Symmetries;
    use super::super::toroid::Toroid;
    use super::*;
    use crate::Point;
    use crate::numeric::random::Stream;
    use crate::shape::Implicit;

    /// Rows against differences of the distances, and distances against the shape's own.
    fn is_complete<M: Member>(member: &M, middle: &[f64], spread: f64) {
        let mut random = Stream::new(8, 0);
        let (mut seen, mut same) = (0, 0);
        for _ in 0..40 {
            let numbers: Vec<f64> =
                middle.iter().map(|v| v + random.between(-spread, spread)).collect();
            let turn = Vector::from_fn(|_, _| random.normal()) * f64::from(u8::from(M::POSED));
            let body = Body {
                member: member.clone(),
                numbers,
                position: turn * 0.1,
                rotation: Rotation3::new(turn),
            };
            let body = body.stepped(&vec![0.0; body.count()]);
            let points: Vec<Vector> =
                (0..20).map(|_| Vector::from_fn(|_, _| random.between(-1.2, 1.2))).collect();
            let (distances, rows) = body.rows(&points);
            assert_eq!(distances, body.distances(&points));
            for k in 0..body.count() {
                let h = 1e-6;
                let at = |sign: f64| {
                    let mut step = vec![0.0; body.count()];
                    step[k] = sign * h;
                    body.stepped(&step).distances(&points)
                };
                let (after, before) = (at(1.0), at(-1.0));
                for (i, (a, b)) in after.iter().zip(&before).enumerate() {
                    if distances[i].abs() > 0.5 {
                        continue;
                    }
                    seen += 1;
                    let (numeric, exact) = ((a - b) / (2.0 * h), rows[i * body.count() + k]);
                    let error = (numeric - exact).abs() / (1.0 + exact.abs());
                    assert!(error < 1e-4, "parameter {k}: {numeric} against {exact}");
                }
            }
            let Ok(shape) = member.shape(&body.numbers, 2.0) else { continue };
            for (p, d) in points.iter().zip(&distances).filter(|(_, d)| d.abs() < 0.02) {
                let own = shape.first_order_distance(&Point::from(body.local(p) * 2.0));
                assert!((own - 2.0 * d).abs() < 0.1 * d.abs() + 1e-9, "{own} {d}");
                same += 1;
            }
        }
        assert!(seen > 1000 && same > 5, "{seen} {same}");
    }

    #[test]
    fn derivatives_are_complete() {
        let toroid = Toroid { taper: true, twist: true, bend: true };
        let ring = [-1.2, -1.1, -0.8, 2.5, 0.8, 0.9, 0.0, 0.0, 0.0, 0.0, 0.0];
        is_complete(&toroid, &ring, 0.3);
        is_complete(&Toroid { taper: true, twist: false, bend: false }, &ring, 0.2);
        let vase = [-0.3, -0.2, 0.1, 0.9, 0.8, 0.7, 1.0, 0.6, 0.9, 0.7];
        is_complete(&Extended::new(3, 4), &vase, 0.3);
        let star = [1.0, 0.3, 0.1, 0.0, 0.1, 0.7, 0.2, 0.3, -0.1, -0.2];
        is_complete(&Symmetries { around: 6, along: 4 }, &star, 0.2);
        is_complete(&Symmetries { around: 5, along: 2 }, &star, 0.2);
        let stone = [
            [1.0, 0.1, 0.0, 0.1, 1.2],
            [0.0, 1.2, 0.2, -0.1, 1.5],
            [0.3, 0.0, 1.1, 0.1, 1.0],
            [0.6, 0.6, -0.7, 0.2, 1.3],
        ];
        is_complete(&Terms { count: 4 }, stone.as_flattened(), 0.2);
    }
}
