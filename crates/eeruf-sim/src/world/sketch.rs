//! [`Sketch`]: today's ways of firing a ring, by sketches and by modules that fire themselves.

use eeruf_core::{MAX_PERIOD, Micros};
use serde::{Deserialize, Serialize};

/// Settings of the [methods](crate::Method::is_sketch) that imitate today's rings: `[firing]` in scene files.
#[derive(Clone, Debug, PartialEq)]
pub struct Sketch {
    /// Longest wait for a sensor; `None` for its listening time.
    pub timeout: Option<Micros>,
    /// The time from an echo, or from the time-out, to the next trigger.
    pub pause: Micros,
    /// The least time from one trigger to the next in turn, as set by a ping timer. For free-running modules it is
    /// their cycle, if longer than their rest.
    pub turn: Micros,
    /// The least time from one trigger of a sensor to its next. `None` for the modules' own rest (with a sync line or
    /// free-running modules) or for 0 (otherwise).
    pub rest: Option<Micros>,
    /// The sensors of each array, in the order in which they fire. Empty for two halves of the ring.
    pub arrays: Vec<Vec<u8>>,
    /// The groups of sensors that fire together, in turn. Empty for groups as far apart as the robot's `neighbours`.
    pub groups: Vec<Vec<u8>>,
    /// The number of consecutive readings that must agree, 1 to 8; with 1 each reading is believed.
    pub consecutive: u8,
    /// The largest deviation of a free-running module's cycle, in parts per million; each module has its own deviation.
    /// The default, 5000, is a choice: that of a ceramic resonator.
    pub drift_ppm: f64,
    /// The firing times of the method `table`; `None` for the robot's own schedule.
    pub table: Option<FiringTable>,
}

impl Default for Sketch {
    fn default() -> Self {
        Self {
            timeout: None,
            pause: Micros::ZERO,
            turn: Micros::ZERO,
            rest: None,
            arrays: vec![],
            groups: vec![],
            consecutive: 1,
            drift_ppm: 5000.0,
            table: None,
        }
    }
}

/// Firing times of any number of phases.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct FiringTable {
    /// The length of a period.
    #[serde(rename = "period_us")]
    pub period: Micros,
    /// For each phase the time of each sensor's firing after the beginning of the period.
    #[serde(rename = "t_fire_us")]
    pub rows: Vec<Vec<Micros>>,
}

impl FiringTable {
    /// Returns the mean time from one firing to the next.
    pub fn gap(&self) -> Micros {
        Micros::new(self.period.as_micros() / self.rows.first().map_or(1, |row| row.len().max(1)) as u32)
    }
}

impl Sketch {
    /// Finds the first setting that is invalid for this many sensors with this window; returns its name in files, its
    /// value, and the expected range.
    pub(super) fn check(&self, sensors: usize, window: Micros) -> Result<(), (&'static str, f64, &'static str)> {
        let us = |time: Micros| f64::from(time.as_micros());
        if let Some(timeout) = self.timeout.filter(|&timeout| timeout == Micros::ZERO || timeout > window) {
            return Err(("timeout_us", us(timeout), "1 to window_us"));
        }
        for (name, time) in
            [("pause_us", self.pause), ("turn_us", self.turn), ("rest_us", self.rest.unwrap_or_default())]
        {
            if time > MAX_SKETCH {
                return Err((name, us(time), "0 to 10000000"));
            }
        }
        for (name, sets) in [("arrays", &self.arrays), ("groups", &self.groups)] {
            let mut left = vec![true; sensors];
            for &sensor in sets.iter().flatten() {
                match left.get_mut(usize::from(sensor)) {
                    Some(left) if *left => *left = false,
                    _ => return Err((name, f64::from(sensor), "each sensor once, from 0")),
                }
            }
            if let Some(missing) = left.iter().position(|&left| left).filter(|_| !sets.is_empty()) {
                return Err((name, missing as f64, "each sensor once; this one is missing"));
            }
            if sets.iter().any(Vec::is_empty) {
                return Err((name, 0.0, "one sensor or more in each list"));
            }
        }
        if !(1..=8).contains(&self.consecutive) {
            return Err(("firing.consecutive", f64::from(self.consecutive), "1 to 8"));
        }
        if !(0.0..=100_000.0).contains(&self.drift_ppm) {
            return Err(("drift_ppm", self.drift_ppm, "0 to 100000"));
        }
        let Some(FiringTable { period, rows }) = &self.table else { return Ok(()) };
        if *period == Micros::ZERO || *period > MAX_PERIOD {
            return Err(("firing.schedule", us(*period), "a period of 1 to 268435456 us"));
        }
        if rows.is_empty() {
            return Err(("firing.schedule", 0.0, "one phase or more"));
        }
        if let Some(row) = rows.iter().find(|row| row.len() != sensors) {
            return Err(("firing.schedule", row.len() as f64, "in each phase one time for each sensor"));
        }
        match rows.iter().flatten().find(|&time| time >= period) {
            Some(&late) => Err(("firing.schedule", us(late), "times before the end of the period")),
            None => Ok(()),
        }
    }
}

/// The longest time of a sketch's setting.
const MAX_SKETCH: Micros = Micros::from_millis(10_000);
