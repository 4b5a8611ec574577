//! The log of a simulated ring's firings, as firmware would write it.

use std::path::Path;

use eeruf_logs::{Firing, FiringLog, McapWriter, Weighed};
use eeruf_sim::Readings;

use super::error::InputError;
use super::write::write;

/// The name of the simulation's clock.
pub(crate) const CLOCK: &str = "simulation, true time";

/// One of the readings of a simulation, as a log of firings has it.
pub fn firing(readings: &Readings, k: usize) -> Firing {
    Firing {
        sensor: readings.sensor[k],
        fired_us: (1e6 * readings.fired_s[k]).round() as i64,
        period: readings.period[k],
        phase: readings.phase[k],
        t_echo_us: (!readings.earliest_us[k].is_nan()).then(|| readings.earliest_us[k] as u32),
        rejected: Some(readings.kind[k].is_rejected()),
        weighed: readings.weighed[k].map(|weighed| Weighed {
            given: k as u64,
            kind: Some(readings.kind[k]),
            solo: weighed.solo,
            steady: weighed.steady,
            changes: weighed.changes,
            expected_change_us: weighed.expected_change_us,
        }),
    }
}

/// Every firing of the first robot.
pub(crate) fn firing_log(readings: &Readings) -> FiringLog {
    let of_first = (0..readings.len()).filter(|&k| readings.robot[k] == 0);
    FiringLog::new(CLOCK, of_first.map(|k| firing(readings, k)).collect())
}

/// Writes every firing of the first robot, as MCAP if the file's name ends so, else as CSV.
pub(crate) fn write_firings(file: &Path, readings: &Readings) -> Result<(), InputError> {
    let log = firing_log(readings);
    if file.extension().is_some_and(|ending| ending == "mcap") {
        let mut out = McapWriter::create(file)?;
        for firing in &log.firings {
            out.firing("/firings", CLOCK, 1000 * firing.fired_us.unsigned_abs(), firing)?;
        }
        return Ok(out.finish()?);
    }
    write(file, csv(&log, file)?)
}

/// A log as CSV; `file` stands in errors.
pub(crate) fn csv(log: &FiringLog, file: &Path) -> Result<Vec<u8>, InputError> {
    let mut text = Vec::new();
    log.write(&mut text).map_err(|error| InputError::new(file, error))?;
    Ok(text)
}
