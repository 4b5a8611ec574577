//! TOML files of ours, and what is wrong with one in a line that a user understands.

use core::fmt;

use serde::de::DeserializeOwned;

/// An error in a text, in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TextError {
    /// The line, from 1, where one is to blame.
    pub line: Option<u64>,
    /// The field, its value and what is expected.
    pub message: String,
}

impl fmt::Display for TextError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        f.write_str(&self.message)
    }
}

impl core::error::Error for TextError {}

impl From<String> for TextError {
    fn from(message: String) -> Self {
        Self { line: None, message }
    }
}

/// Reads a TOML text.
///
/// # Errors
/// The first thing wrong with it, with its line.
pub fn parse<T: DeserializeOwned>(text: &str) -> Result<T, TextError> {
    toml::from_str(text).map_err(|error| {
        let line = error.span().map(|span| 1 + text[..span.start].matches('\n').count() as u64);
        // What a number may be, in the words of a user.
        let message = error.message().replace("expected usize", "expected a whole number from 0 on");
        let message = message.replace("expected u32", "expected a whole number from 0 to 4294967295");
        TextError { line, message: message.replace('\n', "; ") }
    })
}
