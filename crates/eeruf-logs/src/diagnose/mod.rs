//! Diagnosis of a ring from its own log: which sensors fool each other, since when, along which paths, and how
//! certainly.
//!
//! A path from sensor x to sensor y takes sound the same time whenever x fires. So if y's readings came along it, the
//! time from x's firing to the edge at y is the same for all of them, however the firings of x and y move against each
//! other; for all other readings it moves with the firings. For each pair the times from x's firings to y's edges are
//! laid over each other, and a time at which many of them meet is a path.
//!
//! Readings with the same time between the two firings repeat each other and prove nothing. So *offsets* count: the
//! number of different times between the two firings that support a path. The probability that an edge falls within the
//! tolerance of a predicted one by accident is small and follows from the readings; the probability that this many
//! offsets agree by accident is then binomial. It is multiplied by the number of places at which a path was looked for
//! (Bonferroni), and a path counts as found if fewer than [`Settings::accidents`] such paths are expected in the whole
//! log by accident. That takes many phases, or lags that move: with two phases there are two offsets, and no pair can
//! be named.
//!
//! While the robot drives, these times change, and no sender is named.

mod faults;
mod naming;
mod search;
mod sensors;
mod share;
mod timeline;
mod timing;

use crate::firings::FiringLog;
use crate::paths::{FoundPath, KeepGoing};
use crate::symptom::Finding;
use faults::faults;
pub use naming::Named;
use naming::name_senders;
use search::paths_to;
pub use sensors::Hearing;
use sensors::hearing;
pub use share::Share;
use timeline::Timeline;
pub use timing::{Timing, timing};

/// Settings of the search for paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// The longest travel time of sound to consider, in microseconds.
    pub max_travel_us: u32,
    /// Largest difference between a reading and its path's prediction, in microseconds: about four times the jitter.
    pub tolerance_us: u32,
    /// Expected number of paths found by accident in the whole log.
    pub accidents: f64,
    /// Confidence from which a sender is named, 0 to 1.
    pub sure: f64,
}

impl Default for Settings {
    /// Settings of 80 ms, 75 us, one path in a hundred logs, and 99 %.
    fn default() -> Self {
        Self { max_travel_us: 80_000, tolerance_us: 75, accidents: 0.01, sure: 0.99 }
    }
}

impl Settings {
    /// The usual settings, with a tolerance of four times the readings' scatter, at least 75 us.
    pub fn of(log: &FiringLog) -> Self {
        /// Difference of successive echoes of a sensor above which they are of different paths.
        const OTHER_US: i64 = 1000;
        /// The lower quartile of absolute differences of two normal variables, in their standard deviations.
        const QUARTILE: f64 = 0.4506;
        let usual = Self::default();
        let (mut last, mut changes) = (vec![None::<Option<u32>>; log.sensors()], vec![]);
        for firing in &log.firings {
            let before = last[usize::from(firing.sensor)].replace(firing.t_echo_us);
            if let (Some(Some(before)), Some(echo)) = (before, firing.t_echo_us) {
                changes.push((i64::from(echo) - i64::from(before)).abs());
            }
        }
        changes.retain(|us| *us < OTHER_US);
        changes.sort_unstable();
        let scatter_us = changes.get(changes.len() / 4).map_or(0.0, |&us| us as f64 / QUARTILE);
        // The quartile of a few changes, or of sound that moves from firing to firing, is not the scatter of one path.
        let is_known = changes.len() >= 100 && 3.0 * scatter_us > f64::from(usual.tolerance_us);
        let tolerance_us = if is_known { (4.0 * scatter_us) as u32 } else { usual.tolerance_us };
        Self { tolerance_us, ..usual }
    }
}

/// Findings about a ring from its log.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnosis {
    /// The paths, by receiver, best supported first. A sensor's own echo is a path from itself.
    pub paths: Vec<FoundPath>,
    /// For each firing of the log, the sender of its reading, if that is certain enough.
    pub named: Vec<Option<Named>>,
    /// The sounds that each sensor hears.
    pub hearing: Vec<Hearing>,
    /// Deaf sensors.
    pub faults: Vec<Finding>,
    /// True if the robot moved: odometry says so, or early ranges do not recur at the end. No path is found then.
    pub moved: bool,
    /// The largest number of offsets at which a reading could come from another sensor's firing, over all pairs.
    pub most_offsets: u32,
}

impl Diagnosis {
    /// Returns true if firings move against each other enough to tell senders apart.
    pub fn firings_move(&self) -> bool {
        self.most_offsets > timeline::OFFSETS_OF_TWO_PHASES
    }

    /// The sensors that hear nothing and are not called deaf: either nothing is in their range, or they are deaf.
    pub fn silent(&self) -> Vec<u8> {
        let is_named = |sensor: u8| self.faults.iter().any(|fault| fault.sensor == usize::from(sensor));
        let silent = self.hearing.iter().filter(|of| of.is_silent && !is_named(of.sensor));
        silent.map(|of| of.sensor).collect()
    }
}

/// Finds the paths of a ring, names the sender of each reading if that is certain enough, and finds faults.
pub fn diagnose(log: &FiringLog, settings: &Settings) -> Diagnosis {
    diagnose_while(log, settings, &|| true)
}

/// Diagnoses like [`diagnose`], and ends early with the results so far if `keep_going` returns `false`.
pub fn diagnose_while(log: &FiringLog, settings: &Settings, keep_going: KeepGoing<'_>) -> Diagnosis {
    let timeline = Timeline::of(log, settings);
    let mut paths = Vec::new();
    let mut named = vec![None; log.firings.len()];
    let mut fits_none = vec![false; log.firings.len()];
    let moved = log.drives() || timeline.moved();
    for receiver in (0..log.sensors() as u8).filter(|_| !moved).take_while(|_| keep_going()) {
        let found = paths_to(receiver, &timeline, settings, keep_going);
        name_senders(receiver, &found, &timeline, settings, &mut named, &mut fits_none);
        paths.extend(found);
    }
    if !keep_going() {
        return Diagnosis { paths, named, hearing: vec![], faults: vec![], moved, most_offsets: 0 };
    }
    let hearing = hearing(log, &paths, &named, &fits_none);
    let faults = faults(&paths, &hearing, &timeline, settings);
    let period = |place: u32| log.firings.get(place as usize).map_or(0, |firing| firing.period);
    paths.iter_mut().for_each(|path| path.periods = (period(path.periods.0), period(path.periods.1)));
    let most_offsets = timeline.most_offsets(settings.tolerance_us.into());
    Diagnosis { paths, named, hearing, faults, moved, most_offsets }
}
