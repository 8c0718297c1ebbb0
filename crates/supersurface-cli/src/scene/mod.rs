//! `supersurface scene`: makes scenes for simulators and for training.

mod args;
mod dataset;
mod make;
mod random;
mod sites;
mod text;
mod touches;

pub(crate) use self::args::SceneArgs;

use self::args::SceneCommand;
use crate::exit::Failure;

pub(crate) fn run(args: &SceneArgs) -> Result<(), Failure> {
    match &args.command {
        SceneCommand::Random(args) => random::run(args),
        SceneCommand::Dataset(args) => dataset::run(args),
    }
}
