//! A convex solid as a shape of parry: superellipsoids, convex tapered ones, sectors of toroids and hulls of points.
//!
//! Everything is asked of the exact shape: support points, boxes, mass, and for superellipsoids closest points and first
//! hits too. No triangles are made of it.

mod feature;
mod hull;
mod sector;
mod tapered;

use std::f64::consts::FRAC_PI_2;

use parry3d_f64::bounding_volume::{Aabb, BoundingSphere};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::details::{
    local_point_projection_on_support_map, local_ray_intersection_with_support_map_with_params,
};
use parry3d_f64::query::gjk::VoronoiSimplex;
use parry3d_f64::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use parry3d_f64::shape::{
    FeatureId, PolygonalFeatureMap, Shape, ShapeType, SupportMap, TypedShape,
};
use supersurface::contact::Convex;
use supersurface::deform::{Deformed, Taper};
use supersurface::measure::{ClosestFinder, first_hit};
use supersurface::nalgebra::{Rotation3, Translation3, UnitQuaternion};
use supersurface::shape::{
    Implicit, Mass, MassProperties as _, Ray as LibraryRay, Superellipsoid, SupportMap as _,
};
use supersurface::{Direction, Pose, Vector};

pub(crate) use self::hull::Hull;
pub(crate) use self::sector::Sector;
use self::tapered::Tapered;
use crate::convert::{from_point, from_pose, from_vector, to_point, to_vector};

/// A convex solid in its own frame, as parry and rapier take it. Lengths are metres.
///
/// Made by [`shape`](crate::shape()); `downcast` from a [`SharedShape`](crate::parry::shape::SharedShape) to ask for
/// [`superellipsoid`](Self::superellipsoid).
///
/// Closest points and rays of tapered solids and of pieces come from parry's iterations on the support function, and are
/// as good as these (about 1e-7 of the size); those of superellipsoids are exact.
#[derive(Clone, Debug)]
pub struct ConvexSolid {
    kind: Kind,
    bounds: Aabb,
    /// Mass properties for a density of 1 kg/m³.
    mass: Mass,
}

#[derive(Clone, Debug)]
enum Kind {
    Superellipsoid(Box<(Convex, ClosestFinder)>),
    Tapered(Tapered),
    Sector(Sector),
    Hull(Hull),
}

impl ConvexSolid {
    /// With the mass properties for a density of 1 kg/m³.
    pub(crate) fn from_superellipsoid(solid: Convex, mass: Mass) -> Self {
        let finder = ClosestFinder::superellipsoid(solid.shape());
        Self::new(Kind::Superellipsoid(Box::new((solid, finder))), mass)
    }

    /// `None` where the taper makes it hollow somewhere.
    pub(crate) fn from_tapered(
        solid: &Deformed<Superellipsoid, Taper>,
        mass: Mass,
    ) -> Option<Self> {
        Some(Self::new(Kind::Tapered(Tapered::new(solid)?), mass))
    }

    /// One of several sectors of a toroid, with its share of the toroid's mass properties.
    pub(crate) fn from_sector(sector: Sector, mass: Mass) -> Self {
        Self::new(Kind::Sector(sector), mass)
    }

    /// A piece of a solid, with its share of the solid's mass properties.
    pub(crate) fn from_hull(hull: Hull, mass: Mass) -> Self {
        Self::new(Kind::Hull(hull), mass)
    }

    fn new(kind: Kind, mass: Mass) -> Self {
        let mut solid = Self { kind, bounds: Aabb::new_invalid(), mass };
        solid.bounds = solid.tight_box(&ParryPose::identity());
        solid
    }

    /// The tight box, by support points.
    fn tight_box(&self, position: &ParryPose) -> Aabb {
        let axes = [ParryVector::X, ParryVector::Y, ParryVector::Z];
        let reach = |n: ParryVector| self.support_point(position, n).dot(n);
        let [maxs, mins] = [1.0, -1.0].map(|side| {
            let [x, y, z] = axes.map(|axis| side * reach(axis * side));
            ParryVector::new(x, y, z)
        });
        Aabb::new(mins, maxs)
    }

    /// The superellipsoid with the constants of its exact contacts, if it is one.
    pub fn superellipsoid(&self) -> Option<&Convex> {
        match &self.kind {
            Kind::Superellipsoid(solid) => Some(&solid.0),
            _ => None,
        }
    }
}

/// Mass properties as parry has them, by principal axes, of a body whose mass for a density of 1 kg/m³ is known.
pub(crate) fn to_parry_mass(mass: &Mass, density: f64) -> MassProperties {
    let mut axes = mass.inertia.symmetric_eigen();
    // a rotation, not a reflection
    if axes.eigenvectors.determinant() < 0.0 {
        axes.eigenvectors.neg_mut();
    }
    // orthonormal as they are: a search for the nearest rotation may go on for ever
    let turn = Rotation3::from_matrix_unchecked(axes.eigenvectors);
    let turn = UnitQuaternion::from_rotation_matrix(&turn);
    let frame = from_pose(&Pose::from_parts(Translation3::identity(), turn)).rotation;
    let inertia = from_vector(&axes.eigenvalues.map(|v| v.max(0.0) * density));
    MassProperties::with_principal_inertia_frame(
        from_point(&mass.centre),
        mass.mass * density,
        inertia,
        frame,
    )
}

