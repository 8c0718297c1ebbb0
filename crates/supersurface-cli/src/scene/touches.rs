//! Where the bodies of a scene touch each other and what they lie on, by the exact queries.

use supersurface::contact::{Contact, Convex, WarmStart, half_space, pair, ring};
use supersurface::nalgebra;
use supersurface::scene::Scene;
use supersurface::shape::{Posed, Superellipsoid, Supertoroid, SupportMap};
use supersurface::surface::Surface;
use supersurface::{Point, Vector};
use supersurface_io::Touch;

/// Bodies touch that are no farther apart than this, in metres.
const NEAR: f64 = 5e-4;
/// Exponents of a box: its faces are where they should be, its edges 2 % of its size rounder.
const BOX: [f64; 2] = [0.02; 2];

/// A part as the queries take it. Other parts (tapered, bent, twisted) touch the table alone.
enum Part {
    Convex(Posed<Convex>),
    Ring(Posed<Supertoroid>),
    Other,
}

impl Part {
    fn new(solid: &Posed<Surface>) -> Self {
        let convex = |s: &Superellipsoid| Posed::new(Convex::new(*s).ok()?, *solid.pose()).ok();
        match solid.shape() {
            Surface::Superellipsoid(s) => convex(s).map_or(Self::Other, Self::Convex),
            Surface::Supertoroid(s) => {
                Posed::new(*s, *solid.pose()).map_or(Self::Other, Self::Ring)
            }
            _ => Self::Other,
        }
    }
}

/// A body or a board with its parts, each in its box along the world's axes.
struct Thing {
    name: String,
    parts: Vec<(Part, [Point; 2])>,
}

/// The box around a solid.
fn boxed(solid: &Posed<impl SupportMap>) -> [Point; 2] {
    let end = |sign: f64| {
        let coordinate = |k: usize| solid.support_point(&(Vector::ith(k, sign)))[k];
        Point::new(coordinate(0), coordinate(1), coordinate(2))
    };
    [end(-1.0), end(1.0)]
}

/// False for boxes that are farther apart than what touches.
fn near([a, b]: [&[Point; 2]; 2]) -> bool {
    (0..3).all(|k| a[0][k] <= b[1][k] + NEAR && b[0][k] <= a[1][k] + NEAR)
}

/// All touches, those with the table first.
pub(super) fn touches(scene: &Scene) -> Vec<Touch> {
    let mut found = Vec::new();
    let mut things = Vec::new();
    for body in &scene.bodies {
        let solids = body.solids();
        let contacts = solids.iter().map(|solid| half_space(solid, &scene.support));
        let names = [body.name.clone(), "table".to_owned()];
        found.extend(deepest(contacts).and_then(|contact| touch(names, &contact)));
        let parts = solids.iter().map(|s| (Part::new(s), boxed(s))).collect();
        things.push(Thing { name: body.name.clone(), parts });
    }
    for board in &scene.boards {
        let cuboid = Superellipsoid::new(board.half_extents, BOX).and_then(Convex::new);
        let part = cuboid.and_then(|c| Posed::new(c, board.pose));
        let parts = part.into_iter().map(|p| (Part::Convex(p), boxed(&p))).collect();
        things.push(Thing { name: board.name.clone(), parts });
    }
    for (i, a) in things.iter().take(scene.bodies.len()).enumerate() {
        for b in &things[i + 1..] {
            let pairs = a.parts.iter().flat_map(|p| b.parts.iter().map(move |q| (p, q)));
            let pairs = pairs.filter(|((_, p), (_, q))| near([p, q]));
            let contact = deepest(pairs.filter_map(|((p, _), (q, _))| between(p, q)));
            found.extend(contact.and_then(|c| touch([a.name.clone(), b.name.clone()], &c)));
        }
    }
    found
}

fn deepest(contacts: impl Iterator<Item = Contact>) -> Option<Contact> {
    contacts.min_by(|a, b| a.distance.total_cmp(&b.distance))
}

fn between(a: &Part, b: &Part) -> Option<Contact> {
    let turned = |mut contact: Contact| {
        contact.normal = -contact.normal;
        contact.witnesses.reverse();
        contact
    };
    match (a, b) {
        (Part::Convex(a), Part::Convex(b)) => Some(pair(a, b, &mut WarmStart::default())),
        (Part::Ring(a), Part::Convex(b)) => ring(a, b).ok(),
        (Part::Convex(a), Part::Ring(b)) => ring(b, a).ok().map(turned),
        _ => None,
    }
}

fn touch(between: [String; 2], contact: &Contact) -> Option<Touch> {
    let [p, q] = contact.witnesses;
    let point = nalgebra::center(&p, &q);
    let Contact { normal, distance, .. } = *contact;
    (distance < NEAR).then_some(Touch { between, point, normal, distance })
}
