//! What is known beside the points: the support from which the body rises, the space that rays prove
//! empty, and a weak preference for bodies that are not needles.

use super::centred::Placement;
use super::columns::{Evaluation, Sample, distances};
use super::noise::Mixture;
use super::normal::Sum;
use super::parameters::{COUNT, EXPONENT, POSITION, Parameters, RING, ROTATION, Row};
use super::rays::Rays;
use crate::Vector;
use crate::numeric::lanes::Lane;
use crate::numeric::superellipse::{dual_exponent, log_layer};
use crate::shape::SupportMap;

/// The plane under the body, in normalised coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Support {
    pub(super) normal: Vector,
    pub(super) offset: f64,
    /// True when the points come down to the plane: then the body touches it. Otherwise it only may not
    /// reach below.
    pub(super) standing: bool,
    /// Height of the highest point that was seen, when the sensor stands higher: nothing hides a top.
    pub(super) top: Option<f64>,
    /// Least distance that counts, in normalised lengths.
    pub(super) tolerance: f64,
}

/// How much of an object's surface the points can show.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) enum Sight {
    /// All of it; outliers are spread over a box of this volume. The points are then a density on the whole surface, and
    /// its area enters the likelihood; on half seen bodies it must not, as it would pay for growing them.
    AllAround { volume: f64 },
    /// Less than all, by no known viewpoint.
    #[default]
    Partly,
    /// What one viewpoint sees.
    OneSide,
}

/// A place from which the object was seen.
#[derive(Clone, Debug)]
pub(super) struct Eye {
    pub(super) place: Vector,
    /// Points seen beside or behind the object: nothing lies between the place and them.
    pub(super) free: Vec<Vector>,
    /// Places a little before the object's own points: nothing lies between the place and them either.
    /// Only a body with a hole can hide its own far wall.
    pub(super) before: Vec<Vector>,
}

/// Everything beside the points that speaks about the body.
#[derive(Clone, Debug, Default)]
pub(super) struct Terms {
    pub(super) support: Option<Support>,
    pub(super) eyes: Vec<Eye>,
    /// How much of the surface the points can show.
    pub(super) sight: Sight,
    /// Half the cloud's largest extent. On single views no half extent of the body may exceed it much; where less than all
    /// is seen and no ray is known, none may exceed twice of it: a side that no point shows is no reason to be much larger
    /// than all that is seen.
    pub(super) reach: f64,
}

/// Standard deviation of the logarithm of an extent about the mean of the three: weak on purpose.
const ASPECT_DEVIATION: f64 = 1.2;

/// Nats that a body on a single view pays for growing an extent e-fold: where nothing speaks for a hidden side,
/// it is small.
const SIZE_WEIGHT: f64 = 3.0;

/// The same where not all is seen and no ray is known: noise makes extrapolated bodies too large.
const PART_SIZE_WEIGHT: f64 = 15.0;

/// A point is hidden when so much of the body, in normalised lengths, lies before it.
const LEAST_HIDING: f64 = 0.05;

/// What the terms stand beside.
#[derive(Clone, Copy, Debug)]
pub(super) struct Beside<'a, L> {
    /// Number of points.
    pub(super) points: usize,
    /// Present scale of the noise.
    pub(super) scale: f64,
    /// Number of lines of sight that were looked at.
    pub(super) rays: usize,
    /// Where they lie deepest in the body, held while the body takes a step.
    pub(super) intrusions: &'a Sample<L>,
}

/// Weight of the reach against the points: a body twice the reach costs each point half a nat.
const REACH_WEIGHT: f64 = 2.0;

/// Multiple of the reach that stands in its place where not all is seen and no ray is known: more than half of a body may
/// be missing there.
const PART_REACH: f64 = 2.0;

/// Outlier density a unit of normalised length where only one side is seen: along a ray it is a constant.
const RAY_DENSITY: f64 = 0.25;
/// The same where not all is seen and no ray is known.
const PART_DENSITY: f64 = 0.5;

