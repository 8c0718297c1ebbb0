//! Two convex bodies: signed distance, common normal, witness points.

use super::Convex;
use super::cells::{first_guess, least};
use super::continuation::settle;
use super::difference::{Difference, dot, scaled, sum};
use crate::shape::Posed;
use crate::{Direction, Point, Vector};

/// What two bodies are to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// Signed distance.
    pub distance: f64,
    /// Bounds.
    pub bounds: [f64; 2],
    /// Normal.
    pub normal: Direction,
    /// Witnesses.
    pub witnesses: [Point; 2],
    /// debugging
    pub debug: [f64; 6],
}

/// Start.
#[derive(Clone, Copy, Debug, Default)]
pub struct WarmStart {
    normal: Option<Direction>,
}

fn query(a: &Posed<Convex>, b: &Posed<Convex>, tolerance: f64, most: usize) -> Contact {
    let pair = Difference::new(a, b);
    let mut found = settle(&pair, &first_guess(&pair));
    let first = found.evaluations;
    let mut low = found.expansion.value;
    let (mut cells, mut descents) = (0, 0);
    if found.expansion.value > 0.0 {
        let l = least(&pair, found, tolerance, most);
        found = l.minimum;
        low = l.bound;
        cells = l.cells;
        descents = l.descents;
    }
    let n = found.normal[0];
    let xa = found.expansion.points[0];
    let xb = sum(&pair.centre, &scaled(&pair.to_a(&found.expansion.points[1]), -1.0));
    let world =
        |p: &[f64; 3]| a.pose() * Point::new(p[0] * pair.size, p[1] * pair.size, p[2] * pair.size);
    let across = sum(&xb, &scaled(&xa, -1.0));
    let hi = if found.expansion.value < 0.0 { dot(&across, &across).sqrt() } else { -low };
    let normal = a.pose().rotation * Vector::new(n[0], n[1], n[2]);
    Contact {
        distance: -found.expansion.value * pair.size,
        bounds: [-found.expansion.value * pair.size, hi * pair.size],
        normal: Direction::new_normalize(normal),
        witnesses: [world(&xa), world(&xb)],
        debug: [
            f64::from(first),
            cells as f64,
            descents as f64,
            f64::from(u8::from(found.settled)),
            found.slope(),
            (hi + found.expansion.value),
        ],
    }
}

/// Pair.
pub fn pair(a: &Posed<Convex>, b: &Posed<Convex>, start: &mut WarmStart) -> Contact {
    let found = query(a, b, 1e-3, std::env::var("MOST").ok().map_or(20_000,|s|s.parse().unwrap()));
    start.normal = Some(found.normal);
    found
}

/// Certify.
pub fn certify(a: &Posed<Convex>, b: &Posed<Convex>, tolerance: f64) -> Contact {
    query(a, b, tolerance, 3_000_000)
}
