//! How long a query takes.

use std::hint::black_box;
use std::time::Instant;

use crate::contender::Contender;

/// Batches of one query; the best counts, as other load only ever adds.
const BATCHES: usize = 5;
/// Queries in a batch; an even number, as warm queries go to and fro.
const QUERIES: usize = 16;
/// Passes over all pairs; the best counts.
const PASSES: usize = 3;

/// Microseconds of a cold query of the same pair again and again.
pub fn cold<C: Contender>(contender: &C) -> f64 {
    best_batch(|_| {
        black_box(contender.cold());
    })
}

/// Microseconds of a query that starts from the answer to the pair a small motion away.
pub fn warm<C: Contender>(contender: &mut C) -> f64 {
    contender.warm(true);
    best_batch(|k| {
        black_box(contender.warm(k % 2 == 1));
    })
}

/// Mean microseconds of a cold query in one pass over distinct pairs.
pub fn streaming<C: Contender>(contenders: &[C]) -> f64 {
    let pass = || {
        let start = Instant::now();
        for contender in contenders {
            black_box(contender.cold());
        }
        1e6 * start.elapsed().as_secs_f64() / contenders.len() as f64
    };
    (0..PASSES).map(|_| pass()).fold(f64::INFINITY, f64::min)
}

fn best_batch(mut query: impl FnMut(usize)) -> f64 {
    let mut batch = || {
        let start = Instant::now();
        for k in 0..QUERIES {
            query(k);
        }
        1e6 * start.elapsed().as_secs_f64() / QUERIES as f64
    };
    (0..BATCHES).map(|_| batch()).fold(f64::INFINITY, f64::min)
}
