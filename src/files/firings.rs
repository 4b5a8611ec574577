//! The log of a simulated ring's firings, as firmware would write it.

use std::path::Path;

use eeruf_core::ReadingKind;
use eeruf_logs::{Firing, FiringLog};
use eeruf_sim::Readings;

use super::error::InputError;
use super::write::write;

/// Writes every firing of the first robot. The clock is the simulation's.
pub(crate) fn write_firings(file: &Path, readings: &Readings) -> Result<(), InputError> {
    let firing = |k: usize| Firing {
        sensor: readings.sensor[k],
        fired_us: (1e6 * readings.fired_s[k]).round() as i64,
        period: readings.period[k],
        phase: readings.phase[k],
        t_echo_us: (!readings.earliest_us[k].is_nan()).then(|| readings.earliest_us[k] as u32),
        rejected: Some(readings.kind[k] == ReadingKind::Rejected),
    };
    let firings = (0..readings.len()).filter(|&k| readings.robot[k] == 0).map(firing).collect();
    let mut text = Vec::new();
    let log = FiringLog::new("simulation, true time", firings);
    log.write(&mut text).map_err(|error| InputError::new(file, None, error))?;
    write(file, &text)
}
