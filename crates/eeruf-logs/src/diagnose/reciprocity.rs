//! Sound takes as long from one sensor to another as back: what breaks that is a wire or a trigger.
//!
//! Along a loud path from x to y, y's sound must reach x after the same time whenever nothing earlier hides it. Each
//! path is held against the readings of its sender; an explanation is taken if it leaves no contradiction. While the
//! robot drives a path is a line of a second, with its rate, and the lines of a pair are held against them together.

use super::share::Share;
use super::statistics::ln_at_least;
use super::timeline::Timeline;
use super::{FoundPath, Settings};

/// A path that is heard so often is loud, in both directions.
const LOUD: f64 = 0.4;
/// Fewer readings along a path, or fewer chances to hear it back, say nothing.
const FEW: u32 = 10;
/// A path is confirmed from this share on that hears it back, and contradicted below the other.
const CONFIRMED: f64 = 0.5;
const CONTRADICTED: f64 = 0.15;
/// A trigger that is less late than this, in microseconds, does not show beside the scatter of faint echoes.
const LEAST_LATE_US: f64 = 300.0;
/// A longer delay is another path, in microseconds.
const MOST_LATE_US: f64 = 5000.0;
/// Delays this close are one, in microseconds.
const LATE_ALIKE_US: f64 = 75.0;
/// As many delays of a sensor are tried.
const DELAYS: usize = 8;
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

/// Loud paths that are held against the way back together: one, or all lines from a sensor to another while the robot
/// drives, as each of them lasts for a moment.
type Ways<'a> = Vec<&'a FoundPath>;

fn loud(paths: &[FoundPath]) -> Vec<Ways<'_>> {
    let mut all = Vec::<Ways<'_>>::new();
    for path in paths.iter().filter(|path| path.heard >= LOUD && path.sender != path.receiver) {
        let pair = |of: &FoundPath| (of.sender, of.receiver);
        match all.iter_mut().find(|ways| path.rate_us_s.is_some() && pair(ways[0]) == pair(path)) {
            Some(ways) => ways.push(path),
            None => all.push(vec![path]),
        }
    }
    all.retain(|ways| ways.iter().map(|path| path.readings).sum::<u32>() >= FEW);
    all
}

/// A loud path on which nothing is heard back, as the log stands. A healthy ring has none.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contradicted {
    pub(super) sender: u8,
    pub(super) receiver: u8,
    /// The natural logarithm of the probability that a whole ring does not hear it back.
    pub(super) ln_accident: f64,
}

impl Contradicted {
    pub(super) fn is_of(&self, sensor: u8) -> bool {
        self.sender == sensor || self.receiver == sensor
    }
}

pub(super) fn contradicted(paths: &[FoundPath], timeline: &Timeline, settings: &Settings) -> Vec<Contradicted> {
    let tolerance = i64::from(settings.tolerance_us.max(1));
    let of = |ways: Ways<'_>| {
        let Score { contradicted, ln_accident, .. } =
            score(core::slice::from_ref(&ways), Wiring::AsItIs, timeline, tolerance);
        let (sender, receiver) = (ways[0].sender, ways[0].receiver);
        (contradicted > 0).then_some(Contradicted { sender, receiver, ln_accident })
    };
    loud(paths).into_iter().filter_map(of).collect()
}

