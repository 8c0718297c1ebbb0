//! One question to the library, and how long the answer takes.

use std::hint::black_box;
use std::time::Instant;

use supersurface::contact::{Contact, Convex, Sliced, WarmStart, certify, pair, solids};
use supersurface::shape::Posed;

/// Batches of which the best counts.
const BATCHES: u32 = 5;

/// How the contact of two bodies is asked for.
pub(super) struct Query {
    /// Width of the bounds in metres, where it must be proven.
    pub(super) tolerance: Option<f64>,
}

impl Query {
    /// The contact; it fails where lengths overflow or vanish beside others.
    pub(super) fn ask(&self, [a, b]: &[Sliced; 2]) -> Result<Contact, String> {
        match (a.as_convex(), b.as_convex()) {
            (Some(a), Some(b)) => self.ask_convex(&[a, b]),
            _ if self.tolerance.is_some() => {
                Err("--certify is for two convex superellipsoids".to_owned())
            }
            _ => finite(solids(a, b).map_err(|e| e.to_string())?),
        }
    }

    /// The same of convex bodies.
    pub(super) fn ask_convex(&self, [a, b]: &[Posed<Convex>; 2]) -> Result<Contact, String> {
        finite(self.cold(a, b))
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

/// A contact all of whose numbers are.
fn finite(contact: Contact) -> Result<Contact, String> {
    let points = contact.witnesses.iter().flat_map(|p| p.coords.iter());
    let numbers = points.chain(contact.normal.iter()).chain(&contact.bounds);
    match contact.distance.is_finite() && numbers.copied().all(f64::is_finite) {
        true => Ok(contact),
        false => Err("lengths overflow, or differ by too much: are all of them metres?".to_owned()),
    }
}
