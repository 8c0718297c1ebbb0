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
    /// The memory does not hold the file.
    #[error(
        "{file}: its {bytes} bytes do not fit into memory; thin the cloud out, or crop it to the scene"
    )]
    NoMemory {
        /// Name of the file.
        file: String,
        /// Its size.
        bytes: u64,
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
        Self { place: printable(&place.into()), problem: printable(&problem.into()) }
    }

    /// A fault in a line (from 1).
    pub(crate) fn line(number: usize, problem: impl Into<String>) -> Self {
        Self::new(format!("line {number}"), problem)
    }
}

/// Most characters of a place or a problem.
const MOST: usize = 400;

/// A message that may quote what a file says: in one line, nothing in it steers a terminal, and the middle of what
/// is long is left out (the mend stands at the end).
pub(crate) fn printable(text: &str) -> String {
    let count = text.chars().count();
    let left_out = if count > MOST { MOST / 2..count - MOST / 2 } else { count..count };
    let mut out = String::new();
    for (i, c) in text.chars().enumerate() {
        match c {
            _ if left_out.contains(&i) => {
                out.push_str(if i == left_out.start { " ... " } else { "" });
            }
            '\n' | '\t' => out.push(' '),
            // the quotes that messages have
            '"' | '\'' | '\\' => out.push(c),
            _ => out.extend(c.escape_debug()),
        }
    }
    out
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
