//! The threads of a run: as many as were asked for, or as many as the system gives.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::exit::Failure;

/// Most threads that are tried.
pub(crate) const MOST: u16 = 512;

/// Address space a thread: glibc reserves up to 128 MiB for what it allocates, beside its stack and its work.
const SPACE: u64 = 192 << 20;

/// A pool of `asked` threads, by default one a core (or `RAYON_NUM_THREADS`). Where the system does not carry that
/// many it has fewer, in the end this thread alone, and a warning says so.
pub(crate) fn pool(asked: Option<u16>) -> Result<(ThreadPool, Option<String>), Failure> {
    let asked = asked.map_or_else(usual, usize::from);
    let warning = |n: usize| {
        let text =
            format!("threads: {n} instead of {asked}, as the system carries no more (--threads)");
        (n < asked).then_some(text)
    };
    let most = space().map_or(asked, |s| asked.min((s / SPACE).max(1) as usize));
    let halves = std::iter::successors(Some(most), |n| Some(n / 2)).take_while(|n| *n > 0);
    for n in halves {
        if let Ok(pool) = ThreadPoolBuilder::new().num_threads(n).build() {
            return Ok((pool, warning(n)));
        }
    }
    let alone = ThreadPoolBuilder::new().num_threads(1).use_current_thread().build();
    alone.map(|p| (p, warning(1))).map_err(|e| Failure::usage(format!("--threads: {e}")))
}

/// Bytes of address space where they are limited (`ulimit -v`, Linux).
fn space() -> Option<u64> {
    let limits = std::fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|l| l.strip_prefix("Max address space"))?;
    line.split_whitespace().next()?.parse().ok()
}

/// Threads where nothing is said.
fn usual() -> usize {
    let said = std::env::var("RAYON_NUM_THREADS").ok().and_then(|n| n.parse().ok());
    let said = said.filter(|n| *n > 0);
    said.or_else(|| std::thread::available_parallelism().ok().map(usize::from))
        .map_or(1, |n| n.min(MOST.into()))
}
