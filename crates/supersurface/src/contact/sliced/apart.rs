//! The slices that are nearest, by branch and bound over their places.
//!
//! The normal between two slices bounds the distance of all slices of their intervals from below, by how far these reach
//! along it. That is less than the distance by the square of the intervals near a minimum.

use super::body::Sliced;
use super::grid::Grid;
use super::lowest::lowest;
use super::slice::{FEW, Touch};
use crate::contact::WarmStart;
use crate::shape::InvalidShape;

/// Slices of each body at first.
const FIRST: usize = 16;
/// Bounds of the distance are at most this far apart, relative to the smaller body's size.
pub(super) const CONTENT: f64 = 1e-6;
/// Pairs of slices after which the bounds are what they are.
const MOST: usize = 4_000;
/// Low nodes of the grid that are followed at first.
const FOLLOWED: usize = 8;

/// The nearest slices, and bounds of the bodies' distance in their contact; where two slices are found to be nearer than
/// `stop`, these. Bounds are `content` apart, if the pairs of slices last. Both relative to the smaller body's size.
pub(super) fn nearest(
    bodies: [&Sliced; 2],
    content: f64,
    stop: f64,
    start: &mut WarmStart,
) -> Result<Touch, InvalidShape> {
    let size = bodies[0].size().min(bodies[1].size());
    let [content, stop] = [content * size, stop * size];
    let bound = |touch: &Touch, half: [f64; 2]| {
        let n = touch.contact.normal.into_inner();
        let [a, b] =
            [(0, n), (1, -n)].map(|(k, n)| bodies[k].extent_within(touch.at[k], half[k], &n));
        -a - b
    };
    let grid = Grid::new(bodies, FIRST)?;
    let mut nodes: Vec<Touch> = Vec::with_capacity(grid.len());
    for k in 0..grid.len() {
        let [a, b] = grid.node(k);
        let found = a.touch(b, start, FEW);
        if found.contact.distance <= stop {
            return Ok(found);
        }
        nodes.push(found);
    }
    let distance = |k: usize| nodes[k].contact.distance;
    let mut low: Vec<usize> =
        (0..nodes.len()).filter(|k| grid.turns(*k, |k| Some(nodes[k]))).collect();
    low.sort_by(|p, q| distance(*p).total_cmp(&distance(*q)));
    let mut best = nodes[0];
    for k in low.into_iter().take(FOLLOWED) {
        let found = lowest(bodies, &nodes[k], grid.half.map(|h| 2.0 * h), start)?;
        if found.contact.distance < best.contact.distance {
            best = found;
        }
    }
    let mut open: Vec<(Touch, [f64; 2])> =
        nodes.into_iter().map(|node| (node, grid.half)).collect();
    let (mut least, mut asked) = (f64::INFINITY, 0);
    let mut better: Option<[f64; 2]> = None;
    while let Some((middle, half)) = open.pop() {
        if middle.contact.distance <= stop {
            return Ok(middle);
        }
        if middle.contact.distance < best.contact.distance {
            (best, better) = (middle, Some(half));
        }
        let bound = bound(&middle, half);
        if bound >= best.contact.distance - content || asked >= MOST {
            least = least.min(bound);
            continue;
        }
        let [a, b] = [0, 1].map(|k| bodies[k].way(middle.at[k], half[k]));
        let axis = usize::from(b > a);
        for side in [-0.5, 0.5] {
            let (mut at, mut half) = (middle.at, half);
            at[axis] += side * half[axis];
            half[axis] *= 0.5;
            let found = bodies[0].slice(at[0])?.touch(&bodies[1].slice(at[1])?, start, FEW);
            asked += 1;
            open.push((found, half));
        }
    }
    if let Some(half) = better {
        best = lowest(bodies, &best, half.map(|h| 2.0 * h), start)?;
    }
    if best.contact.distance > 0.0 {
        best.contact.bounds[0] = least.min(best.contact.bounds[0]).max(0.0);
    }
    Ok(best)
}
