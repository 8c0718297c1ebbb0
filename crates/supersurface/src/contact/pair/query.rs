//! Two convex bodies: signed distance, common normal, witness points and a certificate.
//!
//! The paper asks for the nearest points of two surfaces (44) with a sign (45). That is degenerate where bodies
//! overlap, so the question is turned around: which direction separates the bodies best? Its separation is the signed
//! distance (see `difference.rs`), and Newton's method on the sphere of directions finds it. A direction bounds the
//! signed distance from below, whichever it is. Where the bodies are apart, two of their points bound it from above;
//! where they overlap, branch and bound over all directions does, and finds the least of the several minima.
//!
//! What is not guaranteed: where two minima of the depth lie within a few degrees of each other, or differ by less than
//! the bounds, the other one may be returned; the bounds hold all the same.

use super::Convex;
use super::cells::{first_guess, least};
use super::continuation::settle;
use super::descent::Minimum;
use super::difference::{Difference, FARTHEST, Triple, dot};
use super::gilbert::gilbert;
use super::proven::Proven;
use super::witness::Witnesses;
use crate::shape::Posed;
use crate::{Direction, Point, Vector};

/// How far apart two bodies are, or how deep in each other.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// Distance of the bodies in metres; negative where they overlap: minus the shortest translation that separates
    /// them.
    pub distance: f64,
    /// The true signed distance lies between these, in metres.
    pub bounds: [f64; 2],
    /// Common normal in the world, from A to B: moving B by `-distance` along it makes the bodies touch. Of several
    /// equally good ones, one.
    pub normal: Direction,
    /// The points of A's and of B's surface that are nearest, or deepest in the other body, in the world: the second less
    /// the first is `distance` times `normal`. On parallel faces one pair of many.
    pub witnesses: [Point; 2],
}

impl Contact {
    /// The contact of the same bodies in the other order.
    #[must_use]
    pub fn turned(mut self) -> Self {
        self.normal = -self.normal;
        self.witnesses.reverse();
        self
    }
}

/// What a query remembers for the next one of the same two bodies a moment later.
///
/// It changes how long the next query takes, and what it says by rounding only.
#[derive(Clone, Debug, Default)]
pub struct WarmStart {
    /// The normal in A's frame.
    normal: Option<Triple>,
    proven: Option<Box<Proven>>,
}

/// Widest bounds of the depth, in the pair's size, that [`pair`] is content with.
pub(super) const CONTENT: f64 = 1e-3;
/// Cells after which [`pair`] gives the bounds that it has.
pub(super) const CELLS: usize = 20_000;
/// The same for [`certify`].
const MANY_CELLS: usize = 3_000_000;
/// What rounding may have done to a bound, relative to the lengths that went into it.
const ROUNDING: f64 = 4e-15;

/// The contact of two bodies. Bounds are tight where they are apart, and at most a thousandth of their size (the mean
/// of the largest semi-axes) wide where they overlap, or what 20,000 cells of directions prove.
///
/// ```
/// use supersurface::contact::{Convex, WarmStart, pair};
/// use supersurface::{Pose, Vector, shape::{Posed, Superellipsoid}};
/// let cube = Convex::new(Superellipsoid::new([0.02; 3], [0.1, 0.1])?)?;
/// let at = |x: f64| Posed::new(cube, Pose::translation(x, 0.0, 0.0));
/// let mut start = WarmStart::default();
/// let apart = pair(&at(0.0)?, &at(0.05)?, &mut start);
/// assert!((apart.distance - 0.01).abs() < 1e-12 && apart.normal.x > 0.999);
/// let inside = pair(&at(0.0)?, &at(0.03)?, &mut start);
/// assert!((inside.distance + 0.01).abs() < 1e-12);
/// assert!(inside.bounds[0] <= -0.01 && -0.01 <= inside.bounds[1]);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
pub fn pair(a: &Posed<Convex>, b: &Posed<Convex>, start: &mut WarmStart) -> Contact {
    answer(a, b, start, CONTENT, CELLS).contact(a, b)
}

/// The same, with the bounds of a depth that so many cells of directions prove.
pub(in crate::contact) fn pair_by_cells(
    a: &Posed<Convex>,
    b: &Posed<Convex>,
    start: &mut WarmStart,
    cells: usize,
) -> Contact {
    answer(a, b, start, CONTENT, cells).contact(a, b)
}

