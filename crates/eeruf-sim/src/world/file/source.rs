//! The text of a file, and the line of it that an error is about.

use core::fmt;
use core::ops::Range;
use std::path::{Path, PathBuf};

/// A file that is no world, in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorldFileError {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1, where one is to blame.
    pub line: Option<usize>,
    /// The error and what is expected.
    pub message: String,
}

impl fmt::Display for WorldFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl core::error::Error for WorldFileError {}

/// A file and its text.
#[derive(Clone)]
pub(super) struct Source {
    pub(super) file: PathBuf,
    pub(super) text: String,
}

impl Source {
    pub(super) fn read(file: &Path) -> Result<Self, WorldFileError> {
        match std::fs::read_to_string(file) {
            Ok(text) => Ok(Self { file: file.to_owned(), text }),
            Err(error) => Err(WorldFileError { file: file.to_owned(), line: None, message: error.to_string() }),
        }
    }

    /// The file of this name beside this one.
    pub(super) fn beside(&self, name: &str) -> Result<Self, WorldFileError> {
        Self::read(&self.file.parent().unwrap_or(Path::new("")).join(name))
    }

    pub(super) fn toml<T: serde::de::DeserializeOwned>(&self) -> Result<T, WorldFileError> {
        toml::from_str(&self.text).map_err(|error| self.error(error.span(), "", error.message().replace('\n', "; ")))
    }

    /// An error at a field within a part of the text, or at the part's first line.
    pub(super) fn error(&self, part: Option<Range<usize>>, field: &str, message: impl fmt::Display) -> WorldFileError {
        let line = part.map(|part| self.line(part, field));
        WorldFileError { file: self.file.clone(), line, message: message.to_string() }
    }

    /// The line on which a field is set, which begins with its name or holds it in braces; entries of arrays of tables
    /// span from their header on.
    pub(super) fn line(&self, part: Range<usize>, field: &str) -> usize {
        let end = part.end.min(self.text.len());
        let start = part.start.min(end);
        let first = 1 + self.text.get(..start).map_or(0, |before| before.matches('\n').count());
        // The span of a table may end with its header; what follows it up to the next header belongs to it.
        let rest = self.text.get(start..).unwrap_or("");
        let own = rest.lines().enumerate().take_while(|(k, line)| *k == 0 || !line.trim_start().starts_with("[["));
        let sets = |line: &str| line.split(['{', ',']).any(|item| item.trim_start().starts_with(field));
        let mut found = own.filter(|(_, line)| !field.is_empty() && sets(line.split('#').next().unwrap_or("")));
        first + found.next().map_or(0, |(k, _)| k)
    }
}
