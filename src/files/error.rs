//! What is wrong with an input file, in one line: file, line or field, value, what is expected.

use std::fmt;
use std::path::{Path, PathBuf};

/// Bad input, in one line.
#[derive(Debug)]
pub(crate) struct InputError {
    file: PathBuf,
    line: Option<u64>,
    message: String,
}

impl InputError {
    pub(crate) fn new(file: &Path, line: Option<u64>, message: impl fmt::Display) -> Self {
        Self { file: file.to_owned(), line, message: message.to_string().replace('\n', "; ") }
    }
}

impl From<eeruf_logs::LogError> for InputError {
    fn from(error: eeruf_logs::LogError) -> Self {
        Self::new(error.file(), error.line(), error.message())
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for InputError {}
