//! One question to the library, and how long the answer takes.

use std::hint::black_box;
use std::time::Instant;

use supersurface::contact::{Contact, Convex, WarmStart, certify, pair, ring};
use supersurface::shape::Posed;

use super::body::Body;

/// Batches of which the best counts.
const BATCHES: u32 = 5;

/// How the contact of two bodies is asked for.
pub(super) struct Query {
    /// Width of the bounds in metres, where it must be proven.
    pub(super) tolerance: Option<f64>,
}

impl Query {
    /// The contact; it fails where lengths overflow or vanish beside others.
    pub(super) fn ask(&self, bodies: &[Body; 2]) -> Result<Contact, String> {
        let contact = match bodies {
            [Body::Convex(a), Body::Convex(b)] => self.cold(a, b),
            [Body::Ring(_), Body::Ring(_)] => {
                return Err("of two supertoroids one must be replaced by convex parts".to_owned());
            }
            _ if self.tolerance.is_some() => {
                return Err("--certify is for two superellipsoids".to_owned());
            }
            [Body::Ring(a), Body::Convex(b)] => ring(a, b).map_err(|e| e.to_string())?,
            [Body::Convex(a), Body::Ring(b)] => turned(ring(b, a).map_err(|e| e.to_string())?),
        };
        let points = contact.witnesses.iter().flat_map(|p| p.coords.iter());
        let numbers = points.chain(contact.normal.iter()).chain(&contact.bounds);
        match contact.distance.is_finite() && numbers.copied().all(f64::is_finite) {
            true => Ok(contact),
            false => {
                Err("lengths overflow, or differ by too much: are all of them metres?".to_owned())
            }
        }
    }

    /// Nanoseconds of such a query: the mean of the best batch of `repeat` queries.
    pub(super) fn time(&self, [a, b]: &[Posed<Convex>; 2], repeat: u32) -> Option<f64> {
        let batch = |_| {
            let clock = Instant::now();
            for _ in 0..repeat {
                black_box(self.cold(black_box(a), black_box(b)));
            }
            clock.elapsed().as_secs_f64() * 1e9 / f64::from(repeat)
        };
        // tenths are as fine as clocks are
        let best = (0..BATCHES).map(batch).min_by(f64::total_cmp);
        best.filter(|_| repeat > 0).map(|ns| (10.0 * ns).round() / 10.0)
    }

    /// The contact of bodies that were never asked about before.
    fn cold(&self, a: &Posed<Convex>, b: &Posed<Convex>) -> Contact {
        match self.tolerance {
            Some(tolerance) => certify(a, b, tolerance),
            None => pair(a, b, &mut WarmStart::default()),
        }
    }
}

/// The contact of the same bodies in the other order.
fn turned(mut contact: Contact) -> Contact {
    contact.normal = -contact.normal;
    contact.witnesses.reverse();
    contact
}