/// The same with bounds at most `tolerance` wide, in metres, where rounding and three million cells allow it. For
/// depths it takes milliseconds rather than microseconds.
pub fn certify(a: &Posed<Convex>, b: &Posed<Convex>, tolerance: f64) -> Contact {
    let quick = pair(a, b, &mut WarmStart::default());
    if quick.bounds[1] - quick.bounds[0] <= tolerance {
        return quick;
    }
    let size = Difference::new(a, b).size;
    let tolerance = (tolerance / size).max(0.0);
    let mut found = answer(a, b, &mut WarmStart::default(), tolerance, MANY_CELLS).contact(a, b);
    // where the cells ran out, the coarse search may know more
    found.bounds[0] = found.bounds[0].max(quick.bounds[0]);
    found.bounds[1] = found.bounds[1].min(quick.bounds[1]);
    found
}

/// True where the bodies overlap or touch. Cheaper than [`pair`] for deep overlaps, which are not measured.
pub fn intersect(a: &Posed<Convex>, b: &Posed<Convex>) -> bool {
    let pair = Difference::new(a, b);
    let found = settle(&pair, &first_guess(&pair), f64::INFINITY);
    let value = found.expansion.value;
    // a positive minimum is not yet all of them
    value >= 0.0 && {
        let least = least(&pair, found, &mut Proven::default(), value, CELLS);
        least.minimum.expansion.value >= 0.0
    }
}

/// What was found, before it is told in the world's frame.
pub(super) struct Answer {
    pub(super) pair: Difference,
    pub(super) minimum: Minimum,
    /// A bound from below of the depth.
    least_depth: f64,
    /// False where another direction is as good.
    pub(super) unique: bool,
}

#[inline]
pub(super) fn answer(
    a: &Posed<Convex>,
    b: &Posed<Convex>,
    start: &mut WarmStart,
    tolerance: f64,
    most: usize,
) -> Answer {
    let pair = Difference::new(a, b);
    let guess = match start.normal {
        Some(n) => [n, pair.to_b(&n)],
        None => first_guess(&pair),
    };
    let minimum = settle(&pair, &guess, f64::INFINITY);
    let mut answer = Answer { pair, minimum, least_depth: f64::NEG_INFINITY, unique: true };
    if minimum.expansion.value > 0.0 {
        let proven = start.proven.get_or_insert_default();
        proven.carry(&answer.pair);
        let least = least(&answer.pair, minimum, proven, tolerance, most);
        answer.minimum = least.minimum;
        answer.least_depth = least.bound;
        answer.unique = least.unique;
        if least.bound < 0.0 && least.minimum.expansion.value > 0.0 {
            // not shown to overlap
            let other = gilbert(&answer.pair, &answer.minimum.normal);
            if other.expansion.value < answer.minimum.expansion.value {
                answer.minimum = other;
            }
        }
    }
    start.normal = Some(answer.minimum.normal[0]);
    answer
}

impl Answer {
    #[inline]
    pub(super) fn contact(&self, a: &Posed<Convex>, b: &Posed<Convex>) -> Contact {
        let (pair, found) = (&self.pair, &self.minimum);
        let n = found.normal[0];
        let distance = -found.expansion.value;
        let witnesses = Witnesses::of(a, b, pair, found);
        // of bodies that are apart no two points are nearer than the bodies
        let above = if distance >= 0.0 { witnesses.distance() } else { -self.least_depth };
        let reach = dot(&n, &pair.centre).abs() + found.expansion.value.abs();
        let error = reach * (ROUNDING + a.shape().error() + b.shape().error());
        let apart = b.pose().translation.vector - a.pose().translation.vector;
        let beyond = if apart.amax() > FARTHEST { f64::INFINITY } else { 0.0 };
        let world = |p: &Triple| a.pose() * Point::from(Vector::from(*p) * pair.size);
        Contact {
            distance: distance * pair.size,
            bounds: [
                (distance - found.slack - error) * pair.size,
                (above.max(distance) + found.slack + error) * pair.size + beyond,
            ],
            normal: Direction::new_normalize(a.pose().rotation * Vector::from(n)),
            witnesses: [world(&witnesses.of_a), world(&witnesses.of_b)],
        }
    }
}
