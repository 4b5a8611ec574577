//! Readers who know more than `diagnose`, and so bound it. One knows the scene: a whole ring at the same place that
//! fires at the same instants shows it how many readings differ. The other knows along which path each reading came,
//! but no lengths and no levels: what it can hold against a log is that sound takes as long back, and is as loud.

use std::collections::{BTreeMap, HashMap};
use std::error::Error;
use std::sync::Arc;

use eeruf_core::{Micros, Phase};
use eeruf_logs::Share;
use eeruf_sim::{Cause, Firing, FiringPeriod, Method, Options, Own, OwnError, Readings, Simulation, Stop, World};

use super::truth::SENSORS;

/// Readings that differ by less are the same, in microseconds: four times the jitter, and half a burst.
const SAME_US: f64 = 75.0;
/// The same of arrivals of a robot that drives, whose paths are taken from the readings around.
const NEAR_US: f64 = 300.0;
/// While the robot drives a reading tells the length of its path for so long to both sides, in seconds.
const TELLS_S: f64 = 0.5;
/// Fewer readings are no path.
const FEWEST: usize = 5;
/// Logs of whole rings that say what is heard at a place.
const TWINS: u64 = 4;
/// Periods of a replay, in microseconds.
const REPLAY_US: u32 = 60_000;

/// Fires at the instants of a log.
struct Replay(Vec<Vec<(Micros, u8)>>);

impl Replay {
    fn of(world: &World, readings: &Readings) -> Self {
        let start_us = i64::from(world.robots()[0].start.as_micros());
        let mut periods = vec![];
        for (sensor, at_us) in firings(readings) {
            let at_us = u32::try_from(at_us - start_us).unwrap_or(0);
            let period = (at_us / REPLAY_US) as usize;
            periods.resize(periods.len().max(period + 1), vec![]);
            periods[period].push((Micros::new(at_us % REPLAY_US), sensor));
        }
        Self(periods)
    }
}

impl Firing for Replay {
    fn plan(&mut self, period: u32) -> Result<FiringPeriod, OwnError> {
        let firings = self.0.get(period as usize).cloned().unwrap_or_default();
        Ok(FiringPeriod { length: Micros::new(REPLAY_US), phase: Phase(0), firings })
    }
}

/// Sensor and instant of each reading of the first robot.
fn firings(readings: &Readings) -> impl Iterator<Item = (u8, i64)> + '_ {
    let of_first = (0..readings.len()).filter(|&k| readings.robot[k] == 0);
    of_first.map(|k| (readings.sensor[k], (1e6 * readings.fired_s[k]).round() as i64))
}

/// Simulates a whole ring at the same firings, with other noise.
fn twin(world: World, readings: &Readings, seed: u64) -> Result<Readings, Box<dyn Error>> {
    let own = Own::new().firing(0, Replay::of(&world, readings));
    let options = Options { seed: Some(seed), ..Options::default() };
    let mut twin = Simulation::with_own(Arc::new(world), Method::Conventional, &options, own, Stop::default())?;
    Ok(twin.step(readings.duration_s + 0.1, |_| true)?)
}

/// Readings of these sensors that are those of none of the twins.
fn odd(readings: &Readings, twins: &[Readings], sensors: &[usize]) -> Share {
    let twins: Vec<HashMap<_, _>> = twins.iter().map(|twin| firings(twin).zip(&twin.earliest_us).collect()).collect();
    let mut share = Share { count: 0, of: 0 };
    let of_them = firings(readings).zip(&readings.earliest_us).filter(|(firing, _)| sensors.contains(&firing.0.into()));
    for (firing, &echo_us) in of_them {
        let is_same = |twin: &HashMap<_, &f64>| {
            let other_us = twin.get(&firing).map_or(f64::NAN, |&&other_us| other_us);
            echo_us.is_nan() && other_us.is_nan() || (echo_us - other_us).abs() <= SAME_US
        };
        share.count += u32::from(!twins.iter().any(is_same));
        share.of += 1;
    }
    share
}

/// Returns true if one who knows the scene can tell that these sensors are broken: more of their readings are none that
/// a whole ring gives there than in the log of another whole ring.
pub(super) fn scene_tells(
    world: impl Fn() -> Result<World, Box<dyn Error>>,
    readings: &Readings,
    sensors: &[usize],
    seed: u64,
) -> Result<bool, Box<dyn Error>> {
    let twins = (0..=TWINS).map(|k| twin(world()?, readings, seed + k)).collect::<Result<Vec<_>, _>>()?;
    let (whole, twins) = twins.split_first().ok_or("no twins")?;
    Ok(odd(readings, twins, sensors).interval_95().0 > odd(whole, twins, sensors).interval_95().1)
}

