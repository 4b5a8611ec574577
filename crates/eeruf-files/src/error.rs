//! An error in a file, or in reading or writing one.

use std::fmt;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// An error in a file, in one line: the file, the place in it, then `thing: value; expected X`, with the likely cause
/// and the next command where there is one.
///
/// ```
/// use eeruf_files::FileError;
/// let error = FileError::new("log.csv".as_ref(), "column b: `?`; expected a range in metres").at_line(Some(3));
/// assert_eq!(error.to_string(), "log.csv, line 3: column b: `?`; expected a range in metres");
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FileError {
    file: PathBuf,
    line: Option<u64>,
    byte: Option<u64>,
    message: String,
    is_full: bool,
}

impl FileError {
    /// Makes an error in a file. Line breaks in the message become semicolons; other control characters are escaped.
    pub fn new(file: &Path, message: impl fmt::Display) -> Self {
        let message = in_one_line(&message.to_string().replace('\n', "; "));
        Self { file: file.to_owned(), line: None, byte: None, message, is_full: false }
    }

    /// Makes an error in a text that is in no file; [`in_file`](Self::in_file) can name the file later.
    pub fn in_text(message: impl fmt::Display) -> Self {
        Self::new(Path::new(""), message)
    }

    /// Makes the error of a file that cannot be read.
    pub fn reading(file: &Path, error: &io::Error) -> Self {
        let is_toml = file.extension().is_some_and(|ending| ending == "toml");
        if let Some(meant) = alike(file).filter(|_| error.kind() == ErrorKind::NotFound) {
            return Self::new(file, format!("{error}; did you mean `{meant}`?"));
        }
        let advice = match error.kind() {
            ErrorKind::NotFound if file.starts_with("~") => "expected a path without `~`, which only shells know",
            ErrorKind::NotFound if is_toml => "expected a file that exists; `eeruf examples .` writes some",
            ErrorKind::NotFound => "expected a file that exists",
            ErrorKind::InvalidData => "expected text in UTF-8",
            ErrorKind::IsADirectory => "expected a file",
            ErrorKind::FileTooLarge => "expected a smaller file",
            _ => "expected a file that can be read",
        };
        Self::new(file, format!("{error}; {advice}"))
    }

    /// Makes the error of a file that cannot be written.
    pub fn writing(file: &Path, error: &io::Error) -> Self {
        let is_full =
            matches!(error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded | ErrorKind::FileTooLarge);
        let advice = match error.kind() {
            _ if is_full => "expected room for it; free some space, or name another place",
            ErrorKind::NotFound => "expected a folder that exists",
            ErrorKind::AlreadyExists => "expected a folder, not a file",
            _ => "expected a file that can be written",
        };
        Self { is_full, ..Self::new(file, format!("{error}; {advice}")) }
    }

    /// Adds the line of the error, counted from 1.
    #[must_use]
    pub fn at_line(self, line: Option<u64>) -> Self {
        Self { line, ..self }
    }

    /// Adds the byte of the error, counted from 0.
    #[must_use]
    pub fn at_byte(self, byte: Option<u64>) -> Self {
        Self { byte, ..self }
    }

    /// Adds a related message.
    #[must_use]
    pub fn and(self, more: impl fmt::Display) -> Self {
        Self { message: format!("{}; {more}", self.message), ..self }
    }

    /// Sets the file.
    #[must_use]
    pub fn in_file(self, file: &Path) -> Self {
        Self { file: file.to_owned(), ..self }
    }

    /// Returns the file; an empty path for a text that is in no file.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// Returns the line, counted from 1, if the error is in a line.
    pub fn line(&self) -> Option<u64> {
        self.line
    }

    /// Returns the error and what is expected, without the place.
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Returns true if the disk has no room for the data to be written.
    pub fn is_full(&self) -> bool {
        self.is_full
    }
}

impl fmt::Display for FileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let file = in_one_line(&self.file.display().to_string());
        let line = self.line.map(|line| format!("line {line}"));
        let byte = self.byte.map(|byte| format!("byte {byte}"));
        let place: Vec<_> = [Some(file).filter(|file| !file.is_empty()), line, byte].into_iter().flatten().collect();
        if !place.is_empty() {
            write!(f, "{}: ", place.join(", "))?;
        }
        f.write_str(&self.message)
    }
}

impl std::error::Error for FileError {}

#[cfg(not(feature = "toml"))]
fn alike(_: &Path) -> Option<String> {
    None
}

/// Returns the file in the same folder whose name is most similar to a missing file's.
#[cfg(feature = "toml")]
fn alike(file: &Path) -> Option<String> {
    let folder = file.parent()?;
    let here = if folder == Path::new("") { Path::new(".") } else { folder };
    let names = std::fs::read_dir(here).ok()?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let names: Vec<String> = names.filter(|name| Path::new(name).extension() == file.extension()).collect();
    let meant = crate::meant::meant(&file.file_name()?.to_string_lossy(), names.iter().map(String::as_str))?;
    Some(folder.join(meant).display().to_string())
}

/// Returns the text on one line, without control characters: a file's content may span lines.
fn in_one_line(text: &str) -> String {
    let escaped = |c: char| if c.is_control() { c.escape_default().to_string() } else { c.to_string() };
    text.chars().map(escaped).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_stand_before_the_message() {
        let error = FileError::in_text("a: 1; expected 2");
        assert_eq!(error.to_string(), "a: 1; expected 2");
        assert_eq!(error.clone().at_line(Some(3)).to_string(), "line 3: a: 1; expected 2");
        assert_eq!(error.in_file(Path::new("b\nc")).at_byte(Some(7)).to_string(), "b\\nc, byte 7: a: 1; expected 2");
    }

    #[test]
    fn full_disk_differs_from_a_bad_name() {
        let of = |kind: ErrorKind| FileError::writing(Path::new("out"), &kind.into());
        assert!(of(ErrorKind::StorageFull).is_full() && !of(ErrorKind::NotFound).is_full());
        assert!(of(ErrorKind::NotFound).to_string().ends_with("; expected a folder that exists"));
    }
}
