//! Errors in a map.

use core::fmt;
use std::path::{Path, PathBuf};

/// An error in a map: the file, what it says, and what is expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapError {
    file: PathBuf,
    message: String,
}

impl MapError {
    pub(super) fn new(file: &Path, message: impl fmt::Display) -> Self {
        Self { file: file.to_owned(), message: in_one_line(&message.to_string()) }
    }

    /// The file that is wrong: the YAML file or the picture.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// The error.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", in_one_line(&self.file.display().to_string()), self.message)
    }
}

impl core::error::Error for MapError {}

/// A text whose control characters are escaped: what a file holds, such as the name of its picture, may span lines.
fn in_one_line(text: &str) -> String {
    let escaped = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(escaped).collect()
}
