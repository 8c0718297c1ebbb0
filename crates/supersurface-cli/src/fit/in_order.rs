//! Results of threads, told in the order of what was asked for and as soon as that allows.

use std::sync::{Mutex, PoisonError};

use crate::exit::Failure;
use crate::progress::Progress;

/// What one cloud has to tell.
pub(super) struct Done {
    /// For standard output.
    pub(super) text: String,
    pub(super) warnings: Vec<String>,
    pub(super) failures: Vec<Failure>,
}

/// Tells each result once all before it are told.
pub(super) struct InOrder<'a> {
    progress: &'a Progress,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    waiting: Vec<Option<Done>>,
    told: usize,
    done: usize,
    failures: Vec<Failure>,
}

impl<'a> InOrder<'a> {
    pub(super) fn new(progress: &'a Progress, count: usize) -> Self {
        let waiting = (0..count).map(|_| None).collect();
        Self { progress, state: Mutex::new(State { waiting, ..State::default() }) }
    }

    /// Takes the result of the cloud at an index.
    pub(super) fn add(&self, index: usize, done: Done) {
        let mut state = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let state = &mut *state;
        let count = state.waiting.len();
        state.waiting[index] = Some(done);
        state.done += 1;
        self.progress.say(format!("fitted {} of {count} clouds", state.done));
        while let Some(next) = state.waiting.get_mut(state.told).and_then(Option::take) {
            state.told += 1;
            for warning in &next.warnings {
                self.progress.warn(warning);
            }
            if !next.text.is_empty() {
                state.failures.extend(self.progress.print(&next.text).err());
            }
            state.failures.extend(next.failures);
        }
    }

    /// All that went wrong, in the order of the clouds.
    pub(super) fn failures(self) -> Vec<Failure> {
        self.state.into_inner().unwrap_or_else(PoisonError::into_inner).failures
    }
}
