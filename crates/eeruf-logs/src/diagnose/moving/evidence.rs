//! Evidence of other readings for a line through one reading.

use super::super::Settings;
use super::super::statistics::ln_factorial;
use super::super::timeline::{Heard, Timeline};
use super::Guess;
use super::prior::{MOST_RATE, Rates};

/// Time before and after a reading, in milliseconds, within which other readings serve as evidence.
const ASKED_MS: f64 = 400.0;
/// Change of a rate, in microseconds per millisecond per second: a robot at 1 m/s that passes an object at 1 m.
const BEND: f64 = 2.0;
/// Half width of the interval of echo times for the density of accidental readings, and the width of its bins, in
/// microseconds.
const NEAR_US: i64 = 2000;
const BIN_US: i64 = 500;
/// Distance beyond the earliest and the latest echo up to which a line is looked for, in microseconds.
const BEYOND_US: i64 = 500;

/// Number of factorials that are stored.
const FACTORIALS: u32 = 128;

/// The relation of a reading to a line.
#[derive(Clone, Copy, PartialEq)]
enum Meets {
    Heard,
    Missed,
    /// An earlier echo hid the sound.
    Hidden,
}

/// A reading that may lie on the line.
struct Trial {
    /// Time since the reading that the line goes through, in milliseconds.
    since_ms: f64,
    /// Difference of the edge from the prediction of a line without a rate, in microseconds; infinite without an echo.
    off_us: f64,
    tolerance_us: f64,
    /// Terms of the log likelihood ratio if the line is heard, and if it is missed.
    heard: f64,
    missed: f64,
}

impl Trial {
    fn meets(&self, rate: f64) -> Meets {
        let off_us = self.off_us - rate * self.since_ms;
        if off_us < -self.tolerance_us {
            Meets::Hidden
        } else if off_us <= self.tolerance_us {
            Meets::Heard
        } else {
            Meets::Missed
        }
    }
}

pub(super) struct Evidence<'a> {
    timeline: &'a Timeline,
    guesses: &'a [Vec<Guess>],
    /// The earliest echo of all.
    earliest_us: i64,
    tolerance_us: i64,
    /// By receiver and bin of echo times: the probability that a reading, if not earlier, lies within a microsecond.
    density: Vec<Vec<f64>>,
    /// The logarithms of factorials.
    factorials: Vec<f64>,
}

impl<'a> Evidence<'a> {
    pub(super) fn new(timeline: &'a Timeline, settings: &Settings, guesses: &'a [Vec<Guess>]) -> Self {
        let receivers = 0..timeline.sensors() as u8;
        let echoes = receivers.clone().flat_map(|receiver| timeline.heard_by(receiver)).filter_map(|of| of.echo_us);
        let earliest_us = echoes.min().unwrap_or(0);
        let density = receivers.map(|receiver| density(timeline.heard_by(receiver), timeline.window_us)).collect();
        let factorials = (0..FACTORIALS).map(|n| ln_factorial(f64::from(n))).collect();
        Self { timeline, guesses, earliest_us, tolerance_us: settings.tolerance_us.max(2).into(), density, factorials }
    }

    /// The log likelihood ratio of the surrounding readings if this reading heard this firing, and the rate of its
    /// path's travel time. `all` are the firings that the reading may have heard.
    pub(super) fn of(
        &self,
        receiver: u8,
        reading: &Heard,
        (fired_us, sender): (i64, u8),
        all: &[(i64, u8)],
        rates: &Rates,
    ) -> (f64, f64) {
        let mut trials = Vec::new();
        self.ask(receiver, sender, reading, fired_us, all, &mut trials);
        if sender != receiver {
            // The way back: what the sender heard of the receiver.
            self.ask(sender, receiver, reading, fired_us, &[], &mut trials);
        }
        self.integrated(&trials, rates)
    }

