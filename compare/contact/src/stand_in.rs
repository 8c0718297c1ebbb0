//! Stands in for `ours.rs` until supersurface has contact queries: parry's answers under another name.

use crate::contender::Contender;
use crate::pairs::Pair;
use crate::parry64::Parry64;

/// True: these are not supersurface's answers.
pub const STAND_IN: bool = true;

/// parry, called ours.
pub struct Ours(Parry64);

impl Contender for Ours {
    const NAME: &'static str = "stand-in";
    type Contact = <Parry64 as Contender>::Contact;

    fn new(pair: &Pair) -> Self {
        Self(Parry64::new(pair))
    }

    fn cold(&self) -> Self::Contact {
        self.0.cold()
    }

    fn warm(&mut self, later: bool) -> Self::Contact {
        self.0.warm(later)
    }

    fn distance(contact: &Self::Contact) -> f64 {
        Parry64::distance(contact)
    }
}

/// Nothing is certified yet.
pub fn certified(_: &Pair, _: f64) -> (f64, [f64; 2]) {
    (f64::NAN, [f64::NEG_INFINITY, f64::INFINITY])
}
