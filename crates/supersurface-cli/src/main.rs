//! The `supersurface` command: a depth camera's cloud in, shapes and grasps out.

mod args;
mod contact;
mod demo;
mod exit;
mod fit;
mod gallery;
mod grasp;
mod input;
mod numbers;
mod outputs;
mod places;
mod progress;
mod scene;
mod segment;
mod shape;
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
        Command::Segment(args) => segment::run(args),
        Command::Demo(args) => demo::run(args),
        Command::Fit(args) => fit::run(args),
        Command::Contact(args) => contact::run(args),
        Command::Scene(args) => scene::run(args),
        Command::Gallery(args) => gallery::run(args),
        Command::Info(args) => shape::info(args),
        Command::Mesh(args) => shape::mesh(args),
        Command::Sample(args) => shape::sample(args),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
