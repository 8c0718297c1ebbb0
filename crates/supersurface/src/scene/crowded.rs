//! Bodies that touch: packed side by side on a table, or piled up: standing, stacked on each other, leaning.
//!
//! That is geometry, not physics: a body slides, falls or tips until it touches, and stays where its middle is over what
//! carries it. Contacts are told by points of their surfaces, to about a millimetre.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::{Translation3, UnitQuaternion};

use crate::mesh::{MarchOptions, Resolution, march};
use crate::numeric::random::Stream;
use crate::scene::Body;
use crate::scene::layout::{Scene, SceneError, TRIALS, footprint, rests};
use crate::shape::{Implicit, Posed, SupportMap};
use crate::surface::Surface;
use crate::{Point, Pose, Vector};

/// How bodies that touch are laid out.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Crowd {
    /// All on the table, pushed together.
    Packed,
    /// Some on the table, some on top of others, some leaning.
    Pile,
}

/// Cells along a body of the mesh by whose vertices contacts are told, and directions of support points beside them.
const CELLS: usize = 24;
const CORNERS: usize = 200;
/// Distance up to which bodies touch, in metres.
const TOUCH: f64 = 0.0015;
/// A body is carried where contacts surround its middle at least so far, in metres.
const CARRIED: f64 = 0.006;
/// Halvings of a way to the first contact.
const HALVINGS: usize = 14;
/// Steepest and least lean, in radians.
const LEAN: [f64; 2] = [0.2, 1.1];

/// Puts the shapes on a table so that they touch, about its middle. The same seed gives the same scene. Fails when a body
/// finds no place within the table.
///
/// ```
/// use supersurface::scene::{Crowd, crowded, household};
/// let scene = crowded(&household(4, 1)?, Crowd::Pile, [0.3, 0.3], 1)?;
/// assert_eq!(scene.bodies.len(), 4);
/// # Ok::<(), supersurface::scene::SceneError>(())
/// ```
pub fn crowded(
    shapes: &[(String, Surface)],
    crowd: Crowd,
    half_size: [f64; 2],
    seed: u64,
) -> Result<Scene, SceneError> {
    let mut placed: Vec<Solid> = Vec::new();
    for (index, (name, shape)) in shapes.iter().enumerate() {
        let mut stream = Stream::new(seed, index as u64);
        let solid = Solid::new(*shape, seed ^ index as u64)?;
        let found = (0..TRIALS).find_map(|_| {
            let pose = match (crowd, stream.index(10)) {
                (Crowd::Packed, _) | (Crowd::Pile, 0..4) => pushed(&solid, &placed, &mut stream),
                (Crowd::Pile, 4..8) => stacked(&solid, &placed, &mut stream),
                (Crowd::Pile, _) => leaning(&solid, &placed, &mut stream),
            }?;
            let at = pose.translation.vector;
            let radius = solid.radius;
            let within = at.x.abs() + radius <= half_size[0] && at.y.abs() + radius <= half_size[1];
            within.then_some(pose)
        });
        let none = || SceneError::NoRoom { name: name.clone(), trials: TRIALS };
        placed.push(solid.at(found.ok_or_else(none)?)?);
    }
    let mut scene = Scene::empty(half_size);
    for ((name, shape), solid) in shapes.iter().zip(placed) {
        scene.bodies.push(Body::single(name, *shape, *solid.surface.pose())?);
    }
    Ok(scene)
}

/// A body with points of its surface, in its own frame.
struct Solid {
    surface: Posed<Surface>,
    points: Vec<Point>,
    radius: f64,
}

impl Solid {
    fn new(shape: Surface, seed: u64) -> Result<Self, SceneError> {
        let surface = Posed::new(shape, Pose::identity())?;
        let cells = MarchOptions { resolution: Resolution::Count(CELLS), ..Default::default() };
        let mesh = march(&shape, &cells).ok();
        let mut points = mesh.map_or_else(Vec::new, |mesh| mesh.vertices().to_vec());
        // the corners, which a grid misses
        let mut stream = Stream::new(seed, 0);
        let corner = |_| {
            let way = Vector::from(std::array::from_fn::<_, 3, _>(|_| stream.normal()));
            shape.support_point(&way)
        };
        points.extend((0..CORNERS).map(corner));
        let radius = points.iter().map(|p| p.coords.norm()).fold(0.0, f64::max);
        Ok(Self { surface, points, radius })
    }

