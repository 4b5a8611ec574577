//! A ring whose periods are planned one by one, by a method or by the caller's own code.

use eeruf_core::{Instant, MAX_SENSORS, Micros, Ring, RingEvent};

use super::firing::{Firing, OwnError, PeriodFiring};
use super::ring_runner::{RingRunner, StartError, Started, config_of};
use crate::world::Robot;

/// A robot's ring that fires as it is planned, no sensor again within `refire` of firing, with up to `E` echoes of a
/// firing and a memory of `H` firings of each sensor.
pub(super) fn planned<'s, const E: usize, const H: usize>(
    robot: &Robot,
    firing: Box<dyn Firing>,
    refire: Micros,
    now: Instant,
) -> Started<'s> {
    let scheduler = PeriodFiring::new(firing, robot.sensors.len(), refire, now);
    if let Some(error) = scheduler.error() {
        return Err(StartError::Own(error.clone()));
    }
    let ring = Ring::<_, MAX_SENSORS, E, H>::remembering(scheduler, config_of(robot).with_echoes::<E>(), now)?;
    Ok(Box::new(PlannedRing::new(ring)))
}

/// Core's ring with the scheduler of a plan.
struct PlannedRing<const K: usize, const E: usize, const H: usize> {
    ring: Ring<PeriodFiring, K, E, H>,
    /// The number of the present period, and of that in which each sensor last fired: their phases do not say so.
    period: u32,
    fired_in: Vec<u32>,
}

impl<const K: usize, const E: usize, const H: usize> PlannedRing<K, E, H> {
    fn new(ring: Ring<PeriodFiring, K, E, H>) -> Self {
        let fired_in = vec![0; ring.sensors()];
        Self { ring, period: 0, fired_in }
    }
}

impl<const K: usize, const E: usize, const H: usize> RingRunner<'_> for PlannedRing<K, E, H> {
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        let mut event = self.ring.poll_expecting(now, expected_change_us)?;
        match &mut event {
            RingEvent::Fire { sensor, .. } => {
                if let Some(fired_in) = self.fired_in.get_mut(usize::from(*sensor)) {
                    *fired_in = self.period;
                }
            }
            RingEvent::Reading(reading) => {
                if let Some(&fired_in) = self.fired_in.get(usize::from(reading.sensor)) {
                    reading.period = fired_in;
                }
            }
            RingEvent::PeriodEnded(_) => self.period = self.period.wrapping_add(1),
        }
        Some(event)
    }

    fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    fn echo(&mut self, sensor: u8, at: Instant) {
        // A ring is as large as its robot's.
        _ = self.ring.echo(sensor, at);
    }

    fn error(&self) -> Option<&OwnError> {
        self.ring.scheduler().error()
    }
}