impl Terms {
    /// Density of outliers about a body, a unit of distance from its surface.
    pub(super) fn outlier_density(&self, s: &Parameters) -> f64 {
        match self.sight {
            Sight::AllAround { volume } => (s.area() / volume).clamp(1e-4, 1e3),
            Sight::Partly => PART_DENSITY,
            Sight::OneSide => RAY_DENSITY,
        }
    }

    /// What the points' being spread over the whole surface adds to the cost of a body.
    pub(super) fn spread_cost(&self, s: &Parameters, points: usize) -> f64 {
        match self.sight {
            Sight::AllAround { .. } => points as f64 * s.area().ln(),
            Sight::Partly | Sight::OneSide => 0.0,
        }
    }

    /// What the points on sides that face away from the sensor cost: it cannot have seen them there, so they
    /// are outliers. At a rim noise carries points around the edge; so a step towards the sensor must lead into the body.
    pub(super) fn facing_cost<L: Lane>(
        &self,
        s: &Parameters,
        mixture: &Mixture,
        points: &Sample<L>,
        evaluation: &Evaluation<L>,
    ) -> f64 {
        if !points.has_rays() {
            return 0.0;
        }
        let step = (6.0 * mixture.scale).max(LEAST_HIDING);
        let away = |i: &usize| {
            let normal = evaluation.outwards(*i);
            normal.dot(&points.ray(*i)) > 0.4 * normal.norm()
        };
        let suspects: Vec<usize> = (0..points.len()).filter(away).collect();
        let before = suspects.iter().map(|i| points.point(*i) - points.ray(*i) * step);
        let depths = distances(s, before);
        let hidden = suspects.iter().zip(depths).filter(|(_, d)| *d < -0.25 * step);
        hidden.map(|(i, _)| mixture.price_of_leaving(evaluation.distances[*i].wide())).sum()
    }

    /// Adds all terms; `intruding` is a buffer.
    pub(super) fn add<L: Lane>(
        &self,
        s: &Parameters,
        beside: &Beside<'_, L>,
        intruding: &mut Evaluation<L>,
        to: &mut impl Sum,
    ) {
        self.add_support(s, beside.points, beside.scale, to);
        add_intrusions(s, beside, intruding, to);
        self.add_reach(s, beside.points, to);
        match self.sight {
            Sight::OneSide => add_size(s, SIZE_WEIGHT, to),
            Sight::Partly => add_size(s, PART_SIZE_WEIGHT, to),
            Sight::AllAround { .. } => {}
        }
        add_aspect(s, to);
    }

    /// `½ w ln²(h_i / r)` for every half extent above `r`, the reach or a multiple of it.
    fn add_reach(&self, s: &Parameters, points: usize, to: &mut impl Sum) {
        let most = match self.sight {
            Sight::OneSide => self.reach.ln(),
            Sight::Partly => (PART_REACH * self.reach).ln(),
            Sight::AllAround { .. } => return,
        };
        for (i, half) in s.log_half_extents().iter().enumerate() {
            let excess = half - most;
            if excess > 0.0 {
                let mut row = [0.0; COUNT];
                row[i] = 1.0;
                if s.family.is_ring() && i < 2 {
                    row[RING] = 1.0 / (1.0 + s.ring);
                }
                to.add(excess, REACH_WEIGHT * points as f64, &row);
            }
        }
    }

    fn add_support<S: Sum>(&self, s: &Parameters, points: usize, scale: f64, to: &mut S) {
        let Some(support) = self.support else { return };
        let sigma = scale.max(support.tolerance);
        let weight = 0.2 * points as f64 / (sigma * sigma);
        let Some((lowest, row)) = extreme::<S>(s, &support.normal, support.offset) else { return };
        if support.standing || lowest < 0.0 {
            to.add(lowest, weight, &row);
        }
        // undeformed bodies are symmetric about their middle, which lies halfway up
        let middle = support.normal.dot(&s.position) + support.offset;
        let may_be_over = |top: &f64| s.family.is_deformed() || 2.0 * middle - lowest > *top;
        // the highest point is the lowest of the other side
        let below = |top: f64| extreme::<S>(s, &-support.normal, top - support.offset);
        if let Some((below, row)) = support.top.filter(may_be_over).and_then(below)
            && below < 0.0
        {
            to.add(below, weight, &row);
        }
    }

