//! The text of a file, and the line to which an error refers.

use core::fmt;
use core::ops::Range;
use std::path::{Path, PathBuf};

use eeruf_files::{AnySchedule, FileError, ScheduleFile, explain, parse};
use serde::Deserialize as _;
use toml::{Spanned, Value};

/// A file and its text.
#[derive(Clone)]
pub(super) struct Source {
    pub(super) file: PathBuf,
    pub(super) text: String,
}

impl Source {
    pub(super) fn read(file: &Path) -> Result<Self, FileError> {
        match std::fs::read_to_string(file) {
            Ok(text) => Ok(Self { file: file.to_owned(), text }),
            Err(error) => Err(FileError::reading(file, &error)),
        }
    }

    /// Reads the file of this name in the same folder.
    pub(super) fn beside(&self, name: &str) -> Result<Self, FileError> {
        Self::read(&self.file.parent().unwrap_or(Path::new("")).join(name))
    }

    pub(super) fn toml<T: serde::de::DeserializeOwned>(&self) -> Result<T, FileError> {
        parse(&self.text).map_err(|error| error.in_file(&self.file))
    }

    /// Reads a schedule in the file itself, or in another file of the same folder.
    pub(super) fn schedule(&self, value: &Spanned<Value>) -> Result<AnySchedule, FileError> {
        let here = |message: String| self.error(Some(value.span()), "", format!("schedule: {message}"));
        if let Value::String(name) = value.get_ref() {
            let source = self.beside(name)?;
            let file: ScheduleFile = source.toml()?;
            return file.schedule().map_err(|message| source.error(None, "", message));
        }
        let file = ScheduleFile::deserialize(value.get_ref().clone()).map_err(|error| here(explain(&error)))?;
        file.schedule().map_err(here)
    }

    /// Makes an error about a field within a part of the text, at the field's line or else at the part's first line.
    pub(super) fn error(&self, part: Option<Range<usize>>, field: &str, message: impl fmt::Display) -> FileError {
        FileError::new(&self.file, message).at_line(part.map(|part| self.line(part, field)))
    }

    /// Returns the line on which a field is set: it begins with the field's name or has it in braces. Entries of arrays
    /// of tables begin at their header.
    pub(super) fn line(&self, part: Range<usize>, field: &str) -> u64 {
        let end = part.end.min(self.text.len());
        let start = part.start.min(end);
        let first = 1 + self.text.get(..start).map_or(0, |before| before.matches('\n').count());
        // The span of a table may end with its header, but the lines up to the next header belong to it.
        let rest = self.text.get(start..).unwrap_or("");
        let own = rest.lines().enumerate().take_while(|(k, line)| *k == 0 || !line.trim_start().starts_with("[["));
        let sets = |line: &str| line.split(['{', ',']).any(|item| item.trim_start().starts_with(field));
        let mut found = own.filter(|(_, line)| !field.is_empty() && sets(line.split('#').next().unwrap_or("")));
        (first + found.next().map_or(0, |(k, _)| k)) as u64
    }
}
