//! Curvature of a level surface from gradient and second derivatives of its function (Goldman 2005).
//!
//! With the gradient `g` and the Hessian `H`, outward gradients and convex surfaces positive:
//!
//! ```text
//! mean     (|g|² tr H - gᵀHg) / (2 |g|³)
//! Gaussian gᵀ adj(H) g / |g|⁴
//! ```
//!
//! Both are invariants of the shape operator `Bᵀ H B/|g|` in an orthonormal basis `B` of the tangent plane, and the
//! principal curvatures and directions are its eigenvalues and eigenvectors. They are taken from there: the
//! quadratic equation of mean and Gaussian curvature would lose half the digits where both are nearly equal.

use nalgebra::Matrix3;

use crate::shape::{Curvature, SecondOrder};
use crate::{Direction, Point, Vector};

/// Curvature of a surface with its frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurvatureFrame {
    /// Principal curvatures, the larger first, in 1/m.
    pub curvature: Curvature,
    /// Unit tangents along which the surface bends so; any two perpendicular ones where both are equal.
    pub directions: [Direction; 2],
    /// Unit normal, along the gradient.
    pub normal: Direction,
}

/// Curvature of the level surface of the gauge through a point: of the surface itself for a point on it.
///
/// `None` where the gauge has no gradient or no second derivatives (seams, edges, the centre) and where a curvature
/// overflows. Exact up to rounding, which is largest where the gauge is steep: relative to the curvature of the
/// sharpest direction about `1e-15` times the conditioning of the Hessian.
///
/// ```
/// use supersurface::{Point, measure::implicit_curvature, shape::Superellipsoid};
/// let ball = Superellipsoid::new([0.5; 3], [1.0, 1.0])?;
/// let found = implicit_curvature(&ball, &Point::new(0.3, 0.0, 0.4)).unwrap();
/// assert!((found.curvature.gaussian() - 4.0).abs() < 1e-12);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn implicit_curvature(
    shape: &(impl SecondOrder + ?Sized),
    p: &Point,
) -> Option<CurvatureFrame> {
    level_curvature(&shape.gradient(p), &shape.hessian(p)?)
}

/// Curvature of a level surface from the gradient (1/m) and the symmetric second derivatives (1/m²) of any function
/// that grows outwards; `None` where the gradient vanishes or a number is not finite.
///
/// ```
/// use supersurface::{Vector, measure::level_curvature, nalgebra::Matrix3};
/// // f = x² + y² at (1, 0, 0), a cylinder
/// let hessian = Matrix3::from_diagonal(&Vector::new(2.0, 2.0, 0.0));
/// let found = level_curvature(&Vector::new(2.0, 0.0, 0.0), &hessian).unwrap();
/// assert_eq!(found.curvature.principal, [1.0, 0.0]);
/// assert!(found.directions[1].z.abs() == 1.0);
/// ```
pub fn level_curvature(gradient: &Vector, hessian: &Matrix3<f64>) -> Option<CurvatureFrame> {
    // scaled first: the squares of 1e200 would overflow
    let largest = gradient.amax();
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let scaled = gradient / largest;
    let slope = scaled.norm();
    let normal = Direction::new_unchecked(scaled / slope);
    let [u, v] = tangents(&normal);
    let (hu, hv) = (hessian / largest * u / slope, hessian / largest * v / slope);
    let (a, b, c) = (u.dot(&hu), 0.5 * (u.dot(&hv) + v.dot(&hu)), v.dot(&hv));
    let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
    let radius = half.hypot(b);
    let (larger, smaller) = (mean + radius, mean - radius);
    if !(larger.is_finite() && smaller.is_finite()) {
        return None;
    }
    // half the angle of (half, b) turns u to the direction of the larger
    let (sine, cosine) = (0.5 * b.atan2(half)).sin_cos();
    let first = u * cosine + v * sine;
    let second = normal.cross(&first);
    Some(CurvatureFrame {
        curvature: Curvature { principal: [larger, smaller] },
        directions: [first, second].map(Direction::new_normalize),
        normal,
    })
}

