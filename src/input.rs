//! Reading input files. Whatever is wrong with one is said in one line: file, line or field, value, what is expected.

use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

use eeruf_core::{MAX_SENSORS, Micros, Phase, Schedule, ScheduleError};
use serde::{Deserialize, Serialize, de::DeserializeOwned};

/// A schedule whose number of sensors is known only at run time.
pub(crate) type AnySchedule = Schedule<MAX_SENSORS>;

/// Bad input, in one line.
#[derive(Debug)]
pub(crate) struct InputError {
    file: PathBuf,
    line: Option<u64>,
    message: String,
}

impl InputError {
    pub(crate) fn new(file: &Path, line: Option<u64>, message: impl fmt::Display) -> Self {
        Self { file: file.to_owned(), line, message: message.to_string().replace('\n', "; ") }
    }
}

impl fmt::Display for InputError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl std::error::Error for InputError {}

/// Reads a TOML file.
pub(crate) fn read_toml<T: DeserializeOwned>(file: &Path) -> Result<T, InputError> {
    let text = fs::read_to_string(file).map_err(|error| InputError::new(file, None, error))?;
    toml::from_str(&text).map_err(|error| {
        let line = error.span().map(|span| 1 + text[..span.start].matches('\n').count() as u64);
        InputError::new(file, line, error.message())
    })
}

/// A schedule file: either lags and waits, or firing times, in whole microseconds.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ScheduleFile {
    period_us: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_lag_us: Option<Vec<u32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_wait_a_us: Option<Vec<u32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_wait_b_us: Option<Vec<u32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_fire_a_us: Option<Vec<u32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    t_fire_b_us: Option<Vec<u32>>,
}

impl ScheduleFile {
    fn schedule(&self) -> Result<AnySchedule, String> {
        let micros = |us: &[u32]| us.iter().copied().map(Micros::new).collect::<Vec<_>>();
        let build = |lag: &[u32], a: &[u32], b: &[u32]| {
            AnySchedule::from_slices(Micros::new(self.period_us), &micros(lag), [&micros(a), &micros(b)])
        };
        let Self { t_lag_us, t_wait_a_us, t_wait_b_us, t_fire_a_us, t_fire_b_us, .. } = self;
        let built = match (t_lag_us, t_wait_a_us, t_wait_b_us, t_fire_a_us, t_fire_b_us) {
            (Some(lag), Some(a), Some(b), None, None) => build(lag, a, b),
            (None, None, None, Some(a), Some(b)) => build(&vec![0; a.len()], a, b),
            _ => {
                return Err("expected either t_lag_us, t_wait_a_us and t_wait_b_us, or t_fire_a_us and t_fire_b_us, \
                            one number for each sensor"
                    .to_owned());
            }
        };
        built.map_err(|error| match error {
            ScheduleError::Waits { phase, waits, sensors } => {
                let given = if t_fire_a_us.is_some() { "t_fire" } else { "t_wait" };
                let first = if t_fire_a_us.is_some() { "t_fire_a_us" } else { "t_lag_us" };
                format!("{given}_{phase}_us has {waits} numbers; expected {sensors}, as many as {first}")
            }
            error => error.to_string(),
        })
    }
}

impl From<&AnySchedule> for ScheduleFile {
    /// In firing times if the lags are all zero, as they are for a schedule given by its firing times.
    fn from(schedule: &AnySchedule) -> Self {
        let us = |times: &[Micros]| Some(times.iter().map(|time| time.as_micros()).collect());
        let (a, b) = (us(schedule.t_wait(Phase::A)), us(schedule.t_wait(Phase::B)));
        let period_us = schedule.period().as_micros();
        if schedule.t_lag().iter().all(|&lag| lag == Micros::ZERO) {
            let (t_lag_us, t_wait_a_us, t_wait_b_us) = (None, None, None);
            return Self { period_us, t_lag_us, t_wait_a_us, t_wait_b_us, t_fire_a_us: a, t_fire_b_us: b };
        }
        let t_lag_us = us(schedule.t_lag());
        Self { period_us, t_lag_us, t_wait_a_us: a, t_wait_b_us: b, t_fire_a_us: None, t_fire_b_us: None }
    }
}

/// Reads a schedule file.
pub(crate) fn read_schedule(file: &Path) -> Result<AnySchedule, InputError> {
    read_toml::<ScheduleFile>(file)?.schedule().map_err(|message| InputError::new(file, None, message))
}

/// Writes a file that the user asked for.
pub(crate) fn write(file: &Path, contents: impl AsRef<[u8]>) -> Result<(), InputError> {
    fs::write(file, contents).map_err(|error| InputError::new(file, None, error))
}

/// What `--json` prints: one object on one line.
pub(crate) fn to_json(answer: &impl Serialize) -> String {
    // Our own types: named fields, numbers and strings, which always serialise.
    serde_json::to_string(answer).unwrap_or_default()
}
