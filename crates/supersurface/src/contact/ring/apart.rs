//! The slice that is nearest to a body, by branch and bound over the angles.

use super::size;
use super::slices::{Slice, Touch, minimum, way};
use crate::contact::{Contact, Convex, WarmStart};
use crate::shape::{InvalidShape, Posed, Supertoroid};
use std::f64::consts::TAU;

/// Intervals at first.
const FIRST: usize = 16;
/// Bounds of the distance are at most this far apart, relative to the ring's size.
pub(super) const CONTENT: f64 = 1e-3;
/// Slices after which the bounds are what they are.
const MOST: usize = 4_000;

/// The contact with the nearest slice; where the two overlap, that with a slice that the body overlaps.
pub(super) fn nearest(
    torus: &Posed<Supertoroid>,
    body: &Posed<Convex>,
    content: f64,
    start: &mut WarmStart,
) -> Result<Contact, InvalidShape> {
    let content = content * size(torus);
    let width = TAU / FIRST as f64;
    let touch = |angle: f64, start: &mut WarmStart| {
        Slice::new(torus, angle).map(|slice| slice.touch(torus, body, start))
    };
    let mut around: Vec<Touch> = Vec::with_capacity(FIRST + 1);
    for slice in Slice::around(torus, FIRST)? {
        let found = slice.touch(torus, body, start);
        if found.contact.distance <= 0.0 {
            return Ok(found.contact);
        }
        around.push(found);
    }
    around.push(Touch { angle: around[0].angle + TAU, ..around[0] });
    let mut best = around[0];
    for pair in around.windows(2) {
        let [low, high] = [&pair[0], &pair[1]];
        let bound =
            low.contact.distance.min(high.contact.distance) - way(torus.shape(), low.angle, width);
        if low.slope < 0.0 && high.slope >= 0.0 && bound < best.contact.distance {
            let found = minimum(torus, body, [low, high], start)?;
            if found.contact.distance < best.contact.distance {
                best = found;
            }
        }
    }
    let mut open: Vec<(Touch, f64)> =
        around[..FIRST].iter().map(|found| (*found, 0.5 * width)).collect();
    let (mut least, mut slices) = (f64::INFINITY, 0);
    let mut refined = true;
    let mut at = 0.5 * width;
    while let Some((middle, half)) = open.pop() {
        if middle.contact.distance <= 0.0 {
            return Ok(middle.contact);
        }
        if middle.contact.distance < best.contact.distance {
            (best, at, refined) = (middle, half, false);
        }
        let bound = middle.contact.distance - way(torus.shape(), middle.angle, half);
        if bound >= best.contact.distance - content || slices >= MOST {
            least = least.min(bound);
            continue;
        }
        for side in [-0.5, 0.5] {
            let found = touch(middle.angle + side * half, start)?;
            slices += 1;
            open.push((found, 0.5 * half));
        }
    }
    if !refined {
        let ends = [touch(best.angle - 2.0 * at, start)?, touch(best.angle + 2.0 * at, start)?];
        // the minimum lies on the side to which the distance falls
        let ends = if best.slope < 0.0 { [best, ends[1]] } else { [ends[0], best] };
        let found = minimum(torus, body, [&ends[0], &ends[1]], start)?;
        if found.contact.distance < best.contact.distance {
            best = found;
        }
    }
    let mut contact = best.contact;
    if contact.distance > 0.0 {
        contact.bounds[0] = least.min(contact.bounds[0]).max(0.0);
    }
    Ok(contact)
}
