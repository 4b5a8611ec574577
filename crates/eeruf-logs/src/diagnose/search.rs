//! Evidence for the paths to one receiver in a log of firings.

use super::Settings;
use super::share::Share;
use super::timeline::{Heard, Timeline};
use crate::paths::{Evidence, FoundPath, KeepGoing, Support, paths};
use crate::statistics::{groups, ln_at_least};

/// Half width of the interval of echo times for the density of accidental readings, in microseconds.
const NEAR_US: i64 = 2000;
/// Least number of a receiver's firings for finding a path.
const FEWEST: usize = 20;
/// Shares of unhidden readings in which a path must be heard at an offset for support: for a loud path, and for a faint
/// one.
const SUPPORTS: [f64; 2] = [0.5, 0.2];

/// A possible sender: a sensor, or the receiver itself by this firing or an earlier one.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Source {
    Other(u8),
    OwnNow,
    OwnBefore,
}

struct Search<'a> {
    receiver: u8,
    timeline: &'a Timeline,
    heard: &'a [Heard],
    /// Readings that a found path explains.
    explained: Vec<bool>,
    /// The sorted echo times of unexplained readings, and of all readings.
    open: Vec<i64>,
    all: Vec<i64>,
    silent: usize,
    tolerance: i64,
}

/// All paths to a receiver.
pub(super) fn paths_to(
    receiver: u8,
    timeline: &Timeline,
    settings: &Settings,
    keep_going: KeepGoing<'_>,
) -> Vec<FoundPath> {
    let heard = timeline.heard_by(receiver);
    if heard.len() < FEWEST {
        return Vec::new();
    }
    let silent = heard.iter().filter(|heard| heard.echo_us.is_none()).count();
    let tolerance = i64::from(settings.tolerance_us);
    let explained = vec![false; heard.len()];
    let mut all: Vec<_> = heard.iter().filter_map(|heard| heard.echo_us).collect();
    all.sort_unstable();
    let mut search = Search { receiver, timeline, heard, explained, open: Vec::new(), all, silent, tolerance };
    // Number of places at which a path is looked for, in the whole log.
    let places = f64::from(settings.max_travel_us) / f64::from(2 * settings.tolerance_us.max(1));
    let ln_places = (places * search.sources().len() as f64 * timeline.sensors() as f64).ln();
    paths(&mut search, ln_places, settings.accidents, keep_going)
}

impl Search<'_> {
    /// The probability that a reading no earlier than `echo_us` lies within the tolerance of `echo_us` by accident.
    fn accident(&self, echo_us: i64) -> f64 {
        let below = |limit: i64| self.open.partition_point(|&open| open < limit);
        let near = below(echo_us + NEAR_US) - below(echo_us - NEAR_US);
        // `all` includes readings that found paths explain: they too could have heard something near.
        let later = self.all.len() - self.all.partition_point(|&echo| echo < echo_us - NEAR_US) + self.silent;
        let share = (near as f64 + 1.0) / (later as f64 + 1.0);
        (share * self.tolerance as f64 / NEAR_US as f64).min(0.9)
    }

    /// The firings of a source that a reading may have heard, as times after the receiver's own firing.
    fn offsets(&self, source: Source, heard: &Heard, until_us: i64) -> impl Iterator<Item = i64> + '_ {
        let (receiver, fired_us) = (self.receiver, heard.fired_us);
        let before = self.timeline.before(fired_us + until_us);
        let offsets = before.map(move |(at, sensor)| (at - fired_us, sensor));
        offsets
            .filter(move |&(offset, sensor)| match source {
                Source::Other(other) => sensor == other,
                Source::OwnNow => sensor == receiver && offset == 0,
                Source::OwnBefore => sensor == receiver && offset < 0,
            })
            .map(|(offset, _)| offset)
    }

    /// Number of offsets at which a path was heard in at least this share of the readings, number of all offsets, and
    /// the mean chance of an accident.
    fn by_offset(&self, trials: &mut [(i64, bool, f64, usize)], share: f64) -> ((u32, u32), f64) {
        trials.sort_unstable_by_key(|trial| trial.0);
        let sorted: Vec<_> = trials.iter().map(|trial| trial.0).collect();
        let groups = groups(&sorted, 2 * self.tolerance);
        let (mut supporting, mut accidents) = (0, 0.0);
        for group in &groups {
            let group = &trials[group.clone()];
            let matches = group.iter().filter(|trial| trial.1).count();
            supporting += u32::from(matches as f64 >= share * group.len() as f64);
            accidents += group.iter().map(|trial| trial.2).sum::<f64>() / group.len() as f64;
        }
        ((supporting, groups.len() as u32), accidents / groups.len().max(1) as f64)
    }

    /// Counts the offsets of a sensor's own echo. It does not move with others' firings, so the count is the number of
    /// offsets to another sensor at which it was heard, for the sensor with the fewest: that sensor's sound is the
    /// alternative explanation.
    fn own_offsets(&self, trials: &[(i64, bool, f64, usize)], share: f64) -> ((u32, u32), f64) {
        let accident = trials.iter().map(|trial| trial.2).sum::<f64>() / trials.len().max(1) as f64;
        let mut fewest = (u32::MAX, 0);
        for sensor in (0..self.timeline.sensors() as u8).filter(|&sensor| sensor != self.receiver) {
            let mut offsets = Vec::new();
            // Readings in which this one was silent for long, each by itself: its sound explains none of them.
            let mut alone = Share::NONE;
            for &(_, is_heard, accident, reading) in trials {
                let heard = &self.heard[reading];
                let until = heard.echo_us.unwrap_or(self.timeline.window_us);
                match self.offsets(Source::Other(sensor), heard, until).next() {
                    Some(offset) => offsets.push((offset, is_heard, accident, reading)),
                    None => alone.add(is_heard),
                }
            }
            let ((supporting, of), _) = self.by_offset(&mut offsets, share);
            let all = (supporting + alone.count, of + alone.of);
            if all.0 < fewest.0 {
                fewest = all;
            }
        }
        // A single sensor fools only itself.
        let offsets = if fewest.0 == u32::MAX { (1, 1) } else { fewest };
        (offsets, accident)
    }
}

