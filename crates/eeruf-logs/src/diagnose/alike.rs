//! Firings of a sensor at which the ring fired alike, which say what repeats whatever the paths are.

use std::collections::{BTreeMap, HashMap};

use super::FoundPath;
use super::sensors::Share;
use super::statistics::median;
use super::timeline::{Heard, Timeline};

/// Others that fired so long before are still heard, in microseconds.
const BEFORE_US: i64 = 40_000;
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
/// Parts of a log of which the median says how much a sensor chatters.
const PARTS: usize = 40;
/// Fewer firings alike say nothing of each other.
const FEWEST: usize = 4;

/// Readings of one sensor that repeat.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Alike {
    /// Firings with an echo, of those after one with an echo at which the ring fired alike.
    pub(super) repeats: Share,
    /// The same of those after one without, where any firing alike has an echo.
    pub(super) returns: Share,
    /// Firings whose echo comes at no time at which others come, of those that can be compared.
    pub(super) wandering: Share,
    /// The share of these in the median part of the log: who walks by makes echoes wander for a while.
    pub(super) wanders_steadily: f64,
    /// Firings whose echo wanders by that of the sensor's firing just before, without and with one.
    pub(super) wanders_after: [Share; 2],
    /// Firings with an echo by that of the sensor's firing just before, without and with one, where any firing alike
    /// has an echo.
    pub(super) after: [Share; 2],
    /// Arrivals that it should hear, as others hear its own sound along these paths, and that it heard.
    pub(super) answers: Share,
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
    let mut all = Alike {
        repeats: Share::NONE,
        returns: Share::NONE,
        wandering: Share::NONE,
        wanders_steadily: 0.0,
        wanders_after: [Share::NONE; 2],
        after: [Share::NONE; 2],
        answers: answers(receiver, paths, timeline, tolerance),
    };
    let mut wanders = BTreeMap::new();
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
        is_sound.extend(group.iter().map(|firing| (firing.firing, firing.echo_us.is_some())));
        for firing in wandering(&echoes, group.len()).filter(|firing| fits_none[firing.firing]) {
            wanders.insert(firing.firing, true);
        }
    }
    let part_of = |part: &[Heard]| {
        let mut share = Share::NONE;
        part.iter().filter_map(|firing| wanders.get(&firing.firing)).for_each(|&wanders| share.add(wanders));
        share
    };
    all.wandering = part_of(heard);
    let mut parts: Vec<_> =
        heard.chunks(heard.len().div_ceil(PARTS).max(1)).map(|part| part_of(part).value()).collect();
    all.wanders_steadily = median(&mut parts);
    for two in heard.windows(2) {
        if let [Some(before), Some(after)] = [0, 1].map(|k| wanders.get(&two[k].firing)) {
            all.wanders_after[usize::from(*before)].add(*after);
        }
        if let [Some(before), Some(after)] = [0, 1].map(|k| is_sound.get(&two[k].firing)) {
            all.after[usize::from(*before)].add(*after);
        }
    }
    all
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
        let mut around: Vec<_> = (1..=AROUND)
            .flat_map(|k| [k, -k])
            .map(|k| within(us + (2 * k - 1) * SAME_US + 1, us + (2 * k + 1) * SAME_US))
            .collect();
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
