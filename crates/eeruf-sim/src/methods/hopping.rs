//! A ring that hops in time: core's own, for a robot.

use eeruf_core::{
    HoppingCode, HoppingListening, HoppingRing, HoppingSchedule, Instant, MAX_SENSORS, Micros, RingEvent, Weighed,
};

use super::ring_runner::{RingRunner, RingStart, Started};
use crate::world::Robot;

/// By how much crosstalk moves at least from phase to phase: 90 us more than the tracker's `T_delta`, for jitter and
/// lateness.
const STEP: Micros = Micros::new(240);

impl<const K: usize, const H: usize> RingRunner<'_> for HoppingRing<K, H> {
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        self.poll_expecting(now, expected_change_us)
    }

    fn next_deadline(&self) -> Instant {
        HoppingRing::next_deadline(self)
    }

    fn echo(&mut self, sensor: u8, at: Instant) {
        // A ring is as large as its robot's.
        _ = HoppingRing::echo(self, sensor, at);
    }

    fn weighed(&self, sensor: u8, expected_change_us: i32) -> Option<Weighed> {
        HoppingRing::weighed(self, sensor, expected_change_us)
    }
}

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
    // Each phase gives one vote.
    let code = HoppingCode::new(sensors.len(), start.hopping.tracker.votes, STEP)?;
    let schedule = HoppingSchedule::<K>::spread(code, period, neighbours)?;
    let settings = start.hopping.with_neighbours(neighbours);
    let listening = HoppingListening::new(window).with_blanking(blanking);
    let seed = start.random.of(0).bits() as u32;
    Ok(Box::new(HoppingRing::<K>::new(&schedule, settings, listening, seed, start.now)?))
}
