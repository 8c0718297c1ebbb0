//! `supersurface grasp`: the whole way on a file.

use crate::args::GraspArgs;
use crate::exit::Failure;
use crate::input;
use crate::outputs::Run;
use crate::progress::Progress;

/// Reads the cloud and runs the pipeline on it.
pub(crate) fn run(args: &GraspArgs) -> Result<(), Failure> {
    let mut progress = Progress::new(args.output.quiet);
    progress.begin("read", format!("reading {}", args.input.display()));
    let source = input::read(args)?;
    Run { source, how: &args.how, output: &args.output }.run(progress)
}
