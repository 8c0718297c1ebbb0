//! A slice: a flat convex disc that moves with its place in a body, or a convex body that is whole.
//!
//! A point `M + u X + v Y` of the disc, with the middle `M`, the axes `X` and `Y` and shares `|u|, |v| <= 1` of the half
//! widths, moves with the place by `M' + ω × (p - M) + u w1' X + v w2' Y`; so the distance of a body from the slice changes by
//! `-n` times that for the witness point and the normal. The minima over the places are roots of that.

use crate::contact::pair::pair_by_cells;
use crate::contact::{Contact, Convex, WarmStart};
use crate::shape::{InvalidShape, Posed, Superellipsoid};
use crate::{Point, Pose, Vector};
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion};

/// Thickness of a disc relative to its smaller half width: none has none in the pair's query.
const THIN: f64 = 1e-10;
/// Smallest half width, relative to the body's size.
const NARROW: f64 = 1e-9;

/// A disc in a body's frame and how it changes with its place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    pub(super) middle: Vector,
    /// Unit vectors across each other.
    pub(super) axes: [Vector; 2],
    /// Half widths along them, in metres.
    pub(super) widths: [f64; 2],
    pub(super) exponent: f64,
    /// Derivatives by the place: of the middle, the turn and the half widths.
    pub(super) velocity: Vector,
    pub(super) turning: Vector,
    pub(super) growth: [f64; 2],
}

/// Cells of directions for a depth that is one of many, and for one that proves something.
pub(super) const FEW: usize = 30;
pub(super) const MANY: usize = 300;

/// The slice of a body at a place, in the world.
#[derive(Clone, Copy, Debug)]
pub(super) struct Slice {
    pub(super) at: f64,
    body: Posed<Convex>,
    widths: [f64; 2],
    velocity: Vector,
    turning: Vector,
    growth: [f64; 2],
}

/// The contact of two slices, and its derivatives by the place of each in metres a radian.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) at: [f64; 2],
    pub(super) contact: Contact,
    pub(super) slopes: [f64; 2],
}

impl Slice {
    /// A body that is not cut.
    pub(super) fn whole(body: &Posed<Convex>) -> Self {
        let still = Vector::zeros();
        let none = [0.0; 2];
        Self {
            at: 0.0,
            body: *body,
            widths: [1.0; 2],
            velocity: still,
            turning: still,
            growth: none,
        }
    }

    /// The disc at a place of a body of a size in metres.
    pub(super) fn disc(at: f64, pose: &Pose, size: f64, disc: &Disc) -> Result<Self, InvalidShape> {
        let widths = disc.widths.map(|w| w.max(NARROW * size));
        let thin = THIN * widths[0].min(widths[1]);
        // the profile's axis lies in the disc: the pair's query is best at thin sections
        let shape = Superellipsoid::new([widths[0], thin, widths[1]], [disc.exponent, 1.0])?;
        let [x, y] = disc.axes;
        let turn = Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[x, y.cross(&x), y]));
        let turn = UnitQuaternion::from_rotation_matrix(&turn);
        let place = Pose::from_parts(Translation3::from(disc.middle), turn);
        Ok(Self {
            at,
            body: Posed::new(Convex::new(shape)?, pose * place)?,
            widths,
            velocity: pose.rotation * disc.velocity,
            turning: pose.rotation * disc.turning,
            growth: disc.growth,
        })
    }

    /// The same slice of the body after a translation.
    pub(super) fn moved(&self, by: &Vector) -> Self {
        Self { body: self.body.moved(&Pose::translation(by.x, by.y, by.z)), ..*self }
    }

    /// True where the balls around two slices are apart.
    pub(super) fn clear_of(&self, other: &Self) -> bool {
        let apart = other.body.pose().translation.vector - self.body.pose().translation.vector;
        // a body lies within the box of its semi-axes
        let reach = |s: &Self| Vector::from(s.body.shape().shape().semi_axes()).norm();
        apart.norm() > reach(self) + reach(other)
    }

    /// The contact with another slice, of which so many cells of directions bound the depth. This one is A.
    pub(super) fn touch(&self, other: &Self, start: &mut WarmStart, cells: usize) -> Touch {
        let contact = pair_by_cells(&self.body, &other.body, start, cells);
        let n = contact.normal.into_inner();
        let [p, q] = contact.witnesses;
        let slopes = [-n.dot(&self.velocity(&p)), n.dot(&other.velocity(&q))];
        Touch { at: [self.at, other.at], contact, slopes }
    }

    /// How a point of the slice moves with the place, in metres a radian.
    fn velocity(&self, p: &Point) -> Vector {
        let pose = self.body.pose();
        let local = pose.inverse_transform_point(p);
        let share = |x: f64, k: usize| (x / self.widths[k]).clamp(-1.0, 1.0) * self.growth[k];
        let grown = pose.rotation * Vector::new(share(local.x, 0), 0.0, share(local.z, 1));
        self.velocity + self.turning.cross(&(p - pose.translation.vector).coords) + grown
    }
}
