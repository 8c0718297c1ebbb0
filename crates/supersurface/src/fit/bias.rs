//! Noise makes bodies of other sizes: outside an edge there is more room than inside, so distances pull the fit.
//! A parametric bootstrap says how far.
//!
//! A cloud is drawn from the fit with the estimated noise and fitted from there; what its shape is off is taken back.
//! Each sample is drawn twice, with opposite noise, so that what is left is the bias and not chance.

use super::columns::Sample;
use super::parameters::{EXPONENT, Parameters, RING, Row, TAPER, TWIST};
use super::samples::sample;
use super::solver::{Hypothesis, Schedule, Workspace, refine};
use super::terms::Terms;
use crate::Vector;
use crate::numeric::random::Stream;

/// Samples of the surface; twice as many points.
const SAMPLES: usize = 700;
/// No shape parameter moves farther than this.
const MOST: f64 = 0.3;

/// The body without its bias.
pub(super) fn without_bias(
    h: &Hypothesis,
    terms: &Terms,
    schedule: &Schedule,
    work: &mut Workspace,
) -> Parameters {
    let mut random = Stream::new(3, 1);
    let mut surface = Vec::with_capacity(SAMPLES);
    sample(&h.parameters, SAMPLES, &mut random, &mut surface);
    let mut cloud = Vec::with_capacity(2 * surface.len());
    for p in surface {
        let noise = Vector::from_fn(|_, _| h.mixture.scale * random.normal());
        cloud.extend([p + noise, p - noise]);
    }
    let again = refine(h, &Sample::new(cloud.into_iter()), terms, schedule, work).parameters;
    let s = &h.parameters;
    let back = |found: f64, drawn: f64| (drawn - found).clamp(-MOST, MOST);
    let mut step: Row = [0.0; _];
    let axes = again.log_axes.iter().zip(&s.log_axes);
    step.iter_mut().zip(axes).for_each(|(step, (found, drawn))| *step = back(*found, *drawn));
    step[RING] = back(again.ring, s.ring);
    for k in 0..2 {
        step[EXPONENT + k] = back(again.exponents[k], s.exponents[k]);
        step[TAPER + k] = back(again.taper[k], s.taper[k]);
    }
    step[TWIST] = back(again.twist, s.twist);
    s.stepped(&step)
}
