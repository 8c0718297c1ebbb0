//! From a direction down to a minimum of `φ`: Newton's method on the sphere in the chart of flat faces.
//!
//! The Riemannian second derivative is the tangential one less `φ` times the metric; where it is not positive
//! definite it is shifted. Where a step is refused it is shortened, as are the next ones, and every other time the
//! majorant's step is taken, which always descends for exponents up to 1. A step may lead far along a face, where `t`
//! grows by magnitudes, so it is its length before it is bent that is bounded.

use super::chart::{Chart, LONGEST};
use super::difference::{Difference, Expansion, Triple, dot};
use crate::numeric::lanes::{Job, dispatch};

/// Evaluations after which a descent gives up.
const MOST: u32 = 40;
/// Refused steps after which it does.
const REFUSALS: i32 = 14;
/// The support points are to face each other as well as this, in the pair's size.
const FACING: f64 = 1e-10;

/// Steps, relative to the tangents, that bend a face's coordinates by no more than rounding of the last step.
const SMALL: f64 = 1e-3;

/// Newton steps shorter than this, in radians, tell what is left to gain, to a factor.
const NEAR: f64 = 0.1;
const PLAINLY: f64 = 4.0;

/// Curvature below which a minimum is a valley.
const FLAT: f64 = 1e-9;

/// Where a descent ended.
#[derive(Clone, Copy, Debug)]
pub(super) struct Minimum {
    /// The direction in both frames.
    pub(super) normal: [Triple; 2],
    pub(super) expansion: Expansion,
    /// False where it gave up.
    pub(super) settled: bool,
    /// What the value may be off by: that of the last step, where it was not evaluated.
    pub(super) slack: f64,
}

impl Minimum {
    /// False where the second derivative says that a whole line of directions is as good.
    pub(super) fn is_isolated(&self, pair: &Difference) -> bool {
        let chart = Chart::at(pair, &self.normal);
        let at = pair.expand::<false>(&self.normal, &chart.tangents);
        let [t, s] = &chart.tangents[0];
        let [a, b, c] = curvature(&at.hessian, at.value, &chart);
        // of the form scaled to ones on its diagonal, as rows may differ by hundreds of magnitudes
        let scale = [a, c].map(|v| 1.0 / v.abs().sqrt());
        let mixed = b * scale[0] * scale[1];
        let floor = FLAT * (at.value.abs() + 1.0);
        a > floor * dot(t, t) && c > floor * dot(s, s) && 1.0 - mixed * mixed > FLAT
    }

    /// Length of the gradient along the sphere, in the pair's size: how far the support points are from facing each
    /// other.
    #[inline(always)]
    pub(super) fn slope(&self) -> f64 {
        let (gap, n) = (&self.expansion.gap, &self.normal[0]);
        let along = dot(gap, n);
        let across = [gap[0] - along * n[0], gap[1] - along * n[1], gap[2] - along * n[2]];
        dot(&across, &across).sqrt()
    }
}

/// What is worked out once at a direction and used for all steps from it.
struct Plan {
    newton: [f64; 2],
    predicted: f64,
    /// The most that the step can gain.
    estimate: f64,
}

/// The descent from `start`, a direction in both frames; it ends early where it plainly leads to no less than `worth`.
#[inline]
pub(super) fn descend(pair: &Difference, start: &[Triple; 2], worth: f64) -> Minimum {
    let mut here =
        Minimum { normal: *start, expansion: Expansion::NONE, settled: false, slack: 0.0 };
    dispatch(Descent { pair, worth, here: &mut here });
    here
}

struct Descent<'a> {
    pair: &'a Difference,
    worth: f64,
    here: &'a mut Minimum,
}

impl Job for Descent<'_> {
    #[inline(always)]
    fn run<const FUSED: bool>(self) {
        self.here.settled = run::<FUSED>(self.pair, self.worth, self.here);
    }
}

