//! parry in double precision: GJK and EPA on supersurface's own support map.

use std::hint::black_box;

use parry3d_f64::math::{Pose, Rotation, Vector};
use parry3d_f64::query::Contact;
use parry3d_f64::query::details::contact_support_map_support_map_with_params;
use parry3d_f64::query::gjk::{GJKResult, VoronoiSimplex};
use parry3d_f64::shape::SupportMap;
use supersurface::shape::{Posed, Superellipsoid, SupportMap as OurSupportMap};

use crate::contender::Contender;
use crate::pairs::Pair;

/// A superellipsoid that parry can query.
#[derive(Clone, Copy, Debug)]
struct Shape(Superellipsoid);

impl SupportMap for Shape {
    fn local_support_point(&self, n: Vector) -> Vector {
        let p = OurSupportMap::support_point(&self.0, &[n.x, n.y, n.z].into());
        Vector::new(p.x, p.y, p.z)
    }
}

/// A pair in parry's types.
pub struct Parry64 {
    a: (Shape, Pose),
    b: (Shape, Pose),
    b_later: (Shape, Pose),
    /// The last warm normal, in A's frame.
    normal: Option<Vector>,
}

impl Contender for Parry64 {
    const NAME: &'static str = "parry f64";
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
        contact.map_or(f64::NAN, |c| c.dist)
    }
}

/// What `parry::query::contact` does for two support maps at any distance, with the first direction given.
fn contact(a: &(Shape, Pose), b: &(Shape, Pose), start: &mut Option<Vector>) -> Option<Contact> {
    let b_in_a = a.1.inv_mul(&b.1);
    let mut simplex = VoronoiSimplex::new();
    let found = contact_support_map_support_map_with_params(
        &b_in_a,
        &a.0,
        &b.0,
        f64::MAX,
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
    let (t, q) = (posed.pose().translation, posed.pose().rotation);
    let pose =
        Pose::from_parts(Vector::new(t.x, t.y, t.z), Rotation::from_xyzw(q.i, q.j, q.k, q.w));
    (Shape(*posed.shape()), pose)
}
