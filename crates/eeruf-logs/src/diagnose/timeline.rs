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
    /// True if the ring fires in more than two phases, so that others' sound moves from firing to firing.
    pub(super) has_many_phases: bool,
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
        let has_many_phases = log.firings.iter().any(|firing| firing.phase > 1);
        Self { firings, heard, window_us, has_many_phases, max_travel_us: settings.max_travel_us.into() }
    }

    pub(super) fn sensors(&self) -> usize {
        self.heard.len()
    }

    /// The readings of a sensor.
    pub(super) fn heard_by(&self, receiver: u8) -> &[Heard] {
        &self.heard[usize::from(receiver)]
    }

    /// Returns true if ranges that recur in the first third of the log do not come back in the last one, at most of the
    /// sensors that have any.
    pub(super) fn moved(&self) -> bool {
        /// Echoes this close are of one thing that stands, in microseconds.
        const SAME_US: i64 = 75;
        /// A range that comes so often in a third recurs.
        const RECURS: f64 = 0.1;
        const FEWEST: usize = 10;
        const PARTS: usize = 3;
        let (mut stay, mut all) = (0, 0);
        for heard in &self.heard {
            let third = heard.len() / 3;
            let sorted = |part: &[Heard]| {
                let mut times: Vec<i64> = part.iter().filter_map(|heard| heard.echo_us).collect();
                times.sort_unstable();
                times
            };
            let (first, last) = (sorted(&heard[..third]), sorted(&heard[heard.len() - third..]));
            let near = |times: &[i64], us: i64| {
                times.partition_point(|&at| at <= us + SAME_US) - times.partition_point(|&at| at < us - SAME_US)
            };
            // The most crowded range of the first third that is there in each part of it: that of a thing that stands,
            // and not of another's sound at lags that hold for a while.
            let parts: Vec<_> = heard[..third].chunks((third / PARTS).max(1)).take(PARTS).map(sorted).collect();
            let lasts = |us: &i64| {
                let enough = RECURS * third as f64 / PARTS as f64;
                parts.iter().all(|part| near(part, *us) as f64 >= enough)
            };
            let lasting = first.iter().copied().filter(lasts).map(|us| (near(&first, us), us));
            let Some((crowd, at)) = lasting.max().filter(|&(crowd, _)| crowd >= FEWEST) else { continue };
            all += 1;
            stay += u32::from(8 * near(&last, at) >= crowd);
        }
        all > 1 && 2 * stay < all
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
