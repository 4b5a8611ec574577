//! The kind of a file, recognised by its name and its keys before it is parsed.

use std::fs;
use std::path::Path;

use super::error::InputError;

/// A kind of file that a command reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// A schedule: firing times or waits.
    Schedule,
    /// A ring of `design`.
    Ring,
    /// A ring of `search`.
    Waits,
    /// A scene with robots.
    Scene,
    /// A map of `scene`.
    Map,
    /// A log of readings or firings.
    Log,
}

impl Kind {
    /// Returns the kind that a file looks like, if it looks like one.
    pub(crate) fn of(file: &Path, text: &str) -> Option<Self> {
        match file.extension().map(|ending| ending.to_string_lossy().to_lowercase()).as_deref() {
            Some("csv" | "mcap" | "bag" | "db3") => return Some(Self::Log),
            Some("yaml" | "yml") => return Some(Self::Map),
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

    /// Returns the kind that a file looks like; none for one that cannot be read as text.
    pub(crate) fn of_file(file: &Path) -> Option<Self> {
        fs::read_to_string(file).ok().and_then(|text| Self::of(file, &text))
    }

    fn name(self) -> &'static str {
        match self {
            Self::Schedule => "a schedule",
            Self::Ring => "a ring for `eeruf design`",
            Self::Waits => "a ring for `eeruf search`",
            Self::Scene => "a scene",
            Self::Map => "a map",
            Self::Log => "a log",
        }
    }

    fn command(self) -> &'static str {
        match self {
            Self::Schedule => "verify",
            Self::Ring => "design",
            Self::Waits => "search",
            Self::Scene => "study",
            Self::Map => "scene",
            Self::Log => "replay",
        }
    }

    /// Refuses a file that is certainly of another kind than the one expected.
    ///
    /// # Errors
    /// The kind found, the kind expected, and the command that reads the kind found.
    pub(crate) fn expect(self, file: &Path, text: &str) -> Result<(), String> {
        let Some(found) = Self::of(file, text).filter(|found| *found != self) else { return Ok(()) };
        let (is, command) = (found.name(), found.command());
        Err(format!("this is {is}; expected {}; did you mean `eeruf {command} {}`?", self.name(), file.display()))
    }
}

/// Refuses a TOML file or a map where a log is expected.
///
/// # Errors
/// The kind found, and the command that reads it.
pub(crate) fn expect_log(file: &Path) -> Result<(), InputError> {
    fs::metadata(file).map_err(|error| InputError::reading(file, &error))?;
    let is_toml = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    // What cannot be read gets its error from the reader of logs.
    let text = if is_toml { fs::read_to_string(file).unwrap_or_default() } else { String::new() };
    Kind::Log.expect(file, &text).map_err(|message| InputError::new(file, None, message))
}
