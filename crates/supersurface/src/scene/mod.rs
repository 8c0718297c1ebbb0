//! Floor 8: scenes of supersurfaces, looked at by a simulated depth camera.
//!
//! A [`Scene`] is a table top at z = 0 with bodies on it; [`place`] puts bodies down at random and apart, [`crowded`] so that
//! they touch, [`demo`] lays a table by hand; [`look`] gives the depth image and the labels that a camera sees.

mod arrange;
mod body;
mod crowded;
mod demo;
mod household;
mod layout;
mod likeness;
mod look;
mod noise;
mod rays;
mod recipe;

pub use arrange::{Layout, arrange};
pub use body::{Board, Body, DENSITY, FRICTION};
pub use crowded::{Crowd, crowded};
pub use demo::{Demo, demo};
pub use household::household;
pub use layout::{Scene, SceneError, place, rests};
pub use look::{Look, facing, look, visibility};
pub use noise::DepthNoise;
pub use recipe::{Likeness, Range, Recipe, draw};
