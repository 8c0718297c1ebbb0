//! The options of `supersurface contact`.

use std::path::PathBuf;

use clap::Args;

use super::query::Query;
use crate::exit::Failure;
use crate::threads::MOST;

/// Which bodies, and what is asked of them.
#[derive(Debug, Args)]
pub(crate) struct ContactArgs {
    /// First body: a shape (docs/shape.md) or a fit as a JSON file, - for standard input, or JSON itself. A
    /// superellipsoid (ε2 at most 2), as it is or tapered, then twisted, then bent, or a supertoroid (ε1 at most 2).
    #[arg(required_unless_present = "cases")]
    pub(super) a: Option<String>,
    /// Second body. The normal points towards it.
    #[arg(required_unless_present = "cases")]
    pub(super) b: Option<String>,
    /// Query all pairs of a JSON list instead (docs/contact.md); - reads standard input.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["a", "b"], requires = "output")]
    pub(super) cases: Option<PathBuf>,
    /// Where to, with --cases: one JSON line a pair in the order of the list; - writes to standard output.
    #[arg(long, short, value_name = "FILE", requires = "cases")]
    pub(super) output: Option<PathBuf>,
    /// Prove the distance to so many metres, where rounding and some seconds of search allow it. For two
    /// convex superellipsoids.
    #[arg(long, value_name = "METRES", allow_hyphen_values = true)]
    certify: Option<f64>,
    /// Time each pair of --cases, as the best of 5 batches of so many queries; 0 times nothing.
    #[arg(long, value_name = "N", default_value_t = 20, requires = "cases", value_parser = clap::value_parser!(u32).range(..=1_000_000))]
    pub(super) repeat: u32,
    /// Number of threads for --cases; answers do not depend on it. The default is 1 where queries are timed, else all
    /// cores.
    #[arg(long, value_name = "N", requires = "cases", value_parser = clap::value_parser!(u16).range(1..=i64::from(MOST)))]
    pub(super) threads: Option<u16>,
    /// Print as JSON (fields: docs/contact.md).
    #[arg(long, conflicts_with = "cases")]
    pub(super) json: bool,
    /// Draw both bodies, the two points and the normal.
    #[arg(long, value_name = "FILE", conflicts_with = "cases")]
    pub(super) png: Option<PathBuf>,
    /// No progress on standard error.
    #[arg(long, short)]
    pub(super) quiet: bool,
}

impl ContactArgs {
    /// What is asked of each pair.
    pub(super) fn query(&self) -> Result<Query, Failure> {
        match self.certify {
            Some(t) if !(t > 0.0 && t.is_finite()) => {
                Err(Failure::usage(format!("--certify: {t} is not positive and finite")))
            }
            tolerance => Ok(Query { tolerance }),
        }
    }
}
