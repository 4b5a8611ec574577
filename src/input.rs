//! Reading input files. Whatever is wrong with one is said in one line: file, line or field, value, what is expected.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

pub(crate) use eeruf_sim::{AnySchedule, ScheduleFile};
use serde::{Serialize, de::DeserializeOwned};

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

/// Reads a TOML file.
pub(crate) fn read_toml<T: DeserializeOwned>(file: &Path) -> Result<T, InputError> {
    let text = fs::read_to_string(file).map_err(|error| InputError::new(file, None, error))?;
    toml::from_str(&text).map_err(|error| {
        let line = error.span().map(|span| 1 + text[..span.start].matches('\n').count() as u64);
        // What a number may be, in the words of a user.
        let message = error.message().replace("expected usize", "expected a whole number from 0 on");
        InputError::new(file, line, message.replace("expected u32", "expected a whole number from 0 to 4294967295"))
    })
}

/// Reads a schedule file.
pub(crate) fn read_schedule(file: &Path) -> Result<AnySchedule, InputError> {
    read_toml::<ScheduleFile>(file)?.schedule().map_err(|message| InputError::new(file, None, message))
}

/// Writes a file that the user asked for.
pub(crate) fn write(file: &Path, contents: impl AsRef<[u8]>) -> Result<(), InputError> {
    fs::write(file, contents).map_err(|error| InputError::new(file, None, error))
}

/// What `--json` prints: one object on one line.
pub(crate) fn to_json(answer: &impl Serialize) -> String {
    // Our own types: named fields, numbers and strings, which always serialise.
    serde_json::to_string(answer).unwrap_or_default()
}
