//! Jitter, lateness and drift of firings relative to a fixed schedule.

use crate::firings::FiringLog;

/// Adherence of firings to a schedule.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Timing {
    /// Drift of the log's clock relative to the schedule's, positive if firings become later, in millionths.
    pub drift_ppm: f64,
    /// Standard error of the drift.
    pub drift_error_ppm: f64,
    /// Scatter of firings around the drifting schedule, rms, in microseconds.
    pub jitter_us: f64,
    /// Lateness, relative to the drifting schedule, that 99 % of firings do not exceed, in microseconds.
    pub late_99_us: f64,
    /// Number of firings that were compared.
    pub firings: usize,
}

/// Largest plausible clock error, that of microcontrollers without a crystal.
const MOST_DRIFT: f64 = 0.1;
/// Distance from the schedule, in microseconds, beyond which a firing is of another one.
const ELSEWHERE_US: f64 = 1000.0;

/// Compares a log with a fixed schedule: its period in microseconds, and a function for the firing time of a sensor in
/// a phase (both from 0) after the start of the period.
///
/// # Errors
/// A schedule that is not the ring's, lags that moved, or fewer than ten periods.
pub fn timing(log: &FiringLog, period_us: u32, fires_at: impl Fn(u8, u8) -> Option<u32>) -> Result<Timing, String> {
    let mut points = Vec::with_capacity(log.firings.len());
    for firing in &log.firings {
        let (sensor, phase) = (firing.sensor, firing.phase);
        let in_period = fires_at(sensor, phase).ok_or_else(|| {
            format!("the log has sensor {} in phase {phase}, which the schedule does not have", sensor + 1)
        })?;
        let due = f64::from(firing.period) * f64::from(period_us) + f64::from(in_period);
        points.push((due, firing.fired_us as f64 - due));
    }
    let periods = log.firings.iter().map(|firing| firing.period);
    if periods.clone().max().unwrap_or(0) - periods.min().unwrap_or(0) < 10 {
        return Err("fewer than ten periods; expected ten or more".to_owned());
    }
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let spread = points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>();
    let slope = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum::<f64>() / spread;
    if slope.abs() > MOST_DRIFT {
        let percent = 100.0 * (1.0 + slope);
        return Err(format!("its periods last {percent:.1} % of the schedule's; expected 90 to 110 %"));
    }
    let mut off: Vec<_> = points.iter().map(|point| point.1 - y - slope * (point.0 - x)).collect();
    let elsewhere = off.iter().filter(|off| off.abs() > ELSEWHERE_US).count() as f64 / n;
    if elsewhere > 0.05 {
        return Err(format!(
            "{:.0} % of the firings are more than 1 ms from the schedule; expected the one that the ring fired by, \
             with lags that did not move",
            100.0 * elsewhere
        ));
    }
    let jitter_us = (off.iter().map(|off| off * off).sum::<f64>() / (n - 2.0).max(1.0)).sqrt();
    off.sort_by(f64::total_cmp);
    // Measured from the earliest firings, since firings are only ever late.
    let earliest = off[off.len() / 100];
    let late_99_us = off[off.len() - 1 - off.len() / 100] - earliest;
    Ok(Timing {
        drift_ppm: 1e6 * slope,
        drift_error_ppm: 1e6 * jitter_us / spread.sqrt(),
        jitter_us,
        late_99_us,
        firings: points.len(),
    })
}
