//! What is going on, on standard error: a spinner on a terminal, nothing in a pipe.

use std::thread;
use std::time::{Duration, Instant};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use supersurface::pipeline::Stage;

use crate::exit::{Failure, print};

/// Announces stages and keeps their times.
pub(crate) struct Progress {
    bar: ProgressBar,
    began: Instant,
    running: Option<&'static str>,
    times: Vec<(&'static str, f64)>,
}

impl Progress {
    /// Quiet when asked to be, and always when standard error is not a terminal.
    pub(crate) fn new(quiet: bool) -> Self {
        let bar = if quiet {
            ProgressBar::hidden()
        } else {
            ProgressBar::with_draw_target(None, ProgressDrawTarget::stderr())
        };
        bar.set_style(ProgressStyle::default_spinner());
        // the spinner turns by a thread of its own, which a system without room for one refuses by a panic
        if !bar.is_hidden() && thread::Builder::new().spawn(|| {}).is_ok_and(|t| t.join().is_ok()) {
            bar.enable_steady_tick(Duration::from_millis(100));
        }
        Self { bar, began: Instant::now(), running: None, times: Vec::new() }
    }

    /// A stage begins; the one before has ended.
    pub(crate) fn begin(&mut self, name: &'static str, message: String) {
        self.end();
        self.running = Some(name);
        self.began = Instant::now();
        self.bar.set_message(message);
    }

    /// The same for a stage of the pipeline.
    pub(crate) fn stage(&mut self, stage: Stage) {
        match stage {
            Stage::Segment => self.begin("segment", "finding the table and the objects".into()),
            Stage::Fit(n) => self.begin("fit", format!("fitting {n} objects")),
            Stage::Grasp(n) => self.begin("grasp", format!("planning grasps for {n} objects")),
        }
    }

    /// Says what was noticed; the run goes on.
    pub(crate) fn warn(&self, warning: &str) {
        self.bar.suspend(|| {
            let line = format!("warning: {warning}\n");
            // a closed standard error is no reason to stop
            let _ = std::io::Write::write_all(&mut std::io::stderr(), line.as_bytes());
        });
    }

    /// How far the stage is.
    pub(crate) fn say(&self, message: String) {
        self.bar.set_message(message);
    }

    /// Prints a result without a torn spinner in it.
    pub(crate) fn print(&self, text: &str) -> Result<(), Failure> {
        self.bar.suspend(|| print(text))
    }

    fn end(&mut self) {
        if let Some(name) = self.running.take() {
            self.times.push((name, self.began.elapsed().as_secs_f64()));
        }
    }

    /// Ends the last stage and gives the seconds of each.
    pub(crate) fn finish(&mut self) -> &[(&'static str, f64)] {
        self.end();
        self.bar.finish_and_clear();
        &self.times
    }
}
