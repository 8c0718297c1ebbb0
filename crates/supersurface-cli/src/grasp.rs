//! `supersurface grasp`: the whole way on a file.

use crate::args::GraspArgs;
use crate::exit::Failure;
use crate::input;
use crate::outputs::Run;

/// Reads the cloud and runs the pipeline on it.
pub(crate) fn run(args: &GraspArgs) -> Result<(), Failure> {
    let name = supersurface_io::shown_name(&args.input);
    let stage = ("read", format!("reading {name}"));
    Run { how: &args.how, output: &args.output, name: &name }.run(stage, || input::read(args))
}
