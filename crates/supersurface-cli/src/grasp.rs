//! `supersurface grasp`: the whole way on a file.

use std::path::{Path, PathBuf};

use crate::args::GraspArgs;
use crate::exit::Failure;
use crate::input;
use crate::outputs::Run;

/// Reads the cloud and runs the pipeline on it.
pub(crate) fn run(args: &GraspArgs) -> Result<(), Failure> {
    let name = supersurface_io::shown_name(&args.input);
    let stage = ("read", format!("reading {name}"));
    let given = [Some(&args.input), args.camera.as_ref(), args.mask.as_ref()];
    let inputs: Vec<&Path> = given.into_iter().flatten().map(PathBuf::as_path).collect();
    Run { how: &args.how, output: &args.output, name: &name, inputs: &inputs }
        .run(stage, || input::read(args))
}
