//! Sound takes as long from one sensor to another as back: what breaks that is a wire or a trigger.
//!
//! Along a loud path from x to y, y's sound must reach x after the same time whenever nothing earlier hides it. Each
//! path is held against the readings of its sender; an explanation is taken if it leaves no contradiction.

use super::share::Share;
use super::statistics::ln_at_least;
use super::timeline::Timeline;
use super::{FoundPath, Settings};

/// A path that is heard so often is loud, in both directions.
const LOUD: f64 = 0.4;
/// Fewer readings along a path, or fewer chances to hear it back, say nothing.
const FEW: u32 = 20;
/// A path is confirmed from this share on that hears it back, and contradicted below the other.
const CONFIRMED: f64 = 0.5;
const CONTRADICTED: f64 = 0.15;
/// A trigger that is less late than this, in microseconds, does not show beside the scatter of faint echoes.
const LEAST_LATE_US: f64 = 300.0;
/// A longer delay is another path, in microseconds.
const MOST_LATE_US: f64 = 5000.0;
/// No sensor hears others sooner after it fired, in microseconds.
const DEAF_US: i64 = 3000;

/// An explanation of the paths.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Wiring {
    /// As it should be.
    AsItIs,
    /// The echo lines of two sensors are exchanged.
    Swapped(u8, u8),
    /// The trigger of a sensor is late by this many microseconds.
    Late(u8, f64),
}

/// Paths that are heard back, and paths that are not.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Score {
    pub(super) confirmed: u32,
    pub(super) contradicted: u32,
    /// The natural logarithm of the probability that as many paths that are heard back seem contradicted.
    ln_accident: f64,
}

impl Score {
    pub(super) fn share(self) -> Share {
        Share { count: self.confirmed, of: self.confirmed + self.contradicted }
    }
}

fn loud(paths: &[FoundPath]) -> impl Iterator<Item = &FoundPath> {
    paths.iter().filter(|path| path.heard >= LOUD && path.readings >= FEW)
}

/// The loud paths on which nothing is heard back, as the log stands: their senders and receivers. A healthy ring has
/// none.
pub(super) fn contradicted(paths: &[FoundPath], timeline: &Timeline, settings: &Settings) -> Vec<(u8, u8)> {
    let tolerance = i64::from(settings.tolerance_us.max(1));
    let is_contradicted = |path: &&FoundPath| score(&[path], Wiring::AsItIs, timeline, tolerance).contradicted > 0;
    loud(paths).filter(is_contradicted).map(|path| (path.sender, path.receiver)).collect()
}

/// Returns true if others hear a silent sensor along paths, loud or not, on which it would hear them but for an
/// accident that happens in one of a thousand logs.
pub(super) fn is_unheard(silent: u8, paths: &[FoundPath], timeline: &Timeline, settings: &Settings) -> bool {
    const ACCIDENT: f64 = 0.001;
    let tolerance = i64::from(settings.tolerance_us.max(1));
    let ln_accident = |path: &FoundPath| {
        let heard = heard_at(path.receiver, silent, path.travel_us.round() as i64, timeline, tolerance);
        ln_at_least(heard.of - heard.count, heard.of, 1.0 - CONFIRMED * path.heard)
    };
    let out = paths.iter().filter(|path| path.sender == silent && path.receiver != silent);
    out.map(ln_accident).sum::<f64>() < ACCIDENT.ln()
}

