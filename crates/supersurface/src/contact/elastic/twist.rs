//! How a rigid body moves.

use std::ops::Sub;

use crate::{Point, Vector};

/// The velocities of a rigid body in world axes. The default is rest.
///
/// ```
/// use supersurface::{Point, Vector, contact::Twist};
/// let turning = Twist { angular: Vector::z() * 2.0, ..Twist::default() };
/// assert_eq!(turning.velocity_at(&Point::new(3.0, 0.0, 0.0)), Vector::new(0.0, 6.0, 0.0));
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Twist {
    /// Velocity of the body's point at `about`, in m/s.
    pub linear: Vector,
    /// Angular velocity, in rad/s.
    pub angular: Vector,
    /// Where the linear velocity is that of the body, in metres.
    pub about: Point,
}

impl Twist {
    /// Velocity of the body's point at `p`, in m/s.
    pub fn velocity_at(&self, p: &Point) -> Vector {
        self.linear + self.angular.cross(&(p - self.about))
    }

    /// The same motion told about another point.
    pub fn moved_to(&self, about: &Point) -> Self {
        Self { linear: self.velocity_at(about), angular: self.angular, about: *about }
    }
}

/// The motion of the first body as the second, which may turn, sees its points; about the first one's point.
impl Sub for Twist {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        let other = other.moved_to(&self.about);
        Self {
            linear: self.linear - other.linear,
            angular: self.angular - other.angular,
            about: self.about,
        }
    }
}