    /// Evaluates the readings that lie on a line with this one. Among several at one offset between the two firings,
    /// which have the same information, it takes the one nearest in time.
    fn ask(&self, line: u8, sender: u8, reading: &Heard, fired_us: i64, all: &[(i64, u8)], trials: &mut Vec<Trial>) {
        let (timeline, beyond) = (self.timeline, (self.earliest_us - BEYOND_US, self.timeline.window_us + BEYOND_US));
        let at_us = reading.fired_us + reading.echo_us.unwrap_or(0);
        let travel_us = at_us - fired_us;
        let asked_us = (1000.0 * ASKED_MS) as i64;
        let (is_own, is_way_back) = (fired_us == reading.fired_us && sender == line, all.is_empty());
        let heard = timeline.heard_by(line);
        let first = heard.partition_point(|of| of.fired_us < at_us - asked_us - timeline.window_us);
        let by_sender = timeline.heard_by(sender);
        let mut found = Vec::<(i64, Trial)>::new();
        for of in heard[first..].iter().take_while(|of| of.fired_us <= at_us + asked_us) {
            if of.firing == reading.firing {
                continue;
            }
            let earliest = by_sender.partition_point(|sent| sent.fired_us < of.fired_us + beyond.0 - travel_us);
            for sent in
                by_sender[earliest..].iter().take_while(|sent| sent.fired_us <= of.fired_us + timeline.window_us)
            {
                let predicted_us = sent.fired_us + travel_us - of.fired_us;
                let since_ms = (sent.fired_us - fired_us) as f64 * 1e-3;
                if predicted_us > beyond.1 || since_ms.abs() > ASKED_MS || sent.fired_us == fired_us {
                    continue;
                }
                // The own echo of this firing, or sound of another one.
                if sender == line && is_own != (sent.firing == of.firing) {
                    continue;
                }
                let offset_us = sent.fired_us - of.fired_us;
                let repeats = (offset_us - (fired_us - reading.fired_us)).abs() <= 2 * self.tolerance_us;
                if !is_own && !is_way_back && repeats {
                    continue;
                }
                let bin = if is_own { of.firing as i64 } else { offset_us.div_euclid(2 * self.tolerance_us) };
                let trial = self.trial(line, of, (sent.fired_us, sender), predicted_us, since_ms, (fired_us, all));
                match found.iter_mut().find(|(other, _)| *other == bin) {
                    Some((_, other)) if other.since_ms.abs() <= since_ms.abs() => {}
                    Some((_, other)) => *other = trial,
                    None => found.push((bin, trial)),
                }
            }
        }
        trials.extend(found.into_iter().map(|(_, trial)| trial));
    }

    /// Evaluates one reading that may have heard this firing. To the extent that it lies on another line it is
    /// explained and proves nothing. A line that also goes through the reading in question already competes there, and
    /// must not compete twice.
    fn trial(
        &self,
        line: u8,
        of: &Heard,
        sent: (i64, u8),
        predicted_us: i64,
        since_ms: f64,
        (fired_us, all): (i64, &[(i64, u8)]),
    ) -> Trial {
        let is_rival = |guess: &&Guess| {
            let goes_there = |&(other_us, sender): &(i64, u8)| {
                let apart_us = (other_us - fired_us) - (guess.fired_us - sent.0);
                sender == guess.sender && apart_us.abs() <= 2 * self.tolerance_us
            };
            (guess.fired_us, guess.sender) != sent && !all.iter().any(goes_there)
        };
        let explained = self.guesses[of.firing].iter().filter(is_rival).map(|guess| guess.weight).sum::<f64>();
        let explained = explained.min(1.0);
        let tolerance_us = 0.5 * self.tolerance_us as f64 + 0.5e-3 * BEND * since_ms * since_ms;
        let density = &self.density[usize::from(line)];
        let bin = (predicted_us.max(0) / BIN_US) as usize;
        let accident = (2.0 * tolerance_us * density.get(bin).copied().unwrap_or(0.0)).clamp(1e-4, 0.9);
        Trial {
            since_ms,
            off_us: of.echo_us.map_or(f64::INFINITY, |echo_us| (echo_us - predicted_us) as f64),
            tolerance_us,
            heard: ((1.0 - explained) / accident + explained).ln(),
            missed: -(1.0 - accident).ln(),
        }
    }

