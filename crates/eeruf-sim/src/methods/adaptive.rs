//! A ring that moves along a ladder of scaled schedules as the rejection rate asks for (end of Sec. 3.1).

use eeruf_core::{Adaptation, Instant, Ladder, MAX_SENSORS, Requirements, RingEvent, ScheduledRing};

use super::ring_runner::{RingRunner, RingStart, StartError, Started};
use crate::world::{AnySchedule, Robot};

/// A ring that moves along a ladder of schedules (end of Sec. 3.1).
struct AdaptiveRing<'s> {
    ring: ScheduledRing<'s, MAX_SENSORS>,
    adaptation: Adaptation<'s, MAX_SENSORS>,
}

impl RingRunner for AdaptiveRing<'_> {
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        let event = self.ring.poll_expecting(now, expected_change_us)?;
        if let RingEvent::PeriodEnded(stats) = event
            && let Some(schedule) = self.adaptation.observe(&stats)
        {
            // Every rung was checked against the window, so this cannot fail.
            _ = self.ring.change_schedule(schedule);
        }
        Some(event)
    }

    fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    fn echo(&mut self, sensor: u8, at: Instant) {
        self.ring.echo(sensor, at);
    }
}

/// What the rungs of the adaptive method's ladder are, times the schedule it starts from.
const RUNGS: [(u32, u32); 4] = [(5, 6), (1, 1), (4, 3), (5, 3)];

/// The rungs of a robot's ladder, from the schedule that it starts from.
pub(super) fn rungs(robot: &Robot, base: AnySchedule) -> Result<Vec<AnySchedule>, StartError> {
    let requirements = requirements(robot);
    let fits = |schedule: &AnySchedule| schedule.verify(&requirements).ok();
    let rungs: Vec<_> = RUNGS.iter().filter_map(|&(num, den)| base.scaled(num, den).ok()).filter(fits).collect();
    if rungs.is_empty() {
        return match Ladder::new(&[base], &requirements).err() {
            Some(error) => Err(StartError::Ladder(error)),
            None => Ok(vec![base]),
        };
    }
    Ok(rungs)
}

/// A ring on its ladder.
pub(super) fn adaptive<'s>(start: &RingStart<'s>) -> Started<'s> {
    let ladder = Ladder::new(start.schedules, &requirements(start.robot)).map_err(StartError::Ladder)?;
    let ring = ScheduledRing::new(start.schedule(), start.config(), start.now)?;
    Ok(Box::new(AdaptiveRing { ring, adaptation: Adaptation::new(ladder) }))
}

fn requirements(robot: &Robot) -> Requirements<'static> {
    Requirements { window: robot.window, ..Requirements::new(robot.t_delta) }
}
