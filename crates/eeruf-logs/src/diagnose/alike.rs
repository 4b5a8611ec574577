//! Firings of a sensor at which the ring fired alike, which say what repeats whatever the paths are.

use std::collections::HashMap;

use super::FoundPath;
use super::share::Share;
use super::statistics::{ln_at_least, median};
use super::timeline::{Heard, Timeline};

/// Others that fired so long before are still heard, in microseconds.
const BEFORE_US: i64 = 40_000;
/// Sound dies in this time after another sensor fired, in microseconds.
const ALONE_US: i64 = 30_000;
/// Readings this close come along one path, in microseconds: the jitter of an edge to both sides.
const SAME_US: i64 = 60;
/// Stretches as wide to each side that a path is compared with.
const AROUND: i64 = 5;
/// A path is this many times as crowded as the usual one of these.
const CROWDS: f64 = 3.0;
/// A reading whose neighbours in time are this near follows a thing that moves, or that fades, in microseconds.
const FOLLOWS_US: i64 = 200;
/// Among fewer firings alike two echoes at one time are no accident.
const MANY: usize = 20;
/// Half of the stretch of travel times that a faint path is compared with, in microseconds.
const STRETCH_US: i64 = 2000;
/// The probability that an echo that wanders counts as one of a faint path.
const ACCIDENT: f64 = 0.001;
/// Parts of a log over which the echoes of a chattering sensor are spread as by chance, of as many firings or more.
const PARTS: usize = 40;
const FEWEST_OF_PART: usize = 15;
/// They come in more than this share of the parts, and vary from part to part by no more than this many times what
/// chance alone makes of it. Nobody is in the way for so much of the time as the last share.
const COMES: f64 = 0.6;
const VARIES: f64 = 2.5;
const OFTEN: f64 = 0.35;
/// One comes after another not more often than this many times as often as after any reading: who walks by makes runs.
const RUNS: f64 = 1.25;
/// Fewer firings alike say nothing of each other.
const FEWEST: usize = 4;
/// Fewer than one firing in this many has enough others alike where gaps are random.
const SELDOM: usize = 4;

/// A sensor that hears so few of the arrivals that it should is broken, of this many.
const ANSWERS: f64 = 0.75;
const ARRIVALS: u32 = 20;
/// A sensor that loses echoes hears one in fewer of the firings at which it should, of this many.
const KEEPS: f64 = 0.8;
const COMPARED: u32 = 8;
/// More echoes behind the usual one show that this one fades.
const BEHIND: f64 = 0.3;
/// An echo of its own is there to be heard in more of the firings that can be compared, whatever others do.
const MOSTLY: f64 = 0.4;
/// Misses at random come as often after a miss as after an echo; those of a sound that fades come in runs.
const RANDOM: f64 = 0.1;

/// Readings of one sensor that repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Alike {
    /// Firings with an echo, of those after one with an echo at which the ring fired alike.
    pub(super) repeats: Share,
    /// The same of those after one without, where any firing alike has an echo.
    pub(super) returns: Share,
    /// Firings whose echo comes at no time at which others come, of those that can be compared.
    pub(super) wandering: Share,
    /// True if they are spread over the log as by chance: who walks by makes echoes wander for a while.
    pub(super) wanders_steadily: bool,
    /// Firings with an echo by that of the sensor's firing just before, without and with one, where any firing alike
    /// has an echo.
    pub(super) after: [Share; 2],
    /// Firings with an echo where the one before had it, of all but the first: others' sound moves from firing to
    /// firing, its own does not.
    pub(super) steady: Share,
    /// Echoes behind the one that comes most often when the ring fires alike, of all that do not come before it. Where
    /// an echo is lost, what is behind it is lost with it; where it fades, that is heard.
    pub(super) behind: Share,
    /// Arrivals that it should hear, as others hear its own sound along these paths, and that it heard.
    pub(super) answers: Share,
    /// Firings with an echo, of those at which no other sound was in the air.
    pub(super) alone: Share,
    /// The median echo time, in microseconds.
    pub(super) echo_us: f64,
}

