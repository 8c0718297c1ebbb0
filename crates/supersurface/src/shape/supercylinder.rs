//! The supercylinder: boxes with round edges along one axis, tins, prisms with superelliptic base.
//!
//! `g = max(ρ̂, |z|/a3) = 1`, the limit ε1 → 0 of the superellipsoid (FORMULAS §2.2).

use nalgebra::Matrix3;

use crate::numeric::dirichlet::dirichlet;
use crate::numeric::powers::larger;
use crate::numeric::superellipse::norm;
use crate::shape::filled::{Bits, eighth};
use crate::shape::jet::Jet;
use crate::shape::superellipsoid::{Superellipsoid, check_axes, check_exponents};
use crate::shape::{Filled, Implicit, InvalidShape, Mass, MassProperties, SecondOrder, SupportMap};
use crate::{Point, Vector};

/// A supercylinder about its own origin, z along its axis.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, Supercylinder}};
/// let tin = Supercylinder::new([0.03, 0.03, 0.05], 1.0)?;
/// assert!(tin.contains(&Point::new(0.0, 0.0299, 0.0499)));
/// assert!((tin.volume() - std::f64::consts::PI * 0.03 * 0.03 * 0.1).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Supercylinder {
    semi_axes: [f64; 3],
    exponent: f64,
}

impl Supercylinder {
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

    /// Volume in m³: `2 a3` times the base.
    pub fn volume(&self) -> f64 {
        2.0 * self.semi_axes[2] * base_moments(self.semi_axes, self.exponent)[0]
    }

    fn radius(&self, p: &Point) -> f64 {
        let [a1, a2, _] = self.semi_axes;
        norm((p.x / a1).abs(), (p.y / a2).abs(), 2.0 / self.exponent)
    }

    fn jet(&self, p: &Point) -> Jet {
        let [a1, a2, a3] = self.semi_axes;
        let radius = Jet::axis(0, p.x, a1).norm(&Jet::axis(1, p.y, a2), 2.0 / self.exponent);
        radius.max(&Jet::axis(2, p.z, a3))
    }
}

/// Area of a superelliptic base in m² and its second moments by x and by y in m⁴:
/// `∫xⁱyʲ = 4 a1^(i+1) a2^(j+1) D2(ε2; i, j)`.
pub(super) fn base_moments([a1, a2, _]: [f64; 3], exponent: f64) -> [f64; 3] {
    let k = 2.0 / exponent;
    let area = 4.0 * a1 * a2;
    let second = area * dirichlet(&[(k, 2.0), (k, 0.0)]);
    [area * dirichlet(&[(k, 0.0), (k, 0.0)]), a1 * a1 * second, a2 * a2 * second]
}

/// The point of a superelliptic base's rim that lies farthest along `n`, at the height 0; the centre where
/// `n` stands on the base.
pub(super) fn rim_support([a1, a2, _]: [f64; 3], exponent: f64, n: &Vector) -> Point {
    let flat = Vector::new(n.x, n.y, 0.0);
    Superellipsoid::from_checked([a1, a2, 1.0], [1.0, exponent]).support_point(&flat)
}

impl Implicit for Supercylinder {
    fn gauge(&self, p: &Point) -> f64 {
        larger(self.radius(p), (p.z / self.semi_axes[2]).abs())
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

impl SecondOrder for Supercylinder {
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        self.jet(p).hessian()
    }
}

/// By lines from the axis at the height `a3 (2t - 1)`: the volume element is `2 a1 a2 a3 r ds dt dr / n(s)²`.
impl Filled for Supercylinder {
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
        let volume = 2.0 * a1 * a2 * a3 * turn;
        for r in shares {
            each(Point::new(a1 * r * x, a2 * r * y, a3 * (2.0 * t - 1.0)), volume * r);
        }
    }
}

impl SupportMap for Supercylinder {
    /// `h(n) = a3 |n_z| + ‖(a1 n_x, a2 n_y)‖_q2` with `q = 2/(2-ε)`.
    fn support_point(&self, n: &Vector) -> Point {
        let rim = rim_support(self.semi_axes, self.exponent, n);
        Point::new(rim.x, rim.y, self.semi_axes[2].copysign(n.z))
    }
}

impl MassProperties for Supercylinder {
    fn mass_properties(&self, density: f64) -> Mass {
        let a3 = self.semi_axes[2];
        let [area, xx, yy] = base_moments(self.semi_axes, self.exponent);
        let height = 2.0 * a3 * density;
        let [x, y, z] = [height * xx, height * yy, height * area * a3 * a3 / 3.0];
        Mass {
            mass: height * area,
            centre: Point::origin(),
            inertia: Matrix3::from_diagonal(&Vector::new(y + z, x + z, x + y)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::checks;

    #[test]
    fn it_is_the_limit_of_superellipsoids() {
        let s = Supercylinder::new([0.3, 0.5, 0.4], 1.3).unwrap();
        let near = Superellipsoid::new([0.3, 0.5, 0.4], [1e-6, 1.3]).unwrap();
        for p in checks::points([0.0; 3], [0.6; 3], 50) {
            assert!((s.gauge(&p) - near.gauge(&p)).abs() < 1e-5);
        }
        assert!((s.volume() / near.volume() - 1.0).abs() < 1e-5);
    }
}
