//! `supersurface scene`: makes scenes for simulators and for training, and recovers what is in them.

mod args;
mod dataset;
mod make;
mod random;
mod recover;
mod recovered;
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
        SceneCommand::Recover(args) => recover::run(args),
    }
}
