//! What the rays of a camera meet in a scene: exact surfaces, not meshes.

use crate::measure::first_hit;
use crate::scene::{Board, Scene};
use crate::shape::{Implicit, Posed, Ray};
use crate::surface::Surface;
use crate::{Direction, Point, Pose, Vector};

/// The surfaces of a scene, ready for the rays of one camera.
pub(super) struct Rays<'a> {
    scene: &'a Scene,
    targets: Vec<Target>,
    pose: Pose,
}

/// What the ray of a pixel meets.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    /// Along the optical axis, in metres.
    pub(super) depth: f64,
    /// Cosine of the angle between ray and normal.
    pub(super) incidence: f64,
    /// Number of the body from 1; 0 for what is no body.
    pub(super) label: u32,
    /// Outward unit normal in the world; zero where nothing is met.
    pub(super) normal: Vector,
}

const NOTHING: Seen =
    Seen { depth: f64::INFINITY, incidence: 1.0, label: 0, normal: Vector::new(0.0, 0.0, 0.0) };

/// A part of a body as rays meet it: in its own frame, which its bounds fit tightly.
struct Target {
    solid: Posed<Surface>,
    label: u32,
    centre: Point,
    radius: f64,
}

impl Target {
    fn new(solid: Posed<Surface>, label: u32) -> Self {
        let [low, high] = solid.shape().bounds();
        let centre = solid.pose() * nalgebra::center(&low, &high);
        Self { solid, label, centre, radius: 0.5 * (high - low).norm() }
    }

    /// Distance along the ray and normal in the world, when nearer than `max`.
    fn meet(&self, ray: &Ray, max: f64) -> Option<(f64, Vector)> {
        let to = self.centre - ray.origin;
        let middle = to.dot(&ray.direction);
        let aside = to.norm_squared() - middle * middle;
        if aside > self.radius * self.radius || middle < -self.radius {
            return None;
        }
        let pose = self.solid.pose();
        let hit = first_hit(self.solid.shape(), &local(pose, ray), max)?;
        Some((hit.distance, pose.rotation * hit.normal.into_inner()))
    }
}

impl Board {
    /// Distance along the ray and normal in the world, from outside.
    fn meet(&self, ray: &Ray) -> Option<(f64, Vector)> {
        let ray = local(&self.pose, ray);
        let (mut near, mut far) = ((f64::NEG_INFINITY, 0), f64::INFINITY);
        for k in 0..3 {
            let half = self.half_extents[k].copysign(ray.direction[k]);
            // a ray along a face divides by zero: infinities, or NaN that no comparison takes
            let [enters, leaves] = [-half, half].map(|h| (h - ray.origin[k]) / ray.direction[k]);
            if enters > near.0 {
                near = (enters, k);
            }
            far = far.min(leaves);
        }
        let axis = near.1;
        let normal = -Vector::ith(axis, 1f64.copysign(ray.direction[axis]));
        (near.0 > 0.0 && near.0 <= far).then(|| (near.0, self.pose.rotation * normal))
    }
}

/// A ray in the frame of a pose.
fn local(pose: &Pose, ray: &Ray) -> Ray {
    Ray {
        origin: pose.inverse_transform_point(&ray.origin),
        direction: pose.inverse_transform_unit_vector(&ray.direction),
    }
}

impl<'a> Rays<'a> {
    /// For a camera whose optical frame stands at `pose` in the world.
    pub(super) fn new(scene: &'a Scene, pose: &Pose) -> Self {
        let labelled = scene.bodies.iter().zip(1..);
        let targets = labelled
            .flat_map(|(body, label)| body.solids().into_iter().map(move |s| Target::new(s, label)))
            .collect();
        Self { scene, targets, pose: *pose }
    }

    /// The ray in the world; `along` is the point at depth 1 that it passes, in the optical frame.
    fn ray(&self, along: Vector) -> Ray {
        Ray {
            origin: Point::from(self.pose.translation.vector),
            direction: Direction::new_normalize(self.pose.rotation * along),
        }
    }

    /// What a ray meets first.
    pub(super) fn see(&self, along: Vector) -> Seen {
        let length = along.norm();
        let ray = self.ray(along);
        let mut nearest = f64::INFINITY;
        let mut seen = NOTHING;
        let mut take = |(t, normal): (f64, Vector), label| {
            let incidence = normal.dot(&ray.direction).abs();
            seen = Seen { depth: t / length, incidence, label, normal };
            t
        };
        let Scene { support, half_size, boards, .. } = self.scene;
        let up = support.normal().into_inner();
        let t = -support.height(&ray.origin) / up.dot(&ray.direction);
        let foot = ray.at(t);
        if t > 0.0 && foot.x.abs() <= half_size[0] && foot.y.abs() <= half_size[1] {
            nearest = take((t, up), 0);
        }
        for board in boards {
            if let Some(met) = board.meet(&ray).filter(|(t, _)| *t < nearest) {
                nearest = take(met, 0);
            }
        }
        for target in &self.targets {
            if let Some(met) = target.meet(&ray, nearest) {
                nearest = take(met, target.label);
            }
        }
        seen
    }

    /// True where a ray would meet a body, were nothing before it.
    pub(super) fn meets(&self, along: Vector, label: u32) -> bool {
        let ray = self.ray(along);
        let mut parts = self.targets.iter().filter(|target| target.label == label);
        parts.any(|target| target.meet(&ray, f64::INFINITY).is_some())
    }
}
