//! What is not convex, as a compound of convex pieces cut by the shape's own axis.
//!
//! Toroids: sectors around z whose hulls have exact support functions (`convex/sector.rs`); only the hole's side is off, by
//! chords of at most 1 % of the ring's radius. Everything else: slices across the axis of the undeformed solid, the hull of
//! each made of points of its true surface, so that what lies between them is off by chords: about 0.5 % of the half
//! widths, and on the inside of a bend 1 % of its radius. Mass is exact, whatever the pieces are.

use std::f64::consts::{FRAC_PI_2, TAU};

use parry3d_f64::bounding_volume::{Aabb, BoundingSphere};
use parry3d_f64::mass_properties::MassProperties;
use parry3d_f64::math::{Pose as ParryPose, Vector as ParryVector};
use parry3d_f64::query::{PointProjection, PointQuery, Ray, RayCast, RayIntersection};
use parry3d_f64::shape::{
    CompositeShape, Compound, FeatureId, Shape, ShapeType, SharedShape, TypedShape,
};
use supersurface::Point;
use supersurface::measure::ClosestFinder;
use supersurface::numeric::powers::power;
use supersurface::shape::{Implicit, Mass, Parametric, Supertoroid};
use supersurface::surface::{Solid, Surface};

use crate::convert::{from_point, to_point};
use crate::convex::{ConvexSolid, Hull, Sector, exact_hit, to_parry_mass};

/// Numbers of sectors that are tried, least first.
const SECTORS: [usize; 5] = [16, 24, 32, 48, 64];
/// How far a sector's chords may be off, in ring radii.
const CHORD: f64 = 0.01;
/// Fewest and most slices.
const SLICES: [usize; 2] = [8, 48];
/// A slice twists and bends by at most this, in radians.
const TURN: f64 = 0.28;
/// Points around a slice's outline, and outlines of a slice.
const OUTLINE: usize = 32;
const LEVELS: usize = 3;

/// A solid that is not convex, as parry and rapier take it: convex pieces for contacts, the exact solid for mass, rays
/// and (of toroids) closest points.
#[derive(Clone)]
pub struct Pieces {
    surface: Surface,
    compound: Compound,
    /// The convex hull of a toroid: all that a half space can touch.
    hull: Option<ConvexSolid>,
    /// Mass properties for a density of 1 kg/m³.
    mass: Mass,
    finder: Option<ClosestFinder>,
}

impl std::fmt::Debug for Pieces {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.compound.shapes().len();
        f.debug_struct("Pieces").field("surface", &self.surface).field("pieces", &count).finish()
    }
}

impl Pieces {
    /// `None` for exponents above 2, or where no hull can be made.
    pub(crate) fn new(surface: &Surface, mass: Mass) -> Option<Self> {
        if surface.exponents().iter().any(|e| *e > 2.0) {
            return None;
        }
        let Surface::Supertoroid(toroid) = surface else {
            let compound = Compound::new(solids(slices(surface)?, &mass, ConvexSolid::from_hull));
            return Some(Self { surface: *surface, compound, hull: None, mass, finder: None });
        };
        let sectors = solids(sectors(toroid)?, &mass, ConvexSolid::from_sector);
        Some(Self {
            surface: *surface,
            compound: Compound::new(sectors),
            hull: Some(ConvexSolid::from_sector(Sector::ring(toroid), mass)),
            mass,
            finder: Some(ClosestFinder::supertoroid(toroid)),
        })
    }

    /// The solid itself.
    pub const fn surface(&self) -> &Surface {
        &self.surface
    }

    /// The convex hull, where it is known.
    pub(crate) const fn hull(&self) -> Option<&ConvexSolid> {
        self.hull.as_ref()
    }

    /// The convex pieces, each with its pose in the solid's frame.
    pub fn pieces(&self) -> &[(ParryPose, SharedShape)] {
        self.compound.shapes()
    }
}

/// Pieces as shapes. Each has an equal share of the whole mass, as if it were spread over all of it: together they weigh
/// exactly what the solid does.
fn solids<T>(
    pieces: Vec<T>,
    whole: &Mass,
    solid: impl Fn(T, Mass) -> ConvexSolid,
) -> Vec<(ParryPose, SharedShape)> {
    let share = 1.0 / pieces.len() as f64;
    let mass = Mass { mass: whole.mass * share, inertia: whole.inertia * share, ..*whole };
    let shape = |piece| (ParryPose::identity(), SharedShape::new(solid(piece, mass)));
    pieces.into_iter().map(shape).collect()
}

/// As few sectors as the chords of the hole allow.
fn sectors(toroid: &Supertoroid) -> Option<Vec<Sector>> {
    let [a, b, _] = toroid.semi_axes();
    let allowed = CHORD * a.min(b) * toroid.ring_ratio();
    let [.., most] = SECTORS;
    let mut found = None;
    for count in SECTORS {
        let sectors = Sector::all(toroid, count);
        let worst = sectors.iter().map(Sector::deviation).fold(0.0, f64::max);
        if worst <= allowed || count == most {
            found = Some(sectors);
            break;
        }
    }
    found
}

