//! The log of a simulated ring's firings, as firmware would write it.

use std::path::Path;

use eeruf_logs::{Firing, FiringLog, McapWriter};
use eeruf_sim::Readings;

use super::error::InputError;
use super::write::write;

/// The name of the simulation's clock.
pub(crate) const CLOCK: &str = "simulation, true time";

/// Converts a simulated reading to a firing of a log.
pub(crate) fn firing(readings: &Readings, k: usize) -> Firing {
    Firing {
        sensor: readings.sensor[k],
        fired_us: (1e6 * readings.fired_s[k]).round() as i64,
        period: readings.period[k],
        phase: readings.phase[k],
        t_echo_us: (!readings.earliest_us[k].is_nan()).then(|| readings.earliest_us[k] as u32),
        reading: Some(readings.kind[k]),
        g_us_ms: None,
    }
}

/// Rate below which a robot counts as stationary, so that its log has no motion.
const LEAST_US_MS: f32 = 1e-3;

/// Returns every firing of the first robot, with the rate of change of its readings if it moves.
pub fn firing_log(readings: &Readings) -> FiringLog {
    let of_first: Vec<_> = (0..readings.len()).filter(|&k| readings.robot[k] == 0).collect();
    let motion: Vec<_> = of_first.iter().map(|&k| g_us_ms(readings, k)).collect();
    let moves = motion.iter().any(|g| *g > LEAST_US_MS);
    let firings = of_first.iter().zip(motion);
    let firings = firings.map(|(&k, g)| Firing { g_us_ms: moves.then_some(g), ..firing(readings, k) });
    FiringLog::new(CLOCK, firings.collect())
}

/// Returns the rate at which the sensor's motion changes readings, over 20 ms or more before this one, or after it for
/// the first one, in microseconds for each millisecond.
fn g_us_ms(readings: &Readings, k: usize) -> f32 {
    const WITHIN_S: f64 = 0.02;
    /// Arm at which a wall moves when the robot turns, in metres, and the speed of sound in m/s, as rings assume them.
    const LEVER_M: f64 = 0.5;
    const SOUND_M_S: f64 = 343.0;
    let Readings { fired_s, x_m, y_m, heading_rad, .. } = readings;
    let is_apart = |&j: &usize| readings.id(j) == readings.id(k) && (fired_s[k] - fired_s[j]).abs() >= WITHIN_S;
    let Some(j) = (0..k).rev().find(is_apart).or_else(|| (k..readings.len()).find(is_apart)) else { return 0.0 };
    let turned = (heading_rad[k] - heading_rad[j]).sin().abs();
    let moved_m = (x_m[k] - x_m[j]).hypot(y_m[k] - y_m[j]) + LEVER_M * turned;
    (2e3 * moved_m / SOUND_M_S / (fired_s[k] - fired_s[j]).abs()) as f32
}

/// Writes every firing of the first robot, as MCAP if the file's name ends in .mcap, else as CSV.
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

/// Formats a log as CSV; `file` is the name used in errors.
pub(crate) fn csv(log: &FiringLog, file: &Path) -> Result<Vec<u8>, InputError> {
    let mut text = Vec::new();
    log.write(&mut text).map_err(|error| InputError::new(file, error))?;
    Ok(text)
}
