//! Findings of a measuring run: which sensor hears which, along which paths, and how certainly.
//!
//! In each slot of a survey at most two sensors fire, and all earlier sound has died away: see
//! [`SurveyPlan`](https://docs.rs/eeruf-core/latest/eeruf_core/struct.SurveyPlan.html). So an edge is the sensor's own
//! echo, which does not move, or the other's sound, which comes earlier by as much as the other fired earlier, or a
//! stray. For each receiver the times from a firing to its edges are overlaid; a time at which edges of
//! different slots meet is a path if their number is improbable as strays (a binomial test, times the number of places
//! at which a path was looked for). The best supported path is taken first, and its edges are removed.
//!
//! A log in which more than two sensors fire close to each other can be read as well, but is better left to
//! [`diagnose`](crate::diagnose()).

use std::collections::HashMap;

use crate::firings::{Firing, FiringLog};
use crate::paths::{Evidence, FoundPath, KeepGoing, Support, paths};
use crate::statistics::{groups, ln_at_least};

/// Settings of the search for paths in a survey.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathSettings {
    /// Largest difference between edges of one path, in microseconds: about four times the jitter.
    pub tolerance_us: u32,
    /// Expected number of paths found by accident in the whole survey.
    pub accidents: f64,
}

impl Default for PathSettings {
    /// A tolerance of 100 us, and one accidental path in a hundred surveys.
    fn default() -> Self {
        Self { tolerance_us: 100, accidents: 0.01 }
    }
}

/// Findings of a survey.
#[derive(Clone, Debug, PartialEq)]
pub struct Surveyed {
    /// Number of sensors on the ring.
    pub sensors: usize,
    /// The paths, by receiver and sender, shortest first. A sensor's own echo is a path from itself.
    pub paths: Vec<FoundPath>,
    /// Number of edges, and of edges that no path explains.
    pub edges: (u32, u32),
    /// The longest echo time of the log in microseconds, and so the least listening time.
    pub window_us: u32,
    /// For each pair, sender first and by sender, the number of slots in which both fired; for listeners, in which they
    /// listened.
    slots: Vec<u32>,
    /// For each pair in the same order, the milliseconds of travel time at which a path would have been seen with two
    /// offsets, as bits from 0.
    visible: Vec<u128>,
}

impl Surveyed {
    /// The paths of a pair, shortest first.
    pub fn between(&self, sender: u8, receiver: u8) -> impl Iterator<Item = &FoundPath> {
        self.paths.iter().filter(move |path| (path.sender, path.receiver) == (sender, receiver))
    }

    /// Returns the number of slots in which a receiver could have heard a sender.
    pub fn slots(&self, sender: u8, receiver: u8) -> u32 {
        self.of_pair(&self.slots, sender, receiver)
    }

    /// The share of the travel times below `until_us` (at most 128 ms) at which a path of the pair would have been seen
    /// with at least two offsets. At the others the receiver is deaf, its own echo hides the path, or the survey has no
    /// such lead.
    pub fn visible(&self, sender: u8, receiver: u8, until_us: u32) -> f64 {
        let all = (until_us / 1000).clamp(1, 128);
        let mask = if all == 128 { u128::MAX } else { (1 << all) - 1 };
        f64::from((self.of_pair(&self.visible, sender, receiver) & mask).count_ones()) / f64::from(all)
    }

    fn of_pair<T: Copy + Default>(&self, of: &[T], sender: u8, receiver: u8) -> T {
        let is_there = usize::from(sender.max(receiver)) < self.sensors;
        let place = usize::from(sender) * self.sensors + usize::from(receiver);
        of.get(place).filter(|_| is_there).copied().unwrap_or_default()
    }

    /// The pairs that hear each other within `until_us`, in either direction, with the longest such travel time in
    /// microseconds, which must lie between their firings so that neither hears the other's sound.
    pub fn conflicts(&self, until_us: u32) -> Vec<(u8, u8, f64)> {
        let mut conflicts = Vec::<(u8, u8, f64)>::new();
        let foreign = self.paths.iter().filter(|path| path.sender != path.receiver);
        for path in foreign.filter(|path| path.travel_us <= f64::from(until_us)) {
            let pair = (path.sender.min(path.receiver), path.sender.max(path.receiver));
            match conflicts.iter_mut().find(|known| (known.0, known.1) == pair) {
                Some(known) => known.2 = known.2.max(path.travel_us),
                None => conflicts.push((pair.0, pair.1, path.travel_us)),
            }
        }
        conflicts.sort_by_key(|conflict| (conflict.0, conflict.1));
        conflicts
    }
}