/// Sound of one sensor on a line along one path: when it came, and how long it took by the log.
type Heard = Vec<(f64, f64)>;

/// Firings of a line: when, and its reading with the firing's number.
struct Line {
    at_us: Vec<f64>,
    echo_us: Vec<f64>,
    numbers: Vec<usize>,
    blanking_us: f64,
    window_us: f64,
}

impl Line {
    /// Arrivals of sound that was sent at these times and takes as long as what was heard around did: those that
    /// nothing earlier hid, and of them those that were heard.
    fn arrivals(&self, sent_us: &[f64], heard: &Heard, moves: bool) -> Share {
        let near_us = if moves { NEAR_US } else { 2.0 * SAME_US };
        let mut share = Share { count: 0, of: 0 };
        let mut middle: Vec<_> = heard.iter().map(|of| of.1).collect();
        middle.sort_by(f64::total_cmp);
        let middle = middle[middle.len() / 2];
        for (place, &at_us) in self.at_us.iter().enumerate() {
            let from = sent_us.partition_point(|&sent| sent < at_us - self.window_us);
            for &sent in sent_us[from..].iter().take_while(|&&sent| sent < at_us + self.window_us) {
                // The reading in question says nothing of itself.
                let is_other = |of: &&(f64, f64)| of.0 != at_us && (of.0 - sent).abs() < 1e6 * TELLS_S;
                let around =
                    heard.iter().filter(is_other).min_by(|a, b| (a.0 - sent).abs().total_cmp(&(b.0 - sent).abs()));
                let travel_us = if moves { around.map(|of| of.1) } else { Some(middle) };
                let Some(travel_us) = travel_us else { continue };
                let arrival_us = sent + travel_us - at_us;
                let echo_us = self.echo_us[place];
                let listens = (self.blanking_us + near_us..self.window_us - near_us).contains(&arrival_us);
                if listens && !(echo_us < arrival_us - near_us) {
                    share.of += 1;
                    share.count += u32::from(echo_us <= arrival_us + near_us);
                }
            }
        }
        share
    }
}

/// Returns true if one who knows the paths of all readings, but not the scene, can tell that a sensor is broken: less
/// of what others hear of it, and it of others, is heard on the way back.
pub(super) fn paths_tell(world: &World, readings: &Readings, sensors: &[usize]) -> bool {
    let (robot, moves) = (&world.robots()[0], world.moves());
    let mut lines: Vec<_> = (0..SENSORS)
        .map(|sensor| Line {
            at_us: vec![],
            echo_us: vec![],
            numbers: vec![],
            blanking_us: robot.blanking_of(sensor).as_micros().into(),
            window_us: robot.window.as_micros().into(),
        })
        .collect();
    for k in (0..readings.len()).filter(|&k| readings.robot[k] == 0) {
        let line = &mut lines[usize::from(readings.sensor[k])];
        line.at_us.push((1e6 * readings.fired_s[k]).round());
        line.echo_us.push(readings.earliest_us[k]);
        line.numbers.push(k);
    }
    let mut paths = BTreeMap::<_, Heard>::new();
    for (receiver, line) in lines.iter().enumerate() {
        for ((&at_us, &echo_us), &k) in line.at_us.iter().zip(&line.echo_us).zip(&line.numbers) {
            let crosstalk = Some(k).filter(|&k| readings.cause[k] == Cause::Crosstalk);
            let Some(path) = crosstalk.and_then(|k| readings.path_of(k)) else { continue };
            let sender = usize::from(path.emitter.sensor);
            // The log's firing, which the sound may be later than.
            let sent = &lines[sender].at_us;
            let logged = sent.partition_point(|&sent_us| sent_us < 1e6 * readings.emitted_s[k] + 100.0);
            let Some(&sent_us) = logged.checked_sub(1).and_then(|place| sent.get(place)) else { continue };
            paths.entry((sender, receiver, readings.path[k])).or_default().push((at_us, at_us + echo_us - sent_us));
        }
    }
    let (mut back, mut expected) = (Share { count: 0, of: 0 }, 0.0);
    let is_asked = |(sender, receiver): (usize, usize)| {
        sender != receiver && (sensors.contains(&sender) || sensors.contains(&receiver))
    };
    for ((sender, receiver, _), heard) in paths.iter().filter(|(key, _)| is_asked((key.0, key.1))) {
        if heard.len() < FEWEST {
            continue;
        }
        let there = lines[*receiver].arrivals(&lines[*sender].at_us, heard, moves);
        let and_back = lines[*sender].arrivals(&lines[*receiver].at_us, heard, moves);
        back.count += and_back.count;
        back.of += and_back.of;
        expected += f64::from(and_back.of) * there.interval_95().0;
    }
    back.of > 0 && back.interval_95().1 < expected / f64::from(back.of)
}
