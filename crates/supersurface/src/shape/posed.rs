//! A shape with a pose.

use crate::shape::{Implicit, InvalidShape, SupportMap};
use crate::{Point, Pose, Vector};

/// A shape whose own frame stands at `pose` in the world: `p_world = pose * p_local`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Posed<S> {
    shape: S,
    pose: Pose,
}

impl<S> Posed<S> {
    /// Fails when the pose is not finite.
    pub fn new(shape: S, pose: Pose) -> Result<Self, InvalidShape> {
        let numbers = pose.translation.vector.iter().chain(pose.rotation.coords.iter());
        for v in numbers {
            InvalidShape::check(v.is_finite(), "a number of the pose", *v, "finite")?;
        }
        Ok(Self { shape, pose })
    }

    /// The shape in its own frame.
    pub const fn shape(&self) -> &S {
        &self.shape
    }

    /// Pose of the shape's frame in the world.
    pub const fn pose(&self) -> &Pose {
        &self.pose
    }

    /// The same shape moved by `motion` (applied after the present pose).
    pub fn moved(&self, motion: &Pose) -> Self
    where
        S: Clone,
    {
        Self { shape: self.shape.clone(), pose: motion * self.pose }
    }

    /// A world point in the shape's frame.
    #[inline]
    pub fn to_local(&self, p: &Point) -> Point {
        self.pose.inverse_transform_point(p)
    }
}

impl<S: Implicit> Implicit for Posed<S> {
    fn gauge(&self, p: &Point) -> f64 {
        self.shape.gauge(&self.to_local(p))
    }

    fn gradient(&self, p: &Point) -> Vector {
        self.pose.rotation * self.shape.gradient(&self.to_local(p))
    }

    fn bounds(&self) -> [Point; 2] {
        let [low, high] = self.shape.bounds();
        if low.iter().chain(high.iter()).any(|v| v.is_infinite()) {
            return [f64::NEG_INFINITY, f64::INFINITY].map(|v| Point::new(v, v, v));
        }
        let centre = self.pose * nalgebra::center(&low, &high);
        let half = (high - low) * 0.5;
        let extent = self.pose.rotation.to_rotation_matrix().matrix().abs() * half;
        [centre - extent, centre + extent]
    }

    fn extent(&self, n: &Vector) -> f64 {
        let local = self.pose.rotation.inverse_transform_vector(n);
        n.dot(&self.pose.translation.vector) + self.shape.extent(&local)
    }

    fn is_convex(&self) -> bool {
        self.shape.is_convex()
    }
}

impl<S: SupportMap> SupportMap for Posed<S> {
    fn support_point(&self, n: &Vector) -> Point {
        self.pose * self.shape.support_point(&self.pose.rotation.inverse_transform_vector(n))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Superparaboloid;

    #[test]
    fn a_turned_shape_without_bounds_has_none_in_any_direction() {
        let bowl = Superparaboloid::new([1.0; 3], [1.0; 2]).unwrap();
        let [low, high] = Posed::new(bowl, Pose::rotation(Vector::x())).unwrap().bounds();
        assert!(low.iter().all(|v| *v == f64::NEG_INFINITY));
        assert!(high.iter().all(|v| *v == f64::INFINITY));
    }
}
