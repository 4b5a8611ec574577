//! A scene under a firing method: the readings of the sensors, and their quality.

use eeruf_core::ReadingKind;
use eeruf_sim::{
    Attribution, Cause, DEFAULT_TOLERANCE_US, Method, Options, Point, Readings, SimulationError, Summary, World,
    shortest_schedule_for, simulate_while,
};
use serde::Serialize;

use crate::progress::progress;
use crate::trace::pairs;

/// Budget of nodes for the search for `eeruf_best`, as in `eeruf study`.
const BUDGET: u64 = 20_000;
/// The largest number of periods.
const MAX_PERIODS: u32 = 100_000;

/// A run of a robot's ring. Sensors from 0.
#[derive(Serialize)]
pub(crate) struct Run {
    summary: Summary,
    duration_s: f64,
    /// Sensors that never had a reading accepted.
    blind: Vec<usize>,
    /// Counts for each sensor: readings, accepted and right ones, accepted and wrong ones.
    tally: Vec<[u32; 3]>,
    /// Sources of wrong readings, the commonest first.
    fooled: Vec<Attribution>,
    /// The readings of the first seconds, as arrays of equal length.
    readings: Shown,
    /// The paths that their sound took.
    paths: Vec<ShownPath>,
}

#[derive(Default, Serialize)]
struct Shown {
    sensor: Vec<u8>,
    period: Vec<u32>,
    phase: Vec<u8>,
    fired_s: Vec<f64>,
    /// `null` for no echo.
    t_echo_us: Vec<f64>,
    /// Readings of the sensor alone; `null` for no echo.
    reference_us: Vec<f64>,
    /// One of `accepted`, `rejected`, `none` (nothing heard, believed or not), `first` (not yet compared).
    verdict: Vec<&'static str>,
    /// True if the reading was believed and is off by more than the tolerance.
    wrong: Vec<bool>,
    cause: Vec<Cause>,
    /// The path in `paths`; `null` for none.
    path: Vec<Option<u32>>,
    emitted_s: Vec<f64>,
}

#[derive(Serialize)]
struct ShownPath {
    emitter: u8,
    receiver: u8,
    order: u32,
    length_m: f64,
    corners: Vec<[f64; 2]>,
}

/// Simulates this many of the robot's periods, and shows the readings of the first `shown_s` seconds.
pub(crate) fn run(world: &World, method: Method, periods: u32, shown_s: f64) -> Result<Run, String> {
    if !(1..=MAX_PERIODS).contains(&periods) {
        return Err(format!("{periods} periods; expected 1 to {MAX_PERIODS}"));
    }
    let [robot] = world.robots() else { return Err(format!("{} robots; expected one", world.robots().len())) };
    let best = if method == Method::EerufBest {
        let keep_going = |at: &eeruf_core::search::Progress| {
            progress(f64::NAN, at.nodes as f64);
            true
        };
        let best = shortest_schedule_for(robot, BUDGET, keep_going).map_err(|error| error.to_string())?;
        Some(best.schedule)
    } else {
        None
    };
    let options = Options { best, ..Options::periods(periods) };
    let keep_going = |share| {
        progress(share, f64::NAN);
        true
    };
    let readings = simulate_while(world, method, &options, keep_going).map_err(|error| sentence(&error))?;
    let sensors = robot.sensors.len();
    let mut tally = vec![[0; 3]; sensors];
    for reading in 0..readings.len() {
        let counts = &mut tally[usize::from(readings.sensor[reading])];
        counts[0] += 1;
        if readings.is_accepted(reading) {
            counts[1 + usize::from(readings.is_wrong(reading, DEFAULT_TOLERANCE_US))] += 1;
        }
    }
    Ok(Run {
        summary: readings.summary(),
        duration_s: readings.duration_s,
        blind: (0..sensors).filter(|&sensor| tally[sensor][1] + tally[sensor][2] == 0).collect(),
        tally,
        fooled: readings.attribution(DEFAULT_TOLERANCE_US),
        readings: first_readings(&readings, shown_s),
        paths: shown_paths(world, &readings),
    })
}

/// Returns the simulation's error without the robot's number, since there is only one robot.
fn sentence(error: &SimulationError) -> String {
    error.to_string().trim_start_matches("robot 1, ").to_owned()
}

fn first_readings(readings: &Readings, until_s: f64) -> Shown {
    let mut shown = Shown::default();
    for reading in (0..readings.len()).filter(|&reading| readings.fired_s[reading] < until_s) {
        shown.sensor.push(readings.sensor[reading]);
        shown.period.push(readings.period[reading]);
        shown.phase.push(readings.phase[reading]);
        shown.fired_s.push(readings.fired_s[reading]);
        shown.t_echo_us.push(readings.t_echo_us[reading]);
        shown.reference_us.push(readings.reference_us[reading]);
        shown.verdict.push(match readings.kind[reading] {
            ReadingKind::Accepted => "accepted",
            ReadingKind::Clear | ReadingKind::NoEcho => "none",
            ReadingKind::Rejected | ReadingKind::Ambiguous => "rejected",
            _ => "first",
        });
        shown.wrong.push(readings.is_wrong(reading, DEFAULT_TOLERANCE_US));
        shown.cause.push(readings.cause[reading]);
        shown.path.push(readings.path_of(reading).map(|_| readings.path[reading]));
        shown.emitted_s.push(readings.emitted_s[reading]);
    }
    shown
}

fn shown_paths(world: &World, readings: &Readings) -> Vec<ShownPath> {
    let sensors: Vec<Point> = world.sensors(0, 0.0).map(|pose| Point::from(pose.translation.vector)).collect();
    let corners = |emitter: u8, receiver: u8, bounces: &[eeruf_sim::Bounce]| {
        let ends = (sensors.get(usize::from(emitter))?, sensors.get(usize::from(receiver))?);
        Some(pairs(&world.scene().bounce_points(*ends.0, *ends.1, bounces)?))
    };
    let paths = readings.paths.iter().map(|path| {
        let (emitter, receiver) = (path.emitter.sensor, path.receiver.sensor);
        let corners = corners(emitter, receiver, &path.bounces).unwrap_or_default();
        ShownPath { emitter, receiver, order: path.order, length_m: path.length_m, corners }
    });
    paths.collect()
}
