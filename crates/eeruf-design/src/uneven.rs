//! Needs of sensors that differ, as files and callers give them.

use eeruf_core::{MAX_SENSORS, Micros, Requirements, Uneven, conditions::RequirementsError};

/// Windows and tolerances of each sensor, intervals of pairs, shared echo lines, sensors that fire together.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct OwnedUneven {
    /// `T_delta` of each sensor.
    pub t_delta: Vec<Micros>,
    /// `T_wind` of each sensor.
    pub window: Vec<Micros>,
    /// Least time between two triggers of each sensor.
    pub refire: Vec<Micros>,
    pub(crate) intervals: Vec<(u8, u8, Micros)>,
    pub(crate) shared_lines: Vec<u64>,
    pub(crate) together: Vec<u64>,
}

impl OwnedUneven {
    /// Needs of this many sensors, counted from 0. `t_delta`, `window` and `refire` may be empty: all sensors then have
    /// the common values.
    ///
    /// # Errors
    /// The first invalid value.
    pub fn new(
        sensors: usize,
        [t_delta, window, refire]: [Vec<Micros>; 3],
        intervals_us: &[(usize, usize, u32)],
        shared_lines: &[Vec<usize>],
        together: &[Vec<usize>],
    ) -> Result<Self, String> {
        let mut intervals = Vec::new();
        for &(x, y, us) in intervals_us {
            if x == y || x.max(y) >= sensors {
                return Err(format!(
                    "intervals_us: sensors {x} and {y}; expected two different ones from 0 to {}",
                    sensors - 1
                ));
            }
            // Sensors are below 64.
            intervals.push((x as u8, y as u8, Micros::new(us)));
        }
        let shared_lines = sets("shared_lines", shared_lines, sensors)?;
        let together = sets("together", together, sensors)?;
        let owned = Self { t_delta, window, refire, intervals, shared_lines, together };
        owned.uneven().check(sensors).map_err(|error| match error {
            RequirementsError::PairTwice { pair: (x, y) } => {
                format!("intervals_us: sensors {x} and {y} twice; expected each pair once")
            }
            // Sensors are counted as in the file.
            error => format!("{error:#}"),
        })?;
        Ok(owned)
    }

    /// Returns the limits in core's form.
    pub fn uneven(&self) -> Uneven<'_> {
        let Self { t_delta, window, refire, intervals, shared_lines, together } = self;
        Uneven { t_delta, window, refire, intervals, shared_lines, together }
    }

    /// Returns the needs with other intervals of pairs.
    pub(crate) fn with_intervals(&self, other: impl Fn(Micros) -> Micros) -> Self {
        let intervals = self.intervals.iter().map(|&(x, y, interval)| (x, y, other(interval))).collect();
        Self { intervals, ..self.clone() }
    }

    /// Returns the needs with other tolerances.
    pub(crate) fn with_t_deltas(&self, other: impl Fn(Micros) -> Micros) -> Self {
        Self { t_delta: self.t_delta.iter().map(|t_delta| other(*t_delta)).collect(), ..self.clone() }
    }

    /// Returns the needs with other windows, and unchanged refire times.
    pub(crate) fn with_windows(&self, other: impl Fn(Micros) -> Micros) -> Self {
        Self { window: self.window.iter().map(|window| other(*window)).collect(), ..self.clone() }
    }

    /// Checks that no two sensors that fire together must keep a time between their firings.
    ///
    /// # Errors
    /// The first two sensors that must keep one, in words.
    pub fn can_fire_together(requirements: &Requirements<'_>, sensors: usize) -> Result<(), String> {
        for (x, y) in (0..sensors).flat_map(|x| (x + 1..sensors).map(move |y| (x, y))) {
            let gap = requirements.gap_after(sensors, x, y).max(requirements.gap_after(sensors, y, x));
            if requirements.fire_together(x, y) && gap > Micros::ZERO {
                return Err(format!(
                    "together: sensors {x} and {y} must keep {gap} between their firings; expected a layout in which \
                     they are no neighbours, or intervals_us = [[{x}, {y}, 0]], and no shared line"
                ));
            }
        }
        Ok(())
    }
}

/// Sets of sensors as bits.
pub(crate) fn sets(what: &str, groups: &[Vec<usize>], sensors: usize) -> Result<Vec<u64>, String> {
    let set = |group: &Vec<usize>| {
        let mut set = 0_u64;
        for &sensor in group {
            if sensor >= sensors.min(MAX_SENSORS) || set >> sensor & 1 == 1 {
                return Err(format!(
                    "{what}: {group:?}; expected two or more different sensors from 0 to {}",
                    sensors - 1
                ));
            }
            set |= 1 << sensor;
        }
        if group.len() < 2 {
            return Err(format!("{what}: {group:?}; expected two or more different sensors from 0 to {}", sensors - 1));
        }
        Ok(set)
    };
    groups.iter().map(set).collect()
}
