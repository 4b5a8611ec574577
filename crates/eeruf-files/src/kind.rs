//! The kind of a file, recognised by its name and its keys before it is parsed.

use std::fs;
use std::io::{self, ErrorKind, Read as _};
use std::path::Path;

use crate::FileError;

/// The size in bytes at which a file is refused; some, such as `/dev/zero`, never end.
const TOO_LARGE: u64 = 1 << 26;

/// A kind of file that a command of `eeruf` reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A schedule: firing times or waits.
    Schedule,
    /// A ring file for `design`.
    Ring,
    /// A ring file for `search`.
    Waits,
    /// A scene with robots.
    Scene,
    /// A map for `scene`.
    Map,
    /// A log of readings or firings.
    Log,
}

impl Kind {
    /// Returns the kind that a file looks like, if any.
    pub fn of(file: &Path, text: &str) -> Option<Self> {
        match file.extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
            Some("csv" | "mcap" | "bag" | "db3") => return Some(Self::Log),
            // Only a map is recognised: ROS messages are printed as YAML too.
            Some("yaml" | "yml") => {
                let is_map = text.lines().any(|line| line.starts_with("image:") || line.starts_with("resolution:"));
                return is_map.then_some(Self::Map);
            }
            _ => {}
        }
        let line = |line: &str| line.split('#').next().unwrap_or("").trim().to_owned();
        let lines: Vec<_> = text.lines().map(line).collect();
        let has = |key: &str| {
            let sets = |line: &String| line.strip_prefix(key).is_some_and(|rest| rest.trim_start().starts_with('='));
            lines.iter().any(sets)
        };
        if lines.iter().any(|line| ["[[wall]]", "[[robot]]", "[[pole]]"].contains(&line.as_str())) {
            return Some(Self::Scene);
        }
        if has("wait_max_us") {
            return Some(Self::Waits);
        }
        let schedule = ["t_fire_a_us", "t_fire_b_us", "t_fire_us", "t_wait_a_us", "t_wait_b_us", "step_us"];
        if schedule.iter().any(|key| has(key)) {
            return Some(Self::Schedule);
        }
        if has("sensors") && !has("period_us") {
            return Some(Self::Ring);
        }
        None
    }

    /// Returns the kind that a file looks like; `None` if it cannot be read as text.
    pub fn of_file(file: &Path) -> Option<Self> {
        read_text(file).ok().and_then(|text| Self::of(file, &text))
    }

    fn name(self) -> &'static str {
        match self {
            Self::Schedule => "a schedule",
            Self::Ring => "a ring for `eeruf design`",
            Self::Waits => "a ring for `eeruf lab search`",
            Self::Scene => "a scene",
            Self::Map => "a map",
            Self::Log => "a log",
        }
    }

    fn command(self) -> &'static str {
        match self {
            Self::Schedule => "verify",
            Self::Ring => "design",
            Self::Waits => "lab search",
            Self::Scene => "study",
            Self::Map => "lab scene",
            Self::Log => "logs",
        }
    }

    /// Refuses a file that is certainly not of the expected kind.
    ///
    /// # Errors
    /// The kind found, the kind expected, and the command that reads the kind found.
    ///
    /// ```
    /// use eeruf_files::Kind;
    /// let error = Kind::Scene.expect("ring.toml".as_ref(), "sensors = 8").unwrap_err().to_string();
    /// assert!(error.ends_with("expected a scene; did you mean `eeruf design ring.toml`?"), "{error}");
    /// ```
    pub fn expect(self, file: &Path, text: &str) -> Result<(), FileError> {
        let Some(found) = Self::of(file, text).filter(|found| *found != self) else { return Ok(()) };
        let (is, expected, command) = (found.name(), self.name(), found.command());
        let message = format!("this is {is}; expected {expected}; did you mean `eeruf {command} {}`?", file.display());
        Err(FileError::new(file, message))
    }

    /// Reads a text file of this kind.
    ///
    /// # Errors
    /// The file cannot be read, is not text, or is certainly of another kind.
    pub fn read(self, file: &Path) -> Result<String, FileError> {
        // A log is recognised by its name: not every log is text.
        self.expect(file, "")?;
        let text = read_text(file).map_err(|error| FileError::reading(file, &error))?;
        self.expect(file, &text)?;
        Ok(text)
    }

    /// Refuses a TOML file or a map where a log is expected.
    ///
    /// # Errors
    /// The file does not exist, or is of another kind; the message names the command that reads that kind.
    pub fn expect_log(file: &Path) -> Result<(), FileError> {
        if file.as_os_str() == "-" {
            return Ok(());
        }
        fs::metadata(file).map_err(|error| FileError::reading(file, &error))?;
        let ending = file.extension().map(|ending| ending.to_string_lossy().to_lowercase());
        let is_ours = matches!(ending.as_deref(), Some("toml" | "yaml" | "yml"));
        // The reader of logs reports a file that cannot be read.
        let mut text = Vec::new();
        if is_ours && let Ok(file) = fs::File::open(file) {
            _ = file.take(1 << 16).read_to_end(&mut text);
        }
        let text = String::from_utf8_lossy(&text);
        Self::Log.expect(file, &text)
    }
}

/// Reads a text that is no larger than [`TOO_LARGE`].
fn read_text(file: &Path) -> io::Result<String> {
    let mut bytes = vec![];
    let size = fs::File::open(file)?.take(TOO_LARGE).read_to_end(&mut bytes)?;
    if size as u64 == TOO_LARGE {
        return Err(io::Error::new(ErrorKind::FileTooLarge, "64 MiB or more"));
    }
    let is_utf16 = bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff");
    let what = if is_utf16 { "text in UTF-16; in PowerShell `| Out-File -Encoding utf8`" } else { "no text" };
    String::from_utf8(bytes).map_err(|_| io::Error::new(ErrorKind::InvalidData, what))
}
