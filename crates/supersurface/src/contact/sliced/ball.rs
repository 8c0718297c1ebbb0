//! A ball and a ring: the closest point answers.
//!
//! The signed distance of a point to the ring changes by no more than the point moves. So a ball that overlaps the ring
//! is as deep as its radius is longer than its centre's distance, or deeper; and where it is clear of the ring once it has
//! moved so far away from its closest point, it is exactly so deep.

use super::body::Sliced;
use crate::contact::{Contact, sphere};
use crate::measure::ClosestFinder;
use crate::shape::Posed;
use crate::surface::Solid;

/// A ball that moved out is clear where it overlaps the rest by no more than this, relative to its radius.
const CLEAR: f64 = 1e-11;

/// The contact of a ring with a ball, where its closest point answers; `None` for other bodies.
pub(super) fn ball(ring: &Sliced, ball: &Sliced) -> Option<Contact> {
    let Solid::Supertoroid(shape) = ring.solid().shape() else { return None };
    let Solid::Superellipsoid(round) = ball.solid().shape() else { return None };
    let [radius, b, c] = round.semi_axes();
    if round.exponents() != [1.0; 2] || b != radius || c != radius {
        return None;
    }
    let torus = Posed::new(*shape, *ring.solid().pose()).ok()?;
    let finder = ClosestFinder::supertoroid(shape);
    let centre = ball.solid().pose().translation.vector.into();
    let contact = sphere(&torus, &finder, &centre, radius)?;
    if contact.distance > 0.0 {
        return Some(contact);
    }
    let out = centre - contact.normal.into_inner() * contact.distance;
    let moved = sphere(&torus, &finder, &out, radius)?;
    (moved.distance > -CLEAR * radius).then_some(contact)
}
