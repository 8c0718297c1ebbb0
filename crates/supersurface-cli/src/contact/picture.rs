//! Two bodies, the points where they are nearest or deepest in each other, and the normal.

use supersurface::contact::{Contact, Convex};
use supersurface::picture::{Colour, Image, PALETTE, Picture, View};
use supersurface::shape::{Implicit, Posed};
use supersurface::surface::Solid;
use supersurface::{Point, Vector};

use super::text::Lengths;

const SIZE: [usize; 2] = [900, 700];
const INK: Colour = [28, 30, 34];
const RED: Colour = [210, 30, 45];
/// Where one looks from, before the normal is brought across the picture.
const SIDE: Vector = Vector::new(0.9, -1.5, 1.1);

/// Draws them.
pub(super) fn picture(bodies: &[Posed<Convex>; 2], contact: &Contact) -> Image {
    let n = contact.normal.into_inner();
    let solids = bodies.clone().map(|b| (Solid::from(*b.shape().shape()), *b.pose()));
    let around: Vec<Point> = bodies.iter().flat_map(corners).collect();
    let middle = around.iter().map(|p| p.coords).sum::<Vector>() / around.len() as f64;
    let reach = around.iter().map(|p| (p.coords - middle).norm()).fold(0.0, f64::max);
    // from the side, so that a gap along the normal shows
    let side = SIDE - n * (0.8 * SIDE.dot(&n));
    let from = Point::from(middle + side.normalize() * (4.0 * reach));
    let view = View::towards(&around, &Vector::z(), &from);
    let mut picture = Picture::new(SIZE[0], SIZE[1], &view);
    for ((solid, pose), colour) in solids.iter().zip(PALETTE) {
        picture.solid(solid, pose, colour, 0.45);
    }
    let [on_a, on_b] = &contact.witnesses;
    picture.line(on_a, on_b, RED, 4.0);
    // the arrow goes on where the segment ends, along the normal
    let front = if contact.distance < 0.0 { on_a } else { on_b };
    picture.arrow(front, &(front + n * (0.3 * reach)), INK, 3.0);
    picture.points(&[*on_a, *on_b], |_| RED, Some(11.0));
    picture.label(&bodies[0].pose().translation.vector.into(), "A", PALETTE[0]);
    picture.label(&bodies[1].pose().translation.vector.into(), "B", PALETTE[1]);
    picture.text(16.0, 14.0, &Lengths::of(bodies).told(contact.distance), INK, 18.0);
    picture.finish()
}

/// Corners of the box around a body along its own axes.
fn corners(body: &Posed<Convex>) -> Vec<Point> {
    let [low, high] = body.shape().shape().bounds();
    let corner = |k: usize| {
        body.pose() * Point::from(Vector::from_fn(|i, _| if k >> i & 1 == 0 { low[i] } else { high[i] }))
    };
    (0..8).map(corner).collect()
}
