//! A supertoroid and a convex body: apart, one through the other's hole, or in each other.
//!
//! A supertoroid is the union of its slices (`slices`), which are convex for ε1 up to 2. The distance is the least over
//! the slices of a convex pair's. Slices next to each other differ by at most the way of their outer edge, so that
//! intervals of angles are bounded from below and only those that could hold something nearer are halved; the best
//! is then refined (`apart`); a ball has a closest point (`ball`). Where the two overlap, the shortest translation that parts them is looked for over all
//! directions (`depth`).

mod apart;
mod ball;
mod blocked;
mod depth;
mod directions;
mod foot;
mod settle;
mod slices;

use super::{Contact, Convex, WarmStart};
use crate::shape::{InvalidShape, Posed, Supertoroid};

/// The contact of a ring with a convex body, in metres and in the world. The ring is A.
///
/// Where they overlap, the distance is minus the length of the shortest translation that was found to part them, out of the
/// ring or into its hole, and the normal its direction: where two walls of the hole hold the body, it is that of
/// no surface. For a ball that, moved out by its closest point, is clear of the rest of the ring, the true depth is that
/// point's distance less the radius, which [`sphere`](super::sphere) gives exactly; here another minimum that is nearly
/// as good may be found (1 of 40 random balls, off by 2e-6 of the size).
///
/// Bounds are a thousandth of the ring's size wide at most where they are apart. A depth is shown to be at least 0.95
/// of what was found where 300 cells of directions and 100,000 questions to slices suffice; else the bound is what they show. That it
/// is little more than was found is shown for a translation a thousandth longer, or else for one out of the ring's
/// convex hull. Exponents of 2 or near 0 can take tens of seconds, others mostly a tenth of one. What is not guaranteed: that no shorter
/// translation exists between the bounds; one through a narrow gap can be missed.
///
/// Fails for a section that is not convex (ε1 above 2).
///
/// ```
/// use supersurface::contact::{Convex, ring};
/// use supersurface::{Pose, shape::{Posed, Superellipsoid, Supertoroid}};
/// let torus = Posed::new(Supertoroid::new([0.01; 3], 3.0, [1.0; 2])?, Pose::identity())?;
/// let rod = Convex::new(Superellipsoid::new([0.005, 0.005, 0.2], [0.1, 1.0])?)?;
/// let at = |x: f64| ring(&torus, &Posed::new(rod, Pose::translation(x, 0.0, 0.0))?);
/// assert!((at(0.002)?.distance - 0.013).abs() < 1e-6);
/// assert!((at(0.017)?.distance + 0.002).abs() < 1e-6);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn ring(torus: &Posed<Supertoroid>, body: &Posed<Convex>) -> Result<Contact, InvalidShape> {
    let section = torus.shape().exponents()[0];
    InvalidShape::check(section <= 2.0, "exponent ε1", section, "at most 2 for convex slices")?;
    if let Some(found) = ball::ball(torus, body) {
        return Ok(found);
    }
    let mut start = WarmStart::default();
    match apart::nearest(torus, body, apart::CONTENT, &mut start)? {
        found if found.distance > 0.0 => Ok(found),
        _ => depth::depth(torus, body),
    }
}

/// The ring's largest half width, in metres.
fn size(torus: &Posed<Supertoroid>) -> f64 {
    let [a, b, c] = torus.shape().semi_axes();
    c.max(a.max(b) * (1.0 + torus.shape().ring_ratio()))
}
