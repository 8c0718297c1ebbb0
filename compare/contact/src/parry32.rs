//! parry in single precision, as most games and many robots run it: the same support map in f32.

use std::hint::black_box;

use parry3d::math::{Pose, Rotation, Vector};
use parry3d::query::Contact;
use parry3d::query::details::contact_support_map_support_map_with_params;
use parry3d::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d::shape::SupportMap;
use supersurface::shape::{Posed, Superellipsoid};

use crate::contender::Contender;
use crate::pairs::Pair;

/// A superellipsoid in f32. Its support map is supersurface's, written out: going to f64 and back would cost
/// parry time that is not its own.
#[derive(Clone, Copy, Debug)]
struct Shape {
    semi_axes: [f32; 3],
    exponents: [f32; 2],
}

impl SupportMap for Shape {
    fn local_support_point(&self, n: Vector) -> Vector {
        let ([a1, a2, a3], [e1, e2]) = (self.semi_axes, self.exponents);
        let (planar, [x, y]) = dual((a1 * n.x).abs(), (a2 * n.y).abs(), e2);
        let (_, [xy, z]) = dual(planar, (a3 * n.z).abs(), e1);
        Vector::new(
            (a1 * x * xy).copysign(n.x),
            (a2 * y * xy).copysign(n.y),
            (a3 * z).copysign(n.z),
        )
    }
}

/// The dual norm `(u^q + v^q)^(1/q)`, `q = 2/(2 - ε)`, of two numbers from 0, and its derivatives by them.
fn dual(u: f32, v: f32, epsilon: f32) -> (f32, [f32; 2]) {
    let largest = u.max(v);
    if largest == 0.0 {
        return (0.0, [0.0; 2]);
    }
    let q = 2.0 / (2.0 - epsilon);
    let (u, v) = (u / largest, v / largest);
    let norm = (u.powf(q) + v.powf(q)).powf(1.0 / q);
    (largest * norm, [u, v].map(|part| (part / norm).powf(q - 1.0)))
}

/// A pair in parry's types.
pub struct Parry32 {
    a: (Shape, Pose),
    b: (Shape, Pose),
    b_later: (Shape, Pose),
    /// The last warm normal, in A's frame.
    normal: Option<Vector>,
}

impl Contender for Parry32 {
    const NAME: &'static str = "parry f32";
    type Contact = Option<Contact>;

    fn new(pair: &Pair) -> Self {
        Self { a: body(&pair.a), b: body(&pair.b), b_later: body(&pair.b_later), normal: None }
    }

    fn cold(&self) -> Option<Contact> {
        contact(black_box(&self.a), black_box(&self.b), &mut None)
    }

    fn warm(&mut self, later: bool) -> Option<Contact> {
        let b = if later { &self.b_later } else { &self.b };
        contact(black_box(&self.a), black_box(b), &mut self.normal)
    }

    fn distance(contact: &Option<Contact>) -> f64 {
        contact.map_or(f64::NAN, |c| c.dist.into())
    }
}

/// As in double precision.
fn contact(a: &(Shape, Pose), b: &(Shape, Pose), start: &mut Option<Vector>) -> Option<Contact> {
    let b_in_a = a.1.inv_mul(&b.1);
    let mut simplex = VoronoiSimplex::new();
    let found = contact_support_map_support_map_with_params(
        &b_in_a,
        &a.0,
        &b.0,
        f32::MAX,
        &mut simplex,
        *start,
    );
    let GJKResult::ClosestPoints(on_a, on_b, normal) = found else {
        return None;
    };
    *start = Some(normal);
    let world_normal = a.1.rotation * normal;
    let distance = (on_b - on_a).dot(normal);
    Some(Contact::new(a.1 * on_a, a.1 * on_b, world_normal, -world_normal, distance))
}

fn body(posed: &Posed<Superellipsoid>) -> (Shape, Pose) {
    let shape = Shape {
        semi_axes: posed.shape().semi_axes().map(|a| a as f32),
        exponents: posed.shape().exponents().map(|e| e as f32),
    };
    let [x, y, z] = posed.pose().translation.vector.map(|t| t as f32).into();
    let [i, j, k, w] = posed.pose().rotation.coords.map(|q| q as f32).into();
    (shape, Pose::from_parts(Vector::new(x, y, z), Rotation::from_xyzw(i, j, k, w)))
}
