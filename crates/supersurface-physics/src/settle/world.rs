//! The fall: a rapier world with lengths, speeds and damping in proportion to the bodies.

use parry3d_f64::math::{Pose as ParryPose, Rotation, Vector as ParryVector};
use parry3d_f64::shape::SharedShape;
use rapier3d_f64::dynamics::{
    IntegrationParameters, RigidBodyBuilder, RigidBodyHandle, SpringCoefficients,
};
use rapier3d_f64::geometry::ColliderBuilder;
use rapier3d_f64::pipeline::PhysicsWorld;
use supersurface::Point;

use super::overlap::{Item, Layout};
use super::{Falling, Ground, Rest, SettleError, SettleOptions};
use crate::convert::{from_point, from_pose, from_vector, to_pose};
use crate::dispatch::Dispatcher;
use crate::shape::shape;

/// Contacts are predicted from this share of a body's half size on.
const PREDICTION: f64 = 0.03;
/// A pair's contacts are taken from the step before while it moved by less than this share of the half size, and at most
/// [`FARTHEST`] metres.
const RECYCLED: f64 = 2e-3;
const FARTHEST: f64 = 4e-5;
/// What rapier counts as touching, as a share of the half size.
const SLOP: f64 = 1e-3;
/// Bodies keep this distance, as a share of the smallest half size, and at most [`WIDEST_SKIN`] metres.
const SKIN: f64 = 1e-3;
const WIDEST_SKIN: f64 = 2e-5;
/// Frequencies of the springs that push bodies out of each other and out of the ground, as shares of the rate: stiffer ones
/// keep bodies from coming to rest, softer ones leave deeper overlaps to the correction.
const STIFFNESS: [f64; 2] = [0.35, 0.25];
/// Their damping ratio, rapier's default.
const DAMPING: f64 = 10.0;
/// The share of the time after which the speed of rest grows, and by what it has grown when the time is over.
const PATIENT: f64 = 0.25;
const LATE: f64 = 10.0;
/// How far below everything a body is lost, in its sizes.
const LOST: f64 = 4.0;

/// Seconds for which a body must have stayed in place.
const WATCHED: f64 = 0.5;

/// Where a body was when it last moved, and for how many steps it has been there since.
#[derive(Clone, Copy)]
struct Watch {
    place: ParryVector,
    turn: Rotation,
    still: f64,
}

/// By what the speed of rest has grown when a share of the time is over.
fn grown(share: f64) -> f64 {
    1.0 + (LATE - 1.0) * ((share - PATIENT) / (1.0 - PATIENT)).max(0.0)
}

/// A world of falling bodies.
pub(super) struct Fall {
    world: PhysicsWorld,
    handles: Vec<RigidBodyHandle>,
    /// Shapes of the bodies' parts with their poses in the body, and half the body's size in metres.
    bodies: Vec<(Vec<(ParryPose, SharedShape)>, f64)>,
    ground: Vec<(ParryPose, SharedShape)>,
    lost: Vec<bool>,
    watched: Vec<Watch>,
    /// Below this height along gravity nothing is left to lie on, apart from the floor.
    lowest: f64,
}