    /// The logarithm of the likelihood ratio. With `h` heard and `m` missed and a uniform prior of the share, that of
    /// the counts is `h! m! / (h + m + 1)!`.
    fn ln_ratio(&self, counts: &Counts) -> f64 {
        let ln_factorial = |n: i32| {
            let known = usize::try_from(n).ok().and_then(|n| self.factorials.get(n));
            known.copied().unwrap_or_else(|| ln_factorial(n.into()))
        };
        let Counts { heard, missed, sum } = *counts;
        sum + ln_factorial(heard) + ln_factorial(missed) - ln_factorial(heard + missed + 1)
    }

    /// The log likelihood ratio, integrated over the rates, and the rate that contributes most.
    fn integrated(&self, trials: &[Trial], rates: &Rates) -> (f64, f64) {
        // Rates at which a trial meets something else.
        let mut changes = Vec::with_capacity(2 * trials.len());
        let mut meets: Vec<_> = trials.iter().map(|trial| trial.meets(-MOST_RATE)).collect();
        for (place, trial) in trials.iter().enumerate().filter(|(_, trial)| trial.off_us.is_finite()) {
            let ends =
                [trial.off_us - trial.tolerance_us, trial.off_us + trial.tolerance_us].map(|us| us / trial.since_ms);
            let after = if trial.since_ms > 0.0 { Meets::Hidden } else { Meets::Missed };
            let within = |rate: &f64| rate.abs() < MOST_RATE;
            changes.extend(Some(ends[0].min(ends[1])).filter(within).map(|rate| (rate, place, Meets::Heard)));
            changes.extend(Some(ends[0].max(ends[1])).filter(within).map(|rate| (rate, place, after)));
        }
        changes.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
        let mut counts = Counts::default();
        trials.iter().zip(&meets).for_each(|(trial, &meets)| counts.add(trial, meets, 1));
        let (mut from, mut below) = (-MOST_RATE, 0.0);
        let (mut all, mut most, mut rate) = (0.0, 0.0, 0.0);
        for change in changes.into_iter().map(Some).chain([None]) {
            let until = change.map_or(MOST_RATE, |change| change.0);
            let below_until = if change.is_none() { 1.0 } else { rates.below(until) };
            let part = self.ln_ratio(&counts).exp() * (below_until - below);
            all += part;
            if part > most {
                (most, rate) = (part, 0.5 * (from + until));
            }
            (from, below) = (until, below_until);
            if let Some((_, place, now)) = change {
                counts.add(&trials[place], meets[place], -1);
                counts.add(&trials[place], now, 1);
                meets[place] = now;
            }
        }
        (all.ln(), rate)
    }
}

/// Numbers of trials that heard a line and that missed it.
#[derive(Default)]
struct Counts {
    heard: i32,
    missed: i32,
    sum: f64,
}

impl Counts {
    fn add(&mut self, trial: &Trial, meets: Meets, by: i32) {
        let (count, ratio) = match meets {
            Meets::Heard => (&mut self.heard, trial.heard),
            Meets::Missed => (&mut self.missed, trial.missed),
            Meets::Hidden => return,
        };
        *count += by;
        self.sum += f64::from(by) * ratio;
    }
}

/// By bins of echo times: the number of nearby readings for each microsecond, among those that are not earlier.
fn density(heard: &[Heard], window_us: i64) -> Vec<f64> {
    let mut echoes: Vec<_> = heard.iter().filter_map(|of| of.echo_us).collect();
    echoes.sort_unstable();
    let silent = heard.len() - echoes.len();
    let below = |limit: i64| echoes.partition_point(|&echo| echo < limit);
    let at = |bin: i64| {
        let middle = bin * BIN_US + BIN_US / 2;
        let near = below(middle + NEAR_US) - below(middle - NEAR_US);
        let later = echoes.len() - below(middle - NEAR_US) + silent;
        (near as f64 + 1.0) / (later as f64 + 1.0) / (2 * NEAR_US) as f64
    };
    (0..=(window_us + BEYOND_US) / BIN_US).map(at).collect()
}
