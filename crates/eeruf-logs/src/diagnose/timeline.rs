//! The firings of a log in the form for finding paths.

use std::collections::BTreeMap;

use super::Settings;
use super::share::Share;
use crate::firings::FiringLog;
use crate::statistics::groups;

/// One reading of the receiver.
#[derive(Clone, Copy)]
pub(super) struct Heard {
    /// The place of its firing in the log.
    pub(super) firing: usize,
    pub(super) fired_us: i64,
    pub(super) phase: u8,
    /// Time from firing to edge; `None` without an edge.
    pub(super) echo_us: Option<i64>,
}

/// Number of offsets above which two sensors must have random gaps: two phases have four, and as many again if a loop
/// is sometimes late.
pub(super) const OFFSETS_OF_TWO_PHASES: u32 = 8;

/// All firings in order of time, and each sensor's own.
pub(super) struct Timeline {
    /// Instants and sensors of the firings.
    firings: Vec<(i64, u8)>,
    heard: Vec<Vec<Heard>>,
    /// The longest echo time of any reading, and so the least listening time.
    pub(super) window_us: i64,
    max_travel_us: i64,
    /// True if the ring fires in more than two phases or with random gaps, so that others' sound moves from firing to
    /// firing.
    pub(super) has_many_phases: bool,
}

impl Timeline {
    pub(super) fn of(log: &FiringLog, settings: &Settings) -> Self {
        let firings = log.firings.iter().map(|firing| (firing.fired_us, firing.sensor)).collect();
        let mut heard = vec![Vec::new(); log.sensors()];
        for (place, firing) in log.firings.iter().enumerate() {
            let echo_us = firing.t_echo_us.map(i64::from);
            heard[usize::from(firing.sensor)].push(Heard {
                firing: place,
                fired_us: firing.fired_us,
                phase: firing.phase,
                echo_us,
            });
        }
        let window_us = log.firings.iter().filter_map(|firing| firing.t_echo_us).max().unwrap_or(0).into();
        let max_travel_us = settings.max_travel_us.into();
        let mut timeline = Self { firings, heard, window_us, has_many_phases: false, max_travel_us };
        timeline.has_many_phases = log.firings.iter().any(|firing| firing.phase > 1)
            || timeline.most_offsets(settings.tolerance_us.into()) > OFFSETS_OF_TWO_PHASES;
        timeline
    }

    pub(super) fn sensors(&self) -> usize {
        self.heard.len()
    }

    /// The readings of a sensor.
    pub(super) fn heard_by(&self, receiver: u8) -> &[Heard] {
        &self.heard[usize::from(receiver)]
    }

    /// Returns true if readings of the first third of the log do not recur in the last third: among pairs of a sensor's
    /// firings, one from each third, at the same time after another sensor's firing, hardly any have the same echo. If
    /// the ring stands and people walk in front of it, more than a quarter do.
    pub(super) fn moved(&self) -> bool {
        /// Difference of echoes, in microseconds, below which they are of one object at rest.
        const SAME_US: i64 = 75;
        const COMES_BACK: f64 = 0.2;
        const FEWEST: u32 = 20;
        // With random gaps a ring never fires the same way twice, and its sensors mostly hear their own echoes.
        let by_others = self.comes_back(SAME_US, true);
        let comes_back = if by_others.of < FEWEST { self.comes_back(SAME_US, false) } else { by_others };
        comes_back.of >= FEWEST && comes_back.value() < COMES_BACK
    }

    /// The share of equal readings among pairs of one sensor, one from the first third of the log and one from the
    /// last; with `by_others`, among those at the same time after another sensor's firing.
    fn comes_back(&self, same_us: i64, by_others: bool) -> Share {
        let mut alike = BTreeMap::<_, Vec<Option<i64>>>::new();
        for (sensor, heard) in self.heard.iter().enumerate() {
            for of in heard {
                let mut before = self.before(of.fired_us);
                let before = before.find(|&(_, other)| by_others && usize::from(other) != sensor);
                let stands = before.map(|(at, other)| (other, (of.fired_us - at) / (2 * same_us)));
                alike.entry((sensor, of.phase, stands)).or_default().push(of.echo_us);
            }
        }
        let mut comes_back = Share::NONE;
        for echoes in alike.values() {
            let (first, rest) = echoes.split_at(echoes.len() / 3);
            let pairs = first.iter().zip(&rest[rest.len() - first.len()..]);
            pairs.filter_map(|(a, b)| a.zip(*b)).for_each(|(a, b)| comes_back.add((a - b).abs() <= same_us));
        }
        comes_back
    }

    /// The largest number of different offsets at which one sensor may hear another's sound.
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

    /// Instants and sensors of firings that may be heard at a moment, latest first, including firings at that very
    /// moment.
    pub(super) fn before(&self, moment_us: i64) -> impl Iterator<Item = (i64, u8)> + '_ {
        let end = self.firings.partition_point(|&(fired_us, _)| fired_us <= moment_us);
        let earliest = moment_us - self.max_travel_us;
        self.firings[..end].iter().rev().take_while(move |(fired_us, _)| *fired_us >= earliest).copied()
    }
}