impl Fall {
    pub(super) fn new(
        falling: &[Falling],
        ground: &Ground,
        options: &SettleOptions,
    ) -> Result<Self, SettleError> {
        let mut bodies = Vec::new();
        for (body, Falling { parts, .. }) in falling.iter().enumerate() {
            let shapes: Result<Vec<_>, _> = parts
                .iter()
                .map(|p| Ok((from_pose(p.body().pose()), shape(p.body().shape())?)))
                .collect();
            let shapes = shapes.map_err(|why| SettleError::Body { body, why })?;
            let boxes = shapes.iter().map(|(pose, s)| s.compute_aabb(pose));
            let Some(bounds) = boxes.reduce(|a, b| {
                parry3d_f64::bounding_volume::Aabb::new(a.mins.min(b.mins), a.maxs.max(b.maxs))
            }) else {
                return Err(SettleError::Body { body, why: crate::NoShape::Empty });
            };
            bodies.push((shapes, bounds.half_extents().max_element()));
        }
        let statics = ground_shapes(ground)?;
        let smallest = bodies.iter().map(|(_, r)| *r).fold(f64::INFINITY, f64::min).min(1e6);
        let down = options.gravity.normalize();
        let lowest = statics.iter().filter(|(_, s)| s.as_halfspace().is_none()).map(|(pose, s)| {
            let bounds = s.compute_aabb(pose);
            let vertices = bounds.vertices();
            vertices.iter().map(|v| v.dot(from_vector(&down))).fold(f64::NEG_INFINITY, f64::max)
        });
        let lowest = match ground.floor {
            Some(_) => f64::INFINITY,
            None => lowest.fold(f64::NEG_INFINITY, f64::max),
        };

        let mut world = PhysicsWorld::new();
        world.gravity = from_vector(&options.gravity);
        world.narrow_phase.set_query_dispatcher(Dispatcher);
        world.integration_parameters = integration_parameters(smallest, options.rate);
        // soft CCD sees what comes
        world.integration_parameters.max_ccd_substeps = 0;
        let skin = 0.5 * (SKIN * smallest).min(WIDEST_SKIN);
        for (pose, shape) in &statics {
            let collider = ColliderBuilder::new(shape.clone())
                .position(*pose)
                .friction(ground.friction)
                .restitution(ground.restitution)
                .contact_skin(skin);
            world.insert_collider(collider, None);
        }
        let g = options.gravity.norm();
        let mut handles = Vec::new();
        for (body, (shapes, half)) in falling.iter().zip(&bodies) {
            let damping = (g / half).sqrt() / options.rocking;
            let rigid = RigidBodyBuilder::dynamic()
                .pose(from_pose(&body.start))
                .angular_damping(damping)
                .soft_ccd_prediction(*half);
            let handle = world.insert_body(rigid);
            for ((pose, shape), part) in shapes.iter().zip(&body.parts) {
                let collider = ColliderBuilder::new(shape.clone())
                    .position(*pose)
                    .density(part.density())
                    .friction(body.friction)
                    .restitution(body.restitution)
                    .contact_skin(skin);
                world.insert_collider(collider, Some(handle));
            }
            handles.push(handle);
        }
        Dispatcher.check_world(&world.bodies, &world.colliders)?;
        let lost = vec![false; handles.len()];
        let start = Watch { place: ParryVector::ZERO, turn: Rotation::IDENTITY, still: 0.0 };
        let watched = vec![start; handles.len()];
        Ok(Self { world, handles, bodies, ground: statics, lost, watched, lowest })
    }

    /// Steps until all lie still or the time is over; returns the simulated seconds.
    pub(super) fn run(&mut self, options: &SettleOptions) -> f64 {
        let steps = (options.time_limit * options.rate) as usize;
        for step in 0..steps {
            if self.watched.iter().all(|watch| watch.still >= options.rate * WATCHED) {
                return step as f64 / options.rate;
            }
            self.be_still(options, step as f64 / steps as f64);
            self.world.step();
            self.watch(options, step as f64 / steps as f64);
            self.drop_lost(options);
        }
        steps as f64 / options.rate
    }

    /// Sets the speeds below which bodies are still: those of the options until a quarter of the time is over, then growing,
    /// so that what only trembles comes to rest.
    fn be_still(&mut self, options: &SettleOptions, share: f64) {
        let grown = grown(share);
        let g = options.gravity.norm();
        for (handle, (_, half)) in self.handles.iter().zip(&self.bodies) {
            if let Some(body) = self.world.bodies.get_mut(*handle) {
                let speed = options.still * (g * half).sqrt();
                body.activation_mut().normalized_linear_threshold = grown * speed;
            }
        }
    }

    /// Counts for how many steps each body has stayed where it is, give or take what a body that is still may move in half a
    /// second. What trembles in place is still, however fast.
    fn watch(&mut self, options: &SettleOptions, share: f64) {
        let allowed = grown(share) * options.still * WATCHED;
        let g = options.gravity.norm();
        let bodies = self.handles.iter().zip(&self.bodies).zip(&mut self.watched);
        for ((handle, (_, half)), watch) in bodies {
            let body = &self.world.bodies[*handle];
            let (place, turn) = (body.center_of_mass(), body.position().rotation);
            let turned = watch.turn.inverse() * turn;
            let angle = 2.0 * turned.xyz().length();
            let way = (place - watch.place).length() + angle * half;
            if way <= allowed * (g * half).sqrt() || body.is_sleeping() {
                watch.still += 1.0;
            } else {
                *watch = Watch { place, turn, still: 0.0 };
            }
        }
    }

