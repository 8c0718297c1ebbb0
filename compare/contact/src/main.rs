//! Times contact queries of supersurface and of parry on the same pairs, in one run on one core.
//!
//! Both know a superellipsoid by the same closed-form support map: parry runs GJK and EPA on it. The
//! README of the folder above says what is measured and how.

mod contender;
mod measure;
mod options;
mod ours;
mod pair_file;
mod pairs;
mod parry32;
mod parry64;
mod report;
mod timing;
mod trusted;

use std::fs::File;
use std::io::Write;
use std::path::Path;
use std::process::ExitCode;

use options::{HELP, Options};
use pairs::Regime;

fn main() -> ExitCode {
    let options = match Options::parse(std::env::args().skip(1)) {
        Ok(Some(options)) => options,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(message) => {
            eprintln!("compare-contact: {message}\nTry --help.");
            return ExitCode::from(2);
        }
    };
    match run(&options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("compare-contact: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: &Options) -> Result<(), String> {
    // before the long work, so that a path that cannot be written is known at once
    let mut pair_file = create(options.write_pairs.as_deref())?;
    let mut json_file = create(options.json.as_deref())?;

    let mut results = Vec::new();
    for regime in Regime::ALL {
        let pairs = pairs::draw(regime, options.pairs, options.shapes, options.seed);
        eprintln!("{}: the trusted values of {} pairs ..", regime.name(), pairs.len());
        let trusted: Vec<_> = pairs.iter().map(trusted::trusted).collect();
        if let Some((file, path)) = &mut pair_file {
            pair_file::write(file, &pairs, &trusted).map_err(|e| cannot_write(path, &e))?;
        }
        eprintln!("{}: times ..", regime.name());
        results.push(measure::regime(regime, &pairs, &trusted));
    }
    print!("{}", report::table(options, &results));
    if let Some((file, path)) = &mut json_file {
        writeln!(file, "{:#}", report::json(options, &results))
            .map_err(|e| cannot_write(path, &e))?;
    }
    Ok(())
}

/// The file at a path, empty, and the path for messages.
fn create(path: Option<&Path>) -> Result<Option<(File, &Path)>, String> {
    path.map(|path| File::create(path).map(|file| (file, path)).map_err(|e| cannot_write(path, &e)))
        .transpose()
}

fn cannot_write(path: &Path, error: &std::io::Error) -> String {
    format!("cannot write {}: {error}", path.display())
}