impl Alike {
    /// Returns true if it hears the arrivals that it should.
    fn hears_others(&self) -> bool {
        self.answers.of >= ARRIVALS && self.answers.interval_95().0 > ANSWERS
    }

    /// Returns true if it does not hear the arrivals that it should.
    pub(super) fn misses_others(&self) -> bool {
        self.answers.of >= ARRIVALS && self.answers.interval_95().1 < ANSWERS
    }

    /// Returns true if it misses echoes at random: it loses them, or they are at its threshold and fade independently
    /// at every firing.
    pub(super) fn misses_at_random(&self) -> bool {
        let compared = f64::from(self.repeats.of + self.returns.of);
        self.repeats.of >= COMPARED
            && self.repeats.interval_95().1 < KEEPS
            && !self.hears_others()
            && self.repeats.differs(self.returns).abs() < RANDOM
            && self.after[1].differs(self.after[0]).abs() < RANDOM
            && self.behind.value() < BEHIND
            && compared > MOSTLY * f64::from(self.wandering.of)
    }
}

/// Compares the firings of a sensor.
pub(super) fn alike(
    receiver: u8,
    paths: &[FoundPath],
    timeline: &Timeline,
    fits_none: &[bool],
    tolerance: i64,
) -> Alike {
    let heard = timeline.heard_by(receiver);
    let mut groups = HashMap::<Vec<(u8, i64)>, Vec<Heard>>::new();
    for firing in heard {
        let stand = |(fired_us, sensor): (i64, u8)| {
            let offset = fired_us - firing.fired_us;
            (sensor != receiver && offset > -BEFORE_US).then(|| (sensor, offset.div_euclid(2 * tolerance)))
        };
        let mut key: Vec<_> = timeline.before(firing.fired_us + timeline.window_us).filter_map(stand).collect();
        key.sort_unstable();
        groups.entry(key).or_default().push(*firing);
    }
    let comparable: usize = groups.values().map(Vec::len).filter(|&firings| firings >= FEWEST).sum();
    if comparable < heard.len() / SELDOM {
        // Dice in every gap: others' sound never comes alike, and the sensor's own always does.
        groups = HashMap::from([(Vec::new(), heard.to_vec())]);
    }
    let mut all = Alike {
        repeats: Share::NONE,
        returns: Share::NONE,
        wandering: Share::NONE,
        wanders_steadily: false,
        after: [Share::NONE; 2],
        steady: Share::NONE,
        behind: Share::NONE,
        answers: answers(receiver, paths, timeline, tolerance),
        alone: Share::NONE,
        echo_us: median(&mut heard.iter().filter_map(|of| of.echo_us).map(|us| us as f64).collect::<Vec<_>>()),
    };
    for firing in heard {
        let others = timeline.before(firing.fired_us + timeline.window_us);
        if !others.into_iter().any(|(at, sensor)| sensor != receiver && at > firing.fired_us - ALONE_US) {
            all.alone.add(firing.echo_us.is_some());
        }
    }
    let mut wanders = HashMap::new();
    let mut wanderers = Vec::new();
    // Firings at which something is there to be heard.
    let mut is_sound = HashMap::new();
    for group in groups.values().filter(|group| group.len() >= FEWEST) {
        let echoes: Vec<_> = group.iter().filter(|firing| firing.echo_us.is_some()).collect();
        group.iter().for_each(|firing| _ = wanders.insert(firing.firing, false));
        if echoes.is_empty() {
            continue;
        }
        for two in group.windows(2) {
            let of = if two[0].echo_us.is_some() { &mut all.repeats } else { &mut all.returns };
            of.add(two[1].echo_us.is_some());
        }
        behind(&echoes, &mut all.behind);
        is_sound.extend(group.iter().map(|firing| (firing.firing, firing.echo_us.is_some())));
        for firing in wandering(&echoes, group.len()).filter(|firing| fits_none[firing.firing]) {
            wanderers.push(*firing);
        }
    }
    let is_path = faint(receiver, &wanderers, timeline);
    for (firing, is_path) in wanderers.iter().zip(is_path) {
        wanders.insert(firing.firing, !is_path);
    }
    let compared: Vec<_> = heard.iter().filter_map(|firing| wanders.get(&firing.firing)).copied().collect();
    all.wandering = share_of(&compared);
    let parts: Vec<_> = compared.chunks(compared.len().div_ceil(PARTS).max(FEWEST_OF_PART)).map(share_of).collect();
    let mut runs = Share::NONE;
    compared.windows(2).filter(|two| two[0]).for_each(|two| runs.add(two[1]));
    all.wanders_steadily = is_steady(all.wandering, runs, &parts);
    for two in heard.windows(2) {
        let stays = two[0].echo_us.zip(two[1].echo_us).is_some_and(|(a, b)| (a - b).abs() <= FOLLOWS_US);
        all.steady.add(stays);
        if let [Some(before), Some(after)] = [0, 1].map(|k| is_sound.get(&two[k].firing)) {
            all.after[usize::from(*before)].add(*after);
        }
    }
    all
}

