//! Do the points show all of a body or a part of it? Places on the surface are looked at, and the points about each are
//! counted:
//!
//! ```text
//! coverage = mean over places of min(1, found / due),    due = points on the surface per area, times π r²
//! ```
//!
//! Noise fills gaps that are narrower than itself, so `r` is not below three times its scale.

use std::f64::consts::PI;

use super::columns::{Evaluation, Sample};
use super::noise::Mixture;
use super::parameters::Parameters;
use super::prepare::Normalised;
use super::samples::sample;
use super::solver::{Hypothesis, NOISE_FLOOR};
use super::terms::Sight;
use crate::Vector;
use crate::numeric::lanes::{Job, Lane, dispatch};
use crate::numeric::random::Stream;

/// Coverage from which the points show all of the surface. Chance alone makes it less than 1.
const COVERED: f64 = 0.79;
/// What chance leaves of the coverage of a surface that is all seen.
const BY_CHANCE: f64 = 0.9;

/// True where the points are only on a part of the surface, though no sensor's place says so.
pub(super) fn shows_a_part(cloud: &Normalised, h: &Hypothesis) -> bool {
    cloud.terms.sight != Sight::OneSide && coverage(h, &cloud.middle) < COVERED
}

/// Negative log-likelihood of points as a density on that part of a body which they cover, beside outliers in a box of some
/// volume: a body that is cut where the points end has no advantage over one that goes on unseen.
pub(super) fn covering_cost(h: &Hypothesis, points: &Sample<f32>, volume: f64) -> f64 {
    let area = h.parameters.area() * (coverage(h, points) / BY_CHANCE).min(1.0);
    let mut at = Evaluation::default();
    at.fill_distances(&h.parameters, points);
    let mut mixture = Mixture { density: area / volume, ..h.mixture };
    mixture.update(&at.distances, points.len(), [NOISE_FLOOR, f64::INFINITY], 4);
    mixture.cost(&at.distances, points.len()) + points.len() as f64 * area.ln()
}

/// Share of the points that an evenly seen surface would have and this one has, in [0, 1]: of the points within some radius
/// of a place on it, those that are missing are counted, those too many are not.
fn coverage(h: &Hypothesis, points: &Sample<f32>) -> f64 {
    const PROBES: usize = 160;
    /// Points due within the radius.
    const DUE: f64 = 20.0;
    let s: &Parameters = &h.parameters;
    let near = 3.0 * h.mixture.scale + 1e-3;
    let mut at = Evaluation::default();
    at.fill_distances(s, points);
    let all = points.points().zip(&at.distances);
    let on = Sample::new(all.filter(|(_, d)| d.wide().abs() < near).map(|(p, _)| p));
    let mut probes = Vec::with_capacity(PROBES);
    sample(s, PROBES, &mut Stream::new(5, 1), &mut probes);
    let density = on.len().max(1) as f64 / s.area();
    let square = (DUE / (PI * density)).max((3.0 * h.mixture.scale).powi(2));
    let due = PI * square * density;
    let mut found = 0.0;
    dispatch(Found { points: on.columns(), probes: &probes, square, due, out: &mut found });
    found / probes.len().max(1) as f64
}

/// Sum over places of the share of the due points that are within some distance, at most 1.
struct Found<'a> {
    points: [&'a [f32]; 3],
    probes: &'a [Vector],
    /// The distance's square.
    square: f64,
    due: f64,
    out: &'a mut f64,
}

impl Job for Found<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        const WIDTH: usize = <f32 as Lane>::WIDTH;
        let [x, y, z] = self.points.map(|column| column.chunks_exact(WIDTH));
        let square = self.square as f32;
        for probe in self.probes {
            let [px, py, pz] = [probe.x as f32, probe.y as f32, probe.z as f32];
            let mut found = [0.0f32; WIDTH];
            for ((x, y), z) in x.clone().zip(y.clone()).zip(z.clone()) {
                for i in 0..WIDTH {
                    let [a, b, c] = [x[i] - px, y[i] - py, z[i] - pz];
                    found[i] += if a * a + b * b + c * c < square { 1.0 } else { 0.0 };
                }
            }
            *self.out += (f64::from(found.iter().sum::<f32>()) / self.due).min(1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_are_counted_about_places() {
        let mut random = Stream::new(9, 0);
        let mut places = |n: usize| -> Vec<Vector> {
            (0..n).map(|_| Vector::from_fn(|_, _| random.normal())).collect()
        };
        let (points, probes) = (places(333), places(20));
        let sample = Sample::<f32>::new(points.iter().copied());
        let (square, due) = (0.5, 12.0);
        let mut out = 0.0;
        dispatch(Found { points: sample.columns(), probes: &probes, square, due, out: &mut out });
        let near =
            |probe: &Vector| points.iter().filter(|p| (*p - probe).norm_squared() < square).count();
        let known: f64 = probes.iter().map(|p| (near(p) as f64 / due).min(1.0)).sum();
        assert!(known > 1.0 && (out - known).abs() < 1e-6, "{out} {known}");
    }
}
