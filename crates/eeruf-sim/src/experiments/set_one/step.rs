//! Time until a method sees that the back wall has come nearer or moved away.

use serde::{Deserialize, Serialize};

use crate::{
    experiments::spread::interval_95,
    results::{DEFAULT_TOLERANCE_US, Readings, quantile},
    simulation::{Entry, Options, SimulationError, simulate_in_turn},
    world::World,
};

/// Step of the back wall, in metres.
pub const STEP_M: f64 = 0.25;
/// Number of periods for which the wall stays: one more than [`NEVER`], so that steps come in every phase of a cycle.
const STAYS: u32 = 65;
/// Number of periods after which a step counts as not seen.
const NEVER: u32 = 64;
/// Least change of an echo, in microseconds, for a sensor to be counted.
const MOVED_US: f64 = 1000.0;

/// For each step and each sensor that it concerns, the period after the step in which the first right reading was
/// accepted; `None` for never.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Steps {
    /// Periods after the steps nearer.
    pub nearer: Vec<Option<u32>>,
    /// Periods after the steps away.
    pub farther: Vec<Option<u32>>,
    /// Milliseconds from the first step, which brings the wall nearer than ever, to the echo of the first accepted
    /// right reading.
    pub new_ms: Vec<Option<f64>>,
}

/// Time until steps are seen, over all steps and sensors, in periods: 1 is the period of the step.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Latency {
    /// Number of steps counted, once for each sensor concerned.
    pub steps: usize,
    /// Number of periods within which half of the steps are seen; `None` if more than half never are.
    pub median: Option<u32>,
    /// Number of periods within which nine in ten steps are seen.
    pub p90: Option<u32>,
    /// Share of the steps that are not seen within 64 periods.
    pub never: f64,
    /// 95 % confidence interval of `never`, by bootstrap over steps.
    pub never_95: [f64; 2],
}

impl Latency {
    /// Combines all steps; `None` without any.
    pub(super) fn of<'a>(steps: impl Iterator<Item = &'a Option<u32>>) -> Option<Self> {
        let mut periods: Vec<_> = steps.map(|seen| seen.map_or(f64::INFINITY, f64::from)).collect();
        if periods.is_empty() {
            return None;
        }
        let mut at = |share| Some(quantile(&mut periods, share)).filter(|at| at.is_finite()).map(|at| at as u32);
        let (median, p90) = (at(0.5), at(0.9));
        let never = |periods: &mut [f64]| {
            periods.iter().filter(|seen| seen.is_infinite()).count() as f64 / periods.len() as f64
        };
        let never_95 = interval_95(&periods, never);
        Some(Self { steps: periods.len(), median, p90, never: never(&mut periods), never_95 })
    }
}

/// Time until a wall is seen that comes nearer for the first time, when memory of places does not help: milliseconds
/// from the step to the echo of the first accepted right reading, over all sensors concerned.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct NewStep {
    /// Number of steps counted, once for each sensor concerned.
    pub steps: usize,
    /// Time within which half of the steps are seen; `None` if more than half never are.
    pub median_ms: Option<f64>,
    /// Time within which nine in ten are seen.
    pub p90_ms: Option<f64>,
    /// Time within which nineteen in twenty are seen.
    pub p95_ms: Option<f64>,
    /// Share of the steps that are not seen within 64 periods.
    pub never: f64,
}

impl NewStep {
    /// Combines all steps; `None` without any.
    pub(super) fn of<'a>(steps: impl Iterator<Item = &'a Option<f64>>) -> Option<Self> {
        let mut seen: Vec<_> = steps.map(|seen| seen.unwrap_or(f64::INFINITY)).collect();
        let never = seen.iter().filter(|seen| seen.is_infinite()).count() as f64 / seen.len().max(1) as f64;
        let mut at = |share| Some(quantile(&mut seen, share)).filter(|at| at.is_finite());
        let (median_ms, p90_ms, p95_ms) = (at(0.5), at(0.9), at(0.95));
        (!seen.is_empty()).then_some(Self { steps: seen.len(), median_ms, p90_ms, p95_ms, never })
    }
}

/// Simulates a scene that changes from the first world, with the wall far away, to the second and back.
pub(super) fn steps(
    worlds: &[World; 2],
    steps: u32,
    entry: &Entry,
    options: &Options,
    go_on: impl Fn() -> bool,
) -> Result<Steps, SimulationError> {
    let options = Options { periods: STAYS.saturating_mul(steps.saturating_add(1)), ..entry.options(*options) };
    let own = entry.own(worlds[0].robots())?;
    let readings = simulate_in_turn(worlds, STAYS, entry.method(), &options, own, |_| go_on())?;
    // A world has at least one robot.
    let robot = &worlds[0].robots()[0];
    let period_s = f64::from(robot.period.as_micros()) * 1e-6;
    let mut found = Steps::default();
    for sensor in 0..robot.sensors.len() {
        seen(&readings, sensor, steps, period_s, &mut found);
    }
    Ok(found)
}

/// Adds one sensor's results of all steps to `found`.
fn seen(readings: &Readings, sensor: usize, steps: u32, period_s: f64, found: &mut Steps) {
    let of_sensor: Vec<_> = (0..readings.len()).filter(|&n| usize::from(readings.sensor[n]) == sensor).collect();
    for step in 1..=steps {
        let at_s = f64::from(step * STAYS) * period_s;
        let (before, after) = of_sensor.split_at(of_sensor.partition_point(|&n| readings.fired_s[n] < at_s));
        let reference = |n: Option<&usize>| n.map_or(f64::NAN, |&n| readings.reference_us[n]);
        let moved = reference(after.first()) - reference(before.last());
        // A step does not count either if the echo comes or goes.
        if !(moved.abs() > MOVED_US) {
            continue;
        }
        let is_right = |&&n: &&usize| readings.is_accepted(n) && !readings.is_wrong(n, DEFAULT_TOLERANCE_US);
        let right = after.iter().find(is_right).copied();
        let periods = right.map(|n| ((readings.fired_s[n] - at_s) / period_s) as u32 + 1);
        if step == 1 {
            let heard_ms = |n: usize| 1e3 * (readings.fired_s[n] - at_s) + 1e-3 * readings.t_echo_us[n];
            found.new_ms.push(right.filter(|_| periods <= Some(NEVER)).map(heard_ms));
        }
        let list = if moved < 0.0 { &mut found.nearer } else { &mut found.farther };
        list.push(periods.filter(|&periods| periods <= NEVER));
    }
}
