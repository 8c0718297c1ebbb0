//! Two sheets along the x axis: `F = (|x/a1|^p2 - |y/a2|^p2)^(ε2/ε1) - |z/a3|^p1 = 1` with `p = 2/ε`
//! (FORMULAS §2.3).

use nalgebra::Matrix3;

use super::{ANGLE_LIMIT, superhyperbola, superhyperbola_normal, superhyperbola_slopes};
use crate::numeric::powers::{power, power_difference};
use crate::numeric::superellipse::norm;
use crate::shape::angular::{finite, unit};
use crate::shape::jet::Jet;
use crate::shape::superellipsoid::{check_axes, check_exponents};
use crate::shape::{Implicit, InvalidShape, Parametric, SecondOrder};
use crate::{Direction, Point, Vector};

/// One of the two sheets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sheet {
    /// The one at positive x.
    Positive,
    /// Its mirror image at negative x.
    Negative,
}

impl Sheet {
    const fn sign(self) -> f64 {
        match self {
            Self::Positive => 1.0,
            Self::Negative => -1.0,
        }
    }
}

/// A superhyperboloid of two sheets; the solid is what the sheets contain, far out along x. As a
/// parametric surface it is the sheet at positive x; [`Self::point_on`] knows both.
///
/// ```
/// use supersurface::{Point, shape::{Implicit, Sheet, SuperhyperboloidTwoSheets}};
/// let bowls = SuperhyperboloidTwoSheets::new([0.01, 0.02, 0.02], [1.0, 1.0])?;
/// assert!(!bowls.contains(&Point::origin()));
/// assert!(bowls.contains(&Point::new(-0.02, 0.0, 0.0)));
/// assert_eq!(bowls.point_on(Sheet::Negative, 0.0, 0.0), Point::new(-0.01, 0.0, 0.0));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SuperhyperboloidTwoSheets {
    semi_axes: [f64; 3],
    exponents: [f64; 2],
}

impl SuperhyperboloidTwoSheets {
    /// Semi-axes `[a1, a2, a3]` in metres, positive (2 a1 is the gap); exponents `[ε1, ε2]` in (0, 10].
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

    /// `F`, above 1 inside the sheets (so the other way round than the gauge), 1 on the surface; infinite
    /// where it overflows. `None` for `|x/a1| < |y/a2|`, which is outside.
    pub fn implicit_value(&self, p: &Point) -> Option<f64> {
        let [x, y, z] = self.scaled(p);
        let [e1, e2] = self.exponents;
        if x < y {
            return None;
        }
        // (x^p2 - y^p2)^(1/p2), through the larger
        let rest = if x == y { 0.0 } else { -(2.0 / e2 * (y / x).ln()).exp_m1() };
        let inner = if rest == 0.0 { 0.0 } else { x * power(rest, 0.5 * e2) };
        Some(power_difference(inner, z, 2.0 / e1))
    }

    /// Surface point of a sheet at the two angles; see [`Parametric::point`].
    pub fn point_on(&self, sheet: Sheet, eta: f64, omega: f64) -> Point {
        let mut p = self.point(eta, omega);
        p.x *= sheet.sign();
        p
    }

    /// Outward unit normal of a sheet; see [`Parametric::normal`].
    pub fn normal_on(&self, sheet: Sheet, eta: f64, omega: f64) -> Option<Direction> {
        let mut n = self.normal(eta, omega)?.into_inner();
        n.x *= sheet.sign();
        Some(Direction::new_unchecked(n))
    }

    fn scaled(&self, p: &Point) -> [f64; 3] {
        let [a1, a2, a3] = self.semi_axes;
        [(p.x / a1).abs(), (p.y / a2).abs(), (p.z / a3).abs()]
    }

    fn jet(&self, p: &Point) -> Jet {
        let [a1, a2, a3] = self.semi_axes;
        let [p1, p2] = self.exponents.map(|e| 2.0 / e);
        let waist = Jet::constant(1.0).norm(&Jet::axis(2, p.z, a3), p1);
        Jet::axis(1, p.y, a2).norm(&waist, p2).over(&Jet::axis(0, p.x, a1))
    }
}

