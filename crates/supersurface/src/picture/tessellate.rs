//! Points and normals of a supersurface on a grid of its two angles.
//!
//! Equal steps of the angle crowd at the edges of a box, equal steps of the polar angle
//! (`tan θ = tan^ε ω`) leave its edges out: the grid takes both. Lines drawn on a surface take the
//! polar steps alone, so that they lie evenly.

use crate::numeric::powers::signed_power;
use crate::shape::Parametric;
use crate::surface::Surface;
use crate::{Direction, Point};
use std::f64::consts::{FRAC_PI_2, PI};

/// A grid of vertices; each row is a line of constant `eta`, and quads lie between them.
pub(super) struct Grid {
    pub(super) vertices: Vec<(Point, Direction)>,
    pub(super) columns: usize,
}

/// The vertices of a surface, in its own frame.
pub(super) fn tessellate(surface: &Surface) -> Grid {
    let [e1, e2] = surface.exponents();
    let rows = both(eta_range(surface), e1);
    let columns = both([-PI, PI], e2);
    let mut vertices = Vec::with_capacity(rows.len() * columns.len());
    for eta in &rows {
        for omega in &columns {
            vertices.push(vertex(surface, *eta, *omega));
        }
    }
    Grid { vertices, columns: columns.len() }
}

/// Lines of longitude and latitude, in the surface's own frame.
pub(super) fn wires(surface: &Surface) -> Vec<Vec<(Point, Direction)>> {
    let [e1, e2] = surface.exponents();
    let [low, high] = eta_range(surface);
    let (rows, columns) = (both([low, high], e1), both([-PI, PI], e2));
    let mut lines = Vec::new();
    for omega in polar([-PI, PI], e2, 12).into_iter().skip(1) {
        lines.push(rows.iter().map(|eta| vertex(surface, *eta, omega)).collect());
    }
    let steps = if low < -FRAC_PI_2 { 8 } else { 6 };
    for eta in polar([low, high], e1, steps).into_iter().skip(1) {
        lines.push(columns.iter().map(|omega| vertex(surface, eta, *omega)).collect());
    }
    lines
}

fn eta_range(surface: &Surface) -> [f64; 2] {
    match surface {
        Surface::Superellipsoid(_) => [-FRAC_PI_2, FRAC_PI_2],
        Surface::Supertoroid(_) => [-PI, PI],
    }
}

fn vertex(surface: &Surface, eta: f64, omega: f64) -> (Point, Direction) {
    let (point, normal) = match surface {
        Surface::Superellipsoid(s) => (s.point(eta, omega), s.normal(eta, omega)),
        Surface::Supertoroid(s) => (s.point(eta, omega), s.normal(eta, omega)),
    };
    let outward = Direction::try_new(point.coords, 1e-300);
    (point, normal.or(outward).unwrap_or(crate::Vector::z_axis()))
}

/// Angles with equal steps of the polar angle: `ω = atan(tan^(1/ε) θ)`, kept in its quadrant.
fn polar([low, high]: [f64; 2], exponent: f64, steps: usize) -> Vec<f64> {
    let angle = |i: usize| {
        let theta = low + (high - low) * i as f64 / steps as f64;
        let quadrant = (theta / FRAC_PI_2).round();
        let (s, c) = (theta - quadrant * FRAC_PI_2).sin_cos();
        // within 45 degrees of an axis, so that the power is of a number in [-1, 1]
        quadrant * FRAC_PI_2 + signed_power(s / c, 1.0 / exponent).atan()
    };
    (0..=steps).map(angle).collect()
}

/// Equal steps of the angle and of the polar angle, in rising order.
fn both(range: [f64; 2], exponent: f64) -> Vec<f64> {
    let steps = if range[1] - range[0] > 4.0 { 48 } else { 24 };
    let mut angles = polar(range, exponent, steps);
    angles.extend(polar(range, 1.0, steps));
    angles.sort_by(f64::total_cmp);
    angles.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    angles
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Implicit, Superellipsoid, Supertoroid};

    #[test]
    fn vertices_lie_on_the_surface_with_its_normals() {
        let solid = Superellipsoid::new([0.03, 0.05, 0.08], [0.3, 1.4]).unwrap();
        let ring = Supertoroid::new([0.01, 0.01, 0.02], 3.0, [0.5, 1.0]).unwrap();
        for surface in [Surface::Superellipsoid(solid), Surface::Supertoroid(ring)] {
            let grid = tessellate(&surface);
            assert_eq!(grid.vertices.len() % grid.columns, 0);
            for (point, normal) in &grid.vertices {
                assert!((surface.gauge(point) - 1.0).abs() < 1e-9, "{point}");
                assert!(surface.gauge(&(point + normal.into_inner() * 1e-5)) > 1.0);
            }
        }
    }

    #[test]
    fn the_lines_of_a_box_lie_evenly() {
        let edge = Superellipsoid::new([1.0; 3], [0.1, 0.1]).unwrap();
        let shape = Surface::Superellipsoid(edge);
        let lines = wires(&shape);
        // the longitude at 30 degrees of 12
        let at = lines
            .iter()
            .flatten()
            .find(|(p, _)| (p.y / p.x - 30f64.to_radians().tan()).abs() < 1e-6);
        assert!(at.is_some());
    }
}