    /// The points at which free lines of sight lie deepest in the body, into `found`; `own` says whether the
    /// lines of sight to the object's own points are looked at too.
    pub(super) fn intrusions<L: Lane>(
        &self,
        s: &Parameters,
        rays: usize,
        own: bool,
        search: &mut Rays<L>,
        found: &mut Vec<Vector>,
    ) {
        found.clear();
        for eye in &self.eyes {
            let [free, before] = eye.shares(rays / self.eyes.len(), own);
            search.deepest(
                s,
                &eye.place,
                some(&eye.free, free).chain(some(&eye.before, before)),
                found,
            );
        }
    }

    /// How many lines of sight [`Self::intrusions`] looks at.
    pub(super) fn lines_of_sight(&self, rays: usize, own: bool) -> usize {
        self.eyes.iter().flat_map(|eye| eye.shares(rays / self.eyes.len(), own)).sum()
    }

    /// The place of the sensor where there was but one.
    pub(super) fn only_eye(&self) -> Option<Vector> {
        match &self.eyes[..] {
            [eye] => Some(eye.place),
            _ => None,
        }
    }
}

impl Eye {
    /// How many free and, with `own`, own lines of sight are looked at when they may be `rays`.
    fn shares(&self, rays: usize, own: bool) -> [usize; 2] {
        [self.free.len().min(rays), self.before.len().min(if own { rays / 2 } else { 0 })]
    }
}

/// `count` of the points, evenly spread; not more than there are.
fn some(points: &[Vector], count: usize) -> impl Iterator<Item = &Vector> {
    (0..count).map(move |i| &points[i * points.len() / count])
}

/// Adds the depths of the intrusions; `rays` is how many lines of sight were looked at.
fn add_intrusions<L: Lane, S: Sum>(
    s: &Parameters,
    at: &Beside<'_, L>,
    there: &mut Evaluation<L>,
    to: &mut S,
) {
    let sigma = at.scale.max(0.02);
    // an eighth of the points' say, however many rays there are
    let weight = 0.12 * at.points as f64 / at.rays.max(1) as f64 / (sigma * sigma);
    if at.intrusions.len() == 0 {
        return;
    }
    if S::ROWS {
        there.fill(s, at.intrusions);
    } else {
        there.fill_distances(s, at.intrusions);
    }
    for i in (0..at.intrusions.len()).filter(|i| there.distances[*i].wide() < 0.0) {
        let row = if S::ROWS { there.row(s, i) } else { [0.0; COUNT] };
        to.add(there.distances[i].wide(), weight, &row);
    }
}

/// Least height of the body over the plane `normal · x + offset = 0` and, where rows are looked at, its derivatives.
///
/// The support function of a superellipsoid is the two-layered norm with the dual exponents `q = 2/(2 - ε)`,
/// `h = ‖(ρ, a3 m3)‖` with `ρ = ‖(a1 m1, a2 m2)‖` (FORMULAS §2), and that of a toroid is `h + a4 ρ`. As for the
/// gauge, `d ln ‖(u, v)‖ = w d ln u + (1 - w) d ln v`, here with `- S(w)/2 dε`; the support point is
/// `∂h/∂m`, which by the envelope theorem may be held while the body turns.
fn extreme<S: Sum>(s: &Parameters, normal: &Vector, offset: f64) -> Option<(f64, Row)> {
    if s.family.is_deformed() {
        return extreme_of_deformed::<S>(s, normal, offset);
    }
    let m = -(s.rotation.inverse_transform_vector(normal));
    let log = |i: usize| m[i].abs().max(1e-9).ln() + s.log_axes[i];
    let [q1, q2] = s.exponents.map(dual_exponent);
    let planar = log_layer(log(0), log(1), q2);
    let whole = log_layer(planar.log_norm, log(2), q1);
    let tube = whole.log_norm.exp();
    let radius = planar.log_norm.exp();
    let ring = if s.family.is_ring() { s.ring * radius } else { 0.0 };
    let height = normal.dot(&s.position) + offset - tube - ring;
    let mut row = [0.0; COUNT];
    if !S::ROWS {
        return Some((height, row));
    }
    // derivatives of the support function by ln a1, ln a2, ln a3
    let across = tube * whole.first + ring;
    let by_axes = [across * planar.first, across * planar.second, tube * whole.second];
    let p = Vector::from_fn(|i, _| by_axes[i] / m[i].abs().max(1e-9).copysign(m[i]));
    let turn = m.cross(&p);
    for i in 0..3 {
        row[i] = -by_axes[i];
        row[POSITION + i] = normal[i];
        row[ROTATION + i] = turn[i];
    }
    if s.family.is_ring() {
        row[RING] = -radius;
    }
    row[EXPONENT] = 0.5 * tube * whole.entropy;
    row[EXPONENT + 1] = 0.5 * across * planar.entropy;
    Some((height, row))
}

