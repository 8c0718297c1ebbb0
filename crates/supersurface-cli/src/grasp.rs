//! `supersurface grasp`: the whole way on a file.

use crate::args::GraspArgs;
use crate::exit::Failure;
use crate::input;
use crate::outputs::{Grasping, Run};

/// Reads the cloud and runs the pipeline on it.
pub(crate) fn run(args: &GraspArgs) -> Result<(), Failure> {
    let name = supersurface_io::shown_name(&args.input.input);
    let stage = ("read", format!("reading {name}"));
    let grasping = Grasping::of(&args.how, &args.output);
    let (fit, output) = (&args.how.fit, &args.output.plain);
    Run { fit, output, grasping: Some(grasping), name: &name, inputs: &args.input.files() }
        .run(stage, || input::read(&args.input))
}
