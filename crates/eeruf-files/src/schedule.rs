//! Schedules in files: either lags and waits, or firing times, in whole microseconds, one number for each sensor.

use eeruf_core::{MAX_SENSORS, Micros, Phase, Schedule, ScheduleError};
use serde::{Deserialize, Serialize};

/// A schedule whose number of sensors is known only at run time.
pub type AnySchedule = Schedule<MAX_SENSORS>;

/// A schedule as a file holds it.
///
/// ```
/// let keys = "period_us = 40_000\nt_fire_a_us = [0, 20_000]\nt_fire_b_us = [2_000, 25_000]\n";
/// let file: eeruf_files::ScheduleFile = toml::from_str(keys)?;
/// assert_eq!(file.schedule()?.sensors(), 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScheduleFile {
    pub(crate) period_us: u32,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) t_lag_us: Option<Vec<u32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) t_wait_a_us: Option<Vec<u32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) t_wait_b_us: Option<Vec<u32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) t_fire_a_us: Option<Vec<u32>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    pub(crate) t_fire_b_us: Option<Vec<u32>>,
}

impl ScheduleFile {
    /// Returns the schedule.
    ///
    /// # Errors
    /// A message that names the key, its value and the expected value.
    pub fn schedule(&self) -> Result<AnySchedule, String> {
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

impl<const K: usize> From<&Schedule<K>> for ScheduleFile {
    /// Writes firing times if all lags are zero, as in a schedule given by its firing times.
    fn from(schedule: &Schedule<K>) -> Self {
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

/// Schedules as [`ScheduleFile`]s, for `#[serde(with = "eeruf_files::as_file")]`.
pub mod as_file {
    use serde::de::{Deserialize, Deserializer, Error};
    use serde::ser::{Serialize, Serializer};

    use super::{AnySchedule, ScheduleFile};

    /// Writes the keys of a file.
    ///
    /// # Errors
    /// Errors of the serializer.
    pub fn serialize<S: Serializer>(schedule: &AnySchedule, serializer: S) -> Result<S::Ok, S::Error> {
        ScheduleFile::from(schedule).serialize(serializer)
    }

    /// Reads a schedule.
    ///
    /// # Errors
    /// Errors of [`ScheduleFile::schedule`] and of the deserializer.
    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<AnySchedule, D::Error> {
        ScheduleFile::deserialize(deserializer)?.schedule().map_err(D::Error::custom)
    }
}
