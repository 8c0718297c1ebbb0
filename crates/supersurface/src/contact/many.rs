//! Many bodies: which are near each other, and their contacts.
//!
//! A tree of the bodies' boxes (rstar) says which pairs can be within a distance; each of those is then queried. The
//! boxes are exact, by support points. The order of the result, and every number in it, is the same on any number of
//! threads.

use rstar::primitives::{GeomWithData, Rectangle};
use rstar::{AABB, RTree};

use super::{Contact, Convex, WarmStart, pair};
use crate::Vector;
use crate::shape::{Posed, SupportMap};

/// Two bodies of a list that are near each other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Neighbours {
    /// Their places in the list, the lower first.
    pub bodies: [usize; 2],
    /// Their contact, from the first to the second.
    pub contact: Contact,
}

/// All pairs of bodies that are at most `within` metres apart (0: that touch or overlap), by their places in the list.
///
/// ```
/// use supersurface::contact::{Convex, contacts};
/// use supersurface::{Pose, shape::{Posed, Superellipsoid}};
/// let ball = Convex::new(Superellipsoid::new([0.5; 3], [1.0; 2])?)?;
/// let row: Vec<_> = (0..4).map(|k| Posed::new(ball, Pose::translation(0.9 * k as f64, 0.0, 0.0)).unwrap()).collect();
/// let touching: Vec<[usize; 2]> = contacts(&row, 0.0).iter().map(|c| c.bodies).collect();
/// assert_eq!(touching, [[0, 1], [1, 2], [2, 3]]);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn contacts(bodies: &[Posed<Convex>], within: f64) -> Vec<Neighbours> {
    let candidates = near(bodies, within);
    let query = |of: &[usize; 2]| {
        let contact = pair(&bodies[of[0]], &bodies[of[1]], &mut WarmStart::default());
        (contact.distance <= within).then_some(Neighbours { bodies: *of, contact })
    };
    #[cfg(feature = "parallel")]
    {
        use rayon::prelude::*;
        candidates.par_iter().filter_map(query).collect()
    }
    #[cfg(not(feature = "parallel"))]
    candidates.iter().filter_map(query).collect()
}

/// Pairs of bodies whose boxes are at most `within` metres apart along each axis, in order.
fn near(bodies: &[Posed<Convex>], within: f64) -> Vec<[usize; 2]> {
    let boxes: Vec<[[f64; 3]; 2]> = bodies.iter().map(corners).collect();
    let entry = |(k, [low, high]): (usize, &[[f64; 3]; 2])| {
        GeomWithData::new(Rectangle::from_corners(*low, *high), k)
    };
    let tree = RTree::bulk_load(boxes.iter().enumerate().map(entry).collect());
    let mut found = Vec::new();
    for (k, [low, high]) in boxes.iter().enumerate() {
        let reach = within.max(0.0);
        let around = AABB::from_corners(low.map(|v| v - reach), high.map(|v| v + reach));
        let others = tree.locate_in_envelope_intersecting(around).map(|entry| entry.data);
        found.extend(others.filter(|other| *other > k).map(|other| [k, other]));
    }
    found.sort_unstable();
    found
}

/// Lowest and highest corner of a body's box.
fn corners(body: &Posed<Convex>) -> [[f64; 3]; 2] {
    let reach = |sign: f64| std::array::from_fn(|k| body.support_point(&Vector::ith(k, sign))[k]);
    [reach(-1.0), reach(1.0)]
}
