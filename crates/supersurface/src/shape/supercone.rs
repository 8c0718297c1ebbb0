//! The supercone: cones and pyramids with superelliptic base (FORMULAS §2.2).
//!
//! Base at `z = -a3`, apex at `z = a3`: inside for `|z| <= a3` and `ρ̂ <= (1 - z/a3)/2`. It is the taper
//! `K = -1` of a supercylinder with half its base.

use nalgebra::Matrix3;

use super::supercylinder::{base_moments, rim_support};
use crate::numeric::powers::larger;
use crate::numeric::superellipse::norm;
use crate::shape::filled::{Bits, eighth};
use crate::shape::jet::Jet;
use crate::shape::superellipsoid::{check_axes, check_exponents};
use crate::shape::{Filled, Implicit, InvalidShape, Mass, MassProperties, SecondOrder, SupportMap};
use crate::{Point, Vector};

/// A supercone about the middle of its height, apex towards +z.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, Supercone}};
/// let pyramid = Supercone::new([1.0, 1.0, 0.5], 0.01)?;
/// assert!(pyramid.contains(&Point::new(0.9, 0.9, -0.499)));
/// assert!((pyramid.gauge(&Point::new(0.0, 0.0, 0.5)) - 1.0).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supercone {
    semi_axes: [f64; 3],
    exponent: f64,
}

impl Supercone {
    /// Semi-axes `[a1, a2]` of the base and half the height `a3` in metres, positive; exponent ε2 of the
    /// base in (0, 10].
    pub fn new(semi_axes: [f64; 3], exponent: f64) -> Result<Self, InvalidShape> {
        check_axes(&semi_axes)?;
        check_exponents(&[1.0, exponent])?;
        Ok(Self { semi_axes, exponent })
    }

    /// Semi-axes `[a1, a2]` of the base and half the height `a3`, in metres.
    pub const fn semi_axes(&self) -> [f64; 3] {
        self.semi_axes
    }

    /// Exponent ε2 of the base.
    pub const fn exponent(&self) -> f64 {
        self.exponent
    }

    /// `f = ρ̂ - (1 - z/a3)/2`: negative inside the mantle (between base and apex), 0 on it. It knows no base.
    pub fn implicit_value(&self, p: &Point) -> f64 {
        let radius = self.radius(p);
        if radius == f64::INFINITY {
            return radius;
        }
        radius - 0.5 * (1.0 - p.z / self.semi_axes[2])
    }

    /// Volume in m³: a third of the height `2 a3` times the base.
    pub fn volume(&self) -> f64 {
        2.0 / 3.0 * self.semi_axes[2] * base_moments(self.semi_axes, self.exponent)[0]
    }

    fn radius(&self, p: &Point) -> f64 {
        let [a1, a2, _] = self.semi_axes;
        norm((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / self.exponent)
    }

    fn jet(&self, p: &Point) -> Jet {
        let [a1, a2, a3] = self.semi_axes;
        let radius = Jet::axis(0, p.x, a1).norm(&Jet::axis(1, p.y, a2), 2.0 / self.exponent);
        let up = Vector::z() / a3;
        let mantle = radius.scaled_plus(2.0, up, p.z / a3);
        mantle.max(&Jet::constant(0.0).scaled_plus(1.0, -up, -p.z / a3))
    }
}

impl Implicit for Supercone {
    /// `max(2 ρ̂ + z/a3, -z/a3)`: the gauge about the middle of the height, 1 on mantle and base.
    fn gauge(&self, p: &Point) -> f64 {
        let (radius, height) = (2.0 * self.radius(p), p.z / self.semi_axes[2]);
        if radius == f64::INFINITY { radius } else { larger(radius + height, -height) }
    }

    fn gradient(&self, p: &Point) -> Vector {
        self.jet(p).gradient()
    }

    fn bounds(&self) -> [Point; 2] {
        let a = Vector::from(self.semi_axes);
        [Point::from(-a), Point::from(a)]
    }

    fn is_convex(&self) -> bool {
        self.exponent <= 2.0
    }
}

impl SecondOrder for Supercone {
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        self.jet(p).hessian()
    }
}

/// By lines from the axis at the height `a3 (2t - 1)`: the volume element is `2 a1 a2 a3 (1 - t)² r ds dt dr / n(s)²`.
impl Filled for Supercone {
    fn pieces(&self) -> usize {
        8
    }

    fn along(
        &self,
        piece: usize,
        [s, t]: [f64; 2],
        shares: &[f64],
        each: &mut dyn FnMut(Point, f64),
    ) {
        let [a1, a2, a3] = self.semi_axes;
        let ([x, y], turn) = eighth(&mut Bits::of(piece), s, 2.0 / self.exponent);
        let width = 1.0 - t;
        let volume = 2.0 * a1 * a2 * a3 * width * width * turn;
        for r in shares {
            let rho = r * width;
            each(Point::new(a1 * rho * x, a2 * rho * y, a3 * (2.0 * t - 1.0)), volume * r);
        }
    }
}

impl SupportMap for Supercone {
    /// The apex or a point of the rim: `h(n) = max(a3 n_z, -a3 n_z + ‖(a1 n_x, a2 n_y)‖_q2)`.
    fn support_point(&self, n: &Vector) -> Point {
        let a3 = self.semi_axes[2];
        let rim = rim_support(self.semi_axes, self.exponent, n);
        let apex = Point::new(0.0, 0.0, a3);
        let rim = Point::new(rim.x, rim.y, -a3);
        if n.dot(&apex.coords) >= n.dot(&rim.coords) { apex } else { rim }
    }
}

impl MassProperties for Supercone {
    /// With `r = (1 - z/a3)/2` from the base's 1 to the apex's 0 and `dz = 2 a3 dr`, sections scale with `r²`
    /// and their second moments with `r⁴`: `V = 2 a3 A/3`, centroid `-a3/2`, `∫x² = 2 a3 A_xx/5`, and about the
    /// centroid `∫z² = a3³ A/10`.
    fn mass_properties(&self, density: f64) -> Mass {
        let a3 = self.semi_axes[2];
        let [area, xx, yy] = base_moments(self.semi_axes, self.exponent);
        let height = 2.0 * a3 * density;
        let [x, y, z] = [height * xx / 5.0, height * yy / 5.0, height * area * a3 * a3 / 20.0];
        Mass {
            mass: height * area / 3.0,
            centre: Point::new(0.0, 0.0, -0.5 * a3),
            inertia: Matrix3::from_diagonal(&Vector::new(y + z, x + z, x + y)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gauge_is_one_on_base_and_mantle() {
        let s = Supercone::new([0.3, 0.5, 0.4], 0.7).unwrap();
        for i in 0..40 {
            let omega = 0.16 * f64::from(i);
            let [x, y] = crate::shape::angular::superellipse(omega, 0.7);
            for r in [0.1, 0.5, 0.9, 1.0] {
                let base = Point::new(0.3 * r * x, 0.5 * r * y, -0.4);
                let mantle = Point::new(base.x, base.y, 0.4 * (1.0 - 2.0 * r));
                assert!((s.gauge(&base) - 1.0).abs() < 1e-15);
                assert!((s.gauge(&mantle) - 1.0).abs() < 1e-14);
                assert!(s.implicit_value(&mantle).abs() < 1e-14);
            }
        }
    }
}