/// The share of these that are true.
fn share_of(part: &[bool]) -> Share {
    let mut share = Share::NONE;
    part.iter().for_each(|&counts| share.add(counts));
    share
}

/// Returns true if what counts is spread over the parts as by chance, also in `runs`: right after one that counts.
fn is_steady(all: Share, runs: Share, parts: &[Share]) -> bool {
    let share = all.value();
    let off = |part: &Share| (part.value() - share).powi(2) * f64::from(part.of);
    let varies = parts.iter().map(off).sum::<f64>() / (parts.len() as f64 - 1.0);
    let comes = parts.iter().filter(|part| part.count > 0).count() as f64;
    let is_chance = varies < VARIES * share * (1.0 - share) && runs.interval_95().0 < RUNS * share;
    let by_chance = is_chance || share > OFTEN;
    comes > COMES * parts.len() as f64 && by_chance
}

/// Counts the echoes of firings alike that come behind the one that comes most often, of those that do not come before.
fn behind(echoes: &[&Heard], share: &mut Share) {
    let times = || echoes.iter().filter_map(|firing| firing.echo_us);
    let near = |us: i64| times().filter(|other| (other - us).abs() <= SAME_US).count();
    let Some(most) = times().max_by_key(|&us| near(us)) else { return };
    times().filter(|us| us + SAME_US >= most).for_each(|us| share.add(us > most + SAME_US));
}

