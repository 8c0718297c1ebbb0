//! Where Newton's method stalls: the same pair with rounder bodies first, then sharper ones in steps.
//!
//! Flat faces (ε near 0) and sharp edges (ε near 2) are both limits of `k = ε/(2 - ε)`, at 0 and infinity. With `k`
//! kept in `[1/K, K]` a descent is easy for a small `K`; each next `K` starts where the last ended, faces where the
//! same point of the face is touched, edges where the last two directions point to, as they move like `1/K`.

use super::chart::Chart;
use super::descent::{Minimum, descend};
use super::difference::{Difference, Triple, scaled, sum, unit};
use super::gilbert::gilbert;

/// The first limit of the powers.
const FIRST: f64 = 3.0;

/// The minimum below a start, by rounder bodies if need be, or some place above it, if it is plainly no less than `worth`.
#[inline]
pub(super) fn settle(pair: &Difference, start: &[Triple; 2], worth: f64) -> Minimum {
    let direct = descend(pair, start, worth);
    if direct.settled { direct } else { otherwise(pair, &direct) }
}

/// The other ways down, from where the direct one stalled.
#[cold]
fn otherwise(pair: &Difference, direct: &Minimum) -> Minimum {
    let mut best = continued(pair, &direct.normal);
    if direct.expansion.value < best.expansion.value {
        best = *direct;
    }
    if !best.settled && best.expansion.value < 0.0 {
        let other = gilbert(pair, &best.normal);
        if other.expansion.value <= best.expansion.value {
            best = other;
        }
    }
    best
}

fn continued(pair: &Difference, start: &[Triple; 2]) -> Minimum {
    let sharpest = pair.sharpness();
    let mut limit = FIRST;
    let mut rounded = pair.rounded(limit);
    let mut here = descend(&rounded, start, f64::INFINITY);
    let mut before: Option<(f64, Triple)> = None;
    while limit < sharpest {
        let next_limit = (2.0 * limit).min(sharpest);
        let next = pair.rounded(next_limit);
        let n = here.normal;
        let mut guess = Chart::at(&rounded, &n).sharpened(&n, &rounded, &next);
        if let Some((last_limit, last)) = before {
            let ahead = (1.0 / next_limit - 1.0 / limit) / (1.0 / limit - 1.0 / last_limit);
            let moved = sum(&n[0], &scaled(&sum(&n[0], &scaled(&last, -1.0)), ahead));
            let moved = unit(&moved);
            let moved = [moved, pair.to_b(&moved)];
            if next.value(&moved) < next.value(&guess) {
                guess = moved;
            }
        }
        before = Some((limit, n[0]));
        (limit, rounded) = (next_limit, next);
        here = descend(&rounded, &guess, f64::INFINITY);
    }
    here
}
