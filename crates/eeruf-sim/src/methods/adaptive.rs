//! Rings that move along a ladder of scaled schedules as the rejection rate asks for (end of Sec. 3.1).

use eeruf_core::{
    EachSensor, Instant, MAX_SENSORS, Ring, RingEvent, VerifiedSchedule, adaptation::Adaptation, conditions::Violation,
};

use super::judges::RunningJudge;
use super::ring_runner::{self, FiringPlan, REMEMBERED, RingRunner, RingStart, StartError, Started, TableFiring};
use crate::world::{AnySchedule, Robot};

/// A ring that moves along a ladder of schedules (end of Sec. 3.1).
struct AdaptiveRing<'s, const E: usize> {
    ring: Ring<TableFiring<'s>, RunningJudge<MAX_SENSORS, E>, MAX_SENSORS, E, REMEMBERED>,
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

    fn stands_for(&self, sensor: u8) -> u8 {
        RingRunner::stands_for(&self.ring, sensor)
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
pub(super) fn ring<'s, const E: usize>(start: &RingStart<'s>) -> Started<'s> {
    let &RingStart { robot, plan, ref judging, now, .. } = start;
    let adaptation = Adaptation::new(&plan.ladder).map_err(StartError::Ladder)?;
    // A ladder has a rung.
    let plan = TableFiring::verified(&plan.ladder[0], now);
    Ok(Box::new(AdaptiveRing::<E> { ring: ring_runner::ring(plan, robot, judging, now)?, adaptation }))
}

impl From<Violation> for StartError {
    fn from(violation: Violation) -> Self {
        Self::Unverified(violation)
    }
}
