//! Supersurfaces in physics: as shapes of parry and rapier, with exact contacts, and bodies that settle in one call.
//!
//! | for | use |
//! |---|---|
//! | a shape of a surface, of a body of several parts | [`shape()`], [`compound`] |
//! | contacts in a rapier world | [`Dispatcher`], [`Dispatcher::check_world`] |
//! | rapier's lengths for bodies of centimetres | [`integration_parameters`] |
//! | a pile, a bin, a shelf; a whole scene | [`settle()`], [`settle_scene`] |
//! | poses and points between nalgebra and glam | [`convert`] |
//!
//! Units are SI. [`parry`] and [`rapier`] are those that this crate is built with.
//!
//! In a world of your own, a superellipsoid falls on a cuboid and rests:
//!
//! ```
//! use supersurface::{shape::Superellipsoid, surface::Surface};
//! use supersurface_physics::{Dispatcher, integration_parameters, rapier::prelude::*, shape};
//! let tin = Surface::Superellipsoid(Superellipsoid::new([0.03, 0.03, 0.05], [0.2, 1.0])?);
//! let mut world = PhysicsWorld::new();
//! world.gravity = Vector::new(0.0, 0.0, -9.81);
//! world.integration_parameters = integration_parameters(0.05, 240.0);
//! world.narrow_phase.set_query_dispatcher(Dispatcher);
//! let board = ColliderBuilder::cuboid(0.3, 0.3, 0.01).position(Pose::translation(0.0, 0.0, -0.01));
//! world.insert_collider(board, None);
//! let start = RigidBodyBuilder::dynamic().pose(Pose::translation(0.0, 0.0, 0.08));
//! let (body, _) = world.insert(start, ColliderBuilder::new(shape(&tin)?).density(500.0));
//! Dispatcher.check_world(&world.bodies, &world.colliders)?;
//! for _ in 0..480 {
//!     world.step();
//! }
//! assert!((world.bodies[body].position().translation.z - 0.05).abs() < 5e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The same in one call, for a ring on a floor:
//!
//! ```
//! use supersurface::{Pose, combine::Part, shape::{Posed, Supertoroid}, surface::Surface};
//! use supersurface_physics::{Falling, Ground, SettleOptions, settle};
//! let ring = Surface::Supertoroid(Supertoroid::new([0.01; 3], 3.0, [1.0; 2])?);
//! let body = Falling {
//!     parts: vec![Part::new("ring", Posed::new(ring, Pose::identity())?, 500.0)?],
//!     start: Pose::translation(0.0, 0.0, 0.05),
//!     friction: 0.5,
//!     restitution: 0.0,
//! };
//! let settled = settle(&[body], &Ground::default(), &SettleOptions::default())?;
//! assert!(settled.all_at_rest());
//! assert!((settled.bodies[0].pose.translation.z - 0.01).abs() < 1e-4);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! What is not guaranteed: shapes of this crate do not survive serde, and rapier's debug renderer does not draw them.

pub mod convert;
mod convex;
mod dispatch;
mod pieces;
mod settle;
mod shape;

pub use parry3d_f64 as parry;
pub use rapier3d_f64 as rapier;

pub use convex::ConvexSolid;
pub use dispatch::{Dispatcher, UnsupportedPair};
pub use pieces::Pieces;
pub use settle::{
    Falling, Ground, Rest, SettleError, SettleOptions, Settled, integration_parameters, settle,
    settle_scene,
};
pub use shape::{NoShape, compound, shape};
