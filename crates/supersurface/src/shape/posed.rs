//! A shape with a pose.

use nalgebra::Matrix3;

use crate::numeric::quarter_angle::QuarterAngle;
use crate::shape::{
    Implicit, InvalidShape, Mass, MassEstimate, MassProperties, Parametric, SecondOrder,
    SupportMap, finite_or_zero,
};
use crate::{Direction, Point, Pose, Vector};

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
        let gauge = self.shape.gauge(&self.to_local(p));
        // a turn of 1e308 overflows either way: far outside
        if gauge.is_nan() { f64::INFINITY } else { gauge }
    }

    fn gradient(&self, p: &Point) -> Vector {
        finite_or_zero(self.pose.rotation * self.shape.gradient(&self.to_local(p)))
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
        let extent = n.dot(&self.pose.translation.vector) + self.shape.extent(&local);
        // directions of 1e308 may overflow either way
        let finite = local.iter().all(|v| v.is_finite()) && !extent.is_nan();
        if finite { extent } else { f64::INFINITY }
    }

    fn is_convex(&self) -> bool {
        self.shape.is_convex()
    }
}

impl<S: SecondOrder> SecondOrder for Posed<S> {
    /// `R H Rᵀ`.
    fn hessian(&self, p: &Point) -> Option<Matrix3<f64>> {
        let turn = self.pose.rotation.to_rotation_matrix().into_inner();
        Some(turn * self.shape.hessian(&self.to_local(p))? * turn.transpose())
    }
}

impl<S: Parametric> Parametric for Posed<S> {
    fn domain(&self) -> [[f64; 2]; 2] {
        self.shape.domain()
    }

    fn point(&self, eta: f64, omega: f64) -> Point {
        self.pose * self.shape.point(eta, omega)
    }

    fn point_at(&self, eta: QuarterAngle, omega: QuarterAngle) -> Point {
        self.pose * self.shape.point_at(eta, omega)
    }

    fn tangents(&self, eta: f64, omega: f64) -> Option<[Vector; 2]> {
        Some(self.shape.tangents(eta, omega)?.map(|t| self.pose.rotation * t))
    }

    fn normal(&self, eta: f64, omega: f64) -> Option<Direction> {
        Some(self.pose.rotation * self.shape.normal(eta, omega)?)
    }
}

impl<S: MassProperties> MassProperties for Posed<S> {
    fn mass_properties(&self, density: f64) -> Mass {
        self.shape.mass_properties(density).moved(&self.pose)
    }

    fn mass_estimate(&self, density: f64) -> MassEstimate {
        let found = self.shape.mass_estimate(density);
        MassEstimate { mass: found.mass.moved(&self.pose), ..found }
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
