//! Floor 8: scenes of supersurfaces, looked at by a simulated depth camera.
//!
//! A [`Scene`] is a table top at z = 0 with bodies on it; [`place`] puts bodies down at random,
//! [`demo`] lays a table by hand; [`look`] gives the depth image and the labels that a camera sees.

mod demo;
mod layout;
mod look;
mod noise;

pub use demo::{Demo, demo};
pub use layout::{Body, Scene, SceneError, place, rests};
pub use look::{Look, look};
pub use noise::DepthNoise;
