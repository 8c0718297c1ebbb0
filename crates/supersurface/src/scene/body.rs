//! What a scene is made of: bodies that can move and boards that cannot.

use crate::combine::{Assembly, Part};
use crate::shape::{InvalidShape, Mass, Posed, SupportMap};
use crate::surface::Surface;
use crate::{Point, Pose, Vector};

/// Density of a body that nothing is said of, in kg/m³: a light wood.
pub const DENSITY: f64 = 500.0;
/// Coefficient of friction of a body that nothing is said of.
pub const FRICTION: f64 = 0.6;

/// A body of a scene: parts that may be joined, where they stand, and how rough they are.
///
/// ```
/// use supersurface::{Pose, scene::Body, shape::Superellipsoid, surface::Surface};
/// let can = Surface::Superellipsoid(Superellipsoid::new([0.03, 0.03, 0.05], [0.1, 1.0])?);
/// let body = Body::single("can", can, Pose::translation(0.0, 0.0, 0.05))?;
/// assert!((body.mass().mass - 500.0 * can.volume()).abs() < 1e-12);
/// assert_eq!(body.solids()[0].pose().translation.z, 0.05);
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// What a person would call it.
    pub name: String,
    /// Shape, densities and joints; parts stand in the body's frame. Joints are at their rest.
    pub shape: Assembly<Surface>,
    /// Pose of the body's frame in the world.
    pub pose: Pose,
    /// Coefficient of friction with whatever it touches, not negative.
    pub friction: f64,
}

impl Body {
    /// One part whose frame is the body's, of the usual density and friction.
    pub fn single(name: &str, surface: Surface, pose: Pose) -> Result<Self, InvalidShape> {
        let part = Part::new(name, Posed::new(surface, Pose::identity())?, DENSITY)?;
        let shape = Assembly::single(part);
        Ok(Self { name: name.to_owned(), shape, pose, friction: FRICTION })
    }

    /// Its parts in the world.
    pub fn solids(&self) -> Vec<Posed<Surface>> {
        let parts = self.shape.bodies(&self.shape.rest_rotations());
        parts.iter().map(|part| part.moved(&self.pose)).collect()
    }

    /// Mass, centre of mass and inertia about it, in the body's frame. Where parts overlap they count twice.
    pub fn mass(&self) -> Mass {
        self.shape.mass_properties(&self.shape.rest_rotations())
    }

    /// The corners of a box along the world's axes around it.
    pub fn bounds(&self) -> [Point; 2] {
        let (mut low, mut high) =
            (Point::from([f64::INFINITY; 3]), Point::from([f64::NEG_INFINITY; 3]));
        for solid in self.solids() {
            for k in 0..3 {
                let axis = Vector::ith(k, 1.0);
                high[k] = high[k].max(solid.support_point(&axis)[k]);
                low[k] = low[k].min(solid.support_point(&-axis)[k]);
            }
        }
        [low, high]
    }
}

/// A fixed cuboid: a wall of a bin, a board of a shelf.
#[derive(Clone, Debug, PartialEq)]
pub struct Board {
    /// What a person would call it.
    pub name: String,
    /// Half of its edges along its own axes, in metres.
    pub half_extents: [f64; 3],
    /// Pose of its middle in the world.
    pub pose: Pose,
}
