//! Starts by rays: the nearest point of a surface is the nearest of all first hits.

use nalgebra::Vector2;

use super::quasi_newton::lowest;
use crate::measure::first_hit;
use crate::measure::implicit_curvature::tangents;
use crate::shape::{Implicit, Ray};
use crate::{Direction, Point, Vector};

/// First hits of rays from `p` along the axes, the diagonals and the gradient, up to `reach` or, without one, as far
/// as needed to hit anything.
pub(super) fn hits(shape: &impl Implicit, p: &Point, reach: Option<f64>) -> Vec<Point> {
    let directions = directions(shape, p);
    let cast = |reach: f64| -> Vec<Point> {
        let along = directions.iter().filter_map(|d| {
            let ray = Ray { origin: *p, direction: *d };
            first_hit(shape, &ray, reach)
        });
        along.map(|hit| hit.point).collect()
    };
    if let Some(reach) = reach {
        return cast(reach);
    }
    let [low, high] = shape.bounds();
    let across = (high - low).norm() + (nalgebra::center(&low, &high) - p).norm();
    if across.is_finite() {
        return cast(across);
    }
    let first = shape.first_order_distance(p).abs();
    let mut reach = if first.is_finite() && first > 0.0 { first } else { 1.0 };
    for _ in 0..60 {
        let found = cast(reach);
        if !found.is_empty() {
            return found;
        }
        reach *= 2.0;
    }
    Vec::new()
}

/// The 26 neighbours of a cell of a grid, as many places of the bounding box, and both ways along the gradient.
fn directions(shape: &impl Implicit, p: &Point) -> Vec<Direction> {
    let side = |k: i32| f64::from(k % 3 - 1);
    let neighbours = (0..27).map(|k| Vector::new(side(k), side(k / 3), side(k / 9)));
    let gradient = shape.gradient(p);
    let scaled = gradient / gradient.amax();
    let [low, high] = shape.bounds();
    // a thin body is met along its own middle, and halfway between it and the box
    let (middle, half) = (nalgebra::center(&low, &high), (high - low) * 0.25);
    let inwards = neighbours.clone().map(|v| middle + v.component_mul(&half) - p);
    let all = neighbours.chain(inwards).chain([scaled, -scaled]);
    all.filter(|v| v.iter().all(|c| c.is_finite()))
        .filter_map(|v| Direction::try_new(v, 1e-300))
        .collect()
}

/// A surface point nearer than `start`, by turning the ray towards it.
pub(super) fn narrow(shape: &impl Implicit, start: &Point, p: &Point) -> Option<Point> {
    let direction = Direction::try_new(start - p, 1e-300)?;
    let [u, v] = tangents(&direction);
    let reach = (start - p).norm() * 1.5;
    let hit = |at: &Vector2<f64>| {
        let turned = direction.into_inner() + u * at.x + v * at.y;
        let ray = Ray { origin: *p, direction: Direction::new_normalize(turned) };
        first_hit(shape, &ray, reach).map(|hit| (hit, turned))
    };
    // along w the plane at the hit is met at |w| c/(n·w)
    let distance = |at: &Vector2<f64>| {
        let Some((hit, w)) = hit(at) else { return (f64::INFINITY, Vector2::zeros()) };
        let n = hit.normal.into_inner();
        let (across, length) = (n.dot(&w), w.norm());
        let slope = (w / length - n * (length / across)) * (n.dot(&(hit.point - p)) / across);
        (hit.distance, Vector2::new(slope.dot(&u), slope.dot(&v)))
    };
    // off the edge on which the start may lie, to two sides
    let starts = [[0.03, 0.02], [-0.02, 0.03], [0.003, -0.002]];
    let found = starts.map(|[a, b]| lowest(distance, Vector2::new(a, b)));
    let best = found.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.and_then(|(_, place)| hit(&place)).map(|(hit, _)| hit.point)
}
