//! The only writer of standard output.

use std::fmt;
use std::io::{self, ErrorKind, Write as _};

use super::fit::fit;
use super::settings::settings;

/// A failure to write to standard output.
#[derive(Debug)]
pub(crate) enum OutputError {
    /// The reader of the pipe has closed it.
    Closed,
    /// Any other failure, such as a full disk.
    Failed(io::Error),
}

impl From<io::Error> for OutputError {
    fn from(error: io::Error) -> Self {
        if error.kind() == ErrorKind::BrokenPipe { Self::Closed } else { Self::Failed(error) }
    }
}

impl fmt::Display for OutputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Closed => f.write_str("closed by its reader"),
            Self::Failed(error) => write!(f, "{error}"),
        }
    }
}

/// Writes a text to standard output unchanged, and flushes.
///
/// # Errors
/// The output is closed, or cannot take the text.
pub(crate) fn print(text: impl fmt::Display) -> Result<(), OutputError> {
    let mut out = io::stdout().lock();
    write!(out, "{text}")?;
    Ok(out.flush()?)
}

/// Writes a text and a line break to standard output.
///
/// # Errors
/// The output is closed, or cannot take the text.
pub(crate) fn print_line(text: impl fmt::Display) -> Result<(), OutputError> {
    print(format_args!("{text}\n"))
}

/// Writes a text for people to standard output, fitted to the terminal's width, and flushes.
///
/// # Errors
/// The output is closed, or cannot take the text.
pub(crate) fn tell(text: impl fmt::Display) -> Result<(), OutputError> {
    let text = text.to_string();
    match settings().out_width() {
        Some(width) => print(fit(&text, width)),
        // Tables pad their last column.
        None => print(text.split('\n').map(str::trim_end).collect::<Vec<_>>().join("\n")),
    }
}
