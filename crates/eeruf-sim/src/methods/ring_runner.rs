//! Core's own [`Ring`] of whatever plan and number of echoes behind one trait: the same code as on the target,
//! under simulated time.

use eeruf_core::{
    EachSensor, Instant, MAX_SENSORS, Micros, Ring, RingConfig, RingError, RingEvent, ScheduleError, Silence,
    VerifiedSchedule,
    conditions::Violation,
    flow::InTurn,
    judge::{AgreementRing, Judge},
    plan::{ImmediateRefiring, Plan, ScheduledFiring},
};

use super::firing::{Firing, OwnError, PeriodFiring};
use super::flow::FlowOptions;
use crate::world::{AnySchedule, Random, Robot};

/// A ring of any kind, which can change to schedules that live as long as `'s`.
pub(crate) trait RingRunner<'s>: Send {
    /// The ring's next event, if any; `expected_change_us` says by how much a good reading of a sensor should change.
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent>;
    /// When it is to be polled again.
    fn next_deadline(&self) -> Instant;
    /// A sensor hears an echo.
    fn echo(&mut self, sensor: u8, at: Instant);
    /// The robot moves at this speed, and turns at this rate.
    fn moving(&mut self, _speed_mm_s: u32, _turn_mrad_s: u32, _now: Instant) {}
    /// Changes to another schedule, of as many sensors, when the present period ends.
    fn change_schedule(&mut self, _schedule: &'s AnySchedule) -> Result<(), ChangeError> {
        Err(ChangeError::Fixed)
    }
    /// Why it no longer fires, if it does not.
    fn error(&self) -> Option<&OwnError> {
        None
    }
}

/// Why a ring cannot change to another schedule.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ChangeError {
    /// It fires by no schedule that could be changed.
    Fixed,
    /// It cannot listen as asked.
    Ring(RingError),
}

/// Demands of the simulator on a plan beyond those of a ring.
pub(super) trait SimulatedPlan<'s>: Plan + Send + Sized {
    /// Changes a ring to another schedule.
    fn change<J: Judge, const K: usize, const E: usize, const H: usize>(
        _ring: &mut Ring<Self, J, K, E, H>,
        _schedule: &'s AnySchedule,
    ) -> Result<(), ChangeError> {
        Err(ChangeError::Fixed)
    }
    /// See [`RingRunner::error`].
    fn error(&self) -> Option<&OwnError> {
        None
    }
}

impl<'s> SimulatedPlan<'s> for TableFiring<'s> {
    fn change<J: Judge, const K: usize, const E: usize, const H: usize>(
        ring: &mut Ring<Self, J, K, E, H>,
        schedule: &'s AnySchedule,
    ) -> Result<(), ChangeError> {
        ring.change_with_limits(schedule, &EachSensor::NONE).map_err(ChangeError::Ring)
    }
}

impl<const K: usize> SimulatedPlan<'_> for InTurn<K> {}

impl SimulatedPlan<'_> for PeriodFiring {
    fn error(&self) -> Option<&OwnError> {
        PeriodFiring::error(self)
    }
}

impl<'s> SimulatedPlan<'s> for ImmediateRefiring<'s, MAX_SENSORS> {}

impl<'s, P: SimulatedPlan<'s>, J: Judge + Send, const K: usize, const E: usize, const H: usize> RingRunner<'s>
    for Ring<P, J, K, E, H>
{
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        self.poll_expecting(now, expected_change_us)
    }

    fn next_deadline(&self) -> Instant {
        Ring::next_deadline(self)
    }

    fn echo(&mut self, sensor: u8, at: Instant) {
        // A ring is as large as its robot's.
        _ = Ring::echo(self, sensor, at);
    }

    fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now: Instant) {
        Ring::moving(self, speed_mm_s, turn_mrad_s, now);
    }

    fn change_schedule(&mut self, schedule: &'s AnySchedule) -> Result<(), ChangeError> {
        P::change(self, schedule)
    }

    fn error(&self) -> Option<&OwnError> {
        self.plan().error()
    }
}

/// Firing by a table, whether sensors are alike or not.
pub(super) type TableFiring<'s> = ScheduledFiring<'s, MAX_SENSORS, 2, &'s EachSensor<MAX_SENSORS>>;

/// The plan of a robot's ring.
pub(crate) struct FiringPlan {
    /// The schedule that the method asked for.
    pub(crate) schedule: AnySchedule,
    /// Where it adapts, all that it may change to, the first one first.
    pub(crate) ladder: Vec<VerifiedSchedule<MAX_SENSORS, 2, EachSensor<MAX_SENSORS>>>,
    /// Limits of each sensor, where they are not all alike.
    pub(crate) own_limits: EachSensor<MAX_SENSORS>,
}

impl FiringPlan {
    /// One schedule for sensors that are alike.
    pub(crate) const fn new(schedule: AnySchedule) -> Self {
        Self { schedule, ladder: vec![], own_limits: EachSensor::NONE }
    }
}

/// Settings that a ring is started with.
pub(crate) struct RingStart<'s> {
    pub(crate) robot: &'s Robot,
    pub(crate) plan: &'s FiringPlan,
    /// Settings of a flow ring.
    pub(crate) flow: FlowOptions,
    /// No other robot is about, or expected.
    pub(crate) alone: bool,
    pub(crate) random: Random,
    pub(crate) now: Instant,
}

