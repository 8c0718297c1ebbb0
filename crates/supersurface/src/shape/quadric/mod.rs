//! General quadrics: every surface of the second degree (equations 1 to 4).
//!
//! `A x² + B y² + C z² + D xy + E yz + F xz + G x + H y + I z + J = 0` (equation 3), that is
//! `xᵀMx + N·x + P = 0` with `M = [[A, D/2, F/2], [D/2, B, E/2], [F/2, E/2, C]]`, `N = (G, H, I)`, `P = J`.
//! [`Quadric::normal_form`] says which of the 17 types it is, where it stands and how large it is.

mod kind;
mod normal_form;

pub use kind::QuadricType;
pub use normal_form::NormalForm;

use nalgebra::Matrix3;

use crate::shape::{InvalidShape, Posed, Superellipsoid};
use crate::{Point, Vector};

/// A quadric by the ten coefficients of equation (3). Which side is inside is not said: the equation times -1
/// is the same quadric.
///
/// ```
/// use supersurface::shape::{Quadric, QuadricType};
/// // x² + 4 y² + z² - 2 x - 3 = 0
/// let q = Quadric::new([1.0, 4.0, 1.0, 0.0, 0.0, 0.0, -2.0, 0.0, 0.0, -3.0])?;
/// assert_eq!(q.normal_form().kind, QuadricType::Ellipsoid);
/// let ellipsoid = q.as_ellipsoid().unwrap();
/// assert!((ellipsoid.pose().translation.x - 1.0).abs() < 1e-15);
/// assert!((ellipsoid.shape().semi_axes()[2] - 1.0).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quadric {
    coefficients: [f64; 10],
}

impl Quadric {
    /// `[A, B, C, D, E, F, G, H, I, J]` of equation (3), finite; the largest of A to F at least 1e-100 of the
    /// largest of all (otherwise it is a plane, nothing or everything).
    pub fn new(coefficients: [f64; 10]) -> Result<Self, InvalidShape> {
        for v in coefficients {
            InvalidShape::check(v.is_finite(), "a coefficient of the quadric", v, "finite")?;
        }
        let quadric = Self { coefficients };
        let (second, all) = (quadric.largest(6), quadric.largest(10));
        let what = "the largest coefficient of second degree";
        let range = "not zero, and at least 1e-100 of the largest of all";
        InvalidShape::check(second > 0.0 && second >= 1e-100 * all, what, second, range)?;
        Ok(quadric)
    }

    /// `[A, B, C, D, E, F, G, H, I, J]`.
    pub const fn coefficients(&self) -> [f64; 10] {
        self.coefficients
    }

    /// The left side of equation (3); infinite or meaningless where its terms overflow.
    pub fn value(&self, p: &Point) -> f64 {
        let (m, n, constant) = self.parts(1.0);
        let value = p.coords.dot(&(m * p.coords + n)) + constant;
        if value.is_nan() { f64::INFINITY } else { value }
    }

    /// Its gradient `2 M x + N`.
    pub fn gradient(&self, p: &Point) -> Vector {
        let (m, n, _) = self.parts(1.0);
        (m * p.coords) * 2.0 + n
    }

    /// The ellipsoid that it is, with semi-axes falling from x to z, if it is one.
    pub fn as_ellipsoid(&self) -> Option<Posed<Superellipsoid>> {
        self.normal_form().as_ellipsoid()
    }

    /// `M`, `N` and `P` over `scale`.
    fn parts(&self, scale: f64) -> (Matrix3<f64>, Vector, f64) {
        let [a, b, c, d, e, f, g, h, i, j] = self.coefficients.map(|v| v / scale);
        let (d, e, f) = (0.5 * d, 0.5 * e, 0.5 * f);
        (Matrix3::new(a, d, f, d, b, e, f, e, c), Vector::new(g, h, i), j)
    }

    /// The largest magnitude among the first coefficients.
    fn largest(&self, count: usize) -> f64 {
        self.coefficients.iter().take(count).fold(0.0, |m, v| m.max(v.abs()))
    }
}