/// Two perpendicular unit tangents.
pub(super) fn tangents(normal: &Direction) -> [Vector; 2] {
    let n = normal.into_inner();
    // the axis least along the normal
    let axis = if n.x.abs() <= n.y.abs() && n.x.abs() <= n.z.abs() {
        Vector::x()
    } else if n.y.abs() <= n.z.abs() {
        Vector::y()
    } else {
        Vector::z()
    };
    let u = n.cross(&axis).normalize();
    [u, n.cross(&u)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::{Implicit, Parametric, Superellipsoid, Supertoroid};

    /// Goldman's formulas as they stand.
    fn goldman(g: &Vector, h: &Matrix3<f64>) -> [f64; 2] {
        let (square, slope) = (g.norm_squared(), g.norm());
        let mean = (square * h.trace() - (h * g).dot(g)) / (2.0 * square * slope);
        let [a, b, c] = [h.column(0), h.column(1), h.column(2)];
        let adjugate = Matrix3::from_columns(&[b.cross(&c), c.cross(&a), a.cross(&b)]);
        [mean, (adjugate * g).dot(g) / (square * square)]
    }

    fn same(found: &Curvature, truth: &Curvature, relative: f64, name: &str) {
        let size = truth.principal.iter().fold(0.0f64, |m, k| m.max(k.abs()));
        for (a, b) in found.principal.iter().zip(truth.principal) {
            assert!((a - b).abs() < relative * size, "{name}: {found:?} {truth:?}");
        }
    }

    #[test]
    fn it_is_the_curvature_of_the_fundamental_forms() {
        for case in 0..2000 {
            let mut random = Stream::new(4, case);
            let axes = [0; 3].map(|_| random.between(0.1, 1.0));
            let e = [0; 2].map(|_| random.between(0.3, 1.8));
            let (eta, omega) = (random.between(-1.5, 1.5), random.between(-3.1, 3.1));
            let s = Superellipsoid::new(axes, e).unwrap();
            let p = s.point(eta, omega);
            let found = implicit_curvature(&s, &p).unwrap();
            same(&found.curvature, &s.curvature(eta, omega).unwrap(), 1e-9, "superellipsoid");
            let [mean, gaussian] = goldman(&s.gradient(&p), &s.hessian(&p).unwrap());
            let size = found.curvature.principal[0].abs();
            assert!((found.curvature.mean() - mean).abs() < 1e-10 * size);
            assert!((found.curvature.gaussian() - gaussian).abs() < 1e-10 * size * size);
            let t = Supertoroid::new(axes, random.between(1.5, 5.0), e).unwrap();
            let eta = 2.0 * eta;
            let p = t.point(eta, omega);
            let found = implicit_curvature(&t, &p).unwrap();
            same(&found.curvature, &t.curvature(eta, omega).unwrap(), 1e-8, "supertoroid");
        }
    }

    #[test]
    fn directions_bend_as_their_curvatures_say() {
        let mut random = Stream::new(5, 0);
        for _ in 0..500 {
            let g = Vector::from_fn(|_, _| random.normal());
            let m = Matrix3::from_fn(|_, _| random.normal());
            let h = m + m.transpose();
            let found = level_curvature(&g, &h).unwrap();
            for (d, k) in found.directions.iter().zip(found.curvature.principal) {
                assert!(d.dot(&g).abs() < 1e-14 * g.norm());
                assert!(
                    ((h * d.into_inner()).dot(d) / g.norm() - k).abs()
                        < 1e-12 * h.norm() / g.norm()
                );
            }
            let mixed = (h * found.directions[0].into_inner()).dot(&found.directions[1]);
            assert!(mixed.abs() < 1e-13 * h.norm());
        }
    }

    #[test]
    fn nothing_is_said_of_no_surface() {
        let h = Matrix3::identity();
        for g in [Vector::zeros(), Vector::repeat(f64::NAN), Vector::repeat(f64::INFINITY)] {
            assert!(level_curvature(&g, &h).is_none());
        }
        assert!(level_curvature(&Vector::x(), &(h * f64::INFINITY)).is_none());
        assert!(level_curvature(&(Vector::x() * 1e-300), &(h * 1e300)).is_none());
        let ball = Superellipsoid::new([1e100; 3], [1.0; 2]).unwrap();
        let found = implicit_curvature(&ball, &Point::new(1e100, 0.0, 0.0)).unwrap();
        assert!((found.curvature.principal[0] * 1e100 - 1.0).abs() < 1e-12);
    }
}
