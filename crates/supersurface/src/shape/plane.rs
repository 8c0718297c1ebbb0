//! An oriented plane: a table, a floor, a contact plane.

use crate::shape::InvalidShape;
use crate::{Direction, Point, Vector};

/// The points with `normal · p + offset = 0`; heights are positive on the side of the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    normal: Direction,
    offset: f64,
}

impl Plane {
    /// A plane from a normal of any length (made unit) and the offset in metres for the *unit*
    /// normal. Fails when the normal has no direction or a number is not finite.
    pub fn new(normal: Vector, offset: f64) -> Result<Self, InvalidShape> {
        let length = normal.norm();
        let finite = length > 1e-12 && length.is_finite();
        InvalidShape::check(finite, "length of the plane's normal", length, "positive and finite")?;
        InvalidShape::check(offset.is_finite(), "offset of the plane", offset, "finite")?;
        Ok(Self { normal: Direction::new_normalize(normal), offset })
    }

    /// The plane through `point` with a unit normal.
    pub fn through(point: &Point, normal: Direction) -> Self {
        Self { normal, offset: -normal.dot(&point.coords) }
    }

    /// Unit normal.
    pub const fn normal(&self) -> Direction {
        self.normal
    }

    /// Offset in metres: height of the frame's origin above the plane.
    pub const fn offset(&self) -> f64 {
        self.offset
    }

    /// Signed height of a point above the plane, in metres.
    #[inline]
    pub fn height(&self, p: &Point) -> f64 {
        self.normal.dot(&p.coords) + self.offset
    }

    /// The foot of a point on the plane.
    #[inline]
    pub fn project(&self, p: &Point) -> Point {
        p - self.normal.into_inner() * self.height(p)
    }

    /// The same plane with its normal reversed.
    pub fn flipped(&self) -> Self {
        Self { normal: -self.normal, offset: -self.offset }
    }

    /// Two unit vectors that span the plane; with the normal they form a right-handed frame.
    pub fn tangents(&self) -> [Direction; 2] {
        let n = self.normal.into_inner();
        let helper = if n.x.abs() < 0.7 { Vector::x() } else { Vector::y() };
        let u = Direction::new_normalize(helper - n * n.dot(&helper));
        let v = Direction::new_normalize(n.cross(&u));
        [u, v]
    }
}
