//! A ring that hops in time: core's own, for a robot.

use eeruf_core::{
    Criterion, EachSensor, MAX_SENSORS, Micros, Requirements,
    hopping::{HoppingCode, HoppingListening, HoppingRing, HoppingSchedule},
};

use super::ring_runner::{RingStart, StartError, Started};
use crate::world::Robot;

/// The least shift of crosstalk from phase to phase: 90 us more than the tracker's `T_delta`, for jitter and lateness.
const STEP: Micros = Micros::new(240);

/// Least share of a period for each sensor, unless the robot drives: with less, more crosstalk comes first and what is
/// believed is right for less of the time (docs/explanation/hopping.md).
const TURN_US: u32 = 10_000;

/// A hopping ring, no larger than needed.
pub(super) fn hopping<'s>(start: &RingStart<'s>) -> Started<'s> {
    if let Some(given) = start.hopping_schedule.as_ref().filter(|_| start.robot.is_uneven()) {
        return uneven(start, given);
    }
    match start.robot.sensors.len() {
        ..=8 => ring::<8>(start),
        9..=24 => ring::<24>(start),
        _ => ring::<MAX_SENSORS>(start),
    }
}

fn ring<'s, const K: usize>(start: &RingStart<'s>) -> Started<'s> {
    let Robot { ref sensors, period, window, blanking, neighbours, .. } = *start.robot;
    let schedule = if let Some(given) = start.hopping_schedule {
        of_all(&given, sensors.len())?;
        let lags = core::array::from_fn(|sensor| given.t_lag(sensor).unwrap_or_default());
        HoppingSchedule::<K>::new(*given.code(), given.period(), lags)?
    } else {
        // Each phase gives one vote.
        let code = HoppingCode::new(sensors.len(), start.hopping.tracker.votes, STEP)?;
        let stands = start.hopping.solo_rate > 0;
        let turns = Micros::new(if stands { TURN_US * sensors.len() as u32 } else { 0 });
        HoppingSchedule::<K>::spread(code, period.max(turns))?
    };
    let settings = start.hopping.with_neighbours(neighbours);
    let listening = HoppingListening::new(window).with_blanking(blanking);
    let seed = start.random.of(0).bits() as u32;
    Ok(Box::new(HoppingRing::<K>::hopping(&schedule, settings, listening, seed, start.now)?))
}

/// Refuses a schedule of another number of sensors.
fn of_all(given: &HoppingSchedule<MAX_SENSORS>, sensors: usize) -> Result<(), StartError> {
    let schedule = given.code().sensors();
    if schedule == sensors { Ok(()) } else { Err(StartError::Sensors { schedule, sensors }) }
}

/// A ring that hops by the robot's limits of each sensor: the schedule must keep them, and each sensor compares by no
/// more than its own `T_delta` and the tracker's.
fn uneven<'s>(start: &RingStart<'s>, given: &HoppingSchedule<MAX_SENSORS>) -> Started<'s> {
    let Robot { ref sensors, window, blanking, .. } = *start.robot;
    of_all(given, sensors.len())?;
    let most = start.hopping.tracker.t_delta;
    let limits: EachSensor<MAX_SENSORS> = start.robot.asking(most, |requirements| {
        given.limits(&Requirements { criterion: Criterion::Margin(Micros::ZERO), blanking, ..*requirements })
    })?;
    let listening = HoppingListening::new(window).with_blanking(blanking);
    let seed = start.random.of(0).bits() as u32;
    let ring = HoppingRing::<MAX_SENSORS, 4, _>::with_limits(given, limits, start.hopping, listening, seed, start.now)?;
    Ok(Box::new(ring))
}
