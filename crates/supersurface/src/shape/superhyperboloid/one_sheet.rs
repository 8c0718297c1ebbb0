//! One sheet around the z axis: `F = ρ̂^p1 - |z/a3|^p1 = 1` with `p = 2/ε` (FORMULAS §2.3).

use std::f64::consts::PI;

use nalgebra::Matrix3;

use super::{ANGLE_LIMIT, superhyperbola, superhyperbola_normal, superhyperbola_slopes};
use crate::numeric::powers::power_difference;
use crate::numeric::superellipse::norm;
use crate::shape::angular::{finite, superellipse, superellipse_normal, superellipse_slopes, unit};
use crate::shape::jet::Jet;
use crate::shape::superellipsoid::{check_axes, check_exponents};
use crate::shape::{Implicit, InvalidShape, Parametric, SecondOrder};
use crate::{Direction, Point, Vector};

/// A superhyperboloid of one sheet; the solid is the part that contains the z axis.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, SuperhyperboloidOneSheet}};
/// let hourglass = SuperhyperboloidOneSheet::new([0.01, 0.01, 0.02], [1.0, 1.0])?;
/// assert!(hourglass.contains(&Point::new(0.0, 0.0, 5.0)));
/// assert!((hourglass.gauge(&Point::new(0.02, 0.0, 0.0)) - 2.0).abs() < 1e-14);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SuperhyperboloidOneSheet {
    semi_axes: [f64; 3],
    exponents: [f64; 2],
}

impl SuperhyperboloidOneSheet {
    /// Semi-axes `[a1, a2, a3]` in metres, positive (a1 and a2 of the waist, a3 how slowly it opens);
    /// exponents `[ε1, ε2]` (meridian first, then the section across z) in (0, 10].
    pub fn new(semi_axes: [f64; 3], exponents: [f64; 2]) -> Result<Self, InvalidShape> {
        check_axes(&semi_axes)?;
        check_exponents(&exponents)?;
        Ok(Self { semi_axes, exponents })
    }

    /// Semi-axes `[a1, a2, a3]` in metres.
    pub const fn semi_axes(&self) -> [f64; 3] {
        self.semi_axes
    }

    /// Exponents `[ε1, ε2]`.
    pub const fn exponents(&self) -> [f64; 2] {
        self.exponents
    }

    /// `F = ρ̂^p1 - |z/a3|^p1`: below 1 inside, 1 on the surface; infinite where it overflows.
    pub fn implicit_value(&self, p: &Point) -> f64 {
        let [radius, height] = self.coordinates(p);
        power_difference(radius, height, 2.0 / self.exponents[0])
    }

    /// `ρ̂` and `|z/a3|`.
    fn coordinates(&self, p: &Point) -> [f64; 2] {
        let [a1, a2, a3] = self.semi_axes;
        let radius = norm((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / self.exponents[1]);
        [radius, (p.z / a3).abs()]
    }

    fn jet(&self, p: &Point) -> Jet {
        let [a1, a2, a3] = self.semi_axes;
        let [p1, p2] = self.exponents.map(|e| 2.0 / e);
        let radius = Jet::axis(0, p.x, a1).norm(&Jet::axis(1, p.y, a2), p2);
        radius.over(&Jet::constant(1.0).norm(&Jet::axis(2, p.z, a3), p1))
    }
}

impl Implicit for SuperhyperboloidOneSheet {
    /// `ρ̂ / ‖(1, z/a3)‖_p1`: how far out a point is in its own section across z.
    fn gauge(&self, p: &Point) -> f64 {
        let [radius, height] = self.coordinates(p);
        let waist = norm(1.0, height, 2.0 / self.exponents[0]);
        if radius == f64::INFINITY { radius } else { radius / waist }
    }

    fn gradient(&self, p: &Point) -> Vector {
        self.jet(p).gradient()
    }

    /// Infinite: the solid goes on for ever along z, and widens.
    fn bounds(&self) -> [Point; 2] {
        [f64::NEG_INFINITY, f64::INFINITY].map(|v| Point::new(v, v, v))
    }
}

impl SecondOrder for SuperhyperboloidOneSheet {
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        self.jet(p).hessian()
    }
}

impl Parametric for SuperhyperboloidOneSheet {
    /// η up to [`ANGLE_LIMIT`], ω all around.
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-ANGLE_LIMIT, ANGLE_LIMIT], [-PI, PI]]
    }

    /// `(a1 sec^ε1 η cos^ε2 ω, a2 sec^ε1 η sin^ε2 ω, a3 tan^ε1 η)` with signed powers.
    fn point(&self, eta: f64, omega: f64) -> Point {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let ([r, z], [x, y]) = (superhyperbola(eta, e1), superellipse(omega, e2));
        Point::new(a1 * r * x, a2 * r * y, a3 * z)
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let ([r, _], [x, y]) = (superhyperbola(eta, e1), superellipse(omega, e2));
        let ([dr, dz], [dx, dy]) =
            (superhyperbola_slopes(eta, e1)?, superellipse_slopes(omega, e2)?);
        finite([
            Vector::new(a1 * dr * x, a2 * dr * y, a3 * dz),
            Vector::new(a1 * r * dx, a2 * r * dy, 0.0),
        ])
    }

    /// `(sec^(2-ε1) η cos^(2-ε2) ω / a1, sec^(2-ε1) η sin^(2-ε2) ω / a2, -tan^(2-ε1) η / a3)`, normalised:
    /// away from the z axis.
    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let ([r, z], [x, y]) = (superhyperbola_normal(eta, e1)?, superellipse_normal(omega, e2)?);
        unit(Vector::new(r * x / a1, r * y / a2, -z / a3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_beyond_the_limit_are_the_limit() {
        for exponents in [[1.0, 1.0], [0.3, 1.5], [1.9, 0.7], [0.7, 0.2]] {
            let s = SuperhyperboloidOneSheet::new([0.3, 0.5, 0.2], exponents).unwrap();
            for eta in [-9.0, -1.5, 0.0, 0.4, 7.0] {
                let p = s.point(eta, 0.3);
                assert!((s.implicit_value(&p) - 1.0).abs() < 1e-11);
            }
        }
    }

    #[test]
    fn the_waist_of_a_sharp_meridian_has_no_curvature_and_of_a_cusp_no_normal() {
        let s = |e| SuperhyperboloidOneSheet::new([1.0; 3], [e, 1.0]).unwrap();
        let waist = s(1.0).point(0.0, 0.5);
        assert!(s(1.0).hessian(&waist).is_some() && s(0.5).hessian(&waist).is_some());
        assert!(s(1.5).hessian(&waist).is_none() && s(1.5).normal(0.0, 0.5).is_some());
        assert!(s(2.0).normal(0.0, 0.5).is_none());
        assert!(SuperhyperboloidOneSheet::new([1.0, 0.0, 1.0], [1.0; 2]).is_err());
    }
}