    fn at(self, pose: Pose) -> Result<Self, SceneError> {
        Ok(Self { surface: Posed::new(*self.surface.shape(), pose)?, ..self })
    }

    /// Its points that are inside another body, when it stands at `pose`, in the world.
    fn inside<'a>(&'a self, pose: &Pose, other: &'a Posed<Surface>) -> impl Iterator<Item = Point> {
        let pose = *pose;
        let points = self.points.iter().map(move |p| pose * p);
        points.filter(move |p| other.gauge(p) < 1.0)
    }

    /// Where this body at `pose` and others share matter.
    fn contacts<'a>(
        &'a self,
        pose: &'a Pose,
        others: &'a [Self],
    ) -> impl Iterator<Item = Point> + 'a {
        let near = others.iter().filter(|other| {
            let apart = pose.translation.vector - other.surface.pose().translation.vector;
            apart.norm() < self.radius + other.radius
        });
        near.flat_map(move |other| {
            let own = self.inside(pose, &other.surface);
            let moved = self.surface.moved(pose);
            let pose = *other.surface.pose();
            let theirs = other.points.iter().map(move |p| pose * p);
            own.chain(theirs.filter(move |p| moved.gauge(p) < 1.0))
        })
    }

    fn overlaps(&self, pose: &Pose, others: &[Self]) -> bool {
        self.contacts(pose, others).next().is_some()
    }

    /// The height of its frame over its lowest point, when turned.
    fn height(&self, turn: &UnitQuaternion<f64>) -> f64 {
        -(turn * self.surface.shape().support_point(&(turn.inverse() * -Vector::z()))).z
    }
}

/// The share of a way, from the free end at 0 to the other at 1, up to which nothing is met.
fn until_contact(is_met: impl Fn(f64) -> bool) -> f64 {
    let (mut free, mut met) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (free + met);
        if is_met(middle) {
            met = middle;
        } else {
            free = middle;
        }
    }
    free
}

/// One of the ways in which a body rests, turned at random.
fn resting(solid: &Solid, stream: &mut Stream) -> UnitQuaternion<f64> {
    let ways = rests(solid.surface.shape());
    let rest = ways.get(stream.index(ways.len())).copied().unwrap_or_default();
    UnitQuaternion::from_axis_angle(&Vector::z_axis(), stream.between(0.0, TAU)) * rest
}

/// Pushed over the table towards its middle until it touches what is there.
fn pushed(solid: &Solid, placed: &[Solid], stream: &mut Stream) -> Option<Pose> {
    let turn = resting(solid, stream);
    let way = stream.between(0.0, TAU);
    let far = placed.iter().map(|s| s.radius).sum::<f64>() * 2.0 + 2.0 * solid.radius;
    let goal = [0, 1].map(|_| stream.between(-0.03, 0.03));
    let at = |share: f64| {
        let r = (1.0 - share) * far;
        let at = Translation3::new(goal[0] + r * way.cos(), goal[1] + r * way.sin(), 0.0);
        Pose::from_parts(Translation3::from(at.vector + Vector::z() * solid.height(&turn)), turn)
    };
    // the first contact on a coarse walk, then halvings
    let steps = (far / 0.004).ceil().max(1.0);
    let met = (0..=steps as usize).find(|k| solid.overlaps(&at(*k as f64 / steps), placed));
    let Some(met) = met else { return Some(at(1.0)) };
    let from = met.checked_sub(1)? as f64 / steps;
    let share = until_contact(|s| solid.overlaps(&at(from + s / steps), placed));
    Some(at(from + share / steps))
}

