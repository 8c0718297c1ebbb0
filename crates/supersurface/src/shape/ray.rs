//! A half line.

use crate::{Direction, Point};

/// A half line from `origin` along `direction`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where the ray starts.
    pub origin: Point,
    /// Unit direction.
    pub direction: Direction,
}

impl Ray {
    /// The point at `t` metres from the origin.
    #[inline]
    pub fn at(&self, t: f64) -> Point {
        self.origin + self.direction.into_inner() * t
    }
}
