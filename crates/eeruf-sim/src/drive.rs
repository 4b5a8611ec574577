//! Core's own [`Ring`], with whatever scheduler and number of echoes a method asks for, behind one face: the same code as on
//! the target, driven by simulated time.

use eeruf_core::{
    Adaptation, ImmediateRefiring, Instant, Ladder, MAX_SENSORS, Micros, Requirements, Ring, RingConfig, RingError,
    RingEvent, ScheduledFiring, ScheduledRing, Scheduler,
};

use crate::{
    detector::MAX_ECHOES,
    dither::DitherFiring,
    method::{AnySchedule, Method, widest_dither},
    noise::Chance,
    robot::Robot,
    simulate::SimulationError,
};

/// A ring of any kind.
pub(crate) trait Drive {
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent>;
    fn next_deadline(&self) -> Instant;
    fn echo(&mut self, sensor: u8, at: Instant);
}

impl<S: Scheduler, const K: usize, const E: usize> Drive for Ring<S, K, E> {
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        self.poll_expecting(now, expected_change_us)
    }

    fn next_deadline(&self) -> Instant {
        Ring::next_deadline(self)
    }

    fn echo(&mut self, sensor: u8, at: Instant) {
        Ring::echo(self, sensor, at);
    }
}

/// A ring that moves along a ladder of schedules (end of Sec. 3.1).
struct AdaptiveRing<'s> {
    ring: ScheduledRing<'s, MAX_SENSORS>,
    adaptation: Adaptation<'s, MAX_SENSORS>,
}

impl Drive for AdaptiveRing<'_> {
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

/// The schedules that a robot's ring needs, the one it starts from first in line; several for the adaptive method.
pub(crate) fn rungs(
    method: Method,
    index: usize,
    robot: &Robot,
    base: AnySchedule,
) -> Result<Vec<AnySchedule>, SimulationError> {
    if method != Method::Adaptive {
        return Ok(vec![base]);
    }
    let requirements = requirements(robot);
    let fits = |schedule: &AnySchedule| schedule.verify(&requirements).ok();
    let rungs: Vec<_> = RUNGS.iter().filter_map(|&(num, den)| base.scaled(num, den).ok()).filter(fits).collect();
    if rungs.is_empty() {
        let error = Ladder::new(&[base], &requirements).err();
        return Err(match error {
            Some(error) => SimulationError::Ladder { robot: index, error },
            None => return Ok(vec![base]),
        });
    }
    Ok(rungs)
}

fn requirements(robot: &Robot) -> Requirements<'static> {
    Requirements { window: robot.window, ..Requirements::new(robot.t_delta) }
}

/// The ring that a robot fires by under a method, from `now` on.
pub(crate) fn drive<'s>(
    method: Method,
    index: usize,
    robot: &Robot,
    rungs: &'s [AnySchedule],
    chance: Chance,
    now: Instant,
) -> Result<Box<dyn Drive + 's>, SimulationError> {
    let &Robot { t_delta, window, blanking, consecutive, patience, .. } = robot;
    let config = RingConfig { t_delta, window, blanking, consecutive, patience };
    let ring_error = |error| SimulationError::Ring { robot: index, method, error };
    // At least one rung, by construction.
    let schedule = &rungs[0];
    let sensors = robot.sensors.len();
    let made = match method {
        Method::Adaptive => {
            let ladder = Ladder::new(rungs, &requirements(robot))
                .map_err(|error| SimulationError::Ladder { robot: index, error })?;
            let ring = ScheduledRing::new(schedule, config, now).map_err(ring_error)?;
            return Ok(Box::new(AdaptiveRing { ring, adaptation: Adaptation::new(ladder) }));
        }
        Method::Dither => {
            let lags = schedule.t_lag().to_vec();
            let firing = DitherFiring::new(lags, schedule.period(), widest_dither(robot), chance, now);
            boxed::<_, 1>(sensors, firing, config, now)
        }
        Method::EerufImmediate => {
            boxed::<_, 1>(sensors, ImmediateRefiring::new(schedule, robot.min_refire, now), config, now)
        }
        Method::MultiEcho => boxed::<_, MAX_ECHOES>(sensors, ScheduledFiring::new(schedule, now), config, now),
        _ => boxed::<_, 1>(sensors, ScheduledFiring::new(schedule, now), config, now),
    };
    made.map_err(ring_error)
}

/// A ring no larger than it need be: some of its steps take time for each place.
fn boxed<'s, S: Scheduler + 's, const E: usize>(
    sensors: usize,
    scheduler: S,
    config: RingConfig,
    now: Instant,
) -> Result<Box<dyn Drive + 's>, RingError> {
    Ok(match sensors {
        ..=8 => Box::new(Ring::<S, 8, E>::with_scheduler(scheduler, config, now)?),
        9..=24 => Box::new(Ring::<S, 24, E>::with_scheduler(scheduler, config, now)?),
        _ => Box::new(Ring::<S, MAX_SENSORS, E>::with_scheduler(scheduler, config, now)?),
    })
}

/// How soon a sensor may fire again under a method.
pub(crate) fn soonest_refire(method: Method, robot: &Robot) -> Micros {
    if method == Method::EerufImmediate { robot.min_refire } else { robot.window }
}
