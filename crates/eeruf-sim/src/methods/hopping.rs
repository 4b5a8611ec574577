//! A ring that hops in time: core's own, for a robot.

use eeruf_core::{
    MAX_SENSORS, Micros,
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
    match start.robot.sensors.len() {
        ..=8 => ring::<8>(start),
        9..=24 => ring::<24>(start),
        _ => ring::<MAX_SENSORS>(start),
    }
}

fn ring<'s, const K: usize>(start: &RingStart<'s>) -> Started<'s> {
    let Robot { ref sensors, period, window, blanking, neighbours, .. } = *start.robot;
    let schedule = if let Some(given) = start.hopping_schedule {
        if given.code().sensors() != sensors.len() {
            let (schedule, sensors) = (given.code().sensors(), sensors.len());
            return Err(StartError::Sensors { schedule, sensors });
        }
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
