//! How the command ends: the exit status that goes with each kind of failure.

use std::io::{ErrorKind, Write};
use std::process::ExitCode;

/// A failure with its exit status and, where outputs failed too, what else is to tell.
#[derive(Debug)]
pub(crate) struct Failure {
    status: u8,
    messages: Vec<String>,
}

impl Failure {
    fn new(status: u8, message: impl ToString) -> Self {
        Self { status, messages: vec![message.to_string()] }
    }

    /// Wrong use of the command: status 2.
    pub(crate) fn usage(message: impl ToString) -> Self {
        Self::new(2, message)
    }

    /// Input that cannot be read or used: status 3.
    pub(crate) fn input(message: impl ToString) -> Self {
        Self::new(3, message)
    }

    /// Nothing found: status 4.
    pub(crate) fn nothing(message: impl ToString) -> Self {
        Self::new(4, message)
    }

    /// Output that cannot be written: status 5.
    pub(crate) fn output(message: impl ToString) -> Self {
        Self::new(5, message)
    }

    /// The same failure, after which others happened: its status stays, all are told.
    pub(crate) fn and(mut self, others: impl IntoIterator<Item = Self>) -> Self {
        self.messages.extend(others.into_iter().flat_map(|o| o.messages));
        self
    }

    /// What went wrong first, in words.
    pub(crate) fn message(&self) -> &str {
        self.messages.first().map_or("", String::as_str)
    }

    /// Says what went wrong on standard error. Where that cannot be written the status still tells.
    pub(crate) fn report(&self) -> ExitCode {
        let mut err = std::io::stderr().lock();
        for message in &self.messages {
            let _ = writeln!(err, "error: {message}");
        }
        ExitCode::from(self.status)
    }
}

/// Writes to standard output. A reader that has gone away (`| head`) is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::output(format!("standard output: {e}")))
        }
        _ => Ok(()),
    }
}