/// Slices of equal height of the solid before its deformation.
fn slices(surface: &Surface) -> Option<Vec<Hull>> {
    let solid = Solid::from(*surface);
    let [_, _, a3] = surface.semi_axes();
    let [e1, _] = surface.exponents();
    let twist = surface.twist().map_or(0.0, |t| TAU * t.turns().abs());
    let bend = surface.bend().map_or(0.0, |b| 2.0 * a3 * b.curvature().abs());
    let [fewest, most] = SLICES;
    let count = (((twist + bend) / TURN).ceil() as usize).clamp(fewest, most);
    // from the height to the angle of the profile
    let angle = |t: f64| power(t.abs().min(1.0), 1.0 / e1).asin().copysign(t);
    let slice = |k: usize| {
        let levels = (0..LEVELS).map(|level| {
            let share = (k as f64 + level as f64 / (LEVELS - 1) as f64) / count as f64;
            angle(2.0 * share - 1.0)
        });
        let mut points: Vec<Point> = levels.flat_map(|eta| outline(&solid, eta)).collect();
        // the ends round off within a slice: outlines at even angles there
        let end = angle(2.0 / count as f64 - 1.0).abs();
        if k == 0 || k + 1 == count {
            let side = if k == 0 { -1.0 } else { 1.0 };
            let more = (1..=LEVELS).map(|i| {
                let share = i as f64 / (LEVELS + 1) as f64;
                side * (end + (FRAC_PI_2 - end) * share)
            });
            points.extend(more.flat_map(|eta| outline(&solid, eta)));
        }
        Hull::new(&points)
    };
    (0..count).map(slice).collect()
}

fn outline(solid: &Solid, eta: f64) -> Vec<Point> {
    let at = |k: usize| solid.point(eta, TAU * (k as f64 / OUTLINE as f64) - TAU / 2.0);
    (0..OUTLINE).map(at).collect()
}

impl CompositeShape for Pieces {
    fn map_part_at(
        &self,
        shape_id: u32,
        f: &mut dyn FnMut(
            Option<&ParryPose>,
            &dyn Shape,
            Option<&dyn parry3d_f64::query::details::NormalConstraints>,
        ),
    ) {
        self.compound.map_part_at(shape_id, f);
    }

    fn bvh(&self) -> &parry3d_f64::partitioning::Bvh {
        self.compound.bvh()
    }
}

impl PointQuery for Pieces {
    fn project_local_point(&self, pt: ParryVector, solid: bool) -> PointProjection {
        let p = to_point(pt);
        if solid && self.surface.contains(&p) {
            return PointProjection::new(true, pt);
        }
        match self.finder.as_ref().and_then(|finder| finder.find(&p)) {
            Some(closest) => {
                PointProjection::new(closest.distance < 0.0, from_point(&closest.point))
            }
            None => self.compound.project_local_point(pt, solid),
        }
    }

    fn project_local_point_and_get_feature(&self, pt: ParryVector) -> (PointProjection, FeatureId) {
        (self.project_local_point(pt, false), FeatureId::Unknown)
    }

    fn contains_local_point(&self, pt: ParryVector) -> bool {
        self.surface.contains(&to_point(pt))
    }
}

impl RayCast for Pieces {
    fn cast_local_ray_and_get_normal(
        &self,
        ray: &Ray,
        max_time_of_impact: f64,
        solid: bool,
    ) -> Option<RayIntersection> {
        exact_hit(&self.surface, ray, max_time_of_impact, solid)
    }
}

impl Shape for Pieces {
    fn compute_local_aabb(&self) -> Aabb {
        *self.compound.local_aabb()
    }

    fn compute_local_bounding_sphere(&self) -> BoundingSphere {
        self.compound.local_bounding_sphere()
    }

    fn clone_dyn(&self) -> Box<dyn Shape> {
        Box::new(self.clone())
    }

    /// Not for solids that are cut: `None`.
    fn scale_dyn(&self, _: ParryVector, _: u32) -> Option<Box<dyn Shape>> {
        None
    }

    /// Around the turned local box: not tight, but asked for in every step.
    fn compute_aabb(&self, position: &ParryPose) -> Aabb {
        self.compound.local_aabb().transform_by(position)
    }

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
        let thickness = self.compound.shapes().iter().map(|(_, s)| s.ccd_thickness());
        thickness.fold(f64::INFINITY, f64::min)
    }

    fn ccd_angular_thickness(&self) -> f64 {
        FRAC_PI_2
    }

    fn as_composite_shape(&self) -> Option<&(dyn CompositeShape + Sync)> {
        Some(self)
    }
}
