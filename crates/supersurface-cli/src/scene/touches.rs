//! Where the bodies of a scene touch each other and what they lie on, by the exact queries.

use supersurface::contact::{Contact, Convex, Sliced, WarmStart, half_space, pair, solids};
use supersurface::nalgebra;
use supersurface::scene::Scene;
use supersurface::shape::{Posed, Superellipsoid, SupportMap};
use supersurface::surface::{Solid, Surface};
use supersurface::{Point, Vector};
use supersurface_io::Touch;

/// Bodies touch that are no farther apart than this, in metres.
const NEAR: f64 = 5e-4;
/// Exponents of a box: its faces are where they should be, its edges 2 % of its size rounder.
const BOX: [f64; 2] = [0.02; 2];

/// A part as the queries take it. Others (tapered, bent, twisted) touch the table alone, as do two rings: such depths take seconds.
struct Part {
    convex: Option<Posed<Convex>>,
    sliced: Option<Sliced>,
}

impl Part {
    fn new(solid: &Posed<Surface>) -> Self {
        let plain = matches!(solid.shape(), Surface::Superellipsoid(_) | Surface::Supertoroid(_));
        let sliced =
            || Sliced::new(&Posed::new(Solid::from(*solid.shape()), *solid.pose()).ok()?).ok();
        let sliced = if plain { sliced() } else { None };
        Self { convex: sliced.as_ref().and_then(Sliced::as_convex), sliced }
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
        let cuboid = Superellipsoid::new(board.half_extents, BOX).map(Surface::Superellipsoid);
        let solid = cuboid.and_then(|c| Posed::new(c, board.pose));
        let parts = solid.into_iter().map(|s| (Part::new(&s), boxed(&s))).collect();
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
    match (&a.convex, &b.convex) {
        (Some(a), Some(b)) => Some(pair(a, b, &mut WarmStart::default())),
        (None, None) => None,
        _ => solids(a.sliced.as_ref()?, b.sliced.as_ref()?).ok(),
    }
}

fn touch(between: [String; 2], contact: &Contact) -> Option<Touch> {
    let [p, q] = contact.witnesses;
    let point = nalgebra::center(&p, &q);
    let Contact { normal, distance, .. } = *contact;
    (distance < NEAR).then_some(Touch { between, point, normal, distance })
}