/// The explanation that leaves no contradiction where the log as it stands has some, with its score, that of the log as
/// it stands, and the number of explanations that would fit by accident. Sensors that are broken otherwise say nothing.
pub(super) fn wiring(
    paths: &[FoundPath],
    timeline: &Timeline,
    broken: &[u8],
    settings: &Settings,
) -> Option<(Wiring, Score, Score, f64)> {
    let tolerance = i64::from(settings.tolerance_us.max(1));
    let is_whole = |path: &&FoundPath| !broken.contains(&path.sender) && !broken.contains(&path.receiver);
    let loud: Vec<_> = loud(paths).filter(is_whole).collect();
    let score = |wiring| score(&loud, wiring, timeline, tolerance);
    let as_it_is = score(Wiring::AsItIs);
    if as_it_is.contradicted == 0 {
        return None;
    }
    let sensors = timeline.sensors() as u8;
    let mut wirings: Vec<_> = (0..sensors).flat_map(|a| (a + 1..sensors).map(move |b| Wiring::Swapped(a, b))).collect();
    for path in &loud {
        let back = loud.iter().filter(|back| (back.sender, back.receiver) == (path.receiver, path.sender));
        let late = back
            .map(|back| path.travel_us - back.travel_us)
            .filter(|late| (LEAST_LATE_US..MOST_LATE_US).contains(late));
        wirings.extend(late.filter(|_| path.sender != path.receiver).map(|late| Wiring::Late(path.sender, late)));
    }
    // By accident a reading is near a prediction as often as its tolerance is of the stretch of usual echoes.
    let chance = 4.0 * tolerance as f64 / 20_000.0;
    let scored = wirings.iter().map(|&wiring| (wiring, score(wiring)));
    let better = scored.filter(|(_, score)| {
        score.contradicted * 4 <= as_it_is.contradicted && score.confirmed >= as_it_is.confirmed + 2
    });
    let mut better: Vec<_> = better.collect();
    better.sort_by_key(|(_, score)| (core::cmp::Reverse(score.confirmed), score.contradicted));
    let (wiring, best) = *better.first()?;
    // Another explanation of other sensors that is as good leaves it open which is broken.
    let involves = |wiring| match wiring {
        Wiring::AsItIs => (None, None),
        Wiring::Swapped(a, b) => (Some(a), Some(b)),
        Wiring::Late(sensor, _) => (Some(sensor), None),
    };
    let is_open = better.iter().skip(1).any(|&(other, score)| {
        score.confirmed == best.confirmed
            && score.contradicted == best.contradicted
            && involves(other) != involves(wiring)
    });
    let gained = best.confirmed - as_it_is.confirmed;
    // Of the paths that it concerns, those that were contradicted before or are confirmed now.
    let of = gained + best.contradicted + as_it_is.contradicted;
    let accidents = match wiring {
        // The delay is what makes two paths agree, so that they do says nothing: that they contradict each other does.
        Wiring::Late(..) => loud.len() as f64 * as_it_is.ln_accident.exp(),
        _ => wirings.len() as f64 * ln_at_least(gained, of, chance).exp(),
    };
    (!is_open && accidents < settings.accidents).then_some((wiring, best, as_it_is, accidents))
}

/// Holds each loud path against the way back.
fn score(loud: &[&FoundPath], wiring: Wiring, timeline: &Timeline, tolerance: i64) -> Score {
    // The line at which an ear is heard, and the ear of a line.
    let other = |sensor: u8| match wiring {
        Wiring::Swapped(a, b) if sensor == a => b,
        Wiring::Swapped(a, b) if sensor == b => a,
        _ => sensor,
    };
    let late = |sensor: u8| match wiring {
        Wiring::Late(of, late_us) if of == sensor => late_us,
        _ => 0.0,
    };
    let mut score = Score::default();
    for path in loud {
        let (sender, ear) = (path.sender, other(path.receiver));
        if sender == ear {
            continue;
        }
        let travel_us = path.travel_us - late(sender) + late(ear);
        let heard = heard_at(ear, other(sender), travel_us.round() as i64, timeline, tolerance);
        if heard.of < FEW {
            continue;
        }
        let share = heard.value() / path.heard;
        score.confirmed += u32::from(share >= CONFIRMED);
        if share < CONTRADICTED {
            score.contradicted += 1;
            score.ln_accident += ln_at_least(heard.of - heard.count, heard.of, 1.0 - CONFIRMED * path.heard);
        }
    }
    score
}

/// Arrivals of a sensor's sound at a line after a time, and how many of those that nothing hid were heard.
fn heard_at(sender: u8, line: u8, travel_us: i64, timeline: &Timeline, tolerance: i64) -> Share {
    let mut share = Share::NONE;
    for firing in timeline.heard_by(line) {
        for (fired_us, _) in timeline.before(firing.fired_us + timeline.window_us).filter(|of| of.1 == sender) {
            let at = fired_us + travel_us - firing.fired_us;
            if at < DEAF_US || at + 2 * tolerance > timeline.window_us {
                continue;
            }
            match firing.echo_us {
                Some(echo) if echo < at - 2 * tolerance => {}
                echo => share.add(echo.is_some_and(|echo| echo <= at + 2 * tolerance)),
            }
        }
    }
    share
}
