//! The commands about one shape: what it is, its mesh, points on it.

mod args;
mod info;
mod mesh;
mod meshed;
mod sample;

pub(crate) use args::{is_json, named, read};
pub(crate) use info::{InfoArgs, run as info};
pub(crate) use mesh::{MeshArgs, run as mesh};
pub(crate) use sample::{SampleArgs, run as sample};
