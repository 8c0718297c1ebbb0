//! Bodies dropped until they lie still: the one call that makes a pile, a bin or a shelf.
//!
//! The fall is rapier's, with this crate's exact contacts and lengths in proportion to the bodies. What it leaves is then
//! corrected: a body alone on a level place is turned to the stable pose that it was rolling to, and bodies that still
//! overlap are pushed apart along their contact's normal until every overlap is below [`SettleOptions::tolerance`] by the
//! exact query. Same input, same bytes, on any number of threads.
//!
//! What is not guaranteed: rest is a place that a body has not left for half a second, as [`SettleOptions::still`] says; a
//! tall stack may creep for longer than [`SettleOptions::time_limit`] and is then reported as not at rest.

mod lowest;
mod overlap;
mod scene;
mod world;

pub use self::scene::settle_scene;
pub use self::world::integration_parameters;

use supersurface::combine::Part;
use supersurface::mesh::Mesh;
use supersurface::shape::Plane;
use supersurface::surface::Surface;
use supersurface::{Pose, Vector};

use crate::shape::NoShape;
use crate::{UnsupportedPair, convert};

/// A body that is to fall.
#[derive(Clone, Debug, PartialEq)]
pub struct Falling {
    /// What it is made of: convex parts, rings, bent and twisted parts, in its own frame, with their densities. Mass counts
    /// twice where parts overlap.
    pub parts: Vec<Part<Surface>>,
    /// Where it starts: its frame in the world, metres.
    pub start: Pose,
    /// Coefficient of friction, without unit, at least 0; that of two bodies is the mean.
    pub friction: f64,
    /// Coefficient of restitution in [0, 1]; that of two bodies is the mean.
    pub restitution: f64,
}

/// What the bodies fall on; none of it moves.
#[derive(Clone, Debug, PartialEq)]
pub struct Ground {
    /// A floor without end: the half space below a plane.
    pub floor: Option<Plane>,
    /// Boxes (a bin's walls, a shelf's boards): the pose of the centre in the world, and half edges in metres.
    pub cuboids: Vec<(Pose, [f64; 3])>,
    /// A triangle mesh in the world's frame, metres.
    pub mesh: Option<Mesh>,
    /// Coefficient of friction of all of it.
    pub friction: f64,
    /// Coefficient of restitution of all of it.
    pub restitution: f64,
}

impl Default for Ground {
    /// A floor at z = 0 and nothing else; friction 0.5, no restitution.
    fn default() -> Self {
        let floor = Plane::through(&supersurface::Point::origin(), Vector::z_axis());
        Self {
            floor: Some(floor),
            cuboids: Vec::new(),
            mesh: None,
            friction: 0.5,
            restitution: 0.0,
        }
    }
}

/// How bodies settle. The defaults suit bodies of 2 cm to 2 m.
#[derive(Clone, Debug, PartialEq)]
pub struct SettleOptions {
    /// Gravity in m/s², in the world's frame.
    pub gravity: Vector,
    /// Steps per second.
    pub rate: f64,
    /// Seconds after which the simulation ends, at rest or not.
    pub time_limit: f64,
    /// A body is still when in half a second no point of it gets farther than at this share of `√(g r)`, the speed of a fall
    /// through half its size `r`; when a quarter of the time is over it grows, to ten times this.
    pub still: f64,
    /// Rolling and rocking die out in this many times `√(r/g)`.
    pub rocking: f64,
    /// The deepest overlap that is left, in metres.
    pub tolerance: f64,
}

impl Default for SettleOptions {
    fn default() -> Self {
        Self {
            gravity: Vector::new(0.0, 0.0, -9.81),
            rate: 200.0,
            time_limit: 8.0,
            still: 0.004,
            rocking: 1.0,
            tolerance: 2e-5,
        }
    }
}

/// Where a body came to rest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Rest {
    /// Its frame in the world, in metres.
    pub pose: Pose,
    /// False where it still moved when the time was over.
    pub at_rest: bool,
    /// True where it fell off everything that it could lie on; its pose is then of no use.
    pub lost: bool,
}

/// What became of the bodies.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Settled {
    /// One for each body, in their order.
    pub bodies: Vec<Rest>,
    /// Simulated seconds.
    pub time: f64,
    /// The deepest overlap that the simulation left, in metres; 0 for none.
    pub simulated_overlap: f64,
    /// The deepest overlap after the correction, in metres.
    pub overlap: f64,
}

impl Settled {
    /// True when every body lies still and none is lost.
    pub fn all_at_rest(&self) -> bool {
        self.bodies.iter().all(|body| body.at_rest && !body.lost)
    }
}

