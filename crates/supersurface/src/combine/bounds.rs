//! The box of a tree of Boolean operations.
//!
//! Unions join boxes, intersections and differences cut them; a complement has no box. A blend that adds material needs
//! the boxes of its operands' `g = 1 + δ`. A box is then widened about its middle by `1 + 2δ`, which is enough for gauges
//! that grow at least in proportion to the distance from a point of the box (all of this library's but deformed ones far
//! from their surface).

use super::program::{Kind, Program, Step};
use crate::{Point, Vector};

const EVERYTHING: [Vector; 2] = [
    Vector::new(f64::NEG_INFINITY, f64::NEG_INFINITY, f64::NEG_INFINITY),
    Vector::new(f64::INFINITY, f64::INFINITY, f64::INFINITY),
];

/// Lowest and highest corner, infinite where nothing bounds the solid.
pub(super) fn bounds(program: &Program) -> [Point; 2] {
    let mut slack = slack(program).into_iter();
    let [low, high] = program.run(
        EVERYTHING,
        |shape| slack.next().flatten().map_or(EVERYTHING, |by| widened(shape.bounds(), by)),
        |_| EVERYTHING,
        |join, first, second| match join.kind {
            Kind::Union => [first[0].inf(&second[0]), first[1].sup(&second[1])],
            Kind::Intersection => [first[0].sup(&second[0]), first[1].inf(&second[1])],
            Kind::Difference => first,
        },
    );
    // boxes that do not meet: an empty one
    let high = high.sup(&low);
    [low.into(), high.into()]
}

/// For each solid, in the program's order, how much under 0 its value may be where that of the whole is
/// not negative; `None` under a complement, where nothing bounds it.
///
/// From `f >= -δ` follows, for a blend that adds a0, `>= -(δ + a0)` of the operation alone; for `∧` the same
/// of both operands, since `f1 ∧ f2 <= min(f1, f2)`; for `∨` `-δ (1 + √((1-α)/2))` of one of them, since of
/// two negative values `|f1 ∨ f2|` is at least the smaller amount divided by that.
fn slack(program: &Program) -> Vec<Option<f64>> {
    let mut slack = Vec::new();
    let mut open = vec![Some(0.0)];
    for step in program.steps().iter().rev() {
        let own = open.pop().flatten();
        match step {
            Step::Leaf(_) => slack.push(own),
            Step::Complement => open.push(None),
            Step::Join(join) => {
                let added = join.blend.map_or(0.0, |b| b.amount().max(0.0));
                let own = own.map(|d| d + added);
                let spread = 1.0 + (0.5 * (1.0 - join.alpha.value())).sqrt();
                let (first, second) = match join.kind {
                    Kind::Union => (own.map(|d| d * spread), own.map(|d| d * spread)),
                    Kind::Intersection => (own, own),
                    Kind::Difference => (own, None),
                };
                let (lower, upper) = join.ordered(first, second);
                open.extend([lower, upper]);
            }
        }
    }
    slack.reverse();
    slack
}

/// A box widened about its middle by `1 + 2δ`.
fn widened([low, high]: [Point; 2], by: f64) -> [Vector; 2] {
    if by == 0.0 || !(high - low).iter().all(|v| v.is_finite()) {
        return [low.coords, high.coords];
    }
    let more = (high - low) * by;
    [low.coords - more, high.coords + more]
}
