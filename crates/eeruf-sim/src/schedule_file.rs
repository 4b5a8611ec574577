//! Schedules in files: either lags and waits, or firing times, in whole microseconds, one number for each sensor.

use eeruf_core::{Micros, ScheduleError};
use serde::Deserialize;

use crate::method::AnySchedule;

/// A schedule as it stands in a file.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct ScheduleFile {
    period_us: u32,
    t_lag_us: Option<Vec<u32>>,
    t_wait_a_us: Option<Vec<u32>>,
    t_wait_b_us: Option<Vec<u32>>,
    t_fire_a_us: Option<Vec<u32>>,
    t_fire_b_us: Option<Vec<u32>>,
}

impl ScheduleFile {
    /// The schedule, or what is wrong with it.
    pub(crate) fn schedule(&self) -> Result<AnySchedule, String> {
        let Self { period_us, t_lag_us, t_wait_a_us, t_wait_b_us, t_fire_a_us, t_fire_b_us } = self;
        let built = match (t_lag_us, t_wait_a_us, t_wait_b_us, t_fire_a_us, t_fire_b_us) {
            (Some(lag), Some(a), Some(b), None, None) => build(*period_us, lag, a, b),
            (None, None, None, Some(a), Some(b)) => build(*period_us, &vec![0; a.len()], a, b),
            _ => {
                return Err(
                    "expected either t_lag_us, t_wait_a_us and t_wait_b_us, or t_fire_a_us and t_fire_b_us".to_owned()
                );
            }
        };
        built.map_err(|error| error.to_string())
    }
}

fn build(period_us: u32, lag: &[u32], a: &[u32], b: &[u32]) -> Result<AnySchedule, ScheduleError> {
    let [lag, a, b] = [lag, a, b].map(|us| us.iter().copied().map(Micros::new).collect::<Vec<_>>());
    AnySchedule::from_slices(Micros::new(period_us), &lag, [&a, &b])
}
