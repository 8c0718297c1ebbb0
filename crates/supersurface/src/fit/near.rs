//! Distances near to the Euclidean ones, for the last stage on single views.
//!
//! The first-order distance is off by the surface's curvature times its square, which at grazing rims is as large as the
//! noise. A foot is found by alternating between the surface (a step along the normal) and the tangent plane (towards the
//! point); the distance to it, and the first-order derivatives there, are those of the Euclidean distance up to what is
//! left. As a depth camera's noise acts along the ray, a residual is divided by the obliquity under which the ray meets
//! the surface, but for a floor.

use super::columns::{Evaluation, Sample};
use super::parameters::Parameters;
use crate::Vector;

/// Steps towards the foot.
const STEPS: usize = 2;
/// Share of the way in the tangent plane that is gone in a step: at an edge the whole would overshoot.
const DAMPING: f64 = 0.7;
/// Cosine between ray and normal below which residuals weigh no more.
const GRAZING: f64 = 0.35;

/// Buffers of the search for feet.
#[derive(Clone, Debug, Default)]
pub(super) struct Feet {
    feet: Vec<Vector>,
    signs: Vec<f64>,
    sample: Sample,
    there: Evaluation,
}

impl Feet {
    /// Fills `out` with near-Euclidean distances of the points, over obliquity for a sensor at `viewpoint`, and their
    /// derivatives.
    pub(super) fn fill(
        &mut self,
        s: &Parameters,
        points: &Sample,
        viewpoint: &Vector,
        out: &mut Evaluation,
    ) {
        self.there.fill(s, points);
        self.signs.clear();
        self.signs.extend(self.there.distances[..points.len()].iter().map(|d| d.signum()));
        self.feet.clear();
        for (i, x) in points.points().enumerate() {
            self.feet.push(x - self.there.step(i));
        }
        for _ in 0..STEPS {
            self.sample.set(self.feet.iter().copied());
            self.there.fill(s, &self.sample);
            for (i, foot) in self.feet.iter_mut().enumerate() {
                let normal = self.there.normal(i);
                let rest = points.point(i) - *foot;
                let along = rest - normal * normal.dot(&rest);
                *foot += along * DAMPING - self.there.step(i);
            }
        }
        self.sample.set(self.feet.iter().copied());
        out.fill(s, &self.sample);
        for (i, x) in points.points().enumerate() {
            let away = (x - self.feet[i]).norm() * self.signs[i];
            let ray = (x - viewpoint).normalize();
            let cosine = out.normal(i).dot(&ray);
            let (floor, square) = (GRAZING * GRAZING, cosine * cosine);
            let weight = ((1.0 + floor) / (square + floor)).sqrt();
            // where no foot was found the point is far and has no say
            let distance = (away + out.distances[i]) * weight;
            let (distance, weight) = match distance.is_finite() {
                true => (distance, weight),
                false => (self.there.distances[i], 0.0),
            };
            out.distances[i] = distance;
            for (k, row) in out.rows.iter_mut().enumerate() {
                if s.family.has(k) {
                    row[i] *= weight;
                }
            }
        }
    }
}
