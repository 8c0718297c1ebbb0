//! The program that a tree of Boolean operations is kept as.
//!
//! The steps stand in postfix order, and of two operands the one that needs more stack comes first (Sethi and Ullman
//! 1970). A tree of n leaves then needs at most `1 + log2 n` values at a time, so that a fixed array will do for any
//! tree and nothing recurses.

use std::sync::Arc;

use super::rfunction::{self, Alpha, Blend};
use crate::Point;
use crate::shape::Implicit;

/// Values that a program may hold at a time: enough for 2^63 leaves.
const STACK: usize = 64;

pub(super) type Leaf = Arc<dyn Implicit + Send + Sync>;

#[derive(Clone)]
pub(super) enum Step {
    Leaf(Leaf),
    Complement,
    /// Combines the two values on top of the stack.
    Join(Join),
}

/// An operation on two solids.
#[derive(Clone, Copy, Debug)]
pub(super) struct Join {
    pub(super) kind: Kind,
    pub(super) alpha: Alpha,
    pub(super) blend: Option<Blend>,
    /// The second operand lies under the first.
    swapped: bool,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Union,
    Intersection,
    Difference,
}

impl Join {
    pub(super) const fn new(kind: Kind, alpha: Alpha, blend: Option<Blend>) -> Self {
        Self { kind, alpha, blend, swapped: false }
    }

    /// Operands in their order from the stack's, or back.
    pub(super) fn ordered<T>(&self, lower: T, upper: T) -> (T, T) {
        if self.swapped { (upper, lower) } else { (lower, upper) }
    }

    /// The value of two values, and its derivatives by them.
    pub(super) fn apply(&self, f1: f64, f2: f64) -> (f64, [f64; 2]) {
        let (mut value, mut slopes) = match self.kind {
            Kind::Union => rfunction::union(f1, f2, self.alpha),
            Kind::Intersection => rfunction::intersection(f1, f2, self.alpha),
            Kind::Difference => rfunction::difference(f1, f2, self.alpha),
        };
        if let Some(blend) = self.blend {
            let (added, turned) = blend.displacement(f1, f2);
            value += added;
            slopes = [slopes[0] + turned[0], slopes[1] + turned[1]];
        }
        (value, slopes)
    }
}

/// The steps of a tree, and how many values they hold at a time.
#[derive(Clone)]
pub(super) struct Program {
    steps: Vec<Step>,
    need: usize,
}

impl Program {
    pub(super) fn leaf(shape: Leaf) -> Self {
        Self { steps: vec![Step::Leaf(shape)], need: 1 }
    }

    pub(super) fn complemented(mut self) -> Self {
        self.steps.push(Step::Complement);
        self
    }

    pub(super) fn joined(self, other: Self, join: Join) -> Self {
        let swapped = other.need > self.need;
        let need = if self.need == other.need { self.need + 1 } else { self.need.max(other.need) };
        let (mut steps, after) =
            if swapped { (other.steps, self.steps) } else { (self.steps, other.steps) };
        steps.extend(after);
        steps.push(Step::Join(Join { swapped, ..join }));
        Self { steps, need }
    }

    pub(super) fn steps(&self) -> &[Step] {
        &self.steps
    }

    #[cfg(test)]
    pub(super) const fn need(&self) -> usize {
        self.need
    }

    /// Runs it: `leaf` gives the value of a solid, `flip` that of a complement, `join` that of two operands in
    /// their order.
    pub(super) fn run<T: Copy>(
        &self,
        start: T,
        mut leaf: impl FnMut(&Leaf) -> T,
        flip: impl Fn(T) -> T,
        join: impl Fn(&Join, T, T) -> T,
    ) -> T {
        let mut stack = [start; STACK];
        let mut top = 0;
        for step in &self.steps {
            let value = match step {
                Step::Leaf(shape) => leaf(shape),
                Step::Complement => {
                    top -= 1;
                    flip(at(&stack, top))
                }
                Step::Join(operation) => {
                    top -= 2;
                    let (first, second) = operation.ordered(at(&stack, top), at(&stack, top + 1));
                    join(operation, first, second)
                }
            };
            if let Some(place) = stack.get_mut(top) {
                *place = value;
            }
            top += 1;
        }
        at(&stack, 0)
    }
}

fn at<T: Copy>(stack: &[T; STACK], place: usize) -> T {
    stack[place.min(STACK - 1)]
}

/// `1 - g` of a leaf.
pub(super) fn leaf_value(shape: &Leaf, p: &Point) -> f64 {
    rfunction::clamped(1.0 - shape.gauge(p))
}
