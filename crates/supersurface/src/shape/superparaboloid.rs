//! The superparaboloid: bowls, domes, noses (FORMULAS §2.3).
//!
//! Vertex at the origin, open towards +z: `F = ρ̂^p1 - z/a3 = 0` with `p = 2/ε`. Public definitions differ in
//! the place of the vertex and in the exponent; this is the project's.

use std::f64::consts::PI;

use nalgebra::Matrix3;

use crate::numeric::powers::{power, signed_power_slope};
use crate::numeric::superellipse::norm;
use crate::shape::angular::{finite, superellipse, superellipse_normal, superellipse_slopes, unit};
use crate::shape::jet::Jet;
use crate::shape::superellipsoid::{check_axes, check_exponents};
use crate::shape::{Implicit, InvalidShape, Parametric, SecondOrder};
use crate::{Direction, Point, Vector};

/// A superparaboloid; the solid is what it holds above its vertex.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, Superparaboloid}};
/// let bowl = Superparaboloid::new([0.1, 0.1, 0.05], [1.0, 1.0])?;
/// assert!(bowl.contains(&Point::new(0.0, 0.0, 0.01)));
/// assert!((bowl.gauge(&Point::new(0.1, 0.0, 0.05)) - 1.0).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Superparaboloid {
    semi_axes: [f64; 3],
    exponents: [f64; 2],
}

impl Superparaboloid {
    /// `[a1, a2, a3]` in metres, positive: at the height a3 the section has the semi-axes a1 and a2.
    /// Exponents `[ε1, ε2]` (profile first, then the section across z) in (0, 10].
    pub fn new(semi_axes: [f64; 3], exponents: [f64; 2]) -> Result<Self, InvalidShape> {
        check_axes(&semi_axes)?;
        check_exponents(&exponents)?;
        Ok(Self { semi_axes, exponents })
    }

    /// `[a1, a2, a3]` in metres.
    pub const fn semi_axes(&self) -> [f64; 3] {
        self.semi_axes
    }

    /// Exponents `[ε1, ε2]`.
    pub const fn exponents(&self) -> [f64; 2] {
        self.exponents
    }

    /// `F = ρ̂^p1 - z/a3`: negative inside, 0 on the surface; infinite where it overflows.
    pub fn implicit_value(&self, p: &Point) -> f64 {
        let rise = power(self.radius(p), 2.0 / self.exponents[0]);
        if rise == f64::INFINITY { rise } else { rise - p.z / self.semi_axes[2] }
    }

    fn radius(&self, p: &Point) -> f64 {
        let [a1, a2, _] = self.semi_axes;
        norm((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / self.exponents[1])
    }

    /// For points above the vertex.
    fn jet(&self, p: &Point) -> Option<Jet> {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let radius = Jet::axis(0, p.x, a1).norm(&Jet::axis(1, p.y, a2), 2.0 / e2);
        (p.z > 0.0).then(|| radius.over(&Jet::axis(2, p.z, a3).raised(0.5 * e1)))
    }
}

impl Implicit for Superparaboloid {
    /// `ρ̂ / (z/a3)^(1/p1)`: how far out a point is in its own section across z. Infinite below the vertex
    /// and around it at its height; 1 at the vertex.
    fn gauge(&self, p: &Point) -> f64 {
        let radius = self.radius(p);
        let width = power((p.z / self.semi_axes[2]).max(0.0), 0.5 * self.exponents[0]);
        match width > 0.0 && radius < f64::INFINITY {
            true => radius / width,
            false if p.z == 0.0 && radius == 0.0 => 1.0,
            false => f64::INFINITY,
        }
    }

    /// Zero from the height of the vertex down, where the gauge is infinite.
    fn gradient(&self, p: &Point) -> Vector {
        self.jet(p).map_or_else(Vector::zeros, |jet| jet.gradient())
    }

    /// Infinite but for the vertex's plane.
    fn bounds(&self) -> [Point; 2] {
        let far = f64::INFINITY;
        [Point::new(-far, -far, 0.0), Point::new(far, far, far)]
    }
}

impl SecondOrder for Superparaboloid {
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        self.jet(p)?.hessian()
    }
}

impl Parametric for Superparaboloid {
    /// `u` (in place of η) from the vertex to 1, where the height is a3, ω all around. The point exists for
    /// every `u`.
    fn domain(&self) -> [[f64; 2]; 2] {
        [[0.0, 1.0], [-PI, PI]]
    }

    /// `(a1 u cos^ε2 ω, a2 u sin^ε2 ω, a3 u^p1)` with signed powers; `u >= 0`, without unit.
    fn point(&self, u: f64, omega: f64) -> Point {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let [x, y] = superellipse(omega, e2);
        Point::new(a1 * x * u, a2 * y * u, a3 * power(u, 2.0 / e1))
    }

    fn tangents(&self, u: f64, omega: f64) -> Option<[Vector; 2]> {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let ([x, y], [dx, dy]) = (superellipse(omega, e2), superellipse_slopes(omega, e2)?);
        finite([
            Vector::new(a1 * x, a2 * y, a3 * signed_power_slope(u, 2.0 / e1)?),
            Vector::new(a1 * u * dx, a2 * u * dy, 0.0),
        ])
    }

    /// `(p1 u^(p1-1) cos^(2-ε2) ω / a1, p1 u^(p1-1) sin^(2-ε2) ω / a2, -1/a3)`, normalised; at the vertex
    /// only for ε1 < 2.
    fn normal(&self, u: f64, omega: f64) -> Option<Direction> {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        if u == 0.0 {
            return (e1 < 2.0).then(|| -Vector::z_axis());
        }
        let (rise, [x, y]) = (signed_power_slope(u, 2.0 / e1)?, superellipse_normal(omega, e2)?);
        unit(Vector::new(rise * x / a1, rise * y / a2, -1.0 / a3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn points_beyond_the_patch_lie_on_the_surface() {
        for exponents in [[1.0, 1.0], [0.5, 1.5], [1.9, 0.7], [2.5, 0.4]] {
            let s = Superparaboloid::new([0.3, 0.5, 0.2], exponents).unwrap();
            for u in [0.0, 0.4, 1.0, 1.3] {
                let p = s.point(u, 0.3);
                assert!(s.implicit_value(&p).abs() < 1e-12 && (s.gauge(&p) - 1.0).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn the_vertex_is_on_the_surface_and_below_it_is_outside() {
        let s = Superparaboloid::new([1.0; 3], [1.0; 2]).unwrap();
        assert_eq!(s.gauge(&Point::origin()), 1.0);
        assert_eq!(s.normal(0.0, 0.7), Some(-Vector::z_axis()));
        assert_eq!(s.first_order_distance(&Point::new(0.0, 0.0, -1.0)), f64::INFINITY);
        assert!(s.implicit_value(&Point::new(0.0, 0.0, -1.0)) > 0.0);
        let cusp = Superparaboloid::new([1.0; 3], [2.0, 1.0]).unwrap();
        assert!(cusp.normal(0.0, 0.0).is_none());
    }
}
