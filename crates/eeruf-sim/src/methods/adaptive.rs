//! Rings that move along a ladder of scaled schedules with the rejection rate (end of Sec. 3.1).

use std::sync::Arc;

use eeruf_core::{
    EachSensor, Instant, MAX_SENSORS, Ring, RingEvent, VerifiedSchedule, adaptation::OnLadder, conditions::Violation,
};

use super::judges::RunningJudge;
use super::ring_runner::{self, FiringPlan, REMEMBERED, RingRunner, RingStart, SimulatedTable, StartError, Started};
use crate::world::{AnySchedule, Robot};

type Rung = VerifiedSchedule<MAX_SENSORS, 2, EachSensor<MAX_SENSORS>>;

/// A ring that moves along a ladder of schedules (end of Sec. 3.1).
#[derive(Clone)]
struct AdaptiveRing<const E: usize> {
    ring: Ring<SimulatedTable, RunningJudge<MAX_SENSORS, E>, MAX_SENSORS, E, REMEMBERED>,
    adaptation: OnLadder<Arc<[Rung]>>,
}

impl<const E: usize> RingRunner for AdaptiveRing<E> {
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        let event = self.ring.poll_expecting(now, expected_change_us)?;
        if let RingEvent::PeriodEnded(stats) = event {
            // Every rung was verified for the ring's own `t_delta` and window, so this cannot fail.
            let rungs = Arc::clone(self.adaptation.rungs());
            _ = self.adaptation.adapt_to(&stats, |rung| {
                self.ring.change_to(Arc::new(*rungs[rung].schedule()), *rungs[rung].own_limits())
            });
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

    fn copy(&self) -> Option<Box<dyn RingRunner>> {
        Some(Box::new(self.clone()))
    }
}

/// Rungs of the adaptive method's ladder, as multiples of the first schedule's period.
const RUNGS: [(u32, u32); 4] = [(5, 6), (1, 1), (4, 3), (5, 3)];

/// Plans the rungs of a robot's ladder, given its first schedule.
pub(super) fn plan(robot: &Robot, base: AnySchedule) -> Result<FiringPlan, StartError> {
    let scaled = RUNGS.iter().filter_map(|&(num, den)| base.scaled(num, den).ok());
    let mut ladder: Vec<_> = scaled.filter_map(|rung| robot.verified(&rung).ok()).collect();
    if ladder.is_empty() {
        ladder.push(robot.verified(&base)?);
    }
    Ok(FiringPlan { ladder, ..FiringPlan::new(base) })
}

/// Makes a ring on its ladder, with up to `E` echoes of a firing.
pub(super) fn ring<const E: usize>(start: &RingStart<'_>) -> Started {
    let &RingStart { robot, plan, ref judging, now, .. } = start;
    let adaptation = OnLadder::new(Arc::<[Rung]>::from(&plan.ladder[..])).map_err(StartError::Ladder)?;
    // A ladder has at least one rung.
    let lowest = &adaptation.rungs()[0];
    let plan = SimulatedTable::holding(Arc::new(*lowest.schedule()), *lowest.own_limits(), now);
    Ok(Box::new(AdaptiveRing::<E> { ring: ring_runner::ring(plan, robot, judging, now)?, adaptation }))
}

impl From<Violation> for StartError {
    fn from(violation: Violation) -> Self {
        Self::Unverified(violation)
    }
}