impl SupportMap for ConvexSolid {
    fn local_support_point(&self, dir: ParryVector) -> ParryVector {
        let n = to_vector(dir);
        from_point(&match &self.kind {
            Kind::Superellipsoid(solid) => solid.0.support_point(&n),
            Kind::Tapered(solid) => solid.support_point(&n),
            Kind::Sector(sector) => sector.support_point(&n),
            Kind::Hull(hull) => hull.support_point(&n),
        })
    }
}

impl PointQuery for ConvexSolid {
    fn project_local_point(&self, pt: ParryVector, solid: bool) -> PointProjection {
        let by_search = || {
            let simplex = &mut VoronoiSimplex::new();
            local_point_projection_on_support_map(self, simplex, pt, solid)
        };
        let Kind::Superellipsoid(exact) = &self.kind else { return by_search() };
        let p = to_point(pt);
        if exact.0.shape().contains(&p) && solid {
            return PointProjection::new(true, pt);
        }
        match exact.1.find(&p) {
            Some(closest) => {
                PointProjection::new(closest.distance < 0.0, from_point(&closest.point))
            }
            None => by_search(),
        }
    }

    fn project_local_point_and_get_feature(&self, pt: ParryVector) -> (PointProjection, FeatureId) {
        (self.project_local_point(pt, false), FeatureId::Unknown)
    }

    fn contains_local_point(&self, pt: ParryVector) -> bool {
        match &self.kind {
            Kind::Superellipsoid(exact) => exact.0.shape().contains(&to_point(pt)),
            Kind::Tapered(tapered) => tapered.shape().contains(&to_point(pt)),
            Kind::Sector(_) | Kind::Hull(_) => self.project_local_point(pt, true).is_inside,
        }
    }
}

impl RayCast for ConvexSolid {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time_of_impact: f64,
        solid: bool,
    ) -> Option<RayIntersection> {
        match &self.kind {
            Kind::Superellipsoid(exact) => {
                exact_hit(exact.0.shape(), ray, max_time_of_impact, solid)
            }
            Kind::Tapered(tapered) => exact_hit(tapered.shape(), ray, max_time_of_impact, solid),
            Kind::Sector(_) | Kind::Hull(_) => local_ray_intersection_with_support_map_with_params(
                self,
                &mut VoronoiSimplex::new(),
                ray,
                max_time_of_impact,
                solid,
            ),
        }
    }
}

/// The library's first hit in parry's terms: times are in units of the ray's direction, and a ray that starts inside a
/// solid meets it at once.
pub(crate) fn exact_hit(
    shape: &dyn Implicit,
    ray: &Ray,
    max: f64,
    solid: bool,
) -> Option<RayIntersection> {
    let speed = ray.dir.length();
    let direction = Direction::try_new(to_vector(ray.dir), 0.0)?;
    let origin = to_point(ray.origin);
    if solid && shape.contains(&origin) {
        return Some(RayIntersection::new(0.0, ParryVector::ZERO, FeatureId::Unknown));
    }
    let hit = first_hit(shape, &LibraryRay { origin, direction }, max * speed)?;
    let normal = from_vector(&hit.normal);
    // from inside the surface is met from its back
    let normal = if normal.dot(ray.dir) > 0.0 { -normal } else { normal };
    Some(RayIntersection::new(hit.distance / speed, normal, FeatureId::Unknown))
}

impl PolygonalFeatureMap for ConvexSolid {
    fn local_support_feature(
        &self,
        dir: ParryVector,
        out: &mut parry3d_f64::shape::PolygonalFeature,
    ) {
        feature::tilted(self, dir, out);
    }
}

impl Shape for ConvexSolid {
    fn compute_local_aabb(&self) -> Aabb {
        self.bounds
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.bounds.bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    /// Only superellipsoids can be scaled, by factors that are not zero.
    fn scale_dyn(&self, scale: ParryVector, _: u32) -> Option<Box<dyn Shape>> {
        let old = self.superellipsoid()?.shape();
        let [x, y, z] = old.semi_axes();
        let axes = [x * scale.x.abs(), y * scale.y.abs(), z * scale.z.abs()];
        let scaled = Convex::new(Superellipsoid::new(axes, old.exponents()).ok()?).ok()?;
        let mass = scaled.shape().mass_properties(1.0);
        Some(Box::new(Self::from_superellipsoid(scaled, mass)))
    }

    /// Around the turned local box: not tight, but asked for many times in every step.
    fn compute_aabb(&self, position: &ParryPose) -> Aabb {
        self.bounds.transform_by(position)
    }

    /// Those of the library, in closed form for superellipsoids.
    fn mass_properties(&self, density: f64) -> MassProperties {
        to_parry_mass(&self.mass, density)
    }

    fn shape_type(&self) -> ShapeType {
        ShapeType::Custom
    }

    fn as_typed_shape(&self) -> TypedShape<'_> {
        TypedShape::Custom(self)
    }

    fn ccd_thickness(&self) -> f64 {
        self.bounds.half_extents().min_element()
    }

    fn ccd_angular_thickness(&self) -> f64 {
        FRAC_PI_2
    }

    fn is_convex(&self) -> bool {
        true
    }

    fn as_support_map(&self) -> Option<&dyn SupportMap> {
        Some(self)
    }

    fn as_polygonal_feature_map(&self) -> Option<(&dyn PolygonalFeatureMap, f64)> {
        Some((self, 0.0))
    }
}

/// A vector's components across z.
fn planar(n: &Vector) -> [f64; 2] {
    [n.x, n.y]
}
