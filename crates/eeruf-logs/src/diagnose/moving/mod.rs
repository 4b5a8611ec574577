//! Senders of readings while the robot drives.
//!
//! A path is then a line: over half a second its length changes at a constant rate, the same for all objects ahead.
//! For each firing that a reading may have heard, the readings before and after are tested for lying on one line with
//! it, at *other* offsets between the two firings: those of the receiver, and those of the sender that heard the
//! receiver, since sound takes equally long both ways. The likelihood ratio is integrated over all rates and over all
//! shares of readings in which the path is heard, and compared with the chance of an accident.
//!
//! Which sensors hear each other and how often, the life of sound, and the robot's speed are learned from the log in a
//! few passes. From the second pass on, a reading that lies on another line proves less. No path is followed over the
//! whole log, so the test of [`super::search`] is not used; each name states its probability of being wrong.

mod evidence;
mod lines;
mod prior;

use super::timeline::{Heard, Timeline};
use super::{FoundPath, KeepGoing, Named, Settings};
use evidence::Evidence;
use lines::lines;
use prior::Prior;

/// Number of passes over the log. Each learns from the one before; more passes become overconfident.
const PASSES: usize = 3;
/// Probability below which guesses are dropped.
const LEAST: f64 = 0.001;

/// A firing that a reading may have heard, and how likely it is.
#[derive(Clone, Copy, Debug)]
pub(super) struct Guess {
    sender: u8,
    fired_us: i64,
    weight: f64,
    /// Rate at which the path's travel time changes, in microseconds for each millisecond.
    rate: f64,
}

/// Names the sender of each reading, marks those that came along no path, and returns the lines of the named readings.
pub(super) fn follow(
    timeline: &Timeline,
    settings: &Settings,
    named: &mut [Option<Named>],
    fits_none: &mut [bool],
    keep_going: KeepGoing<'_>,
) -> Vec<FoundPath> {
    // In two phases the two offsets between any two firings repeat for ever.
    if !timeline.has_many_phases {
        return Vec::new();
    }
    let mut guesses: Vec<Vec<Guess>> = vec![Vec::new(); named.len()];
    let mut prior = Prior::new(timeline.sensors(), named.len(), settings);
    for _ in 0..PASSES {
        let evidence = Evidence::new(timeline, settings, &guesses);
        let mut learned = Prior::learning(&prior);
        let mut next = Vec::with_capacity(guesses.len());
        next.resize_with(guesses.len(), Vec::new);
        for receiver in 0..timeline.sensors() as u8 {
            for reading in timeline.heard_by(receiver).iter().take_while(|_| keep_going()) {
                next[reading.firing] = guess(receiver, reading, timeline, &evidence, &prior, &mut learned);
            }
        }
        prior = learned.normalized();
        guesses = next;
    }
    for receiver in 0..timeline.sensors() as u8 {
        for reading in timeline.heard_by(receiver) {
            let Some(echo_us) = reading.echo_us else { continue };
            let all = &guesses[reading.firing];
            let best = all.iter().max_by(|a, b| a.weight.total_cmp(&b.weight));
            let any: f64 = all.iter().map(|guess| guess.weight).sum();
            fits_none[reading.firing] = best.is_none_or(|best| best.weight < 1.0 - any);
            let Some(best) = best else { continue };
            let sure = all.iter().filter(|guess| guess.sender == best.sender).map(|guess| guess.weight).sum();
            if sure >= settings.sure {
                let travel_us = (reading.fired_us + echo_us - best.fired_us) as f64;
                named[reading.firing] = Some(Named { sender: best.sender, travel_us, sure });
            }
        }
    }
    lines(timeline, settings, named)
}

/// The firings that a reading may have heard, each with its probability; the rest is the probability that it heard
/// none.
fn guess(
    receiver: u8,
    reading: &Heard,
    timeline: &Timeline,
    evidence: &Evidence<'_>,
    prior: &Prior,
    learned: &mut Prior,
) -> Vec<Guess> {
    let Some(echo_us) = reading.echo_us else { return Vec::new() };
    let at_us = reading.fired_us + echo_us;
    let may_hear = |&(fired_us, sender): &(i64, u8)| sender != receiver || fired_us <= reading.fired_us;
    let fired: Vec<_> = timeline.before(at_us).filter(may_hear).collect();
    let rates = prior.rates(reading.firing);
    let mut guesses = Vec::with_capacity(fired.len());
    // Logarithms until all are known.
    let none = prior.none();
    for &(fired_us, sender) in &fired {
        let (ln_ratio, rate) = evidence.of(receiver, reading, (fired_us, sender), &fired, rates);
        let is_before = sender == receiver && fired_us < reading.fired_us;
        let weight = ln_ratio + prior.of(receiver, sender, is_before, at_us - fired_us).ln();
        guesses.push(Guess { sender, fired_us, weight, rate });
    }
    let most = guesses.iter().map(|guess| guess.weight).fold(none.ln(), f64::max);
    let none = (none.ln() - most).exp();
    let all = none + guesses.iter().map(|guess| (guess.weight - most).exp()).sum::<f64>();
    for guess in &mut guesses {
        guess.weight = (guess.weight - most).exp() / all;
        let is_before = guess.sender == receiver && guess.fired_us < reading.fired_us;
        learned.add(receiver, guess.sender, is_before, at_us - guess.fired_us, guess.weight);
        learned.add_rate(reading.firing, guess.rate, guess.weight);
    }
    learned.add_none(none / all);
    guesses.retain(|guess| guess.weight > LEAST);
    guesses
}
