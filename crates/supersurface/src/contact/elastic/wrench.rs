//! Force and moment.

use std::ops::{Add, Neg};

use crate::{Point, Pose, Vector};

/// A force with the moment about a point, in the axes of one frame.
///
/// ```
/// use supersurface::{Point, Vector, contact::Wrench};
/// let push = Wrench::of_force(Vector::z() * 2.0, &Point::new(0.5, 0.0, 0.0), &Point::origin());
/// assert_eq!(push.moment, Vector::new(0.0, -1.0, 0.0));
/// assert_eq!(push.moved_to(&Point::new(0.5, 0.0, 3.0)).moment, Vector::zeros());
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Wrench {
    /// Force in N.
    pub force: Vector,
    /// Moment about `about`, in N·m.
    pub moment: Vector,
    /// The point, in metres.
    pub about: Point,
}

impl Wrench {
    /// A force at a point, told about another.
    pub fn of_force(force: Vector, at: &Point, about: &Point) -> Self {
        Self { force, moment: (at - about).cross(&force), about: *about }
    }

    /// The same wrench told about another point: `m' = m + (o - o') × f`.
    pub fn moved_to(&self, about: &Point) -> Self {
        let moment = self.moment + (self.about - about).cross(&self.force);
        Self { force: self.force, moment, about: *about }
    }

    /// The same wrench in the axes and coordinates of a frame that stands at `frame`.
    ///
    /// ```
    /// use supersurface::{Point, Pose, Vector, contact::Wrench};
    /// let frame = Pose::new(Vector::x(), Vector::z() * std::f64::consts::FRAC_PI_2);
    /// let push = Wrench { force: Vector::y(), ..Wrench::default() };
    /// let seen = push.seen_from(&frame);
    /// assert!((seen.force - Vector::x()).norm() < 1e-15);
    /// assert!((seen.about - Point::new(0.0, 1.0, 0.0)).norm() < 1e-15);
    /// ```
    pub fn seen_from(&self, frame: &Pose) -> Self {
        Self {
            force: frame.inverse_transform_vector(&self.force),
            moment: frame.inverse_transform_vector(&self.moment),
            about: frame.inverse_transform_point(&self.about),
        }
    }

    /// A wrench of that frame in the world: the reverse of [`seen_from`](Self::seen_from).
    pub fn to_world(&self, frame: &Pose) -> Self {
        Self { force: frame * self.force, moment: frame * self.moment, about: frame * self.about }
    }

    pub(super) fn is_finite(&self) -> bool {
        self.force.iter().chain(self.moment.iter()).all(|v| v.is_finite())
    }
}

/// The reaction.
impl Neg for Wrench {
    type Output = Self;

    fn neg(self) -> Self {
        Self { force: -self.force, moment: -self.moment, about: self.about }
    }
}

/// Both together, about the point of the first.
impl Add for Wrench {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let other = other.moved_to(&self.about);
        Self {
            force: self.force + other.force,
            moment: self.moment + other.moment,
            about: self.about,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::contact::Twist;
    use crate::numeric::random::Stream;

    #[test]
    fn power_and_equilibrium_depend_on_no_point_and_no_frame() {
        let mut random = Stream::new(6, 0);
        let mut vector = || Vector::from_fn(|_, _| random.normal());
        for _ in 0..200 {
            let (a, b) = (Point::from(vector()), Point::from(vector()));
            let wrench = Wrench { force: vector(), moment: vector(), about: a };
            let twist = Twist { linear: vector(), angular: vector(), about: a };
            let power = |w: &Wrench, t: &Twist| w.force.dot(&t.linear) + w.moment.dot(&t.angular);
            let far = power(&wrench.moved_to(&b), &twist.moved_to(&b));
            assert!((power(&wrench, &twist) - far).abs() < 1e-13);
            let rest = twist - twist.moved_to(&b);
            assert!(rest.linear.norm() < 1e-14 && rest.angular.norm() == 0.0);
            let nothing = wrench.moved_to(&b) + -wrench;
            assert!(nothing.force.norm() == 0.0 && nothing.moment.norm() < 1e-14);
            let frame = Pose::new(vector(), vector());
            let back = wrench.seen_from(&frame).to_world(&frame);
            assert!((back.moment - wrench.moment).norm() < 1e-14);
            assert!((back.about - wrench.about).norm() < 1e-14);
            let moved = wrench.seen_from(&frame).moved_to(&frame.inverse_transform_point(&b));
            let same = wrench.moved_to(&b).seen_from(&frame);
            assert!((moved.moment - same.moment).norm() < 1e-13);
        }
    }
}