impl Evidence for Search<'_> {
    type Source = Source;
    const MOST_PATHS: usize = 60;
    const LOOKED_AT: usize = 3;

    fn tolerance(&self) -> i64 {
        self.tolerance
    }

    fn sources(&self) -> Vec<Source> {
        let others = (0..self.timeline.sensors() as u8).filter(|&sensor| sensor != self.receiver);
        others.map(Source::Other).chain([Source::OwnNow, Source::OwnBefore]).collect()
    }

    fn travels(&self, source: Source) -> Vec<(i64, i64)> {
        let mut travels = Vec::new();
        for (reading, heard) in self.heard.iter().enumerate().filter(|(reading, _)| !self.explained[*reading]) {
            let Some(echo_us) = heard.echo_us else { continue };
            travels.extend(self.offsets(source, heard, echo_us).map(|offset_us| match source {
                // The receiver's own echo of this firing has no offset: its readings are counted instead.
                Source::OwnNow => (echo_us - offset_us, reading as i64),
                _ => (echo_us - offset_us, offset_us.div_euclid(self.tolerance.max(1))),
            }));
        }
        travels
    }

    fn support(&self, source: Source, travel_us: i64) -> Support {
        // By offset: whether the path was heard, the chance of that by accident, and the reading.
        let mut trials = Vec::<(i64, bool, f64, usize)>::new();
        for (reading, heard) in self.heard.iter().enumerate() {
            for offset_us in self.offsets(source, heard, self.timeline.window_us) {
                let predicted = offset_us + travel_us;
                if predicted < 0 || predicted > self.timeline.window_us {
                    continue;
                }
                let off = heard.echo_us.map(|echo_us| echo_us - predicted);
                let is_heard = match off {
                    // An earlier echo hid it, or an edge at the same time is already explained.
                    Some(off) if off < -self.tolerance => continue,
                    Some(off) if off <= self.tolerance && self.explained[reading] => continue,
                    off => off.is_some_and(|off| off <= self.tolerance),
                };
                trials.push((offset_us, is_heard, self.accident(predicted), reading));
            }
        }
        let matched: Vec<_> = trials.iter().filter(|trial| trial.1).map(|trial| trial.3).collect();
        let heard = matched.len() as f64 / trials.len().max(1) as f64;
        let mut best = ((0, 0), 0.0);
        for share in SUPPORTS {
            let (offsets, accident) = match source {
                Source::OwnNow => self.own_offsets(&trials, share),
                _ => self.by_offset(&mut trials, share),
            };
            // The mean share of accidents at one offset exceeds its expected value by a factor with a probability of at
            // most one in that factor (Markov). Two thresholds are two chances.
            let tries = (SUPPORTS.len() as f64).ln();
            let ln_accident = (ln_at_least(offsets.0, offsets.1, (accident / share).min(1.0)) + tries).min(0.0);
            if ln_accident < best.1 || best.0 == (0, 0) {
                best = (offsets, ln_accident);
            }
        }
        let (offsets, ln_accident) = best;
        Support { offsets, ln_accident, readings: matched, heard }
    }

    fn explain(&mut self, source: Source, travel_us: i64, reading: usize) -> (Option<i64>, u32) {
        self.explained[reading] = true;
        let heard = &self.heard[reading];
        let travels = self.offsets(source, heard, self.timeline.window_us);
        let mut travels = travels.map(|offset| heard.echo_us.unwrap_or(0) - offset);
        // Places in the log, which `diagnose` converts to periods.
        (travels.find(|travel| (travel - travel_us).abs() <= self.tolerance), heard.firing as u32)
    }

    fn ends(&self, source: Source) -> (u8, u8) {
        (if let Source::Other(sender) = source { sender } else { self.receiver }, self.receiver)
    }

    fn refresh(&mut self) {
        let open = self.heard.iter().zip(&self.explained).filter(|(_, explained)| !**explained);
        self.open = open.filter_map(|(heard, _)| heard.echo_us).collect();
        self.open.sort_unstable();
    }
}
