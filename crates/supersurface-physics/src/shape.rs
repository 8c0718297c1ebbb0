//! From a surface of the library to a shape of parry and rapier.

use parry3d_f64::math::Pose as ParryPose;
use parry3d_f64::shape::SharedShape;
use supersurface::contact::Convex;
use supersurface::shape::{MassProperties, Posed};
use supersurface::surface::{Solid, Surface};

use crate::convert::from_pose;
use crate::convex::ConvexSolid;
use crate::pieces::Pieces;

/// A surface of which no shape for contacts can be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NoShape {
    /// An exponent above 2: the solid is hollow between its edges, and is not made of a few convex pieces.
    #[error("exponents {exponents:?}: contacts need both at most 2")]
    Exponents {
        /// `[ε1, ε2]`.
        exponents: [f64; 2],
    },
    /// So thin or so large that a piece has no hull, or its mass no number.
    #[error("the {name} with semi-axes {semi_axes:?} m has no hull or no mass in double precision")]
    Degenerate {
        /// The member's name.
        name: &'static str,
        /// `[a1, a2, a3]` in metres.
        semi_axes: [f64; 3],
    },
    /// A body without parts.
    #[error("a body has no parts")]
    Empty,
}

/// The shape of a surface in its own frame, in metres, with the exact mass properties of the surface.
///
/// Superellipsoids and convex tapered ones become a [`ConvexSolid`]; toroids, bent, twisted and hollow tapered solids
/// become [`Pieces`]. Fails for exponents above 2, and for numbers so extreme that no hull or mass can be computed.
///
/// In a rapier world, set [`Dispatcher`](crate::Dispatcher) as the narrow phase's query dispatcher: the default one works
/// too, with contacts that are less exact.
///
/// ```
/// use supersurface::{shape::Superellipsoid, surface::Surface};
/// let tin = Surface::Superellipsoid(Superellipsoid::new([0.03, 0.03, 0.05], [0.1, 1.0])?);
/// let shape = supersurface_physics::shape(&tin)?;
/// assert!((shape.mass_properties(1000.0).mass() - 1000.0 * tin.volume()).abs() < 1e-12);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn shape(surface: &Surface) -> Result<SharedShape, NoShape> {
    let exponents = surface.exponents();
    if exponents.iter().any(|e| *e > 2.0) {
        return Err(NoShape::Exponents { exponents });
    }
    let degenerate =
        || NoShape::Degenerate { name: surface.name(), semi_axes: surface.semi_axes() };
    let mass = Solid::from(*surface).mass_properties(1.0);
    let heavy = mass.mass > 0.0 && mass.inertia.iter().all(|v| v.is_finite());
    let turns = mass.inertia.diagonal().iter().all(|v| *v > 0.0);
    if !(heavy && turns && mass.mass.is_finite()) {
        return Err(degenerate());
    }
    let convex = match surface {
        Surface::Superellipsoid(s) => {
            Convex::new(*s).ok().map(|s| ConvexSolid::from_superellipsoid(s, mass))
        }
        Surface::Tapered(s) => ConvexSolid::from_tapered(s, mass),
        _ => None,
    };
    if let Some(convex) = convex {
        return Ok(SharedShape::new(convex));
    }
    Pieces::new(surface, mass).map(SharedShape::new).ok_or_else(degenerate)
}

/// Several posed parts as one compound shape in the frame of their body. Where parts overlap, mass counts twice.
///
/// Fails where a part has no shape, and without parts. In rapier a collider for each part on the same body does the same
/// and keeps the mass exact for cut parts too; [`settle`](crate::settle()) does that.
pub fn compound(parts: &[Posed<Surface>]) -> Result<SharedShape, NoShape> {
    let mut pieces: Vec<(ParryPose, SharedShape)> = Vec::new();
    for part in parts {
        let (pose, shape) = (from_pose(part.pose()), shape(part.shape())?);
        match shape.as_shape::<Pieces>() {
            Some(cut) => pieces.extend(cut.pieces().iter().map(|(p, s)| (pose * *p, s.clone()))),
            None => pieces.push((pose, shape)),
        }
    }
    if pieces.is_empty() {
        return Err(NoShape::Empty);
    }
    Ok(SharedShape::compound(pieces))
}
