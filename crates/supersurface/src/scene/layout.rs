//! Which bodies stand on a table, and where.
//!
//! The table's top is the plane z = 0 of the world. A body rests with one of its axes upright: on a
//! flat face (exponents well under 1), or, where it has none, as low as it can. That is statics by
//! eye, not physics: nothing leans and nothing is stacked.

use crate::camera::InvalidCamera;
use crate::numeric::random::Stream;
use crate::scene::{Board, Body};
use crate::shape::{InvalidShape, Plane};
use crate::surface::Surface;
use crate::{Point, Pose, Vector};
use nalgebra::{Translation3, UnitQuaternion};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Largest exponent whose face still counts as flat enough to stand on.
const FLAT: f64 = 0.5;
/// Free space between the bounding circles of two bodies, in metres.
const GAP: f64 = 0.02;
/// How often another place is tried for one body.
pub(super) const TRIALS: usize = 2000;

/// Why a scene cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SceneError {
    /// No free place was found.
    #[error("no room on the table for {name} after {trials} trials")]
    NoRoom {
        /// The body without a place.
        name: String,
        /// Number of places that were tried.
        trials: usize,
    },
    /// A layout for one body was asked for with several.
    #[error("a single layout holds one body, not {bodies}: take another layout, or several scenes")]
    NotSingle {
        /// Number of bodies.
        bodies: usize,
    },
    /// A number of a body is out of range.
    #[error(transparent)]
    Shape(#[from] InvalidShape),
    /// A number of the camera is out of range.
    #[error(transparent)]
    Camera(#[from] InvalidCamera),
}

/// A table with bodies on it.
#[derive(Clone, Debug, PartialEq)]
pub struct Scene {
    /// The bodies, in the order of their labels 1, 2, 3, …
    pub bodies: Vec<Body>,
    /// Fixed boards that stand on the table; they have no label.
    pub boards: Vec<Board>,
    /// The table's top.
    pub support: Plane,
    /// Half edge lengths of the top along x and y of the world, in metres, about its origin.
    pub half_size: [f64; 2],
}

impl Scene {
    /// An empty table with its top at z = 0. `half_size` in metres.
    pub fn empty(half_size: [f64; 2]) -> Self {
        let support = Plane::through(&Point::origin(), Vector::z_axis());
        Self { bodies: Vec::new(), boards: Vec::new(), support, half_size }
    }

    /// Puts a body down with its centre over (x, y) in metres, resting with `rest` (see [`rests`])
    /// and turned by `yaw` radians about the vertical. Fails when a number is not finite.
    pub fn put(
        &mut self,
        name: &str,
        shape: Surface,
        rest: UnitQuaternion<f64>,
        [x, y]: [f64; 2],
        yaw: f64,
    ) -> Result<(), SceneError> {
        let rotation = UnitQuaternion::from_axis_angle(&Vector::z_axis(), yaw) * rest;
        let height = footprint(&shape, &rest).z;
        let pose = Pose::from_parts(Translation3::new(x, y, height), rotation);
        self.bodies.push(Body::single(name, shape, pose)?);
        Ok(())
    }
}

/// The ways in which a shape rests on a table: rotations of its own frame after which the lowest
/// point lies at minus the half extent along the vertical. Never empty.
pub fn rests(shape: &Surface) -> Vec<UnitQuaternion<f64>> {
    let [x, y, z] = shape.half_extents();
    let [e1, e2] = shape.exponents();
    let least = x.min(y).min(z);
    let (x_up, y_up) = (
        UnitQuaternion::from_axis_angle(&Vector::y_axis(), -FRAC_PI_2),
        UnitQuaternion::from_axis_angle(&Vector::x_axis(), FRAC_PI_2),
    );
    let boxy = e1 <= FLAT && e2 <= FLAT && shape.ring_ratio().is_none();
    let mut rests = Vec::new();
    if shape.ring_ratio().is_some() || e1 <= FLAT || z <= least {
        rests.push(UnitQuaternion::identity());
    }
    if shape.ring_ratio().is_none() && (boxy || x <= least && z > least) {
        rests.push(x_up);
    }
    if boxy || y <= least && rests.is_empty() {
        rests.push(y_up);
    }
    if rests.is_empty() {
        rests.push(UnitQuaternion::identity());
    }
    rests
}

/// Half extents along the world's axes of a shape turned by `rest`.
pub(super) fn footprint(shape: &Surface, rest: &UnitQuaternion<f64>) -> Vector {
    rest.to_rotation_matrix().matrix().abs() * Vector::from(shape.half_extents())
}

/// Puts the shapes on a table, each in one of its [`rests`], at a random place and yaw, without
/// overlap: bounding circles keep 20 mm apart. The same seed gives the same scene. Fails when a
/// free place is not found.
pub fn place(
    shapes: &[(String, Surface)],
    half_size: [f64; 2],
    seed: u64,
) -> Result<Scene, SceneError> {
    let mut scene = Scene::empty(half_size);
    let mut taken: Vec<([f64; 2], f64)> = Vec::new();
    for (index, (name, shape)) in shapes.iter().enumerate() {
        let mut stream = Stream::new(seed, index as u64);
        let ways = rests(shape);
        let rest = ways.get(stream.index(ways.len())).copied().unwrap_or_default();
        let half = footprint(shape, &rest);
        let radius = half.x.hypot(half.y);
        let yaw = stream.between(0.0, TAU);
        let [rx, ry] = half_size.map(|h| h - radius);
        let spot = (0..TRIALS).find_map(|_| {
            let at = [stream.between(-rx, rx), stream.between(-ry, ry)];
            let free = taken
                .iter()
                .all(|(other, r)| (at[0] - other[0]).hypot(at[1] - other[1]) >= radius + r + GAP);
            (free && rx >= 0.0 && ry >= 0.0).then_some(at)
        });
        let Some(at) = spot else {
            return Err(SceneError::NoRoom { name: name.clone(), trials: TRIALS });
        };
        scene.put(name, *shape, rest, at, yaw)?;
        taken.push((at, radius));
    }
    Ok(scene)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Superellipsoid, Supertoroid, SupportMap};

    fn shapes() -> Vec<(String, Surface)> {
        let solid = |a, e| Surface::Superellipsoid(Superellipsoid::new(a, e).unwrap());
        vec![
            ("box".into(), solid([0.03, 0.05, 0.08], [0.1, 0.1])),
            ("can".into(), solid([0.033, 0.033, 0.06], [0.1, 1.0])),
            ("egg".into(), solid([0.03, 0.02, 0.025], [1.0, 1.0])),
            (
                "ring".into(),
                Surface::Supertoroid(Supertoroid::new([0.01; 3], 3.0, [1.0, 1.0]).unwrap()),
            ),
        ]
    }

    #[test]
    fn bodies_stand_on_the_table_and_apart() {
        for seed in 0..50 {
            let scene = place(&shapes(), [0.3, 0.25], seed).unwrap();
            for (i, body) in scene.bodies.iter().enumerate() {
                let lowest = body.solids()[0].support_point(&-Vector::z());
                assert!(scene.support.height(&lowest).abs() < 1e-9, "{}: {lowest}", body.name);
                for other in &scene.bodies[..i] {
                    let [a, b] = [body, other].map(|b| b.pose.translation);
                    assert!((a.vector - b.vector).norm() > 0.05);
                }
            }
            assert_eq!(scene, place(&shapes(), [0.3, 0.25], seed).unwrap());
        }
    }

    #[test]
    fn a_full_table_is_an_error() {
        let error = place(&shapes(), [0.1, 0.1], 1).unwrap_err();
        assert!(error.to_string().starts_with("no room on the table"), "{error}");
        assert!(place(&[], [f64::NAN, 0.1], 1).unwrap().bodies.is_empty());
    }
}
