//! The signed distance that all answers are judged by: this is the one place where it is chosen.

use crate::ours;
use crate::pairs::Pair;

/// Bounds are to be no wider than this share of size.
pub const WIDTH: f64 = 1e-10;

/// A signed distance to trust.
#[derive(Clone, Copy, Debug)]
pub struct Trusted {
    /// In metres; NaN where nothing is known.
    pub distance: f64,
    /// Width of the bounds that certify it, in metres; 0 where it is exact by construction.
    pub width: f64,
    /// True where supersurface's certified bounds leave out what is exact by construction. A fault of ours.
    pub disputed: bool,
}

/// Exact by construction where it can be, so that our own code judges itself only where nothing else can;
/// otherwise by supersurface's slow certified mode.
pub fn trusted(pair: &Pair) -> Trusted {
    let (distance, [low, high]) = ours::certified(pair, WIDTH * pair.size);
    match pair.constructed {
        Some(exact) => {
            let slack = 1e-13 * pair.size; // of the construction's own rounding
            let disputed = !(low - slack..=high + slack).contains(&exact);
            Trusted { distance: exact, width: 0.0, disputed }
        }
        None => Trusted { distance, width: high - low, disputed: false },
    }
}
