//! supersurface's contact queries.

use std::hint::black_box;

use supersurface::contact::{Contact, Convex, WarmStart, certify, pair};
use supersurface::shape::{Posed, Superellipsoid};

use crate::contender::Contender;
use crate::pairs::Pair;

/// A pair in supersurface's types.
pub struct Ours {
    a: Posed<Convex>,
    b: Posed<Convex>,
    b_later: Posed<Convex>,
    start: WarmStart,
}

impl Contender for Ours {
    const NAME: &'static str = "supersurface";
    type Contact = Contact;

    fn new(pair: &Pair) -> Self {
        Self {
            a: convex(&pair.a),
            b: convex(&pair.b),
            b_later: convex(&pair.b_later),
            start: WarmStart::default(),
        }
    }

    fn cold(&self) -> Contact {
        pair(black_box(&self.a), black_box(&self.b), &mut WarmStart::default())
    }

    fn warm(&mut self, later: bool) -> Contact {
        let b = if later { &self.b_later } else { &self.b };
        pair(black_box(&self.a), black_box(b), &mut self.start)
    }

    fn distance(contact: &Contact) -> f64 {
        contact.distance
    }

    fn bounds(contact: &Contact) -> Option<[f64; 2]> {
        Some(contact.bounds)
    }
}

/// The signed distance of a pair and its bounds by the slow certified mode; `tolerance` in metres.
pub fn certified(pair: &Pair, tolerance: f64) -> (f64, [f64; 2]) {
    let contact = certify(&convex(&pair.a), &convex(&pair.b), tolerance);
    (contact.distance, contact.bounds)
}

fn convex(posed: &Posed<Superellipsoid>) -> Posed<Convex> {
    let shape = Convex::new(*posed.shape()).expect("exponents up to 1.9 are convex");
    Posed::new(shape, *posed.pose()).expect("the pose was checked before")
}
