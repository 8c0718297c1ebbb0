//! The locally least distance of two bodies over the places of their slices.
//!
//! Along one place the minimum is the root of a slope that is known exactly, found by the regula falsi with halved ends (Illinois) and
//! halves; where the slope jumps, it is the least that was met. Over two places the second's slope at the minima of the
//! first is that of the least distance, so that one search is nested in the other.

use super::body::Sliced;
use super::slice::{FEW, Slice, Touch};
use crate::contact::WarmStart;
use crate::shape::InvalidShape;
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::PI;

/// Steps of the search for a root, which halves the interval at least every third time.
const ROOT_STEPS: usize = 60;
/// A minimum is found where the interval's ends can differ by this at most, relative to the bodies' size.
const SETTLED: f64 = 1e-14;
/// How often a minimum at the end of its interval is followed.
const FOLLOWED: usize = 8;

/// The minimum near a touch, within intervals of half widths in radians that move along with it.
pub(super) fn lowest(
    bodies: [&Sliced; 2],
    from: &Touch,
    half: [f64; 2],
    start: &mut WarmStart,
) -> Result<Touch, InvalidShape> {
    let mut best = *from;
    for _ in 0..FOLLOWED {
        let both = half[0] > 0.0 && half[1] > 0.0;
        let ends = [0, 1].map(|k| {
            let (at, [first, last]) = (best.at[k], bodies[k].span());
            // of one place the minimum lies where the distance falls
            let [before, after] = match best.slopes[k] < 0.0 {
                _ if both => [half[k]; 2],
                true => [0.0, half[k]],
                false => [half[k], 0.0],
            };
            match bodies[k].is_closed() {
                true => [at - before, at + after],
                false => [(at - before).max(first), (at + after).min(last)],
            }
        });
        let quick = if both { descent(bodies, &best, ends, start)? } else { None };
        let found = match quick {
            Some(found) => found,
            None => within(bodies, ends, start)?,
        };
        let lower = found.contact.distance < best.contact.distance;
        if lower {
            best = found;
        }
        let inside = |k: usize| (found.at[k] - ends[k][0]).min(ends[k][1] - found.at[k]) > 0.0;
        if !lower || (0..2).all(|k| half[k] == 0.0 || inside(k)) {
            break;
        }
    }
    Ok(best)
}

/// How often a step is shortened, and to which share at least at a time.
const SHORTENED: usize = 8;
const SHORTEST: f64 = 0.05;
/// A decrease that rounding can hide, relative to the bodies' size.
const ROUNDING: f64 = 1e-11;
/// Steps of the quasi-Newton method.
const STEPS: usize = 24;

/// The minimum over two places by the quasi-Newton method (BFGS) with its steps kept within intervals; `None` where it does not get
/// there.
fn descent(
    bodies: [&Sliced; 2],
    from: &Touch,
    ends: [[f64; 2]; 2],
    start: &mut WarmStart,
) -> Result<Option<Touch>, InvalidShape> {
    let size = bodies[0].size().min(bodies[1].size());
    let gradient = |touch: &Touch| Vector2::from(touch.slopes);
    let clamped = |x: Vector2<f64>| [0, 1].map(|k| x[k].clamp(ends[k][0], ends[k][1]));
    let mut at = *from;
    // a slice turns about its body's size
    let mut inverse = Matrix2::identity() / size;
    for step in 0..STEPS {
        let slope = gradient(&at);
        let place = Vector2::from(at.at);
        let gain_of = |target: [f64; 2]| -slope.dot(&(Vector2::from(target) - place));
        // at an end the other place alone may go on
        let steps = [inverse * slope, slope * (0.5 * inverse.trace())];
        let [quick, steep] = steps.map(|s| clamped(place - s)).map(|t| (gain_of(t), t));
        let stuck = quick.0 <= SETTLED * size;
        let (gain, mut target) = if stuck { steep } else { quick };
        if gain <= SETTLED * size {
            return Ok(Some(at));
        }
        let mut next = None;
        for _ in 0..SHORTENED {
            let found = bodies[0].slice(target[0])?.touch(&bodies[1].slice(target[1])?, start, FEW);
            let lower = at.contact.distance - found.contact.distance;
            if lower >= 1e-4 * gain {
                next = Some(found);
                break;
            }
            // to where the slope along the step would vanish if it were straight
            let way = Vector2::from(target) - place;
            let [before, after] = [&at, &found].map(|t| gradient(t).dot(&way));
            let share = (before / (before - after)).clamp(SHORTEST, 0.5);
            target = [0, 1].map(|k| place[k] + share * way[k]);
        }
        let Some(found) = next else {
            // what is left may be rounding
            return Ok((gain <= ROUNDING * size || at.contact.distance < 0.0).then_some(at));
        };
        let (s, y) = (Vector2::from(found.at) - place, gradient(&found) - slope);
        let curved = s.dot(&y);
        if curved > 1e-12 * s.norm() * y.norm() {
            if step == 0 {
                inverse = Matrix2::identity() * (curved / y.norm_squared());
            }
            let turn = Matrix2::identity() - s * y.transpose() / curved;
            inverse = turn * inverse * turn.transpose() + s * s.transpose() / curved;
        }
        at = found;
    }
    // of slices that overlap the lowest place is an edge between normals, and any place tells something
    Ok((at.contact.distance < 0.0).then_some(at))
}

/// The minimum within intervals.
fn within(
    bodies: [&Sliced; 2],
    ends: [[f64; 2]; 2],
    start: &mut WarmStart,
) -> Result<Touch, InvalidShape> {
    let [a, b] = bodies;
    let size = a.size().min(b.size());
    let mut of_first = |other: &Slice| -> Result<Touch, InvalidShape> {
        along(0, ends[0], size, |at| Ok(a.slice(at)?.touch(other, start, FEW)))
    };
    along(1, ends[1], size, |at| of_first(&b.slice(at)?))
}

/// The minimum over the place of one body between two.
fn along(
    axis: usize,
    ends: [f64; 2],
    size: f64,
    mut touch: impl FnMut(f64) -> Result<Touch, InvalidShape>,
) -> Result<Touch, InvalidShape> {
    let first = touch(ends[0])?;
    if ends[0] >= ends[1] || first.slopes[axis] >= 0.0 {
        return Ok(first);
    }
    let last = touch(ends[1])?;
    if last.slopes[axis] <= 0.0 {
        return Ok(last);
    }
    let [mut low, mut high] = [first, last].map(|t| (t.at[axis], t.slopes[axis]));
    let mut best = if first.contact.distance <= last.contact.distance { first } else { last };
    for step in 0..ROOT_STEPS {
        let width = high.0 - low.0;
        let straight = low.0 + width * (low.1 / (low.1 - high.1));
        let at = match straight.is_finite() && step % 3 != 2 {
            true => straight.clamp(low.0 + 1e-3 * width, high.0 - 1e-3 * width),
            false => low.0 + 0.5 * width,
        };
        let found = touch(at)?;
        if found.contact.distance < best.contact.distance {
            best = found;
        }
        let slope = found.slopes[axis];
        if slope.abs() * width <= SETTLED * size || width <= 1e-15 * PI {
            break;
        }
        if slope < 0.0 {
            low = (at, slope);
            high.1 *= 0.5;
        } else {
            high = (at, slope);
            low.1 *= 0.5;
        }
    }
    Ok(best)
}