/// Moves to the minimum; false where it gives up.
#[inline(always)]
fn run<const FUSED: bool>(pair: &Difference, worth: f64, here: &mut Minimum) -> bool {
    let mut trial = here.normal;
    let mut chart = Chart::NONE;
    let mut evaluations = 0;
    let mut plan = Plan { newton: [0.0; 2], predicted: 0.0, estimate: f64::INFINITY };
    let (mut factor, mut refusals, mut majorised, mut last) = (1.0, 0, false, false);
    let mut radius = LONGEST;
    let mut moved = 0.0;
    loop {
        let next = Chart::at(pair, &trial);
        let expansion = pair.expand::<FUSED>(&trial, &next.tangents);
        evaluations += 1;
        let gained = here.expansion.value - expansion.value;
        let flat = gained > -4e-16 && plan.estimate * factor < 1e-14;
        let enough = if majorised { 0.0 } else { 1e-4 * factor * plan.predicted };
        if gained > enough || flat {
            let before = here.slope();
            here.normal = trial;
            here.expansion = expansion;
            chart = next;
            let slope = here.slope();
            // a step that was expected to gain this little has squared its error
            let good = !majorised && factor == 1.0 && plan.estimate < 1e-11;
            if good && slope < 1e-7 || plan.estimate < 1e-14 && slope < FACING {
                return true;
            }
            let full = !majorised && factor == 1.0 && plan.estimate.is_finite();
            plan = self::plan::<FUSED>(&here.expansion, &chart);
            if plan.estimate < 1e-15 && slope < FACING {
                return true;
            }
            let near = full && chart.length(&plan.newton) < NEAR;
            if near && here.expansion.value - PLAINLY * plan.estimate > worth {
                here.slack = plan.estimate;
                return true;
            }
            // two steps that changed nothing
            let idle = gained.abs() < 4e-16 && slope > 0.5 * before;
            if idle && last {
                return false;
            }
            // Newton's method squares the error: where it has been seen to, the last step needs no evaluation
            let ratio = slope / before;
            let small = plan.newton[0].abs().max(plan.newton[1].abs()) < SMALL;
            if full && plan.estimate < 1e-11 && small && slope * ratio * ratio < 0.1 * FACING {
                here.expansion.advance(pair, &here.normal, &plan.newton, plan.predicted);
                here.normal = chart.moved(&here.normal, &chart.bent::<FUSED>(&plan.newton));
                here.slack = plan.predicted;
                return true;
            }
            last = idle;
            refusals = 0;
            radius = LONGEST.min(radius.max(4.0 * moved));
            factor = (radius / chart.length(&plan.newton)).min(1.0);
        } else {
            refusals += 1;
            factor *= 0.25;
            radius = chart.length(&plan.newton) * factor;
        }
        if evaluations >= MOST || refusals > REFUSALS {
            return false;
        }
        majorised = refusals > 0 && refusals % 2 == 0;
        let by = if majorised {
            let step = majorised_step(&here.expansion, &chart);
            let shorter = 0.1f64.powi(refusals / 2 - 1);
            [step[0] * shorter, step[1] * shorter]
        } else {
            chart.bent::<FUSED>(&[plan.newton[0] * factor, plan.newton[1] * factor])
        };
        moved = chart.length(&by);
        trial = chart.moved(&here.normal, &by);
    }
}

#[inline(always)]
fn plan<const FUSED: bool>(at: &Expansion, chart: &Chart) -> Plan {
    let gradient = gradient(at, chart);
    let form = curvature(&at.hessian, at.value, chart);
    let newton = solve(&form, &gradient, &chart.lengths);
    let predicted = -0.5 * (gradient[0] * newton[0] + gradient[1] * newton[1]);
    let bent = chart.bent::<FUSED>(&newton);
    let moved = (gradient[0] * bent[0]).abs().max((gradient[1] * bent[1]).abs());
    Plan { newton, predicted, estimate: predicted.max(moved) }
}

/// The step to the minimum of the quadratic that lies above.
#[inline(always)]
fn majorised_step(at: &Expansion, chart: &Chart) -> [f64; 2] {
    let form = curvature(&at.majorant, at.value.min(0.0), chart);
    solve(&form, &gradient(at, chart), &chart.lengths)
}

#[inline(always)]
fn gradient(at: &Expansion, chart: &Chart) -> [f64; 2] {
    let [t, s] = &chart.tangents[0];
    [dot(&at.gap, t), dot(&at.gap, s)]
}

/// A second derivative along the tangents less a value times the metric.
#[inline(always)]
fn curvature(form: &[f64; 3], value: f64, chart: &Chart) -> [f64; 3] {
    let [t, s] = &chart.tangents[0];
    [form[0] - value * dot(t, t), form[1] - value * dot(t, s), form[2] - value * dot(s, s)]
}

/// `-M⁻¹ g` for a symmetric `M` made positive definite, whose rows may differ by hundreds of magnitudes.
#[inline(always)]
fn solve(form: &[f64; 3], gradient: &[f64; 2], lengths: &[f64; 2]) -> [f64; 2] {
    let scale = [
        1.0 / form[0].abs().sqrt().max(1e-6 * lengths[0]),
        1.0 / form[2].abs().sqrt().max(1e-6 * lengths[1]),
    ];
    let (mut a, mut c) = (form[0] * scale[0] * scale[0], form[2] * scale[1] * scale[1]);
    let b = form[1] * scale[0] * scale[1];
    let (middle, half) = (0.5 * (a + c), 0.5 * (a - c));
    let spread = (half * half + b * b).sqrt();
    let least = middle - spread;
    if least < 1e-10 {
        let shift = 1.5 * (-least).max(0.0) + 1e-3 * (middle.abs() + spread);
        a += shift;
        c += shift;
    }
    let g = [gradient[0] * scale[0], gradient[1] * scale[1]];
    let inverse = 1.0 / (a * c - b * b);
    [(g[1] * b - g[0] * c) * inverse * scale[0], (g[0] * b - g[1] * a) * inverse * scale[1]]
}