/// Of echoes in order of time, among this many firings alike, those that neither come at a time at which others crowd
/// nor follow their neighbours.
fn wandering<'a>(echoes: &'a [&'a Heard], firings: usize) -> impl Iterator<Item = &'a Heard> {
    let times: Vec<i64> = echoes.iter().filter_map(|firing| firing.echo_us).collect();
    let mut sorted = times.clone();
    sorted.sort_unstable();
    let least = if firings < MANY { 2 } else { 3 };
    let recurs = move |us: i64| {
        let within =
            |from: i64, to: i64| sorted.partition_point(|&us| us <= to) - sorted.partition_point(|&us| us < from);
        let near = within(us - SAME_US, us + SAME_US);
        // The usual crowd of a stretch around: noise crowds it as much, another path a part of it.
        let mut around = crowds(us, within);
        around.sort_unstable();
        near >= least && near as f64 >= CROWDS * around[around.len() / 2] as f64
    };
    let follows = move |place: usize| {
        let near = |other: Option<&i64>| other.is_some_and(|other| (other - times[place]).abs() <= FOLLOWS_US);
        (near(times.get(place + 1)) || place + 1 == times.len())
            && (place == 0 || near(times.get(place - 1)))
            && times.len() > 1
    };
    let wanders = move |(place, firing): (usize, &&'a Heard)| {
        let recurs = firing.echo_us.is_some_and(&recurs);
        (!recurs && !follows(place)).then_some(*firing)
    };
    echoes.iter().enumerate().filter_map(wanders)
}

/// The crowds of the stretches around a time, next to the one in which it lies.
fn crowds(us: i64, within: impl Fn(i64, i64) -> usize) -> Vec<usize> {
    let places = (1..=AROUND).flat_map(|k| [k, -k]);
    places.map(|k| within(us + (2 * k - 1) * SAME_US + 1, us + (2 * k + 1) * SAME_US)).collect()
}

/// Marks echoes that come along a path too faint to be found: others among them took the same time from a firing of
/// one sensor, the receiver's own or another's, significantly more than the stretch around it gives by accident.
fn faint(receiver: u8, wanderers: &[Heard], timeline: &Timeline) -> Vec<bool> {
    // By source: the time from its firing to an echo, and which echo.
    let mut travels = vec![Vec::new(); timeline.sensors()];
    for (place, firing) in wanderers.iter().enumerate() {
        let Some(echo_us) = firing.echo_us else { continue };
        for (fired_us, sensor) in timeline.before(firing.fired_us + echo_us) {
            if sensor != receiver || fired_us == firing.fired_us {
                travels[usize::from(sensor)].push((firing.fired_us + echo_us - fired_us, place));
            }
        }
    }
    let ln_limit = (ACCIDENT / timeline.sensors() as f64).ln();
    let mut is_path = vec![false; wanderers.len()];
    for travels in &mut travels {
        travels.sort_unstable();
        let within = |from: i64, to: i64| {
            travels.partition_point(|&(at, _)| at <= to) - travels.partition_point(|&(at, _)| at < from)
        };
        let share = SAME_US as f64 / STRETCH_US as f64;
        for &(us, place) in travels.iter() {
            let near = within(us - SAME_US, us + SAME_US);
            let stretch = within(us - STRETCH_US, us + STRETCH_US);
            let mut around = crowds(us, within);
            around.sort_unstable();
            let second = around[around.len() - 2];
            is_path[place] |= near as f64 >= CROWDS * second as f64
                && ln_at_least(near as u32 - 1, stretch as u32 - 1, share) < ln_limit;
        }
    }
    is_path
}

/// Arrivals at a sensor along paths on which others hear its own sound loudly, of which it should hear as many: heard,
/// of those that nothing earlier hid.
fn answers(receiver: u8, paths: &[FoundPath], timeline: &Timeline, tolerance: i64) -> Share {
    /// A path that is heard so often is loud, in both directions.
    const LOUD: f64 = 0.9;
    let heard = timeline.heard_by(receiver);
    let deaf_us = heard.iter().filter_map(|heard| heard.echo_us).min().unwrap_or(0).max(3000);
    let mut share = Share::NONE;
    let out: Vec<_> = paths
        .iter()
        .filter(|path| path.sender == receiver && path.receiver != receiver && path.heard >= LOUD)
        .collect();
    for firing in heard {
        let arrivals = timeline.before(firing.fired_us + timeline.window_us).flat_map(|(fired_us, sensor)| {
            let along = out.iter().filter(move |path| path.receiver == sensor);
            along.map(move |path| fired_us + path.travel_us.round() as i64 - firing.fired_us)
        });
        let first = arrivals.filter(|&at| at >= deaf_us && at + tolerance <= timeline.window_us).min();
        match (first, firing.echo_us) {
            (None, _) => {}
            (Some(at), Some(echo)) if echo < at - tolerance => {}
            (Some(at), echo) => {
                share.of += 1;
                share.count += u32::from(echo.is_some_and(|echo| (echo - at).abs() <= 2 * tolerance));
            }
        }
    }
    share
}