impl Implicit for SuperhyperboloidTwoSheets {
    /// `‖(y/a2, ‖(1, z/a3)‖_p1)‖_p2 / |x/a1|`: where the sheet is on the line along x through the point,
    /// over where the point is. Infinite on the plane between the sheets.
    fn gauge(&self, p: &Point) -> f64 {
        let [x, y, z] = self.scaled(p);
        let [p1, p2] = self.exponents.map(|e| 2.0 / e);
        let sheet = norm(y, norm(1.0, z, p1), p2);
        if x == 0.0 || sheet == f64::INFINITY { f64::INFINITY } else { sheet / x }
    }

    fn gradient(&self, p: &Point) -> Vector {
        self.jet(p).gradient()
    }

    /// Infinite: the sheets widen for ever.
    fn bounds(&self) -> [Point; 2] {
        [f64::NEG_INFINITY, f64::INFINITY].map(|v| Point::new(v, v, v))
    }
}

impl SecondOrder for SuperhyperboloidTwoSheets {
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        self.jet(p).hessian()
    }
}

impl Parametric for SuperhyperboloidTwoSheets {
    /// η and ω up to [`ANGLE_LIMIT`]: the sheet at positive x.
    fn domain(&self) -> [[f64; 2]; 2] {
        [[-ANGLE_LIMIT, ANGLE_LIMIT]; 2]
    }

    /// `(a1 sec^ε1 η sec^ε2 ω, a2 sec^ε1 η tan^ε2 ω, a3 tan^ε1 η)` with signed powers.
    fn point(&self, eta: f64, omega: f64) -> Point {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let ([r, z], [x, y]) = (superhyperbola(eta, e1), superhyperbola(omega, e2));
        Point::new(a1 * r * x, a2 * r * y, a3 * z)
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let ([r, _], [x, y]) = (superhyperbola(eta, e1), superhyperbola(omega, e2));
        let ([dr, dz], [dx, dy]) =
            (superhyperbola_slopes(eta, e1)?, superhyperbola_slopes(omega, e2)?);
        finite([
            Vector::new(a1 * dr * x, a2 * dr * y, a3 * dz),
            Vector::new(a1 * r * dx, a2 * r * dy, 0.0),
        ])
    }

    /// `(-sec^(2-ε1) η sec^(2-ε2) ω / a1, sec^(2-ε1) η tan^(2-ε2) ω / a2, tan^(2-ε1) η / a3)`, normalised:
    /// out of the solid, against the gradient of `F`.
    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        let [a1, a2, a3] = self.semi_axes;
        let [e1, e2] = self.exponents;
        let ([r, z], [x, y]) = (superhyperbola_normal(eta, e1)?, superhyperbola_normal(omega, e2)?);
        unit(Vector::new(-r * x / a1, r * y / a2, z / a3))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sheets_have_their_points_and_normals() {
        for exponents in [[1.0, 1.0], [0.3, 1.5], [1.9, 0.7], [0.7, 0.4]] {
            let s = SuperhyperboloidTwoSheets::new([0.3, 0.5, 0.2], exponents).unwrap();
            for (eta, omega) in [(0.1, 0.2), (-0.8, 0.9), (0.5, -0.4)] {
                let p = s.point_on(Sheet::Negative, eta, omega);
                assert!(p.x < 0.0 && (s.gauge(&p) - 1.0).abs() < 1e-12);
                assert!((s.implicit_value(&p).unwrap() - 1.0).abs() < 1e-9);
                let n = s.normal_on(Sheet::Negative, eta, omega).unwrap();
                assert!(n.dot(&s.gradient(&p)) > (1.0 - 1e-12) * s.gradient(&p).norm());
            }
        }
    }

    #[test]
    fn between_the_sheets_everything_is_outside() {
        let s = SuperhyperboloidTwoSheets::new([1.0; 3], [0.5, 1.5]).unwrap();
        let middle = Point::new(0.0, 0.3, 0.2);
        assert_eq!(s.gauge(&middle), f64::INFINITY);
        assert_eq!(s.implicit_value(&middle), None);
        assert_eq!(s.first_order_distance(&middle), f64::INFINITY);
    }
}
