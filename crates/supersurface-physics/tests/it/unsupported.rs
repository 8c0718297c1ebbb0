//! A shape with a support map and nothing else: parry's distances work, and its manifolds do not.

use supersurface_physics::parry::bounding_volume::{Aabb, BoundingSphere};
use supersurface_physics::parry::mass_properties::MassProperties;
use supersurface_physics::parry::math::Vector;
use supersurface_physics::parry::query::{
    PointProjection, PointQuery, Ray, RayCast, RayIntersection,
};
use supersurface_physics::parry::shape::{
    Ball, FeatureId, Shape, ShapeType, SupportMap, TypedShape,
};

#[derive(Clone)]
pub(crate) struct OnlySupport(pub(crate) Ball);

impl PointQuery for OnlySupport {
    fn project_local_point(&self, pt: Vector, solid: bool) -> PointProjection {
        self.0.project_local_point(pt, solid)
    }

    fn project_local_point_and_get_feature(&self, pt: Vector) -> (PointProjection, FeatureId) {
        self.0.project_local_point_and_get_feature(pt)
    }
}

impl RayCast for OnlySupport {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time_of_impact: f64,
        solid: bool,
    ) -> Option<RayIntersection> {
        self.0.cast_local_ray_and_get_normal(ray, max_time_of_impact, solid)
    }
}

impl Shape for OnlySupport {
    fn compute_local_aabb(&self) -> Aabb {
        Shape::compute_local_aabb(&self.0)
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.0.local_bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    fn scale_dyn(&self, _: Vector, _: u32) -> Option<Box<dyn Shape>> {
        None
    }

    fn mass_properties(&self, density: f64) -> MassProperties {
        Shape::mass_properties(&self.0, density)
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> f64 {
        self.0.radius
    }

    fn ccd_angular_thickness(&self) -> f64 {
        1.0
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(&self.0)
    }
}
