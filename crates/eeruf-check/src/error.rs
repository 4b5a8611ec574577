//! Why a certificate is refused.

use core::fmt;

/// Why a certificate is refused: the line, from 1, and what is wrong there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CheckError {
    /// The number of the line, from 1.
    pub line: usize,
    /// The text found there and the one expected.
    pub what: String,
}

impl fmt::Display for CheckError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: {}", self.line, self.what)
    }
}

impl core::error::Error for CheckError {}
