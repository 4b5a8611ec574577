//! Readings of a simulation as firings of a log, as a ring's firmware would write them.

use eeruf_logs::Firing;
use eeruf_sim::Readings;

/// The firing of this reading.
pub(crate) fn firing_of(readings: &Readings, k: usize) -> Firing {
    Firing {
        sensor: readings.sensor[k],
        fired_us: (1e6 * readings.fired_s[k]).round() as i64,
        period: readings.period[k],
        phase: readings.phase[k],
        t_echo_us: (!readings.earliest_us[k].is_nan()).then(|| readings.earliest_us[k] as u32),
        rejected: Some(readings.kind[k].is_rejected()),
        weighed: None,
    }
}
