//! What the rays of a camera meet in a scene: exact surfaces, not meshes.

use crate::measure::{block_hits, first_hit, ring_hit};
use crate::numeric::lanes::WIDTH;
use crate::scene::{Board, Scene};
use crate::shape::{Implicit, Posed, Ray, Superellipsoid};
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
    pub(super) normal: nalgebra::Vector3<f32>,
}

const NOTHING: Seen = Seen {
    depth: f64::INFINITY,
    incidence: 1.0,
    label: 0,
    normal: nalgebra::Vector3::new(0.0, 0.0, 0.0),
};

/// A part of a body as rays from one point meet it: in its own frame, which its bounds fit tightly.
struct Target {
    solid: Posed<Surface>,
    label: u32,
    /// To the middle of the ball around it, in the world.
    to: Vector,
    radius: f64,
    /// Where the rays start, in its own frame.
    eye: Point,
    /// The solid itself, where blocks of rays can be told at once what they meet.
    convex: Option<Superellipsoid>,
}

impl Target {
    fn new(solid: Posed<Surface>, label: u32, eye: &Point) -> Self {
        let [low, high] = solid.shape().bounds();
        let to = solid.pose() * nalgebra::center(&low, &high) - eye;
        let convex = match solid.shape() {
            Surface::Superellipsoid(s) if s.is_convex() && solid.gauge(eye) > 1.0 => Some(*s),
            _ => None,
        };
        let local = solid.to_local(eye);
        Self { solid, label, to, radius: 0.5 * (high - low).norm(), eye: local, convex }
    }

    /// True where a ray passes through the ball around it, nearer than `max`.
    #[inline]
    fn is_near(&self, direction: &Vector, max: f64) -> bool {
        let middle = self.to.dot(direction);
        let aside = self.to.norm_squared() - middle * middle;
        aside <= self.radius * self.radius && middle >= -self.radius && middle - self.radius < max
    }

    /// The rays that pass so near that they may meet it.
    fn passing(&self, directions: &[Vector], max: impl Fn(usize) -> f64) -> Vec<usize> {
        let near = directions.iter().enumerate().filter(|(ray, d)| self.is_near(d, max(*ray)));
        near.map(|(ray, _)| ray).collect()
    }

    /// Distance along a ray and normal in the world, when nearer than `max`.
    fn meet(&self, direction: &Vector, max: f64) -> Option<(f64, Vector)> {
        let rotation = &self.solid.pose().rotation;
        let direction = Direction::new_unchecked(rotation.inverse() * direction);
        let ray = Ray { origin: self.eye, direction };
        let hit = match self.solid.shape() {
            Surface::Supertoroid(ring) => ring_hit(ring, &ray, max),
            other => first_hit(other, &ray, max),
        }?;
        Some((hit.distance, rotation * hit.normal.into_inner()))
    }

    /// The same of several rays: `take` gets the index of each that meets it.
    fn meet_all(
        &self,
        rays: &[usize],
        directions: &[Vector],
        max: impl Fn(usize) -> f64,
        mut take: impl FnMut(usize, f64, Vector),
    ) {
        let Some(solid) = &self.convex else {
            for ray in rays {
                if let Some((t, normal)) = self.meet(&directions[*ray], max(*ray)) {
                    take(*ray, t, normal);
                }
            }
            return;
        };
        let rotation = self.solid.pose().rotation.to_rotation_matrix();
        for block in rays.chunks(WIDTH) {
            let (mut local, mut farthest) = ([[0.0; WIDTH]; 3], [0.0; WIDTH]);
            for i in 0..WIDTH {
                // the last block repeats its last ray
                let ray = block[i.min(block.len() - 1)];
                let direction = rotation.inverse_transform_vector(&directions[ray]);
                for k in 0..3 {
                    local[k][i] = direction[k];
                }
                farthest[i] = max(ray);
            }
            let hits = block_hits(solid, &self.eye.coords.into(), &local, &farthest);
            for (i, ray) in block.iter().enumerate() {
                if hits.distance[i] < farthest[i] {
                    let normal = Vector::from(hits.normal.map(|row| row[i])).normalize();
                    take(*ray, hits.distance[i], rotation * normal);
                }
            }
        }
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
        let eye = Point::from(pose.translation.vector);
        let labelled = scene.bodies.iter().zip(1..);
        let targets = labelled.flat_map(|(body, label)| {
            body.solids().into_iter().map(move |solid| Target::new(solid, label, &eye))
        });
        Self { scene, targets: targets.collect(), pose: *pose }
    }

    /// What each of some rays meets first; `along` are the points at depth 1 that they pass, in the optical frame.
    pub(super) fn see(&self, along: &[Vector]) -> Vec<Seen> {
        let directions: Vec<Vector> =
            along.iter().map(|along| self.pose.rotation * along.normalize()).collect();
        let mut seen: Vec<Seen> = directions.iter().map(|d| self.ground(d)).collect();
        for target in &self.targets {
            let near = target.passing(&directions, |ray| seen[ray].depth);
            let label = target.label;
            let mut found = Vec::with_capacity(near.len());
            target.meet_all(
                &near,
                &directions,
                |ray| seen[ray].depth,
                |ray, depth, normal| found.push((ray, depth, normal)),
            );
            for (ray, depth, normal) in found {
                let incidence = normal.dot(&directions[ray]).abs();
                seen[ray] = Seen { depth, incidence, label, normal: normal.cast::<f32>() };
            }
        }
        // so far along the rays
        for (seen, along) in seen.iter_mut().zip(along) {
            seen.depth /= along.norm();
        }
        seen
    }

    /// The table and the boards, with the distance along the ray as depth.
    fn ground(&self, direction: &Vector) -> Seen {
        let Scene { support, half_size, boards, .. } = self.scene;
        let origin = Point::from(self.pose.translation.vector);
        let ray = Ray { origin, direction: Direction::new_unchecked(*direction) };
        let mut seen = NOTHING;
        let mut take = |(t, normal): (f64, Vector)| {
            let incidence = normal.dot(direction).abs();
            seen = Seen { depth: t, incidence, label: 0, normal: normal.cast::<f32>() };
            t
        };
        let mut nearest = f64::INFINITY;
        let up = support.normal().into_inner();
        let t = -support.height(&origin) / up.dot(direction);
        let foot = ray.at(t);
        if t > 0.0 && foot.x.abs() <= half_size[0] && foot.y.abs() <= half_size[1] {
            nearest = take((t, up));
        }
        for board in boards {
            if let Some(met) = board.meet(&ray).filter(|(t, _)| *t < nearest) {
                nearest = take(met);
            }
        }
        seen
    }

    /// How many of some rays would meet each body, were nothing before it.
    pub(super) fn alone(&self, along: &[Vector]) -> Vec<u32> {
        let directions: Vec<Vector> =
            along.iter().map(|along| self.pose.rotation * along.normalize()).collect();
        let mut counts = vec![0; self.scene.bodies.len()];
        let mut met = vec![0u32; along.len()];
        for target in &self.targets {
            let near = target.passing(&directions, |_| f64::INFINITY);
            // parts of a body follow each other: a ray that met one counts once
            target.meet_all(
                &near,
                &directions,
                |_| f64::INFINITY,
                |ray, _, _| {
                    counts[target.label as usize - 1] += u32::from(met[ray] != target.label);
                    met[ray] = target.label;
                },
            );
        }
        counts
    }
}
