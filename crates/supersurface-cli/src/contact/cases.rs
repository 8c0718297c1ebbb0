//! A list of pairs: one line of JSON for each, in its order.

use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use supersurface_io::{ContactCase, contact_line, read_contact_cases, shown_name, write_text};

use super::args::ContactArgs;
use super::query::Query;
use crate::exit::Failure;
use crate::places::Places;
use crate::progress::Progress;
use crate::threads;

/// Pairs from one word of progress to the next.
const STRIDE: usize = 50;

/// Reads the pairs, queries them and writes the lines. A pair that cannot be queried is a line that says why.
pub(super) fn run(args: &ContactArgs, file: &Path, query: &Query) -> Result<(), Failure> {
    let output = args.output.as_deref().unwrap_or(Path::new("-"));
    let to_file = output != Path::new("-");
    if to_file {
        Places::read([file]).take("-o", output)?;
    }
    let mut progress = Progress::new(args.quiet);
    // timed queries take turns, unless it is said otherwise
    let threads = args.threads.or((args.repeat > 0).then_some(1));
    let (pool, fewer) = threads::pool(threads)?;
    if let Some(warning) = fewer {
        progress.warn(&warning);
    }
    progress.begin("read", format!("reading {}", shown_name(file)));
    let cases = read_contact_cases(file).map_err(Failure::input)?;
    let count = cases.len();
    progress.begin("query", format!("querying {count} pairs"));
    let (done, failed) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let answer = |case: &ContactCase| {
        let result = match &case.bodies {
            Ok(bodies) => query.ask_convex(bodies).map(|c| (c, query.time(bodies, args.repeat))),
            Err(why) => Err(why.clone()),
        };
        let before = done.fetch_add(1, Ordering::Relaxed);
        if before % STRIDE == 0 {
            progress.say(format!("queried {before} of {count} pairs"));
        }
        match &result {
            Ok((contact, ns)) => contact_line(case, Ok(contact), *ns) + "\n",
            Err(why) => {
                failed.fetch_add(1, Ordering::Relaxed);
                contact_line(case, Err(why), None) + "\n"
            }
        }
    };
    let text: String = pool.install(|| cases.par_iter().map(answer).collect());
    progress.finish();
    let failed = failed.into_inner();
    if failed > 0 {
        progress.warn(&format!("{failed} of {count} pairs have no answer: see their status"));
    }
    match to_file {
        true => write_text(output, &text).map_err(Failure::output),
        false => progress.print(&text),
    }
}
