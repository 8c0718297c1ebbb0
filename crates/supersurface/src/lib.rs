//! **Supersurfaces for robots**: what an object is, where to hold it, in about a dozen numbers.
//!
//! A supersurface (superellipsoid or supertoroid) says the shape and pose of an object in closed
//! form. This library goes the whole way from a depth image to grasps; data flows one way, and the
//! modules are its floors:
//!
//! | floor | module | what it answers |
//! |---|---|---|
//! | 1 | [`numeric`] | norms, powers, random streams |
//! | 2 | [`shape`] | the shapes: gauge, gradient, parametric points, support points, volume |
//! | 3 | [`measure`], [`camera`] | first hits, nearest points, curvatures, boxes; pinhole cameras and depth images |
//! | 4 | [`deform`] | shapes tapered, twisted, bent, hollowed; deformations nest |
//! | 5 | [`surface`] | the closed family as one type, for files and programs |
//! | 6 | [`combine`] | Boolean trees of solids; parts joined to an assembly |
//! | 6 | [`cloud`] | point clouds, organised or not; neighbours; the unit mix-up |
//! | 6 | [`mesh`] | watertight triangle meshes; points spread evenly on curves and surfaces |
//! | 7 | [`segment`], [`fit`] | table plane and what stands on it; one supersurface per object |
//! | 7 | [`contact`] | distance and depth of convex bodies, with bounds; meshes pressed into supersurfaces |
//! | 8 | [`separate`] | things that touch told apart, pieces of one thing put together |
//! | 8 | [`grasp`], [`scene`] | ranked grasps; scenes seen by a simulated depth camera |
//! | 9 | [`pipeline`], [`picture`] | cloud to grasps in one call; pixels on the CPU |
//!
//! Units are metres, radians and newtons. Frames follow REP-103; a camera's frame is optical (x right,
//! y down, z forward); a gripper's z axis approaches and its x axis closes.
//!
//! ```
//! use supersurface::{Point, shape::{Implicit, Superellipsoid}};
//! let tin = Superellipsoid::new([0.033, 0.033, 0.05], [0.1, 1.0])?;
//! assert!(tin.contains(&Point::new(0.0, 0.03, 0.0)));
//! # Ok::<(), supersurface::shape::InvalidShape>(())
//! ```

pub use nalgebra;

pub mod camera;
pub mod cloud;
pub mod combine;
pub mod contact;
pub mod deform;
pub mod fit;
pub mod grasp;
pub mod measure;
pub mod mesh;
pub mod numeric;
pub mod picture;
pub mod pipeline;
pub mod scene;
pub mod segment;
pub mod separate;
pub mod shape;
pub mod surface;

/// A point, in metres.
pub type Point = nalgebra::Point3<f64>;
/// A vector; its unit is said where it is used.
pub type Vector = nalgebra::Vector3<f64>;
/// A unit vector.
pub type Direction = nalgebra::UnitVector3<f64>;
/// A rigid pose: rotation and translation in metres, local to world.
pub type Pose = nalgebra::Isometry3<f64>;

/// The README's example runs.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
