//! `supersurface contact`: how far apart two bodies are, or how deep in each other; one pair or many.

mod args;
mod body;
mod cases;
mod picture;
mod query;
mod single;
mod text;

pub(crate) use self::args::ContactArgs;
use crate::exit::Failure;

/// Answers one pair, or a list of pairs.
pub(crate) fn run(args: &ContactArgs) -> Result<(), Failure> {
    let query = args.query()?;
    match (&args.cases, &args.a, &args.b) {
        (Some(cases), ..) => cases::run(args, cases, &query),
        (None, Some(a), Some(b)) => single::run(args, [a, b], &query),
        _ => Err(Failure::usage("two shapes, or --cases, are needed")),
    }
}
