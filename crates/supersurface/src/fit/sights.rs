//! Distances along the lines of sight, for the last stage on single views.
//!
//! A depth camera errs along the ray. So a residual is the way that a point must go along its ray to the surface, found
//! by Newton's steps `s = d/c` with the first-order distance `d` and the cosine `c` between ray and normal; its
//! derivatives are those of `d` there, over `c`. Unlike the distance to the nearest place it does not make rims, where
//! noise runs along the surface, look larger. Where a ray grazes or misses the surface, `c` has a floor.

use super::columns::{Evaluation, Sample};
use super::parameters::Parameters;
use crate::Vector;

/// Steps along the ray.
const STEPS: usize = 2;
/// Cosine between ray and normal below which a ray grazes.
const GRAZING: f64 = 0.15;
/// Longest step, in normalised lengths.
const LONGEST: f64 = 0.3;

/// Buffers of the way along the rays.
#[derive(Clone, Debug, Default)]
pub(super) struct Sights {
    places: Vec<Vector>,
    sample: Sample,
    there: Evaluation,
}

impl Sights {
    /// Fills `out` with the residuals of the points along the rays in which they were seen, positive before the surface,
    /// and their derivatives.
    pub(super) fn fill(&mut self, s: &Parameters, points: &Sample, out: &mut Evaluation) {
        let rays = points.rays();
        self.places.clear();
        self.places.extend(points.points());
        for _ in 0..STEPS {
            self.sample.set(self.places.iter().copied());
            self.there.fill(s, &self.sample);
            for (i, place) in self.places.iter_mut().enumerate() {
                let step = self.there.distances[i] / slope(&self.there, i, &rays[i]);
                *place += rays[i] * step.clamp(-LONGEST, LONGEST);
            }
        }
        self.sample.set(self.places.iter().copied());
        out.fill(s, &self.sample);
        for (i, x) in points.points().enumerate() {
            let weight = 1.0 / slope(out, i, &rays[i]);
            out.distances[i] = (self.places[i] - x).dot(&rays[i]) + out.distances[i] * weight;
            for (k, row) in out.rows.iter_mut().enumerate() {
                if s.family.has(k) {
                    row[i] *= weight;
                }
            }
        }
    }
}

/// Cosine between the ray and the surface that faces it, but for the floor.
fn slope(at: &Evaluation, i: usize, ray: &Vector) -> f64 {
    (-at.normal(i).dot(ray)).max(GRAZING)
}
