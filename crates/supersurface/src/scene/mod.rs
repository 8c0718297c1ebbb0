//! Floor 8: scenes of supersurfaces, looked at by a simulated depth camera.
//!
//! A [`Scene`] is a table top at z = 0 with bodies on it; [`place`] puts bodies down at random and apart, [`crowded`] so that
//! they touch, [`demo`] lays a table by hand; [`draw`] makes things from recipes and [`arrange`] puts them where they can
//! fall into a bin, a shelf or on a table; [`look`] gives the depth image, the labels and normals that a camera sees, and
//! [`turntable`] says where cameras stand.

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
mod tiles;
mod turntable;

pub use arrange::{Layout, arrange};
pub use body::{Board, Body, DENSITY, FRICTION};
pub use crowded::{Crowd, crowded};
pub use demo::{Demo, demo};
pub use household::household;
pub use layout::{Scene, SceneError, place, rests};
pub use look::{Look, facing, look, visibility};
pub use noise::DepthNoise;
pub use recipe::{Likeness, Range, Recipe, draw};
pub use turntable::turntable;
