//! Two bodies, the points where they are nearest or deepest in each other, and the normal.

use supersurface::contact::{Contact, Sliced};
use supersurface::picture::{Colour, Image, PALETTE, Picture, View};
use supersurface::shape::Implicit;
use supersurface::{Point, Vector};

use super::text::Lengths;

const SIZE: [usize; 2] = [900, 700];
/// Height of the words above.
const CAPTION: usize = 80;
const INK: Colour = [28, 30, 34];
const RED: Colour = [205, 25, 40];
/// Sides to look from; that which has the normal more across the picture is taken.
const SIDES: [Vector; 2] = [Vector::new(0.9, -1.5, 1.1), Vector::new(1.5, 0.9, 1.1)];
/// What is drawn so much nearer to the eye than it is lies before all bodies, and at the same place of the picture.
const BEFORE: f64 = 0.25;

/// Draws them, each body as if the other were glass.
pub(super) fn picture(bodies: &[Sliced; 2], contact: &Contact) -> Image {
    let n = contact.normal.into_inner();
    let boxes: Vec<Point> = bodies.iter().flat_map(corners).collect();
    let middle = boxes.iter().map(|p| p.coords).sum::<Vector>() / boxes.len() as f64;
    let reach = boxes.iter().map(|p| (p.coords - middle).norm()).fold(0.0, f64::max);
    let [on_a, on_b] = contact.witnesses;
    // the arrow goes on along the normal where the segment ends
    let tail = if contact.distance < 0.0 { on_a } else { on_b };
    let tip = tail + n * (0.3 * reach);
    let eye = Point::from(middle + beside(&n) * (4.0 * reach));
    let view = View::towards(&[&boxes[..], &[tip]].concat(), &Vector::z(), &eye);
    let before = |p: Point| eye + (p - eye) * BEFORE;
    let mut picture = Picture::new(SIZE[0], SIZE[1], &view);
    picture.line(&before(on_a), &before(on_b), RED, 4.0);
    picture.points(&[on_a, on_b].map(before), |_| RED, Some(11.0));
    picture.arrow(&before(tail), &before(tip), INK, 3.0);
    let [first, second] = [0, 1].map(|k| {
        let mut picture = picture.clone();
        let solid = bodies[k].solid();
        picture.solid(solid.shape(), solid.pose(), PALETTE[k], 0.9).finish()
    });
    let mean = |(p, q): (&u8, &u8)| p.midpoint(*q);
    let both =
        Image { pixels: first.pixels.iter().zip(&second.pixels).map(mean).collect(), ..first };
    let mut image = Image::filled(SIZE[0], CAPTION + SIZE[1], [255; 3]);
    image.paste(&both, 0, CAPTION);
    image.text(18.0, 16.0, &Lengths::of(bodies).told(contact.distance), INK, 22.0);
    let kind = if contact.distance < 0.0 { "deepest" } else { "nearest" };
    let legend = format!("red: the {kind} points; arrow: the normal, from A to B");
    image.text(18.0, 54.0, &legend, INK, 12.0);
    for (body, name, way) in [(&bodies[0], "A", -n), (&bodies[1], "B", n)] {
        if let Some([x, y]) = picture.project(&on_the_far_side(body, &way)) {
            image.text(x - 10.0, CAPTION as f64 + y - 14.0, name, INK, 28.0);
        }
    }
    image
}

/// A unit direction to look from, such that the normal lies about across the picture.
fn beside(n: &Vector) -> Vector {
    let [one, other] = SIDES.map(|side| side - n * (0.9 * side.dot(n)));
    if one.norm() >= other.norm() { one.normalize() } else { other.normalize() }
}

/// Where a body's name stands: half way from its centre to its end in a direction.
fn on_the_far_side(body: &Sliced, way: &Vector) -> Point {
    let solid = body.solid();
    let local = solid.pose().rotation.inverse_transform_vector(way);
    solid.pose() * Point::from(local * (0.5 * solid.shape().extent(&local)))
}

/// Corners of the box around a body along its own axes.
fn corners(body: &Sliced) -> Vec<Point> {
    let [low, high] = body.solid().shape().bounds();
    let corner = |k: usize| Vector::from_fn(|i, _| if k >> i & 1 == 0 { low[i] } else { high[i] });
    (0..8).map(|k| body.solid().pose() * Point::from(corner(k))).collect()
}
