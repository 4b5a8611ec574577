//! The firings of a log as the search for paths needs them.

use super::Settings;
use super::statistics::groups;
use crate::firings::FiringLog;

/// One reading of the receiver.
#[derive(Clone, Copy)]
pub(super) struct Heard {
    /// Its place in the log.
    pub(super) firing: usize,
    pub(super) fired_us: i64,
    /// From firing to edge; `None` without one.
    pub(super) echo_us: Option<i64>,
}

/// All firings in order of time, and each sensor's own.
pub(super) struct Timeline {
    /// When, and who.
    firings: Vec<(i64, u8)>,
    heard: Vec<Vec<Heard>>,
    /// The longest echo time of any reading: for so long sensors listen, at least.
    pub(super) window_us: i64,
    max_travel_us: i64,
}

impl Timeline {
    pub(super) fn of(log: &FiringLog, settings: &Settings) -> Self {
        let firings = log.firings.iter().map(|firing| (firing.fired_us, firing.sensor)).collect();
        let mut heard = vec![Vec::new(); log.sensors()];
        for (place, firing) in log.firings.iter().enumerate() {
            let echo_us = firing.t_echo_us.map(i64::from);
            heard[usize::from(firing.sensor)].push(Heard { firing: place, fired_us: firing.fired_us, echo_us });
        }
        let window_us = log.firings.iter().filter_map(|firing| firing.t_echo_us).max().unwrap_or(0).into();
        Self { firings, heard, window_us, max_travel_us: settings.max_travel_us.into() }
    }

    pub(super) fn sensors(&self) -> usize {
        self.heard.len()
    }

    /// The readings of a sensor.
    pub(super) fn heard_by(&self, receiver: u8) -> &[Heard] {
        &self.heard[usize::from(receiver)]
    }

    /// The most different offsets at which one sensor may hear another's sound.
    pub(super) fn most_offsets(&self, tolerance_us: i64) -> u32 {
        let mut most = 0;
        for heard in &self.heard {
            let mut offsets = vec![Vec::new(); self.sensors()];
            for reading in heard {
                for (fired_us, sensor) in self.before(reading.fired_us + self.window_us) {
                    offsets[usize::from(sensor)].push(fired_us - reading.fired_us);
                }
            }
            for offsets in &mut offsets {
                offsets.sort_unstable();
                most = most.max(groups(offsets, 2 * tolerance_us).len() as u32);
            }
        }
        most
    }

    /// Firings before a moment that may still be heard at it, latest first: when, and who. What fired at the very
    /// moment counts.
    pub(super) fn before(&self, moment_us: i64) -> impl Iterator<Item = (i64, u8)> + '_ {
        let end = self.firings.partition_point(|&(fired_us, _)| fired_us <= moment_us);
        let earliest = moment_us - self.max_travel_us;
        self.firings[..end].iter().rev().take_while(move |(fired_us, _)| *fired_us >= earliest).copied()
    }
}
