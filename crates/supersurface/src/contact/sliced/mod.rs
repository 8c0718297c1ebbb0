//! Members that are not convex, or have no support function: apart, one through the other's hole or bow, or in each other.
//!
//! Both bodies are unions of flat convex slices (`body`; `ring`, `stack`), or whole where they are convex. The distance is the least over
//! the pairs of slices of a convex pair's. Slices next to each other differ by at most the way between them, so that
//! intervals of places are bounded from below and only those that could hold something nearer are halved (`apart`); the best
//! is refined by slopes that are known exactly (`lowest`). A ball and a ring have a closest point (`ball`). Where the two
//! overlap, the shortest translation that parts them is looked for over all directions (`depth`).

mod apart;
mod ball;
mod blocked;
mod body;
mod depth;
mod directions;
mod foot;
mod grid;
mod lowest;
mod outline;
mod ring;
mod settle;
mod slice;
mod stack;

pub use body::{NotSliced, Sliced};

use super::{Contact, WarmStart, pair};
use crate::shape::InvalidShape;

/// The contact of two members of the family, in metres and in the world. Two convex superellipsoids are a [`pair`].
///
/// Where they overlap, the distance is minus the length of the shortest translation that was found to part them, out of
/// the one or into its hole, and the normal its direction: where two walls of a hole hold the body, it is that of
/// no surface. For a ball that, moved out by its closest point, is clear of the rest of a ring, the true depth is that
/// point's distance less the radius, which [`sphere`](super::sphere) gives exactly; here another minimum that is nearly
/// as good may be found.
///
/// Bounds are a millionth of the smaller body's size wide where they are apart, or what 4,000 pairs of slices show. A depth
/// is shown to be at least 0.95 of what was found where 300 cells of directions and 50,000 questions to slices suffice;
/// else the bound is what they show. That it is little more than was found is shown for a translation a thousandth
/// longer, or else for one out of the convex hull. The translation parts all slices, those between the ones that were asked
/// at first too, but for a millionth of the size. What is not guaranteed: that no shorter one exists between
/// the bounds; one through a narrow gap can be missed. Where one body is cut, a depth mostly takes a tenth of a second;
/// where both are, or with exponents of 2 or near 0, seconds, and up to tens.
///
/// Fails where lengths overflow.
///
/// ```
/// use supersurface::contact::{Sliced, solids};
/// use supersurface::shape::{Posed, Superellipsoid, Supertoroid};
/// use supersurface::{Pose, surface::Solid};
/// let torus = Solid::from(Supertoroid::new([0.01; 3], 3.0, [1.0; 2])?);
/// let torus = Sliced::new(&Posed::new(torus, Pose::identity())?).unwrap();
/// let rod = Solid::from(Superellipsoid::new([0.005, 0.005, 0.2], [0.1, 1.0])?);
/// let at = |x: f64| {
///     let posed = Posed::new(rod.clone(), Pose::translation(x, 0.0, 0.0))?;
///     solids(&torus, &Sliced::new(&posed).unwrap())
/// };
/// assert!((at(0.002)?.distance - 0.013).abs() < 1e-6);
/// assert!((at(0.017)?.distance + 0.002).abs() < 1e-6);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn solids(a: &Sliced, b: &Sliced) -> Result<Contact, InvalidShape> {
    let mut start = WarmStart::default();
    if let (Some(a), Some(b)) = (a.as_convex(), b.as_convex()) {
        return Ok(pair(&a, &b, &mut start));
    }
    if let Some(found) = ball::ball(a, b).or_else(|| ball::ball(b, a).map(Contact::turned)) {
        return Ok(found);
    }
    match apart::nearest([a, b], apart::CONTENT, 0.0, &mut start)?.contact {
        found if found.distance > 0.0 => Ok(found),
        _ => depth::depth([a, b]),
    }
}