/// Why a ring cannot be started.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StartError {
    /// It cannot listen as asked.
    Ring(RingError),
    /// No schedule of its ladder keeps `t_delta` and window.
    Unverified(Violation),
    /// The schedules make no ladder.
    Ladder(ScheduleError),
    /// Its first period cannot be fired.
    Own(OwnError),
}

impl From<RingError> for StartError {
    fn from(error: RingError) -> Self {
        Self::Ring(error)
    }
}

/// A running ring, if it can be started.
pub(super) type Started<'s> = Result<Box<dyn RingRunner<'s> + 's>, StartError>;

/// Settings by which a robot's ring listens and compares.
pub(super) fn config_of(robot: &Robot) -> RingConfig {
    let &Robot { t_delta, window, blanking, consecutive, .. } = robot;
    let mut listens = RingConfig::new().with_t_delta(t_delta).with_window(window).with_blanking(blanking);
    listens.path_change = robot.path_change;
    listens.with_consecutive(consecutive)
}

impl<'s> RingStart<'s> {
    /// The schedule to start with.
    pub(super) fn schedule(&self) -> &'s AnySchedule {
        &self.plan.schedule
    }

    /// Settings by which the robot's ring listens and compares.
    pub(super) fn config(&self) -> RingConfig {
        config_of(self.robot)
    }

    /// A ring of `E` echoes by this plan that remembers `H` firings of each sensor, no larger than needed: some of its
    /// steps take time for each sensor that it has room for. Its judge `ASKS` what explains a reading, or agreement
    /// alone counts.
    fn run<P: SimulatedPlan<'s> + 's, const E: usize, const H: usize, const ASKS: bool>(&self, plan: P) -> Started<'s> {
        match self.robot.sensors.len() {
            ..=8 => ring::<P, 8, E, H, ASKS>(plan, self.config(), self.now),
            9..=24 => ring::<P, 24, E, H, ASKS>(plan, self.config(), self.now),
            _ => ring::<P, MAX_SENSORS, E, H, ASKS>(plan, self.config(), self.now),
        }
    }
}

/// The judge of methods that accept what nothing foreign explains asks.
pub(super) const ASKS: bool = true;
/// That of methods that accept whatever agrees does not.
pub(super) const AGREEMENT_ALONE: bool = false;
/// The firings of each sensor that are remembered for whoever asks.
pub(super) const REMEMBERED: usize = 4;
/// The same of immediate refiring, in which a sensor may fire many times while another listens once.
const REFIRED: usize = 16;

/// A simulated sensor that hears nothing has listened.
pub(super) fn trusting<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
    mut ring: Ring<P, J, K, E, H>,
) -> Ring<P, J, K, E, H> {
    ring.set_silence(Silence::Trusted);
    ring
}

/// A ring with room for `K` sensors: see [`RingStart::run`].
pub(super) fn ring<'s, P, const K: usize, const E: usize, const H: usize, const ASKS: bool>(
    plan: P,
    config: RingConfig,
    now: Instant,
) -> Started<'s>
where
    P: SimulatedPlan<'s> + 's,
{
    let config = config.with_echoes::<E>();
    Ok(if ASKS {
        Box::new(trusting(Ring::<P, _, K, E, H>::remembering(plan, config, now)?))
    } else {
        Box::new(trusting(AgreementRing::<P, K, E>::agreement_alone(plan, config, now)?))
    })
}

/// Scheduled firing, with up to `E` echoes of a firing.
pub(super) fn scheduled<'s, const E: usize, const ASKS: bool>(start: &RingStart<'s>) -> Started<'s> {
    start.run::<_, E, REMEMBERED, ASKS>(TableFiring::with_limits(start.schedule(), &start.plan.own_limits, start.now))
}

/// The robot's own schedule, where sensors are not all alike with what each may do.
pub(super) fn plan_own(robot: &Robot, schedule: AnySchedule) -> Result<FiringPlan, StartError> {
    if !robot.is_uneven() {
        return Ok(FiringPlan::new(schedule));
    }
    let own_limits = *robot.verified(&schedule)?.own_limits();
    Ok(FiringPlan { own_limits, ..FiringPlan::new(schedule) })
}

/// Immediate refiring.
pub(super) fn immediate<'s>(start: &RingStart<'s>) -> Started<'s> {
    start.run::<_, 1, REFIRED, ASKS>(ImmediateRefiring::new(start.schedule(), start.robot.min_refire, start.now))
}

/// A robot's ring that fires as it is planned, no sensor again within `refire` of firing, with up to `E` echoes of a
/// firing; whether its judge `ASKS` what explains a reading.
pub(super) fn planned<'s, const E: usize, const ASKS: bool>(
    robot: &Robot,
    firing: Box<dyn Firing>,
    refire: Micros,
    now: Instant,
) -> Started<'s> {
    let plan = PeriodFiring::new(firing, robot.sensors.len(), refire, now);
    if let Some(error) = plan.error() {
        return Err(StartError::Own(error.clone()));
    }
    ring::<_, MAX_SENSORS, E, REMEMBERED, ASKS>(plan, config_of(robot), now)
}