/// Sounds of one sensor in one slot.
struct Heard {
    slot: u32,
    echo_us: Option<i64>,
    /// Firings in the slot, its own included, as times after it began to listen.
    fired: Vec<(u8, i64)>,
    is_explained: bool,
}

/// Share of the unhidden slots with an offset in which a path must be heard to support that offset.
const SUPPORTS: f64 = 0.5;
/// Base of the votes that are slots, above all votes that are offsets.
const BY_SLOT: i64 = 1 << 40;

/// Finds the paths between all sensors of a survey.
pub fn survey(log: &FiringLog, settings: &PathSettings) -> Surveyed {
    survey_while(log, settings, &|| true)
}

/// Surveys like [`survey`], and ends early with the results so far if `keep_going` returns `false`.
pub fn survey_while(log: &FiringLog, settings: &PathSettings, keep_going: KeepGoing<'_>) -> Surveyed {
    let sensors = log.sensors();
    let rows = || log.firings.iter().chain(&log.listened);
    let window_us = rows().filter_map(|row| row.t_echo_us).max().unwrap_or(0);
    let mut slots = HashMap::<u32, Vec<&Firing>>::new();
    log.firings.iter().for_each(|firing| slots.entry(firing.period).or_default().push(firing));
    let mut of_receiver: Vec<Vec<Heard>> = (0..sensors).map(|_| Vec::new()).collect();
    for row in rows() {
        let fired = slots.get(&row.period).map_or(&[][..], |fired| fired);
        let fired = fired.iter().map(|other| (other.sensor, other.fired_us - row.fired_us)).collect();
        let heard = Heard { slot: row.period, echo_us: row.t_echo_us.map(i64::from), fired, is_explained: false };
        of_receiver[usize::from(row.sensor)].push(heard);
    }
    let mut surveyed = Surveyed {
        sensors,
        paths: Vec::new(),
        edges: (0, 0),
        window_us,
        slots: vec![0; sensors * sensors],
        visible: vec![0; sensors * sensors],
    };
    for (receiver, heard) in of_receiver.into_iter().enumerate() {
        if !keep_going() {
            break;
        }
        let mut search = Search::new(receiver as u8, heard, sensors, window_us.into(), settings);
        let places = (search.window_us / (2 * search.tolerance) + 1) as f64;
        let ln_places = (places * (sensors * sensors) as f64).ln();
        let mut paths = paths(&mut search, ln_places, settings.accidents, keep_going);
        paths.sort_by(|a, b| {
            (a.sender, a.travel_us).partial_cmp(&(b.sender, b.travel_us)).unwrap_or(a.sender.cmp(&b.sender))
        });
        surveyed.paths.append(&mut paths);
        for sender in 0..sensors {
            let pair = sender * sensors + receiver;
            (surveyed.slots[pair], surveyed.visible[pair]) = search.coverage(sender as u8);
        }
        let edges = search.heard.iter().filter(|heard| heard.echo_us.is_some());
        surveyed.edges.0 += edges.clone().count() as u32;
        surveyed.edges.1 += edges.filter(|heard| !heard.is_explained).count() as u32;
    }
    surveyed
}

struct Search {
    receiver: u8,
    heard: Vec<Heard>,
    sensors: usize,
    /// Time before which the sensor hears nothing.
    dead_us: i64,
    window_us: i64,
    tolerance: i64,
}

impl Search {
    fn new(receiver: u8, heard: Vec<Heard>, sensors: usize, window_us: i64, settings: &PathSettings) -> Self {
        let dead_us = heard.iter().filter_map(|heard| heard.echo_us).min().unwrap_or(0);
        let tolerance = settings.tolerance_us.max(1).into();
        // The latest edge of all may belong to a path like any other.
        let window_us = window_us + 2 * tolerance;
        Self { receiver, heard, sensors, dead_us, window_us, tolerance }
    }

    /// The offset of a sender in a slot: its firing time after the receiver's.
    fn offset(heard: &Heard, sender: u8) -> Option<i64> {
        heard.fired.iter().find(|fired| fired.0 == sender).map(|fired| fired.1)
    }

    /// The vote of a reading; readings that agree count once for each vote. It is the offset; for an own echo, which
    /// does not move, and for a sensor that only listens while one other fires, it is the slot.
    fn vote(&self, heard: &Heard, sender: u8, offset: i64) -> i64 {
        let listens_to_one = heard.fired.len() == 1;
        if sender == self.receiver || listens_to_one {
            BY_SLOT + i64::from(heard.slot) * (4 * self.tolerance)
        } else {
            offset
        }
    }

