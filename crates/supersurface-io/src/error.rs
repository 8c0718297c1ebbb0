//! What can go wrong with a file: its name, the place, the mend.

use std::path::Path;

/// Why a file could not be read.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum ReadError {
    /// The operating system refused.
    #[error("{file}: {source}")]
    Io {
        /// Name of the file.
        file: String,
        /// What the system said.
        source: std::io::Error,
    },
    /// The file is larger than what is read into memory.
    #[error("{file}: too large: over {limit} bytes; thin the cloud out, or crop it to the scene")]
    TooLarge {
        /// Name of the file.
        file: String,
        /// Most bytes that are read.
        limit: u64,
    },
    /// A format that is not read.
    #[error("{file}: unsupported format: {format}; {mend}")]
    Unsupported {
        /// Name of the file.
        file: String,
        /// The format that was recognised.
        format: &'static str,
        /// What to do.
        mend: &'static str,
    },
    /// The content is not what its format says.
    #[error("{file}: {format}: {place}: {problem}")]
    Malformed {
        /// Name of the file.
        file: String,
        /// The format.
        format: &'static str,
        /// Line, field or byte.
        place: String,
        /// What is wrong, and the mend.
        problem: String,
    },
}

impl ReadError {
    pub(crate) fn malformed(file: &str, format: &'static str, fault: Fault) -> Self {
        Self::Malformed {
            file: file.to_owned(),
            format,
            place: fault.place,
            problem: fault.problem,
        }
    }

    pub(crate) fn io(file: &Path, source: std::io::Error) -> Self {
        Self::Io { file: file.display().to_string(), source }
    }
}

/// What is wrong and where, before the file's name is known.
#[derive(Debug)]
pub(crate) struct Fault {
    place: String,
    problem: String,
}

impl Fault {
    pub(crate) fn new(place: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { place: place.into(), problem: problem.into() }
    }

    /// A fault in a line (from 1).
    pub(crate) fn line(number: usize, problem: impl Into<String>) -> Self {
        Self::new(format!("line {number}"), problem)
    }
}

/// Why a file could not be written.
#[derive(Debug, thiserror::Error)]
#[error("{file}: cannot be written: {source}")]
pub struct WriteError {
    file: String,
    source: std::io::Error,
}

impl WriteError {
    pub(crate) fn new(file: &Path, source: std::io::Error) -> Self {
        Self { file: file.display().to_string(), source }
    }
}
