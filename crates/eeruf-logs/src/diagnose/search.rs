//! Finds the paths to one receiver: the best supported first; then its readings are removed.

use std::collections::HashMap;

use super::share::Share;
use super::statistics::{groups, ln_at_least, median};
use super::timeline::{Heard, Timeline};
use super::{FoundPath, KeepGoing, Settings};

/// Half width of the interval of echo times for the density of accidental readings, in microseconds.
const NEAR_US: i64 = 2000;
/// Least number of a receiver's firings for finding a path.
const FEWEST: usize = 20;
/// The largest number of paths to one receiver.
const MOST_PATHS: usize = 60;
/// Shares of unhidden readings in which a path must be heard at an offset for support: for a loud path, and for a faint
/// one.
const SUPPORTS: [f64; 2] = [0.5, 0.2];
/// Number of places of each sender that are examined closely before the best is taken.
const LOOKED_AT: usize = 3;

/// A possible sender: a sensor, or the receiver itself by this firing or an earlier one.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Source {
    Other(u8),
    OwnNow,
    OwnBefore,
}

/// The time from a firing to an edge.
#[derive(Clone, Copy)]
struct Travel {
    travel_us: i64,
    /// Time when the sender fired, after the receiver did.
    offset_us: i64,
    /// The place among the receiver's readings.
    reading: usize,
}

/// Support of a path.
struct Support {
    offsets: (u32, u32),
    /// The logarithm of the probability of as much support by accident.
    ln_accident: f64,
    matched: Vec<usize>,
    heard: f64,
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
    let others = (0..timeline.sensors() as u8).filter(|&sensor| sensor != receiver).map(Source::Other);
    let sources: Vec<_> = others.chain([Source::OwnNow, Source::OwnBefore]).collect();
    // Number of places at which a path is looked for, in the whole log.
    let places = f64::from(settings.max_travel_us) / f64::from(2 * settings.tolerance_us.max(1));
    let ln_places = (places * sources.len() as f64 * timeline.sensors() as f64).ln();
    let mut found = Vec::new();
    while found.len() < MOST_PATHS {
        search.refresh();
        let going = sources.iter().take_while(|_| keep_going());
        let best = going.filter_map(|&source| search.best_of(source));
        let Some((source, travel_us, support)) = best.min_by(|a, b| a.2.ln_accident.total_cmp(&b.2.ln_accident)) else {
            break;
        };
        let accidents = (support.ln_accident + ln_places).exp();
        if accidents > settings.accidents {
            break;
        }
        found.push(search.take(source, travel_us, &support, accidents));
    }
    found
}

impl Search<'_> {
    /// Updates the echo times that are still to be explained.
    fn refresh(&mut self) {
        let open = self.heard.iter().zip(&self.explained).filter(|(_, explained)| !**explained);
        self.open = open.filter_map(|(heard, _)| heard.echo_us).collect();
        self.open.sort_unstable();
    }

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

    /// The best supported path of a source.
    fn best_of(&self, source: Source) -> Option<(Source, i64, Support)> {
        let mut travels = Vec::new();
        for (reading, heard) in self.heard.iter().enumerate().filter(|(reading, _)| !self.explained[*reading]) {
            let Some(echo_us) = heard.echo_us else { continue };
            for offset_us in self.offsets(source, heard, echo_us) {
                travels.push(Travel { travel_us: echo_us - offset_us, offset_us, reading });
            }
        }
        travels.sort_unstable_by_key(|travel| travel.travel_us);
        let mut looked_at = Vec::<i64>::new();
        let mut best: Option<(Source, i64, Support)> = None;
        for (_, travel_us) in self.crowded(source, &travels) {
            if looked_at.iter().any(|&other| (other - travel_us).abs() <= 2 * self.tolerance) {
                continue;
            }
            looked_at.push(travel_us);
            let support = self.support(source, travel_us);
            if best.as_ref().is_none_or(|best| support.ln_accident < best.2.ln_accident) {
                best = Some((source, travel_us, support));
            }
            if looked_at.len() >= LOOKED_AT {
                break;
            }
        }
        best
    }

    /// The places at which most offsets meet, with their number, the largest first.
    fn crowded(&self, source: Source, travels: &[Travel]) -> Vec<(usize, i64)> {
        let mut places = Vec::new();
        let mut offsets = HashMap::<i64, u32>::new();
        let mut from = 0;
        // The receiver's own echo of this firing has no offset: its readings are counted instead.
        let bin = |travel: &Travel| match source {
            Source::OwnNow => travel.reading as i64,
            _ => travel.offset_us.div_euclid(self.tolerance.max(1)),
        };
        for to in 0..travels.len() {
            *offsets.entry(bin(&travels[to])).or_default() += 1;
            while travels[to].travel_us - travels[from].travel_us > 2 * self.tolerance {
                let left = bin(&travels[from]);
                if let Some(count) = offsets.get_mut(&left) {
                    *count -= 1;
                    if *count == 0 {
                        offsets.remove(&left);
                    }
                }
                from += 1;
            }
            places.push((offsets.len(), travels[from + (to - from) / 2].travel_us));
        }
        places.sort_unstable_by_key(|&(offsets, _)| core::cmp::Reverse(offsets));
        places
    }

    /// Evidence for a path and against it.
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
        Support { offsets, ln_accident, matched, heard }
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

    /// Records a found path: its readings are explained.
    fn take(&mut self, source: Source, travel_us: i64, support: &Support, accidents: f64) -> FoundPath {
        let travel = |search: &Self, reading: usize| {
            let heard = &search.heard[reading];
            let echo_us = heard.echo_us.unwrap_or(0);
            let offsets = search.offsets(source, heard, search.timeline.window_us);
            offsets.map(|offset| echo_us - offset).find(|travel| (travel - travel_us).abs() <= search.tolerance)
        };
        let mut travels: Vec<_> =
            support.matched.iter().filter_map(|&reading| travel(self, reading)).map(|us| us as f64).collect();
        let middle = median(&mut travels);
        let mut off: Vec<_> = travels.iter().map(|travel| (travel - middle).abs()).collect();
        // The median of the distances of a normal distribution is 0.6745 of its standard deviation.
        let scatter_us = (median(&mut off) / 0.6745).max(1.0);
        // Places in the log, which `diagnose` converts to periods.
        let mut periods = (u32::MAX, 0);
        for &reading in &support.matched {
            self.explained[reading] = true;
            let place = self.heard[reading].firing as u32;
            periods = (periods.0.min(place), periods.1.max(place));
        }
        FoundPath {
            sender: if let Source::Other(sender) = source { sender } else { self.receiver },
            receiver: self.receiver,
            travel_us: middle,
            travel_error_us: scatter_us / (travels.len().max(1) as f64).sqrt(),
            scatter_us,
            offsets: support.offsets,
            accidents,
            readings: support.matched.len() as u32,
            heard: support.heard,
            periods,
        }
    }
}
