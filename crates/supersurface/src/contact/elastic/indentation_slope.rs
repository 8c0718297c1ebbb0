//! How an indentation changes with its point.
//!
//! With `I = (1 - g)/|∇g|² ∇g` (equation 46), the unit normal `n` and the second derivatives `H` of the gauge
//!
//! ```text
//! J = ∂I/∂p = (1 - g)/|∇g|² (H - 2 n (H n)ᵀ) - n nᵀ
//! ```

use nalgebra::Matrix3;

use super::gauge_columns::Layers;
use super::indentation::{BLOCK, Indented, point_of};
use super::slope_columns::fill;
use crate::shape::{
    RadialExtended, SecondOrder, Supercylinder, Superellipsoid, Supershape, Supertoroid,
};
use crate::{Point, Vector};

/// An indentation with its derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct IndentationSlope {
    /// The indentation `I`, outwards, in metres.
    pub vector: Vector,
    /// Its derivatives `∂I/∂p`; not symmetric, as the normals are those of the foot.
    pub by_point: Matrix3<f64>,
    /// False where the surface has an infinite curvature or none (on seams): there `H` is left out.
    pub has_curvature: bool,
}

/// The same for a block of points.
#[derive(Clone, Debug, PartialEq)]
pub struct IndentationSlopes {
    /// Components of the indentations; 0 for points that are not inside.
    pub vectors: [[f64; BLOCK]; 3],
    /// Rows of the derivatives; 0 for points that are not inside.
    pub by_point: [[[f64; BLOCK]; 3]; 3],
    /// 1 for points inside whose second derivatives are left out, otherwise 0.
    pub without_curvature: [f64; BLOCK],
}

impl Default for IndentationSlopes {
    fn default() -> Self {
        Self {
            vectors: [[0.0; BLOCK]; 3],
            by_point: [[[0.0; BLOCK]; 3]; 3],
            without_curvature: [0.0; BLOCK],
        }
    }
}

/// A solid whose indentations by equation (46) have derivatives.
pub trait SmoothlyIndented: Indented + SecondOrder {
    /// The indentation of a point with its derivatives; `None` when it is not inside, and where the gauge has no
    /// gradient.
    ///
    /// ```
    /// use supersurface::{Point, contact::SmoothlyIndented, shape::Superellipsoid};
    /// let ball = Superellipsoid::new([1.0; 3], [1.0, 1.0])?;
    /// let found = ball.slope(&Point::new(0.8, 0.0, 0.0)).unwrap();
    /// assert!((found.vector.x - 0.2).abs() < 1e-15);
    /// // along the ray the depth falls as the point rises, across it the indentation turns
    /// assert!((found.by_point[(0, 0)] + 1.0).abs() < 1e-12);
    /// assert!((found.by_point[(1, 1)] - 0.2 / 0.8).abs() < 1e-12);
    /// # Ok::<(), supersurface::shape::InvalidShape>(())
    /// ```
    fn slope(&self, p: &Point) -> Option<IndentationSlope> {
        let (room, gradient) = (1.0 - self.gauge(p), self.gradient(p));
        let square = gradient.norm_squared();
        if !(room > 0.0 && square > 0.0 && square.is_finite()) {
            return None;
        }
        let (normal, hessian) = (gradient / square.sqrt(), self.hessian(p));
        let bend = hessian.map_or_else(Matrix3::zeros, |h| {
            (h - normal * (h * normal).transpose() * 2.0) * (room / square)
        });
        Some(IndentationSlope {
            vector: gradient * (room / square),
            by_point: bend - normal * normal.transpose(),
            has_curvature: hessian.is_some(),
        })
    }

    /// The same for many points, as columns of coordinates: what a hot loop calls, up to rounding.
    fn slopes(&self, points: &[[f64; BLOCK]; 3], out: &mut IndentationSlopes) {
        one_by_one(self, points, out);
    }
}

/// The plain version of [`SmoothlyIndented::slopes`].
pub(super) fn one_by_one(
    solid: &(impl SmoothlyIndented + ?Sized),
    points: &[[f64; BLOCK]; 3],
    out: &mut IndentationSlopes,
) {
    for i in 0..BLOCK {
        let found = solid.slope(&point_of(points, i));
        for r in 0..3 {
            out.vectors[r][i] = found.map_or(0.0, |f| f.vector[r]);
            for c in 0..3 {
                out.by_point[r][c][i] = found.map_or(0.0, |f| f.by_point[(r, c)]);
            }
        }
        out.without_curvature[i] = f64::from(found.is_some_and(|f| !f.has_curvature));
    }
}

impl SmoothlyIndented for Superellipsoid {
    fn slopes(&self, points: &[[f64; BLOCK]; 3], out: &mut IndentationSlopes) {
        match Layers::of_superellipsoid(self) {
            Some(layers) => fill(layers, points, out),
            None => one_by_one(self, points, out),
        }
    }
}

impl SmoothlyIndented for Supertoroid {
    fn slopes(&self, points: &[[f64; BLOCK]; 3], out: &mut IndentationSlopes) {
        match Layers::of_supertoroid(self) {
            Some(layers) => fill(layers, points, out),
            None => one_by_one(self, points, out),
        }
    }
}

impl SmoothlyIndented for Supercylinder {}
impl SmoothlyIndented for Supershape {}
impl SmoothlyIndented for RadialExtended {}

impl<S: SmoothlyIndented + ?Sized> SmoothlyIndented for &S {
    fn slope(&self, p: &Point) -> Option<IndentationSlope> {
        (**self).slope(p)
    }

    fn slopes(&self, points: &[[f64; BLOCK]; 3], out: &mut IndentationSlopes) {
        (**self).slopes(points, out);
    }
}
