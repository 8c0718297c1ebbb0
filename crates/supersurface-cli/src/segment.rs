//! `supersurface segment`: the table and the objects of a file, without grasps.

use crate::args::SegmentArgs;
use crate::exit::Failure;
use crate::input;
use crate::outputs::Run;

/// Reads the cloud and finds its objects.
pub(crate) fn run(args: &SegmentArgs) -> Result<(), Failure> {
    let name = supersurface_io::shown_name(&args.input.input);
    let stage = ("read", format!("reading {name}"));
    let inputs = args.input.files();
    Run { fit: &args.fit, output: &args.output, grasping: None, name: &name, inputs: &inputs }
        .run(stage, || input::read(&args.input))
}
