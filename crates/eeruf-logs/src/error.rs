//! Errors in a log: why nothing of it can be read, and what of it cannot.

use std::fmt;
use std::path::{Path, PathBuf};

/// Why a log cannot be read at all.
#[derive(Debug)]
pub struct LogError {
    file: PathBuf,
    line: Option<u64>,
    message: String,
}

impl LogError {
    pub(crate) fn new(file: &Path, message: impl fmt::Display) -> Self {
        Self { file: file.to_owned(), line: None, message: message.to_string().replace('\n', "; ") }
    }

    pub(crate) fn at_line(file: &Path, line: Option<u64>, message: impl fmt::Display) -> Self {
        Self { line, ..Self::new(file, message) }
    }

    /// The file that it is about.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The line of the file, from 1, where it has lines.
    pub fn line(&self) -> Option<u64> {
        self.line
    }

    /// The error and what is expected, without file and line.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for LogError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for LogError {}

/// A part of a log that cannot be read; all the rest is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Damage {
    /// The file.
    pub file: PathBuf,
    /// Where in the file, in bytes from its start, if that is known.
    pub at: Option<u64>,
    /// The line of a text, from 1.
    pub line: Option<u64>,
    /// The error, and what is lost by it.
    pub message: String,
}

impl fmt::Display for Damage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        if let Some(at) = self.at {
            write!(f, ", byte {at}")?;
        }
        write!(f, ": {}", self.message)
    }
}
