//! Distances along the lines of sight, for the last stage on single views.
//!
//! A depth camera errs along the ray. So a residual is the way that a point must go along its ray to the surface, found
//! by Newton's steps `s = d/c` with the first-order distance `d` and the cosine `c` between ray and normal; its
//! derivatives are those of `d` there, over `c`. Unlike the distance to the nearest place it does not make rims, where
//! noise runs along the surface, look larger. Where a ray grazes or misses the surface, `c` has a floor.

use super::columns::{Evaluation, Sample};
use super::parameters::{POSITION, Parameters};
use crate::numeric::column::Column;
use crate::numeric::lanes::{Job, Lane, dispatch};

/// Steps along the ray.
const STEPS: usize = 2;
/// Cosine between ray and normal below which a ray grazes.
const GRAZING: f64 = 0.15;
/// Longest step, in normalised lengths.
const LONGEST: f64 = 0.3;

/// Buffers of the way along the rays.
#[derive(Debug, Default)]
pub(super) struct Sights<L> {
    ways: Column<L>,
    secants: Column<L>,
    sample: Sample<L>,
    there: Evaluation<L>,
}

impl<L: Lane> Sights<L> {
    /// Fills `out` with the residuals of the points along the rays in which they were seen, positive before the surface,
    /// and their derivatives.
    pub(super) fn fill(&mut self, s: &Parameters, points: &Sample<L>, out: &mut Evaluation<L>) {
        let longest = L::of(LONGEST);
        self.ways.clear();
        self.ways.resize(points.rays()[0].len(), L::of(0.0));
        self.secants.resize(self.ways.len(), L::of(0.0));
        for _ in 0..STEPS {
            self.sample.set_along(points, &self.ways);
            self.there.fill_normals(s, &self.sample);
            dispatch(Secants { at: &self.there, points, out: &mut self.secants });
            let steps = self.there.distances.iter().zip(&self.secants).map(|(d, c)| *d * *c);
            for (way, step) in self.ways.iter_mut().zip(steps) {
                *way += step.least(longest).most(-longest);
            }
        }
        self.sample.set_along(points, &self.ways);
        out.fill(s, &self.sample);
        dispatch(Secants { at: out, points, out: &mut self.secants });
        for ((d, c), way) in out.distances.iter_mut().zip(&self.secants).zip(&self.ways) {
            *d = *way + *d * *c;
        }
        for (_, row) in out.rows.iter_mut().enumerate().filter(|(k, _)| s.family.has(*k)) {
            row.iter_mut().zip(&self.secants).for_each(|(v, c)| *v = *v * *c);
        }
    }
}

/// Of the angles between the rays and the normals of the surface that faces them, but for the floor of the cosine.
struct Secants<'a, L> {
    at: &'a Evaluation<L>,
    points: &'a Sample<L>,
    out: &'a mut [L],
}

impl<L: Lane> Job for Secants<'_, L> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        let [x, y, z] = self.points.rays();
        let [u, v, w] = std::array::from_fn(|k| &self.at.rows[POSITION + k]);
        let inwards = u.iter().zip(v).zip(w);
        for (out, (((x, y), z), ((u, v), w))) in
            self.out.iter_mut().zip(x.iter().zip(y).zip(z).zip(inwards))
        {
            let square = *u * *u + *v * *v + *w * *w;
            let along = *x * *u + *y * *v + *z * *w;
            let cosine = along * square.most(L::of(1e-24)).inverse_sqrt::<FUSED>();
            *out = L::of(1.0) / cosine.most(L::of(GRAZING));
        }
    }
}
