//! Contacts in closed form or by one closest point: half spaces, spheres, points. (Rays: [`first_hit`].)
//!
//! Where a body is not convex these are still exact: a half space touches the convex hull first, and a sphere is the
//! points within its radius of its centre, so that its distance is the centre's less the radius.
//!
//! [`first_hit`]: crate::measure::first_hit

use super::Contact;
use crate::measure::ClosestFinder;
use crate::shape::{Implicit, Plane, Posed, SupportMap};
use crate::{Direction, Point};

/// What rounding may have done, relative to the lengths that went into a number.
const ROUNDING: f64 = 4e-15;
/// The same of a closest point, whose search ends there.
const CLOSEST: f64 = 1e-12;

/// The contact of a body with the solid half space below a plane.
///
/// ```
/// use supersurface::contact::half_space;
/// use supersurface::{Direction, Point, Pose, Vector, shape::{Plane, Posed, Supertoroid}};
/// let ring = Posed::new(Supertoroid::new([0.01; 3], 3.0, [1.0; 2])?, Pose::translation(0.0, 0.0, 0.03))?;
/// let table = Plane::through(&Point::origin(), Vector::z_axis());
/// assert!((half_space(&ring, &table).distance - 0.02).abs() < 1e-15);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn half_space<S: SupportMap>(body: &Posed<S>, plane: &Plane) -> Contact {
    let normal = -plane.normal();
    let lowest = body.support_point(&normal);
    let distance = plane.height(&lowest);
    let error = ROUNDING * (lowest.coords.norm() + plane.offset().abs());
    Contact {
        distance,
        bounds: [distance - error, distance + error],
        normal,
        witnesses: [lowest, plane.project(&lowest)],
    }
}

/// The contact of a body with a ball of a radius in metres, 0 for a point. `finder` is that of the body's shape.
///
/// `None` for a ball so far away that squares overflow, or where its centre is not finite.
///
/// ```
/// use supersurface::{Point, Pose, contact::sphere, measure::ClosestFinder};
/// use supersurface::shape::{Posed, Supertoroid};
/// let ring = Supertoroid::new([0.01; 3], 3.0, [1.0; 2])?;
/// let posed = Posed::new(ring, Pose::identity())?;
/// let in_the_hole = sphere(&posed, &ClosestFinder::supertoroid(&ring), &Point::origin(), 0.015);
/// assert!((in_the_hole.unwrap().distance - 0.005).abs() < 1e-12);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn sphere<S: Implicit>(
    body: &Posed<S>,
    finder: &ClosestFinder,
    centre: &Point,
    radius: f64,
) -> Option<Contact> {
    let local = body.to_local(centre);
    let closest = finder.find(&local)?;
    let across = (local - closest.point) * 1f64.copysign(closest.distance);
    // a centre on the surface: the surface's own normal
    let at_surface = || Direction::try_new(body.shape().gradient(&closest.point), 0.0);
    let outward = Direction::try_new(across, 1e-9 * closest.point.coords.norm())
        .or_else(at_surface)
        .or_else(|| Direction::try_new(across, 0.0))?;
    let normal = body.pose().rotation * outward;
    let distance = closest.distance - radius;
    let error = CLOSEST * (closest.point.coords.norm() + closest.distance.abs() + radius);
    Some(Contact {
        distance,
        bounds: [distance - error, distance + error],
        normal,
        witnesses: [body.pose() * closest.point, centre - normal.into_inner() * radius],
    })
}
