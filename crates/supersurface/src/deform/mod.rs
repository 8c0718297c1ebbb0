//! Floor 4: smooth maps of space that make new shapes of old ones (FORMULAS §4, equations 20 to 22).
//!
//! A [`Deformation`] `T` acts on a shape's own coordinates; [`Deformed`] joins both to a shape, so that
//! deformations nest. The order of composition is taper, then twist, then bend, then the rigid pose:
//!
//! ```
//! use supersurface::deform::{Bend, Deformed, Taper, Twist};
//! use supersurface::{Point, shape::{Implicit, Superellipsoid}};
//! let stick = Superellipsoid::new([0.01, 0.01, 0.06], [0.3, 1.0])?;
//! let stick = Deformed::new(stick, Taper::new([-0.4, -0.4], 0.06)?)?;
//! let stick = Deformed::new(stick, Twist::new(0.25, 0.06)?)?;
//! let banana = Deformed::new(stick, Bend::new(12.0, 0.0)?)?;
//! assert!(banana.contains(&Point::origin()));
//! assert!(!banana.contains(&Point::new(0.0, 0.0, 0.0599)));
//! # Ok::<(), supersurface::shape::InvalidShape>(())
//! ```

mod bend;
mod cavity;
mod deformed;
mod mass;
mod pull_back;
mod shear_bend;
mod support;
mod taper;
mod tapered_radial;
mod twist;

use nalgebra::Matrix3;

pub use bend::Bend;
pub use cavity::Cavity;
pub use deformed::Deformed;
pub use pull_back::Adjustable;
pub use shear_bend::ShearBend;
pub use taper::Taper;
pub use twist::Twist;

use crate::shape::{Implicit, InvalidShape};
use crate::{Point, Vector};

/// What becomes of a solid's sections across z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sections {
    /// Each stays at its height; the map is linear on it and its determinant constant.
    Kept,
    /// Each is a plane somewhere; the map and its determinant are linear on it.
    Moved,
    /// They are no planes any more.
    Curved,
}

/// A smooth map of a shape's own coordinates, one to one over the solids that
/// [`check_over`](Self::check_over) accepts.
///
/// Lengths are in metres. The determinant of the Jacobian is positive over such solids, so that the inside stays
/// inside.
pub trait Deformation {
    /// Where a point of the undeformed solid goes.
    fn forward(&self, p: &Point) -> Point;

    /// Where a point of the deformed solid comes from; `None` where nothing is mapped to (outside of every
    /// solid that [`check_over`](Self::check_over) accepts).
    fn inverse(&self, p: &Point) -> Option<Point>;

    /// `∂ forward_i / ∂p_j` at an undeformed point.
    fn jacobian(&self, p: &Point) -> Matrix3<f64>;

    /// What becomes of sections across z. Where they stay plane, mass is an integral along z alone.
    fn sections(&self) -> Sections {
        Sections::Curved
    }

    /// Fails with the quantity that is out of range unless the map is one to one over the solid.
    fn check_over(&self, solid: &dyn Implicit) -> Result<(), InvalidShape>;

    /// Corners of a box (lowest, highest) that contains the deformed solid.
    fn bounds_over(&self, solid: &dyn Implicit) -> [Point; 2];

    /// An upper bound of `n·x` over the deformed solid, where it is less than that of the box; infinite otherwise.
    fn extent_over(&self, _solid: &dyn Implicit, _n: &Vector) -> f64 {
        f64::INFINITY
    }
}

/// The range of `n·x` over a solid.
fn range(solid: &dyn Implicit, n: &Vector) -> [f64; 2] {
    [-solid.extent(&-n), solid.extent(n)]
}

/// `sin s / s`.
fn sinc(s: f64) -> f64 {
    if s.abs() < 1e-4 { 1.0 - s * s / 6.0 } else { s.sin() / s }
}

/// What the tests of all deformations share.
#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Stream;
    use crate::shape::{Parametric, Superellipsoid};

    fn inside(stream: &mut Stream, a: [f64; 3]) -> Point {
        Point::from(a.map(|a| stream.between(-a, a)))
    }

    /// Inverse of forward; Jacobian against differences and of positive determinant.
    pub(super) fn is_a_map(map: &dyn Deformation, a: [f64; 3]) {
        let mut stream = Stream::new(3, 0);
        let size = a.into_iter().fold(0.0, f64::max);
        for _ in 0..300 {
            let p = inside(&mut stream, a);
            let back = map.inverse(&map.forward(&p)).unwrap();
            assert!((back - p).amax() < 1e-13 * size, "{p} came back as {back}");
            let jacobian = map.jacobian(&p);
            assert!(jacobian.determinant() > 0.0);
            let step = 1e-5 * size;
            for axis in 0..3 {
                let h = Vector::ith(axis, step);
                let slope = (map.forward(&(p + h)) - map.forward(&(p - h))) / (2.0 * step);
                assert!((slope - jacobian.column(axis)).amax() < 1e-6, "axis {axis} at {p}");
            }
        }
    }

    /// Surface points have gauge 1, lie in the box and within the extents; normals are the gradient's; the volume
    /// that random points in the box find is `ratio` times the undeformed one.
    pub(super) fn is_a_solid<D: Deformation>(
        shape: Superellipsoid,
        solid: &Deformed<Superellipsoid, D>,
        ratio: f64,
    ) {
        let [low, high] = solid.bounds();
        let size = (high - low).amax();
        let mut stream = Stream::new(5, 0);
        for _ in 0..2000 {
            let (eta, omega) = (stream.between(-1.5, 1.5), stream.between(-3.1, 3.1));
            let p = solid.point(eta, omega);
            assert!((solid.gauge(&p) - 1.0).abs() < 1e-9, "{}", solid.gauge(&p));
            assert!((p - low).min() >= 0.0 && (high - p).min() >= 0.0, "{p} of {low} {high}");
            let n = Vector::new(stream.normal(), stream.normal(), stream.normal());
            assert!(n.dot(&p.coords) <= solid.extent(&n) + 1e-12 * size);
            let normal = solid.normal(eta, omega).unwrap().into_inner();
            let gradient = solid.gradient(&p).normalize();
            assert!((normal - gradient).amax() < 1e-5, "{normal} {gradient}");
            let [t, u] = solid.tangents(eta, omega).unwrap();
            let across = u.cross(&t);
            assert!(normal.dot(&across) > (1.0 - 1e-9) * across.norm());
        }
        let count = 400_000;
        let hits = (0..count)
            .filter(|_| {
                let p = Point::from(low.coords.zip_map(&high.coords, |l, h| stream.between(l, h)));
                solid.contains(&p)
            })
            .count() as f64;
        let share = hits / f64::from(count);
        let volume = share * (high - low).product();
        let error = ((1.0 - share) / hits).sqrt();
        let found = volume / (shape.volume() * ratio) - 1.0;
        assert!(found.abs() < 4.0 * error, "volume off by {found}, expected {error}");
    }
}
