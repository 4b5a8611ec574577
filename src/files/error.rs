//! A failure of a command: file, line or field, value, and what is expected.

use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

use crate::console::OutputError;

/// The exit code of bad input.
const BAD_INPUT: u8 = 2;
/// The exit code of a failure to write, `EX_IOERR` of sysexits.h.
const CANNOT_WRITE: u8 = 74;

/// A failure of a command, in one line.
#[derive(Debug)]
pub(crate) struct InputError {
    file: PathBuf,
    line: Option<u64>,
    message: String,
    code: u8,
    is_silent: bool,
}

impl InputError {
    pub(crate) fn new(file: &Path, line: Option<u64>, message: impl fmt::Display) -> Self {
        let message = message.to_string().replace('\n', "; ");
        Self { file: file.to_owned(), line, message, code: BAD_INPUT, is_silent: false }
    }

    /// An input that can be read and does not hold what is asked of it: exit code 1.
    pub(crate) fn answer_is_no(file: &Path, message: impl fmt::Display) -> Self {
        Self { code: 1, ..Self::new(file, None, message) }
    }

    /// A failure to read a file.
    pub(crate) fn reading(file: &Path, error: &io::Error) -> Self {
        let advice = match error.kind() {
            io::ErrorKind::NotFound => "expected a file that exists; `eeruf examples` lists some",
            io::ErrorKind::InvalidData => "expected text in UTF-8",
            _ => "expected a file that can be read",
        };
        Self::new(file, None, format!("{error}; {advice}"))
    }

    /// A failure to write a file: bad input where the name is to blame, else a failure of the disk.
    pub(crate) fn writing(file: &Path, error: &io::Error) -> Self {
        let is_full = is_full(error);
        let code = if is_full { CANNOT_WRITE } else { BAD_INPUT };
        let advice = match error.kind() {
            _ if is_full => "; expected room for it; free some space, or name another place",
            io::ErrorKind::NotFound => "; expected a folder that exists",
            _ => "; expected a file that can be written",
        };
        Self { code, ..Self::new(file, None, format!("{error}{advice}")) }
    }

    /// The exit code of the program.
    pub(crate) fn code(&self) -> u8 {
        self.code
    }

    /// Returns true if nobody is left to read about it: the reader of standard output has gone.
    pub(crate) fn is_silent(&self) -> bool {
        self.is_silent
    }
}

fn is_full(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::StorageFull | io::ErrorKind::QuotaExceeded | io::ErrorKind::FileTooLarge)
}

impl From<OutputError> for InputError {
    fn from(error: OutputError) -> Self {
        let file = Path::new("standard output");
        match error {
            OutputError::Closed => Self { code: 0, is_silent: true, ..Self::new(file, None, error) },
            OutputError::Failed(error) => Self { code: CANNOT_WRITE, ..Self::writing(file, &error) },
        }
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