/// The same for a deformed body: its surface is parallel to the plane at the lowest point, so that it rises as the
/// first-order distance of that point does.
fn extreme_of_deformed<S: Sum>(s: &Parameters, normal: &Vector, offset: f64) -> Option<(f64, Row)> {
    let body = s.surface(&Placement::identity()).ok()?;
    let lowest = body.support_point(&-normal).coords;
    let height = normal.dot(&lowest) + offset;
    if !S::ROWS {
        return Some((height, [0.0; COUNT]));
    }
    let mut there = Evaluation::<f64>::default();
    there.fill(s, &Sample::new(std::iter::once(lowest)));
    Some((height, there.row(s, 0)))
}

/// `λ Σ ln h_i` over the three half extents.
fn add_size(s: &Parameters, weight: f64, to: &mut impl Sum) {
    let mut row = [0.0; COUNT];
    row[..3].fill(weight);
    if s.family.is_ring() {
        row[RING] = 2.0 * weight / (1.0 + s.ring);
    }
    to.add_slope(weight * s.log_half_extents().iter().sum::<f64>(), &row);
}

/// `½ Σ (ln h_i - mean)² / σ²` over the three half extents.
fn add_aspect(s: &Parameters, to: &mut impl Sum) {
    let logs = s.log_half_extents();
    let mean = logs.iter().sum::<f64>() / 3.0;
    let by_ring = 1.0 / (1.0 + s.ring);
    for i in 0..3 {
        let mut row = [0.0; COUNT];
        row[..3].fill(-1.0 / 3.0);
        row[i] += 1.0;
        if s.family.is_ring() {
            row[RING] = (row[0] + row[1]) * by_ring;
        }
        to.add(logs[i] - mean, 1.0 / (ASPECT_DEVIATION * ASPECT_DEVIATION), &row);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fit::columns::tests::some_body;
    use crate::fit::normal::Normal;
    use crate::fit::parameters::Family;
    use crate::numeric::random::Stream;

    #[test]
    fn the_least_height_has_its_derivative() {
        let mut random = Stream::new(8, 0);
        for case in 0..300 {
            let family = Family::ALL[case % 3];
            let mut s = some_body(family, &mut random);
            if family.is_deformed() {
                // no cusps, at which the normal is not one
                s.exponents = s.exponents.map(|e| e.min(1.0));
            }
            let normal = Vector::from_fn(|_, _| random.normal()).normalize();
            let (_, row) = extreme::<Normal>(&s, &normal, 0.3).unwrap();
            for k in (0..COUNT).filter(|k| family.has(*k)) {
                let at = |h: f64| {
                    let mut step = [0.0; COUNT];
                    step[k] = h;
                    extreme::<Normal>(&s.stepped(&step), &normal, 0.3).unwrap().0
                };
                let numeric = (at(1e-6) - at(-1e-6)) / 2e-6;
                assert!((numeric - row[k]).abs() < 1e-4, "case {case} parameter {k}: {numeric}");
            }
        }
    }
}