    /// Takes out what has fallen off.
    fn drop_lost(&mut self, options: &SettleOptions) {
        let down = from_vector(&options.gravity.normalize());
        for (k, handle) in self.handles.iter().enumerate() {
            let Some(body) = self.world.bodies.get_mut(*handle) else { continue };
            let at = body.position().translation;
            let fallen = at.dot(down) > self.lowest + LOST * self.bodies[k].1;
            if !self.lost[k] && (fallen || !at.is_finite()) {
                self.lost[k] = true;
                body.set_enabled(false);
                body.sleep();
            }
        }
    }

    /// Half the size of a body in metres, and its centre of mass in its frame.
    pub(super) fn shape(&self, body: usize) -> (f64, ParryVector) {
        let rigid = &self.world.bodies[self.handles[body]];
        (self.bodies[body].1, rigid.local_center_of_mass())
    }

    pub(super) fn rests(&self, rate: f64) -> Vec<Rest> {
        let rest = |((handle, lost), watch): ((&RigidBodyHandle, &bool), &Watch)| {
            let body = &self.world.bodies[*handle];
            let at_rest = watch.still >= WATCHED * rate && !lost;
            Rest { pose: to_pose(body.position()), at_rest, lost: *lost }
        };
        self.handles.iter().zip(&self.lost).zip(&self.watched).map(rest).collect()
    }

    /// All shapes where they are now.
    pub(super) fn layout(&self) -> Layout {
        let items = self.bodies.iter().enumerate().filter(|(k, _)| !self.lost[*k]);
        let moving = items.flat_map(|(body, (shapes, _))| {
            shapes.iter().map(move |(local, shape)| Item {
                body: Some(body),
                local: *local,
                shape: shape.clone(),
            })
        });
        let fixed = self.ground.iter().map(|(pose, shape)| Item {
            body: None,
            local: *pose,
            shape: shape.clone(),
        });
        let poses = self.handles.iter().map(|h| *self.world.bodies[*h].position()).collect();
        let masses = self.handles.iter().map(|h| self.world.bodies[*h].mass()).collect();
        Layout::new(moving.chain(fixed).collect(), poses, masses)
    }
}

/// rapier's parameters for bodies whose smallest has this half size in metres (half of its largest extent), and this many
/// steps per second: rapier's own suit bodies of metres, and let those of centimetres sink and creep.
///
/// ```
/// let parameters = supersurface_physics::integration_parameters(0.03, 240.0);
/// assert!((parameters.prediction_distance() - 0.0009).abs() < 1e-15);
/// ```
pub fn integration_parameters(half_size: f64, rate: f64) -> IntegrationParameters {
    let spring = |share: f64| SpringCoefficients::new(share * rate, DAMPING);
    let [between, ground] = STIFFNESS;
    IntegrationParameters {
        dt: rate.recip(),
        normalized_prediction_distance: PREDICTION * half_size,
        normalized_allowed_linear_error: SLOP * half_size,
        normalized_contact_recycle_distance: (RECYCLED * half_size).min(FARTHEST),
        contact_softness: spring(between),
        static_contact_softness: spring(ground),
        ..IntegrationParameters::default()
    }
}

fn ground_shapes(ground: &Ground) -> Result<Vec<(ParryPose, SharedShape)>, SettleError> {
    let mut shapes = Vec::new();
    if let Some(plane) = &ground.floor {
        let on_plane = from_point(&plane.project(&Point::origin()));
        let normal = from_vector(&plane.normal());
        shapes.push((ParryPose::from_translation(on_plane), SharedShape::halfspace(normal)));
    }
    for (pose, [x, y, z]) in &ground.cuboids {
        shapes.push((from_pose(pose), SharedShape::cuboid(*x, *y, *z)));
    }
    if let Some(mesh) = &ground.mesh {
        let vertices: Vec<ParryVector> = mesh.vertices().iter().map(from_point).collect();
        let made = SharedShape::trimesh(vertices, mesh.triangles().to_vec());
        let made = made.map_err(|why| SettleError::Mesh(why.to_string()))?;
        shapes.push((ParryPose::identity(), made));
    }
    Ok(shapes)
}
