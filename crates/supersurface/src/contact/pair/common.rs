//! A point in two bodies: the proof that they overlap.
//!
//! A point is in a convex body where its gauge is at most 1, so one in both is where the larger of two gauges is. That
//! is a convex function, and the middle of the witness points is often there; if not, the ellipsoid method finds a
//! place, or a volume too small to hold one.

use super::{Contact, Convex};
use crate::shape::{Implicit, Posed};
use crate::{Point, Vector};
use nalgebra::Matrix3;

/// Steps of the ellipsoid method: each takes a sixth of the volume.
const STEPS: usize = 1000;

/// A point of both bodies, in the world, as far inside as was needed to be sure; `None` for bodies that are apart, or that
/// touch so lightly that rounding decides. With the point of a `contact` nobody need trust its depth to know that the
/// bodies overlap: the gauges of the shapes say it.
///
/// ```
/// use supersurface::contact::{Convex, WarmStart, common_point, pair};
/// use supersurface::{Pose, shape::{Implicit, Posed, Superellipsoid}};
/// let cube = Convex::new(Superellipsoid::new([0.02; 3], [0.1, 0.1])?)?;
/// let at = |x: f64| Posed::new(cube, Pose::translation(x, 0.0, 0.0));
/// let (a, b) = (at(0.0)?, at(0.03)?);
/// let found = common_point(&a, &b, &pair(&a, &b, &mut WarmStart::default())).unwrap();
/// assert!(cube.shape().gauge(&a.to_local(&found)) < 1.0);
/// assert!(cube.shape().gauge(&b.to_local(&found)) < 1.0);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn common_point(a: &Posed<Convex>, b: &Posed<Convex>, contact: &Contact) -> Option<Point> {
    let bodies = [a, b];
    if contact.bounds[0] > 0.0 {
        return None;
    }
    let [on_a, on_b] = contact.witnesses;
    let guesses = [nalgebra::center(&on_a, &on_b), on_a, on_b];
    guesses.into_iter().find(|p| gauge(&bodies, p).0 <= 1.0).or_else(|| search(&bodies))
}

/// The larger gauge of a point, and whose it is.
fn gauge(bodies: &[&Posed<Convex>; 2], p: &Point) -> (f64, usize) {
    let [a, b] = bodies.map(|body| body.shape().shape().gauge(&body.to_local(p)));
    if a >= b { (a, 0) } else { (b, 1) }
}

/// The ellipsoid method (Shor 1977) from a ball around the smaller body.
fn search(bodies: &[&Posed<Convex>; 2]) -> Option<Point> {
    let reach = bodies.map(|body| Vector::from(body.shape().shape().semi_axes()).norm());
    let smaller = usize::from(reach[1] < reach[0]);
    let mut middle = Point::from(bodies[smaller].pose().translation.vector);
    // (x - middle)ᵀ m⁻¹ (x - middle) <= 1, in units of the reach
    let mut m = Matrix3::identity();
    for _ in 0..STEPS {
        let (value, which) = gauge(bodies, &middle);
        if value <= 1.0 {
            return Some(middle);
        }
        let body = bodies[which];
        let steep = body.pose().rotation * body.shape().shape().gradient(&body.to_local(&middle));
        let steep = steep.try_normalize(0.0)?;
        let length = steep.dot(&(m * steep)).sqrt();
        if length.is_nan() || length <= 1e-15 {
            return None;
        }
        let step = m * steep / length;
        middle -= step * (0.25 * reach[smaller]);
        m = (m - step * step.transpose() * 0.5) * 1.125;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Pose;
    use crate::shape::Superellipsoid;

    #[test]
    fn the_search_finds_a_corner_in_a_corner() {
        let cube = Convex::new(Superellipsoid::new([0.02; 3], [0.02, 0.02]).unwrap()).unwrap();
        let at = |v: f64| Posed::new(cube, Pose::translation(v, v, v)).unwrap();
        for (apart, overlap) in [(0.0395, true), (0.039, true), (0.0397, false)] {
            let found = search(&[&at(0.3), &at(0.3 + apart)]);
            assert_eq!(found.is_some(), overlap, "{apart} {found:?}");
            assert!(found.is_none_or(|p| gauge(&[&at(0.3), &at(0.3 + apart)], &p).0 <= 1.0));
        }
    }
}
