//! `supersurface scene random`: one scene.

use std::fs;

use super::args::RandomArgs;
use super::make::{folder, make, recipes};
use super::text::text;
use crate::exit::{Failure, print};
use crate::progress::Progress;
use crate::threads;

pub(super) fn run(args: &RandomArgs) -> Result<(), Failure> {
    let mut progress = Progress::new(args.quiet);
    let (pool, fewer) = threads::pool(args.threads)?;
    if let Some(warning) = fewer {
        progress.warn(&warning);
    }
    let things = recipes(&args.make.things, &args.make.noise)?;
    // before the long work, so that a folder that cannot be made is known at once
    folder(&args.output)?;
    let say = |stage, what| progress.begin(stage, what);
    let made = pool.install(|| make(&args.make, &things, args.seed, &args.output, say))?;
    for warning in &made.warnings {
        progress.warn(warning);
    }
    progress.finish();
    if args.json {
        let file = args.output.join("scene.json");
        let told = fs::read_to_string(&file);
        return print(&told.map_err(|e| Failure::output(format!("{}: {e}", file.display())))?);
    }
    print(&text(&made))
}
