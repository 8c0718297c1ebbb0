//! The `supersurface` command: a depth camera's cloud in, shapes and grasps out.

mod args;
mod demo;
mod exit;
mod grasp;
mod input;
mod outputs;
mod progress;
mod show;
mod terminal;
mod threads;

use std::process::ExitCode;

use args::{Cli, Command};
use clap::Parser;

fn main() -> ExitCode {
    let cli = Cli::parse();
    let result = match &cli.command {
        Command::Grasp(args) => grasp::run(args),
        Command::Demo(args) => demo::run(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