/// Why nothing can be settled.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SettleError {
    /// A body has no shape.
    #[error("body {body}: {why}")]
    Body {
        /// Its place in the list.
        body: usize,
        /// What is wrong.
        why: NoShape,
    },
    /// A number is out of its range.
    #[error("{what} is {value}: it must be {range}")]
    Number {
        /// The quantity.
        what: &'static str,
        /// The value that was given.
        value: f64,
        /// The range in words.
        range: &'static str,
    },
    /// The mesh cannot be used.
    #[error("the mesh of the ground has no triangles that can be touched: {0}")]
    Mesh(String),
    /// Two shapes that cannot touch.
    #[error(transparent)]
    Pair(#[from] UnsupportedPair),
}

/// Drops the bodies on the ground and returns where they lie.
///
/// Fails for numbers out of range, for bodies without parts, and for exponents above 2.
///
/// ```
/// use supersurface::{Pose, combine::Part, shape::{Posed, Superellipsoid}, surface::Surface};
/// use supersurface_physics::{Falling, Ground, SettleOptions, settle};
/// let tin = Surface::Superellipsoid(Superellipsoid::new([0.03, 0.03, 0.05], [0.2, 1.0])?);
/// let part = Part::new("tin", Posed::new(tin, Pose::identity())?, 500.0)?;
/// let drop = |height: f64| Falling {
///     parts: vec![part.clone()],
///     start: Pose::translation(0.0, 0.0, height),
///     friction: 0.5,
///     restitution: 0.0,
/// };
/// let settled = settle(&[drop(0.06), drop(0.18)], &Ground::default(), &SettleOptions::default())?;
/// assert!(settled.all_at_rest() && settled.overlap < 1e-4);
/// assert!((settled.bodies[0].pose.translation.z - 0.05).abs() < 5e-4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn settle(
    bodies: &[Falling],
    ground: &Ground,
    options: &SettleOptions,
) -> Result<Settled, SettleError> {
    check(bodies, ground, options)?;
    let mut world = world::Fall::new(bodies, ground, options)?;
    let time = world.run(options);
    let mut rests: Vec<Rest> = world.rests(options.rate);
    let mut layout = world.layout();
    let simulated_overlap = layout.deepest();
    let down = convert::from_vector(&options.gravity.normalize());
    for (body, _) in rests.iter().enumerate().filter(|(_, rest)| rest.at_rest) {
        layout.lower(body, world.shape(body), down, options.tolerance);
    }
    let overlap = layout.separate(options.tolerance);
    for (rest, pose) in rests.iter_mut().zip(layout.poses()) {
        rest.pose = convert::to_pose(pose);
    }
    Ok(Settled { bodies: rests, time, simulated_overlap, overlap })
}

fn check(bodies: &[Falling], ground: &Ground, options: &SettleOptions) -> Result<(), SettleError> {
    let number = |inside: bool, what, value, range| match inside {
        true => Ok(()),
        false => Err(SettleError::Number { what, value, range }),
    };
    let positive = |v: f64| v > 0.0 && v.is_finite();
    let at_least_0 = |v: f64| v >= 0.0 && v.is_finite();
    let pose = |pose: &Pose, what| {
        let all = pose.translation.vector.iter().chain(pose.rotation.coords.iter());
        let wrong = all.copied().find(|v| v.is_nan() || v.abs() >= 1e6);
        number(wrong.is_none(), what, wrong.unwrap_or_default(), "finite and below 1e6")
    };
    for body in bodies {
        for density in body.parts.iter().map(Part::density) {
            number(positive(density), "density", density, "positive and finite")?;
        }
        pose(&body.start, "a number of a start pose")?;
    }
    let materials = bodies.iter().map(|b| (b.friction, b.restitution));
    for (friction, restitution) in materials.chain([(ground.friction, ground.restitution)]) {
        number(at_least_0(friction), "friction", friction, "at least 0 and finite")?;
        number((0.0..=1.0).contains(&restitution), "restitution", restitution, "in [0, 1]")?;
    }
    for (place, half) in &ground.cuboids {
        pose(place, "a number of a cuboid's pose")?;
        for h in half {
            number(positive(*h) && *h < 1e6, "half edge of a cuboid", *h, "positive, below 1e6")?;
        }
    }
    let g = options.gravity.norm();
    number(positive(g) && g < 1e6, "gravity", g, "positive, below 1e6")?;
    let rate = options.rate;
    number((10.0..=1e5).contains(&rate), "rate", rate, "in [10, 1e5] steps per second")?;
    let limit = options.time_limit;
    number((0.0..=1e4).contains(&limit), "time limit", limit, "in [0, 1e4] s")?;
    number(at_least_0(options.still), "still", options.still, "at least 0 and finite")?;
    number(positive(options.rocking), "rocking", options.rocking, "positive and finite")?;
    number(positive(options.tolerance), "tolerance", options.tolerance, "positive and finite")
}
