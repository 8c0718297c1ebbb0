//! How the command ends: the exit status that goes with each kind of failure.

use std::process::ExitCode;

/// A failure with its exit status.
#[derive(Debug)]
pub(crate) struct Failure {
    status: u8,
    message: String,
}

impl Failure {
    /// Wrong use of the command: status 2.
    pub(crate) fn usage(message: impl ToString) -> Self {
        Self { status: 2, message: message.to_string() }
    }

    /// Input that cannot be read or used: status 3.
    pub(crate) fn input(message: impl ToString) -> Self {
        Self { status: 3, message: message.to_string() }
    }

    /// Nothing found: status 4.
    pub(crate) fn nothing(message: impl ToString) -> Self {
        Self { status: 4, message: message.to_string() }
    }

    /// Output that cannot be written: status 5.
    pub(crate) fn output(message: impl ToString) -> Self {
        Self { status: 5, message: message.to_string() }
    }

    /// What went wrong, in words.
    pub(crate) fn message(&self) -> &str {
        &self.message
    }

    /// Says what went wrong on standard error.
    #[allow(clippy::print_stderr)]
    pub(crate) fn report(&self) -> ExitCode {
        if !self.message.is_empty() {
            eprintln!("error: {}", self.message);
        }
        ExitCode::from(self.status)
    }
}

/// Writes to standard output. A reader that has gone away (`| head`) is no failure.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    use std::io::{ErrorKind, Write};
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::output(format!("standard output: {e}")))
        }
        _ => Ok(()),
    }
}
