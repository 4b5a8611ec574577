//! A failure of a command, and its exit code.

use std::fmt;
use std::path::Path;

use eeruf_files::FileError;

use crate::console::OutputError;

/// The exit code of bad input.
const BAD_INPUT: u8 = 2;
/// The exit code of a failure to write, `EX_IOERR` of sysexits.h.
const CANNOT_WRITE: u8 = 74;

/// A failure of a command: the error type used in all of eeruf, and the exit code.
#[derive(Debug)]
pub(crate) struct InputError {
    report: FileError,
    code: u8,
    is_silent: bool,
}

impl InputError {
    /// Makes an error in a file, an option, or anything else named by the user.
    pub(crate) fn new(of: impl AsRef<Path>, message: impl fmt::Display) -> Self {
        FileError::new(of.as_ref(), message).into()
    }

    /// The exit code of the program.
    pub(crate) fn code(&self) -> u8 {
        self.code
    }

    /// Returns the line of the file with the error, with its first word marked.
    pub(crate) fn quoted(&self) -> Option<String> {
        let number = self.report.line()?;
        let text = std::fs::read_to_string(self.report.file()).ok()?;
        let line = text.lines().nth(usize::try_from(number).ok()?.checked_sub(1)?)?;
        let words = self.report.message().split(|c: char| !(c.is_alphanumeric() || "_-.".contains(c)));
        let word = words.filter(|word| !word.is_empty()).find(|word| line.contains(word)).unwrap_or(line.trim());
        let before = line.split(word).next().unwrap_or("").chars().map(|c| if c == '\t' { c } else { ' ' });
        let gap = " ".repeat(number.to_string().len());
        let mark = "^".repeat(word.chars().count());
        Some(format!("{number} | {line}\n{gap} | {}{mark}", before.collect::<String>()))
    }

    /// Returns true if the reader of standard output has gone.
    pub(crate) fn is_silent(&self) -> bool {
        self.is_silent
    }
}

impl From<FileError> for InputError {
    fn from(report: FileError) -> Self {
        let code = if report.is_full() { CANNOT_WRITE } else { BAD_INPUT };
        Self { report, code, is_silent: false }
    }
}

impl From<OutputError> for InputError {
    fn from(error: OutputError) -> Self {
        let file = Path::new("standard output");
        match error {
            OutputError::Closed => Self { code: 0, is_silent: true, ..Self::new(file, error) },
            OutputError::Failed(error) => Self { code: CANNOT_WRITE, ..FileError::writing(file, &error).into() },
        }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.report.fmt(f)
    }
}

impl std::error::Error for InputError {}
