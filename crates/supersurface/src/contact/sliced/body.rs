//! A member of the family as the union of flat convex slices, one at each place of an interval.
//!
//! A supertoroid is cut by half planes through its axis (`ring`), a superellipsoid that is tapered, twisted, bent, or hollow
//! between its ends (ε1 above 2), across it (`stack`): tapers scale such slices, twists and bends only move them. A convex superellipsoid
//! stays whole. Places are angles in radians, along which slices change smoothly whatever the exponents are.

use super::ring::Ring;
use super::slice::Slice;
use super::stack::Stack;
use crate::contact::Convex;
use crate::shape::{Implicit, InvalidShape, Posed, SupportMap};
use crate::surface::Solid;
use crate::{Pose, Vector};

/// A solid that contact can be asked of: a superellipsoid with ε2 up to 2, as it is or tapered, then twisted, then bent, or a
/// supertoroid with ε1 up to 2.
///
/// ```
/// use supersurface::{Pose, contact::Sliced, shape::{Posed, Superellipsoid}, surface::Solid};
/// let stick = Solid::from(Superellipsoid::new([0.02, 0.02, 0.08], [0.3, 1.0])?);
/// let banana = stick.tapered([-0.3, -0.3])?.bent(8.0, 0.0)?;
/// assert!(Sliced::new(&Posed::new(banana, Pose::identity())?).is_ok());
/// # Ok::<(), supersurface::shape::InvalidShape>(())
/// ```
#[derive(Clone, Debug)]
pub struct Sliced {
    solid: Posed<Solid>,
    cut: Cut,
    size: f64,
}

#[derive(Clone, Copy, Debug)]
enum Cut {
    Whole(Convex),
    Ring(Ring),
    Stack(Stack),
}

/// Why a solid is not the union of convex slices.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotSliced {
    /// Its slices would not be convex.
    #[error(transparent)]
    Section(#[from] InvalidShape),
    /// Another member of the family, or deformed in another order.
    #[error("no convex slices of a {0} are known")]
    Kind(String),
}

impl Sliced {
    /// Fails for what is not named above.
    pub fn new(solid: &Posed<Solid>) -> Result<Self, NotSliced> {
        let cut = match solid.shape() {
            Solid::Superellipsoid(shape) if shape.exponents()[0] <= 2.0 => {
                Cut::Whole(Convex::new(*shape)?)
            }
            Solid::Supertoroid(shape) => Cut::Ring(Ring::new(shape)?),
            other => Cut::Stack(Stack::new(other)?),
        };
        let [low, high] = solid.shape().bounds();
        let size = 0.5 * (high - low).amax();
        Ok(Self { solid: solid.clone(), cut, size })
    }

    /// The solid itself.
    pub const fn solid(&self) -> &Posed<Solid> {
        &self.solid
    }

    /// The body itself, where it is convex.
    pub fn as_convex(&self) -> Option<Posed<Convex>> {
        match self.cut {
            Cut::Whole(convex) => Posed::new(convex, *self.solid.pose()).ok(),
            _ => None,
        }
    }

    /// The largest half width, in metres.
    pub(super) const fn size(&self) -> f64 {
        self.size
    }

    /// First and last place; the same for a body that is whole.
    pub(super) const fn span(&self) -> [f64; 2] {
        match self.cut {
            Cut::Whole(_) => [0.0; 2],
            Cut::Ring(_) => Ring::SPAN,
            Cut::Stack(_) => Stack::SPAN,
        }
    }

    /// True where the last place is the first.
    pub(super) const fn is_closed(&self) -> bool {
        matches!(self.cut, Cut::Ring(_))
    }

    pub(super) fn slice(&self, at: f64) -> Result<Slice, InvalidShape> {
        let disc = match &self.cut {
            Cut::Whole(convex) => {
                return Ok(Slice::whole(&Posed::new(*convex, *self.solid.pose())?));
            }
            Cut::Ring(ring) => ring.disc(at),
            Cut::Stack(stack) => stack.disc(at),
        };
        Slice::disc(at, self.solid.pose(), self.size, &disc)
    }

    /// The longest way from a point of the slice at a place to one of another within so much of it, in metres.
    pub(super) fn way(&self, middle: f64, half: f64) -> f64 {
        match &self.cut {
            Cut::Whole(_) => 0.0,
            Cut::Ring(ring) => ring.way(middle, half),
            Cut::Stack(stack) => stack.way(middle, half),
        }
    }

    /// No point of the slices within so much of a place lies farther along a unit direction, in metres.
    pub(super) fn extent_within(&self, at: f64, half: f64, way: &Vector) -> f64 {
        let pose = self.solid.pose();
        let local = pose.rotation.inverse_transform_vector(way);
        let ends = [at - half, at + half];
        pose.translation.vector.dot(way)
            + match &self.cut {
                Cut::Whole(convex) => convex.support(&local),
                Cut::Ring(ring) => ring.extent(ends, &local),
                Cut::Stack(stack) => stack.extent(ends, &local),
            }
    }

    /// No point of the body lies farther along a direction, in metres.
    pub(super) fn extent(&self, way: &Vector) -> f64 {
        self.solid.extent(way)
    }

    /// The same body after a translation.
    pub(super) fn moved(&self, by: &Vector) -> Self {
        let solid = self.solid.moved(&Pose::translation(by.x, by.y, by.z));
        Self { solid, ..self.clone() }
    }
}
