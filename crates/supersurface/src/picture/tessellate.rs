//! Points and normals of a solid on a grid of its two angles.
//!
//! Equal steps of the angle crowd at the edges of a box, equal steps of the polar angle
//! (`tan θ = tan^ε ω`) leave its edges out: the grid takes both. Lines drawn on a surface take the
//! polar steps alone, so that they lie evenly.

use crate::numeric::powers::signed_power;
use crate::shape::Parametric;
use crate::surface::Solid;
use crate::{Direction, Point};
use std::f64::consts::FRAC_PI_2;

/// A grid of vertices; each row is a line of constant `eta`, and quads lie between them.
pub(super) struct Grid {
    pub(super) vertices: Vec<(Point, Direction)>,
    pub(super) columns: usize,
}

/// The vertices of a solid, in its own frame.
pub(super) fn tessellate(solid: &Solid) -> Grid {
    let ([etas, omegas], [e1, e2]) = (solid.domain(), exponents(solid));
    let (rows, columns) = (both(etas, e1), both(omegas, e2));
    let mut vertices = Vec::with_capacity(rows.len() * columns.len());
    for eta in &rows {
        for omega in &columns {
            vertices.push(vertex(solid, *eta, *omega));
        }
    }
    Grid { vertices, columns: columns.len() }
}

/// Lines of longitude and latitude, in the solid's own frame.
pub(super) fn wires(solid: &Solid) -> Vec<Vec<(Point, Direction)>> {
    let ([etas, omegas], [e1, e2]) = (solid.domain(), exponents(solid));
    let (rows, columns) = (both(etas, e1), both(omegas, e2));
    let mut lines = Vec::new();
    for omega in polar(omegas, e2, 12).into_iter().skip(1) {
        lines.push(rows.iter().map(|eta| vertex(solid, *eta, omega)).collect());
    }
    let steps = if etas[0] < -FRAC_PI_2 { 8 } else { 6 };
    for eta in polar(etas, e1, steps).into_iter().skip(1) {
        lines.push(columns.iter().map(|omega| vertex(solid, eta, *omega)).collect());
    }
    lines
}

/// The exponents that say how its angles crowd.
fn exponents(solid: &Solid) -> [f64; 2] {
    match solid {
        Solid::Superellipsoid(s) => s.exponents(),
        Solid::Supertoroid(s) => s.exponents(),
        Solid::Tapered(s) => exponents(s.shape()),
        Solid::Twisted(s) => exponents(s.shape()),
        Solid::Bent(s) => exponents(s.shape()),
        Solid::ShearBent(s) => exponents(s.shape()),
        Solid::Hollowed(s) => exponents(s.shape()),
        Solid::Separable(s) => {
            let [k1, k2, k3] = s.powers();
            [2.0 / k3, 4.0 / (k1 + k2)]
        }
        Solid::Supercylinder(s) => [1.0, s.exponent()],
        Solid::Supercone(s) => [1.0, s.exponent()],
        Solid::Supershape(_) | Solid::RadialExtended(_) => [1.0; 2],
    }
}

fn vertex(solid: &Solid, eta: f64, omega: f64) -> (Point, Direction) {
    let point = solid.point(eta, omega);
    let outward = Direction::try_new(point.coords, 1e-300);
    let normal = solid.normal(eta, omega).or(outward);
    (point, normal.unwrap_or(crate::Vector::z_axis()))
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
        for surface in [Solid::from(solid), Solid::from(ring)] {
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
        let shape = Solid::from(edge);
        let lines = wires(&shape);
        // the longitude at 30 degrees of 12
        let at = lines
            .iter()
            .flatten()
            .find(|(p, _)| (p.y / p.x - 30f64.to_radians().tan()).abs() < 1e-6);
        assert!(at.is_some());
    }
}
