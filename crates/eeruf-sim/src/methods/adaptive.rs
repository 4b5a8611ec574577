//! Rings that move along a ladder of scaled schedules as the rejection rate asks for (end of Sec. 3.1).

use eeruf_core::{
    EachSensor, EchoFilter, Instant, MAX_SENSORS, Ring, RingEvent, VerifiedSchedule, adaptation::Adaptation,
    conditions::Violation,
};

use super::ring_runner::{FiringPlan, RingRunner, RingStart, StartError, Started, TableFiring, trusting};
use crate::world::{AnySchedule, Robot};

/// A ring that moves along a ladder of schedules (end of Sec. 3.1).
struct AdaptiveRing<'s, const E: usize> {
    ring: Ring<TableFiring<'s>, EchoFilter<MAX_SENSORS, E>, MAX_SENSORS, E>,
    adaptation: Adaptation<'s, VerifiedSchedule<MAX_SENSORS, 2, EachSensor<MAX_SENSORS>>>,
}

impl<'s, const E: usize> RingRunner<'s> for AdaptiveRing<'s, E> {
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        let event = self.ring.poll_expecting(now, expected_change_us)?;
        if let RingEvent::PeriodEnded(stats) = event {
            // Every rung was verified for the ring's own t_delta and window, so this cannot fail.
            _ = self.adaptation.adapt(&stats, |schedule| self.ring.change_schedule(schedule));
        }
        Some(event)
    }

    fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    fn echo(&mut self, sensor: u8, at: Instant) {
        RingRunner::echo(&mut self.ring, sensor, at);
    }
}

/// Rungs of the adaptive method's ladder, times the schedule it starts from.
const RUNGS: [(u32, u32); 4] = [(5, 6), (1, 1), (4, 3), (5, 3)];

/// The rungs of a robot's ladder, from the schedule that it starts from.
pub(super) fn plan(robot: &Robot, base: AnySchedule) -> Result<FiringPlan, StartError> {
    let scaled = RUNGS.iter().filter_map(|&(num, den)| base.scaled(num, den).ok());
    let mut ladder: Vec<_> = scaled.filter_map(|rung| robot.verified(&rung).ok()).collect();
    if ladder.is_empty() {
        ladder.push(robot.verified(&base)?);
    }
    Ok(FiringPlan { ladder, ..FiringPlan::new(base) })
}

/// A ring on its ladder, with up to `E` echoes of a firing.
pub(super) fn adaptive<'s, const E: usize>(start: &RingStart<'s>) -> Started<'s> {
    let adaptation = Adaptation::new(&start.plan.ladder).map_err(StartError::Ladder)?;
    // A ladder has a rung.
    let ring = Ring::new(&start.plan.ladder[0], start.config().with_echoes::<E>(), start.now)?;
    Ok(Box::new(AdaptiveRing { ring: trusting(ring), adaptation }))
}

impl From<Violation> for StartError {
    fn from(violation: Violation) -> Self {
        Self::Unverified(violation)
    }
}
