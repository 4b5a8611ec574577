//! What can be wrong with a map.

use core::fmt;
use std::path::{Path, PathBuf};

/// What is wrong with a map: which file, what it says, and what is expected.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MapError {
    file: PathBuf,
    message: String,
}

impl MapError {
    pub(super) fn new(file: &Path, message: impl fmt::Display) -> Self {
        Self { file: file.to_owned(), message: message.to_string() }
    }

    /// The file that is wrong: the YAML file or the picture.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What is wrong with it.
    pub fn message(&self) -> &str {
        &self.message
    }
}

impl fmt::Display for MapError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.file.display(), self.message)
    }
}

impl core::error::Error for MapError {}
