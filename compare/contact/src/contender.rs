//! What each library under test has to answer.

use crate::pairs::Pair;

/// A library's view of one pair. What does not depend on the poses is prepared by `new` and not timed.
pub trait Contender: Sized {
    /// Its name in tables and files.
    const NAME: &'static str;
    /// Distance, normal and witness points, in the library's own form.
    type Contact;

    /// The pair as this library holds it.
    fn new(pair: &Pair) -> Self;

    /// The pair as it is, with no memory of an earlier query: from the two poses to world normal and witnesses.
    fn cold(&self) -> Self::Contact;

    /// The pair (or, when `later`, the pair after its small motion) from the last warm answer.
    fn warm(&mut self, later: bool) -> Self::Contact;

    /// The signed distance, in metres; NaN where there is no answer.
    fn distance(contact: &Self::Contact) -> f64;

    /// Bounds of the signed distance, in metres, where the library gives them.
    fn bounds(_: &Self::Contact) -> Option<[f64; 2]> {
        None
    }
}