/// Returns true if others hear a silent sensor along paths, loud or not, on which it would hear them but for an
/// accident that happens in one of a thousand logs.
pub(super) fn is_unheard(silent: u8, paths: &[FoundPath], timeline: &Timeline, settings: &Settings) -> bool {
    const ACCIDENT: f64 = 0.001;
    let tolerance = i64::from(settings.tolerance_us.max(1));
    let ln_accident = |path: &FoundPath| {
        let heard = heard_back(path, Wiring::AsItIs, timeline, tolerance);
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
    let is_whole = |ways: &Ways<'_>| !broken.contains(&ways[0].sender) && !broken.contains(&ways[0].receiver);
    let loud: Vec<_> = loud(paths).into_iter().filter(is_whole).collect();
    let score = |wiring| score(&loud, wiring, timeline, tolerance);
    let as_it_is = score(Wiring::AsItIs);
    if as_it_is.contradicted == 0 {
        return None;
    }
    let sensors = timeline.sensors() as u8;
    let mut wirings: Vec<_> = (0..sensors).flat_map(|a| (a + 1..sensors).map(move |b| Wiring::Swapped(a, b))).collect();
    for sensor in 0..sensors {
        wirings.extend(delays_us(sensor, &loud, timeline).into_iter().map(|late_us| Wiring::Late(sensor, late_us)));
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

/// Delays that most readings of a sensor's sound have against what it hears of others.
fn delays_us(sensor: u8, loud: &[Ways<'_>], timeline: &Timeline) -> Vec<f64> {
    let mut delays = Vec::new();
    for path in loud.iter().flatten().filter(|path| path.sender == sensor) {
        let back = loud.iter().flatten().filter(|back| (back.sender, back.receiver) == (path.receiver, sensor));
        for back in back {
            let Some(at_us) = meet(path, back, timeline) else { continue };
            let delay_us = travel_us(path, at_us, timeline) - travel_us(back, at_us, timeline);
            if (LEAST_LATE_US..MOST_LATE_US).contains(&delay_us) {
                delays.push((delay_us, path.readings.min(back.readings)));
            }
        }
    }
    let near = |us: f64| delays.iter().filter(move |of| (of.0 - us).abs() <= LATE_ALIKE_US);
    let mut most: Vec<_> = delays.iter().map(|of| (near(of.0).map(|of| of.1).sum::<u32>(), of.0)).collect();
    most.sort_by(|a, b| b.0.cmp(&a.0).then(a.1.total_cmp(&b.1)));
    let mut late = Vec::<f64>::new();
    for (readings, us) in most {
        let mean_us = near(us).map(|of| of.0 * f64::from(of.1)).sum::<f64>() / f64::from(readings);
        if late.len() < DELAYS && late.iter().all(|of| (of - mean_us).abs() > LATE_ALIKE_US) {
            late.push(mean_us);
        }
    }
    late
}

/// When readings that came along a path begin and end, if it moves.
fn lasts(path: &FoundPath, timeline: &Timeline) -> (i64, i64) {
    match path.rate_us_s {
        Some(_) => (timeline.edge_us(path.receiver, path.periods.0), timeline.edge_us(path.receiver, path.periods.1)),
        None => (i64::MIN, i64::MAX),
    }
}

/// The middle of the time that two paths have in common.
fn meet(path: &FoundPath, other: &FoundPath, timeline: &Timeline) -> Option<i64> {
    let (one, other) = (lasts(path, timeline), lasts(other, timeline));
    let (from, to) = (one.0.max(other.0), one.1.min(other.1));
    (from <= to).then(|| from.saturating_add(to) / 2)
}

/// The time that sound takes along a path that is heard at a moment.
fn travel_us(path: &FoundPath, at_us: i64, timeline: &Timeline) -> f64 {
    let Some(rate_us_s) = path.rate_us_s else { return path.travel_us };
    let (from, to) = lasts(path, timeline);
    path.travel_us + 1e-6 * rate_us_s * (at_us as f64 - 0.5 * (from + to) as f64)
}

/// Holds each loud path against the way back.
fn score(loud: &[Ways<'_>], wiring: Wiring, timeline: &Timeline, tolerance: i64) -> Score {
    let mut score = Score::default();
    for ways in loud {
        let (mut heard, mut expected) = (Share::NONE, 0.0);
        for path in ways {
            let of_path = heard_back(path, wiring, timeline, tolerance);
            heard = Share { count: heard.count + of_path.count, of: heard.of + of_path.of };
            expected += path.heard * f64::from(of_path.of);
        }
        if heard.of < FEW {
            continue;
        }
        let share = f64::from(heard.count) / expected;
        score.confirmed += u32::from(share >= CONFIRMED);
        if share < CONTRADICTED {
            score.contradicted += 1;
            let missed = 1.0 - CONFIRMED * expected / f64::from(heard.of);
            score.ln_accident += ln_at_least(heard.of - heard.count, heard.of, missed);
        }
    }
    score
}

/// Arrivals on the way back of a path, and how many of those that nothing hid were heard.
fn heard_back(path: &FoundPath, wiring: Wiring, timeline: &Timeline, tolerance: i64) -> Share {
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
    let mut share = Share::NONE;
    let (ear, line) = (other(path.receiver), other(path.sender));
    if path.sender == ear {
        return share;
    }
    let (from, to) = lasts(path, timeline);
    for firing in timeline.heard_by(line).iter().filter(|of| (from..=to).contains(&of.fired_us)) {
        for (fired_us, _) in timeline.before(firing.fired_us + timeline.window_us).filter(|of| of.1 == ear) {
            let travel_us = travel_us(path, firing.fired_us, timeline) - late(path.sender) + late(ear);
            let at_us = fired_us + travel_us.round() as i64;
            let at = at_us - firing.fired_us;
            // A module at the end of another's line listens after its own trigger.
            let is_open = line == path.sender || timeline.listens(path.sender, at_us - DEAF_US);
            if at < DEAF_US || at + 2 * tolerance > timeline.window_us || !is_open {
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