/// Let down on what is placed until it touches, where that carries it.
fn stacked(solid: &Solid, placed: &[Solid], stream: &mut Stream) -> Option<Pose> {
    let under = placed.get(stream.index(placed.len().max(1)))?;
    let turn = resting(solid, stream);
    let place = under.surface.pose().translation.vector;
    let mut aside = || stream.between(-0.5, 0.5) * under.radius;
    let (x, y) = (place.x + aside(), place.y + aside());
    let top = placed.iter().map(|s| s.surface.support_point(&Vector::z()).z).fold(0.0, f64::max);
    let ground = solid.height(&turn);
    let at = |z: f64| Pose::from_parts(Translation3::new(x, y, z + ground), turn);
    if solid.overlaps(&at(top + TOUCH), placed) {
        return None;
    }
    let steps = (top / 0.004).ceil().max(1.0);
    let down = |k: f64| at(top * (1.0 - k / steps) + TOUCH);
    let met = (0..=steps as usize).find(|k| solid.overlaps(&down(*k as f64), placed))?;
    let from = met.checked_sub(1)? as f64;
    let share = until_contact(|s| solid.overlaps(&down(from + s), placed));
    let rest = down(from + share);
    // contacts on all sides of its middle
    let lower = Pose::from_parts(
        Translation3::from(rest.translation.vector - Vector::z() * TOUCH),
        rest.rotation,
    );
    let contacts: Vec<Point> = solid.contacts(&lower, placed).collect();
    let reaches = |angle: f64| {
        let (s, c) = angle.sin_cos();
        contacts.iter().any(|p| (p.x - x) * c + (p.y - y) * s > CARRIED)
    };
    (0..16).all(|k| reaches(TAU * f64::from(k) / 16.0)).then_some(rest)
}

/// Tipped over from where it stands beside another body until it leans on it.
fn leaning(solid: &Solid, placed: &[Solid], stream: &mut Stream) -> Option<Pose> {
    let on = placed.get(stream.index(placed.len().max(1)))?;
    // long bodies lean: upright, with their longest axis vertical
    let half = solid.surface.shape().half_extents();
    let longest = (0..3).max_by(|a, b| half[*a].total_cmp(&half[*b]))?;
    let least = half.iter().copied().fold(f64::INFINITY, f64::min);
    if half[longest] < 1.8 * least {
        return None;
    }
    let upright = match longest {
        0 => UnitQuaternion::from_axis_angle(&Vector::y_axis(), -FRAC_PI_2),
        1 => UnitQuaternion::from_axis_angle(&Vector::x_axis(), FRAC_PI_2),
        _ => UnitQuaternion::identity(),
    };
    let way = stream.between(0.0, TAU);
    let (s, c) = way.sin_cos();
    let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), way) * upright;
    let gap = stream.between(0.3, 1.2) * half[longest];
    let from = on.surface.pose().translation.vector;
    let foot = footprint(solid.surface.shape(), &upright).x;
    let beside = on.radius + foot + gap;
    // tips about the horizontal axis across its way
    let across = nalgebra::Unit::new_normalize(Vector::new(-s, c, 0.0));
    let at = |share: f64| {
        let turn = UnitQuaternion::from_axis_angle(&across, -share * LEAN[1]) * turn;
        let lift = solid.height(&turn);
        let reach = share * half[longest];
        let place =
            Translation3::new(from.x + c * (beside - reach), from.y + s * (beside - reach), lift);
        Pose::from_parts(place, turn)
    };
    if solid.overlaps(&at(0.0), placed) || !solid.overlaps(&at(1.0), placed) {
        return None;
    }
    let share = until_contact(|s| solid.overlaps(&at(s), placed));
    let rest = at(share);
    // what it leans on is under its upper half
    let lower = Pose::from_parts(
        Translation3::from(rest.translation.vector - Vector::new(c, s, 0.5) * TOUCH),
        rest.rotation,
    );
    let held = solid.contacts(&lower, placed).any(|p| p.z > rest.translation.z);
    (share * LEAN[1] > LEAN[0] && held).then_some(rest)
}