    /// The probability that a stray edge supports a path at one offset. Possible strays are all unexplained edges of
    /// the slots in which the sender fired, except the path's own.
    fn accident(&self, sender: u8, hits: usize) -> f64 {
        let slots = || self.heard.iter().filter(|heard| Self::offset(heard, sender).is_some());
        let open = slots().filter(|heard| heard.echo_us.is_some() && !heard.is_explained).count();
        let strays = (open.saturating_sub(hits) + 1) as f64 / (slots().count() + 1) as f64;
        let span = (self.window_us - self.dead_us).max(2 * self.tolerance) as f64;
        // Strays crowd, as echoes do: four times the even density.
        (4.0 * strays * 2.0 * self.tolerance as f64 / span).min(0.5)
    }

    /// Number of slots in which a sender could be heard, and the travel times, in milliseconds, at which it could with
    /// two offsets.
    fn coverage(&self, sender: u8) -> (u32, u128) {
        // At each offset, the latest edge: until then nothing hid another's sound.
        let offsets = self.heard.iter().filter_map(|heard| {
            let offset = Self::offset(heard, sender)?;
            Some((offset, self.vote(heard, sender, offset), heard.echo_us.unwrap_or(self.window_us)))
        });
        let offsets: Vec<_> = offsets.collect();
        let mut visible = 0_u128;
        for ms in 0..128 {
            let travel_us = 1000 * i64::from(ms) + 500;
            let is_seen =
                |&&(offset, _, edge): &&(i64, i64, i64)| (self.dead_us..=edge).contains(&(offset + travel_us));
            let mut votes: Vec<_> = offsets.iter().filter(is_seen).map(|seen| seen.1).collect();
            votes.sort_unstable();
            visible |= u128::from(groups(&votes, 2 * self.tolerance).len() >= 2) << ms;
        }
        (offsets.len() as u32, visible)
    }
}

impl Evidence for Search {
    type Source = u8;
    const MOST_PATHS: usize = 200;
    const LOOKED_AT: usize = 4;

    fn tolerance(&self) -> i64 {
        self.tolerance
    }

    fn sources(&self) -> Vec<u8> {
        (0..self.sensors as u8).collect()
    }

    fn travels(&self, sender: u8) -> Vec<(i64, i64)> {
        let travel = |(place, heard): (usize, &Heard)| {
            let (echo_us, offset) = (heard.echo_us?, Self::offset(heard, sender)?);
            (!heard.is_explained && echo_us > offset).then_some((echo_us - offset, place as i64))
        };
        self.heard.iter().enumerate().filter_map(travel).collect()
    }

    fn support(&self, sender: u8, travel_us: i64) -> Support {
        // By offset, or by slot: whether it was heard there.
        let mut trials = Vec::<(i64, bool)>::new();
        let mut hits = Vec::new();
        for (place, heard) in self.heard.iter().enumerate() {
            let Some(offset) = Self::offset(heard, sender) else { continue };
            let predicted = offset + travel_us;
            if predicted < self.dead_us - self.tolerance || predicted + self.tolerance > self.window_us {
                continue;
            }
            let off = heard.echo_us.map(|echo_us| echo_us - predicted);
            // An earlier edge hid it, or an edge at the same time is already explained.
            if off.is_some_and(|off| off < -self.tolerance || off <= self.tolerance && heard.is_explained) {
                continue;
            }
            let is_heard = off.is_some_and(|off| off <= self.tolerance);
            hits.extend(is_heard.then_some(place));
            trials.push((self.vote(heard, sender, offset), is_heard));
        }
        trials.sort_unstable();
        let offsets: Vec<_> = trials.iter().map(|trial| trial.0).collect();
        let groups = groups(&offsets, 2 * self.tolerance);
        let supports = |group: &core::ops::Range<usize>| {
            let heard = trials[group.clone()].iter().filter(|trial| trial.1).count();
            heard as f64 >= SUPPORTS * group.len() as f64
        };
        let supporting = groups.iter().filter(|group| supports(group)).count() as u32;
        let counted = (supporting, groups.len() as u32);
        // One slot, or one offset, proves nothing.
        let ln_accident =
            if supporting < 2 { 0.0 } else { ln_at_least(supporting, counted.1, self.accident(sender, hits.len())) };
        let heard = hits.len() as f64 / trials.len().max(1) as f64;
        Support { offsets: counted, ln_accident, readings: hits, heard }
    }

    fn explain(&mut self, sender: u8, _: i64, reading: usize) -> (Option<i64>, u32) {
        let heard = &mut self.heard[reading];
        heard.is_explained = true;
        (Some(heard.echo_us.unwrap_or_default() - Self::offset(heard, sender).unwrap_or_default()), heard.slot)
    }

    fn ends(&self, sender: u8) -> (u8, u8) {
        (sender, self.receiver)
    }
}
