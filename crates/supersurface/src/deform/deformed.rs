//! A shape with a deformation: itself a shape.
//!
//! Gauge by pull-back, `g(T⁻¹(p))`; gradient `J^{-T} ∇g`; surface points by `T`, tangents by `J`, normals along
//! `J^{-T} n` (FORMULAS §4). The gauge of a bent or twisted solid is not homogeneous, and no distance along a ray.

use nalgebra::Matrix3;

use super::Deformation;
use crate::numeric::quarter_angle::QuarterAngle;
use crate::shape::{Implicit, InvalidShape, Parametric, box_extent};
use crate::{Direction, Point, Vector};

/// A shape whose points a deformation has moved, in the same frame.
///
/// ```
/// use supersurface::deform::{Deformed, Taper};
/// use supersurface::{Point, shape::{Implicit, Superellipsoid}};
/// let tin = Superellipsoid::new([0.03, 0.03, 0.05], [0.1, 1.0])?;
/// let cup = Deformed::new(tin, Taper::new([0.2, 0.2], 0.05)?)?;
/// assert!(cup.contains(&Point::new(0.033, 0.0, 0.045)));
/// assert!(!cup.contains(&Point::new(0.033, 0.0, -0.045)));
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deformed<S, D> {
    shape: S,
    deformation: D,
    bounds: [Point; 2],
}

impl<S: Implicit, D: Deformation> Deformed<S, D> {
    /// Fails when the deformation is not one to one over the shape (a factor of a taper that reaches 0, a bend that
    /// folds), which is judged by the shape's extents.
    pub fn new(shape: S, deformation: D) -> Result<Self, InvalidShape> {
        deformation.check_over(&shape)?;
        let [low, high] = deformation.bounds_over(&shape);
        // rounding of a few bits must not cut the solid
        let margin = |low: f64, high: f64| {
            let m = 1e-14 * low.abs().max(high.abs());
            if m.is_finite() { [low - m, high + m] } else { [low, high] }
        };
        let (x, y, z) = (margin(low.x, high.x), margin(low.y, high.y), margin(low.z, high.z));
        let bounds = [Point::new(x[0], y[0], z[0]), Point::new(x[1], y[1], z[1])];
        Ok(Self { shape, deformation, bounds })
    }
}

impl<S, D: Deformation> Deformed<S, D> {
    /// The shape before the deformation.
    pub const fn shape(&self) -> &S {
        &self.shape
    }

    /// The same solid with its undeformed shape in another type, which must say the same of it.
    pub(crate) fn mapped<T>(self, to: impl FnOnce(S) -> T) -> Deformed<T, D> {
        Deformed { shape: to(self.shape), deformation: self.deformation, bounds: self.bounds }
    }

    /// The deformation.
    pub const fn deformation(&self) -> &D {
        &self.deformation
    }

    /// Where a point comes from; `None` where nothing is mapped to, or too far for a number.
    pub fn pull_back(&self, p: &Point) -> Option<Point> {
        self.deformation.inverse(p).filter(|q| q.iter().all(|v| v.is_finite()))
    }
}

impl<S: Implicit, D: Deformation> Implicit for Deformed<S, D> {
    /// `g(T⁻¹(p))`, infinite where there is no inverse.
    fn gauge(&self, p: &Point) -> f64 {
        self.pull_back(p).map_or(f64::INFINITY, |q| self.shape.gauge(&q))
    }

    /// `J^{-T} ∇g`, zero where there is no inverse.
    fn gradient(&self, p: &Point) -> Vector {
        let pulled = self.pull_back(p).and_then(|q| {
            let jacobian = self.deformation.jacobian(&q);
            let det = jacobian.determinant();
            let gradient = cofactors(&jacobian) * self.shape.gradient(&q) / det;
            gradient.iter().all(|v| v.is_finite()).then_some(gradient)
        });
        pulled.unwrap_or_else(Vector::zeros)
    }

    fn bounds(&self) -> [Point; 2] {
        self.bounds
    }

    fn extent(&self, n: &Vector) -> f64 {
        self.deformation.extent_over(&self.shape, n).min(box_extent(&self.bounds, n))
    }
}

impl<S: Parametric, D: Deformation> Parametric for Deformed<S, D> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.shape.domain()
    }

    fn point(&self, eta: f64, omega: f64) -> Point {
        self.deformation.forward(&self.shape.point(eta, omega))
    }

    fn point_at(&self, eta: QuarterAngle, omega: QuarterAngle) -> Point {
        self.deformation.forward(&self.shape.point_at(eta, omega))
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        let jacobian = self.deformation.jacobian(&self.shape.point(eta, omega));
        let tangents = self.shape.tangents(eta, omega)?.map(|t| jacobian * t);
        tangents.iter().flat_map(Vector::iter).all(|v| v.is_finite()).then_some(tangents)
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        let normal = self.shape.normal(eta, omega)?;
        let jacobian = self.deformation.jacobian(&self.shape.point(eta, omega));
        Direction::try_new(cofactors(&jacobian) * normal.into_inner(), 0.0)
    }
}

/// `det(J) J^{-T}`: the columns are the cross products of the other two. It exists where the inverse does not.
fn cofactors(jacobian: &Matrix3<f64>) -> Matrix3<f64> {
    let [a, b, c] = [jacobian.column(0), jacobian.column(1), jacobian.column(2)];
    Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::deform::{Bend, Taper, Twist};
    use crate::numeric::random::Stream;
    use crate::shape::Superellipsoid;

    #[test]
    fn deformations_nest() {
        let shape = Superellipsoid::new([0.1, 0.15, 0.5], [0.4, 0.7]).unwrap();
        let tapered = Deformed::new(shape, Taper::new([0.5, -0.3], 0.5).unwrap()).unwrap();
        let twisted = Deformed::new(tapered, Twist::new(0.4, 0.5).unwrap()).unwrap();
        let solid = Deformed::new(twisted, Bend::new(2.0, 0.6).unwrap()).unwrap();
        let [low, high] = solid.bounds();
        let mut stream = Stream::new(2, 0);
        for _ in 0..500 {
            let (eta, omega) = (stream.between(-1.5, 1.5), stream.between(-3.1, 3.1));
            let p = solid.point(eta, omega);
            assert!((solid.gauge(&p) - 1.0).abs() < 1e-9);
            assert!((p - low).min() >= 0.0 && (high - p).min() >= 0.0);
            let (normal, gradient) = (solid.normal(eta, omega).unwrap(), solid.gradient(&p));
            assert!(normal.dot(&gradient) > (1.0 - 1e-9) * gradient.norm());
            let step = 1e-6;
            for axis in 0..3 {
                let h = Vector::ith(axis, step);
                // away from the seams of the box, where the second derivatives are large
                let q = p + (p - Point::origin()) * 0.1;
                let slope = (solid.gauge(&(q + h)) - solid.gauge(&(q - h))) / (2.0 * step);
                let exact = solid.gradient(&q)[axis];
                assert!((slope - exact).abs() < 1e-4 * solid.gradient(&q).norm());
            }
        }
    }

    #[test]
    fn any_point_has_a_gauge() {
        let shape = Superellipsoid::new([0.1, 0.15, 0.5], [0.1, 0.1]).unwrap();
        let solid = Deformed::new(shape, Taper::new([0.9, -0.9], 0.5).unwrap()).unwrap();
        let solid = Deformed::new(solid, Bend::new(-3.0, 0.6).unwrap()).unwrap();
        let values = [0.0, 5e-324, -1e-300, 0.3, 1e18, -1e308, f64::MAX];
        for x in values {
            for y in values {
                for z in values {
                    let p = Point::new(x, y, z);
                    assert!(!solid.gauge(&p).is_nan(), "{p}");
                    assert!(solid.gradient(&p).iter().all(|v| v.is_finite()), "{p}");
                }
            }
        }
    }
}
