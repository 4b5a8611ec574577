//! Core's own [`Ring`], with any plan, judge and number of echoes, behind one trait: the code of the target under
//! simulated time. It owns its schedule, so that it can be copied.

use std::sync::Arc;

use eeruf_core::{
    EachSensor, Instant, MAX_SENSORS, Micros, Ring, RingConfig, RingError, RingEvent, ScheduleError, Silence,
    VerifiedSchedule,
    conditions::Violation,
    flow::InTurn,
    judge::Judge,
    plan::{Plan, Refiring, TableFiring},
};

use super::adaptive;
use super::firing::{FiringMethod, OwnError, PeriodFiring};
use super::flow::FlowOptions;
use super::judges::{Judging, RunningJudge};
use super::method::MAX_ECHOES;
use super::schedules;
use crate::world::{AnySchedule, Random, Robot};

/// A ring of any kind.
pub(crate) trait RingRunner: Send {
    /// Returns the ring's next event, if any. `expected_change_us` gives the expected change of a good reading.
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent>;
    /// Returns the time of the next poll.
    fn next_deadline(&self) -> Instant;
    /// Reports a sensor's echo.
    fn echo(&mut self, sensor: u8, at: Instant);
    /// Returns the number of firings since the one whose echo a sensor's last reading reports.
    fn stands_for(&self, sensor: u8) -> u8;
    /// Reports the robot's speed and rate of turn.
    fn moving(&mut self, _speed_mm_s: u32, _turn_mrad_s: u32, _now: Instant) {}
    /// Changes to another schedule, for the same number of sensors, at the end of the current period.
    fn change_schedule(&mut self, _schedule: &AnySchedule) -> Result<(), ChangeError> {
        Err(ChangeError::Fixed)
    }
    /// Returns the reason why the ring no longer fires, if it has stopped.
    fn error(&self) -> Option<&OwnError> {
        None
    }
    /// Returns a ring in the same state; `None` if its firing method cannot be copied.
    fn copy(&self) -> Option<Box<dyn RingRunner>>;
}

/// Reason why a ring cannot change to another schedule.
#[derive(Clone, Copy, Debug)]
pub(crate) enum ChangeError {
    /// The ring's firing method has no schedule to change.
    Fixed,
    /// The ring cannot listen as requested.
    Ring(RingError),
}

/// Operations of a plan that the simulator needs beyond those of a ring.
pub(super) trait SimulatedPlan: Plan + Clone + Send + 'static {
    /// Changes a ring to another schedule.
    fn change<J: Judge, const K: usize, const E: usize, const H: usize>(
        _ring: &mut Ring<Self, J, K, E, H>,
        _schedule: &AnySchedule,
    ) -> Result<(), ChangeError> {
        Err(ChangeError::Fixed)
    }
    /// Returns the reason why the plan no longer fires: see [`RingRunner::error`].
    fn error(&self) -> Option<&OwnError> {
        None
    }
    /// Returns true if a clone fires in the same way.
    fn copies(&self) -> bool {
        true
    }
}

impl SimulatedPlan for SimulatedTable {
    fn change<J: Judge, const K: usize, const E: usize, const H: usize>(
        ring: &mut Ring<Self, J, K, E, H>,
        schedule: &AnySchedule,
    ) -> Result<(), ChangeError> {
        ring.change_to(Arc::new(*schedule), EachSensor::NONE).map_err(ChangeError::Ring)
    }
}

impl<const K: usize> SimulatedPlan for InTurn<K> {}

impl SimulatedPlan for PeriodFiring {
    fn error(&self) -> Option<&OwnError> {
        PeriodFiring::error(self)
    }

    fn copies(&self) -> bool {
        PeriodFiring::copies(self)
    }
}

impl SimulatedPlan for Refiring<Arc<AnySchedule>, MAX_SENSORS> {}

impl<P, J, const K: usize, const E: usize, const H: usize> RingRunner for Ring<P, J, K, E, H>
where
    P: SimulatedPlan,
    J: Judge + Clone + Send + 'static,
{
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        self.poll_expecting(now, expected_change_us)
    }

    fn next_deadline(&self) -> Instant {
        Ring::next_deadline(self)
    }

    fn echo(&mut self, sensor: u8, at: Instant) {
        // The ring is as large as its robot's, so this cannot fail.
        _ = Ring::echo(self, sensor, at);
    }

    fn stands_for(&self, sensor: u8) -> u8 {
        self.judge().stands_for(sensor)
    }

    fn moving(&mut self, speed_mm_s: u32, turn_mrad_s: u32, now: Instant) {
        Ring::moving(self, speed_mm_s, turn_mrad_s, now);
    }

    fn change_schedule(&mut self, schedule: &AnySchedule) -> Result<(), ChangeError> {
        P::change(self, schedule)
    }

    fn error(&self) -> Option<&OwnError> {
        self.plan().error()
    }

    fn copy(&self) -> Option<Box<dyn RingRunner>> {
        self.plan().copies().then(|| Box::new(self.clone()) as _)
    }
}

/// Firing by a table, for sensors with equal or different limits.
pub(super) type SimulatedTable = TableFiring<Arc<AnySchedule>, MAX_SENSORS, 2, EachSensor<MAX_SENSORS>>;

/// The plan of a robot's ring.
pub(crate) struct FiringPlan {
    /// The schedule that the method uses.
    pub(crate) schedule: AnySchedule,
    /// The schedules to which an adaptive ring may change, the first one first.
    pub(crate) ladder: Vec<VerifiedSchedule<MAX_SENSORS, 2, EachSensor<MAX_SENSORS>>>,
    /// Limits of each sensor, if they are not all alike.
    pub(crate) own_limits: EachSensor<MAX_SENSORS>,
}

impl FiringPlan {
    /// Makes a plan with one schedule, for sensors that are alike.
    pub(crate) const fn new(schedule: AnySchedule) -> Self {
        Self { schedule, ladder: vec![], own_limits: EachSensor::NONE }
    }
}

/// Settings for starting a ring.
pub(crate) struct RingStart<'s> {
    pub(crate) robot: &'s Robot,
    pub(crate) plan: &'s FiringPlan,
    pub(crate) judging: Judging,
    /// Settings of a flow ring.
    pub(crate) flow: FlowOptions,
    pub(crate) random: Random,
    pub(crate) now: Instant,
}

/// A way of firing.
#[derive(Clone, Copy)]
pub(super) struct Way {
    /// Returns the schedule with which a robot's ring starts; for dither it has only the lags.
    pub(super) schedule: fn(&Robot, Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError>,
    /// Returns the ring's plan for the schedule with which it starts.
    pub(super) plan: fn(&Robot, AnySchedule) -> Result<FiringPlan, StartError>,
    /// Starts the ring.
    pub(super) ring: fn(&RingStart<'_>) -> Started,
    /// Returns the least time between two firings of a sensor, given by its number.
    pub(super) refire: fn(&Robot, &AnySchedule, usize) -> Micros,
}

impl Way {
    /// Firing by the robot's own schedule, or by the paper's.
    pub(super) const OWN_TABLE: Self = Self { plan: plan_own, ..Self::by_table(schedules::own) };
    /// Immediate refiring.
    pub(super) const IMMEDIATE: Self =
        Self { ring: immediate, refire: |robot, _, _| robot.min_refire, ..Self::by_table(schedules::refiring) };

    /// Makes a way with one schedule, which also sets the least time between two firings of a sensor.
    pub(super) const fn by_table(
        schedule: fn(&Robot, Option<&AnySchedule>) -> Result<AnySchedule, ScheduleError>,
    ) -> Self {
        Self {
            schedule,
            plan: |_, schedule| Ok(FiringPlan::new(schedule)),
            ring: scheduled,
            refire: |_, schedule, sensor| schedules::soonest_refire(schedule, sensor),
        }
    }
}

/// Reason why a ring cannot be started.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum StartError {
    /// The ring cannot listen as requested.
    Ring(RingError),
    /// No schedule of the ladder keeps `t_delta` and window.
    Unverified(Violation),
    /// The schedules do not form a ladder.
    Ladder(ScheduleError),
    /// The first period cannot be fired.
    Own(OwnError),
}

impl From<RingError> for StartError {
    fn from(error: RingError) -> Self {
        Self::Ring(error)
    }
}

/// A running ring, or the error that prevented it.
pub(crate) type Started = Result<Box<dyn RingRunner>, StartError>;

/// Returns the settings by which a robot's ring listens and compares.
pub(super) fn config_of(robot: &Robot) -> RingConfig {
    let &Robot { t_delta, window, blanking, consecutive, .. } = robot;
    let mut listens = RingConfig::new().with_t_delta(t_delta).with_window(window).with_blanking(blanking);
    listens.path_change = robot.path_change;
    listens.with_consecutive(consecutive)
}

/// Number of remembered firings of each sensor, for judges that check explanations.
pub(super) const REMEMBERED: usize = 4;
/// Number of remembered firings with immediate refiring, where a sensor may fire many times while another listens once.
const REFIRED: usize = 16;

/// Makes silence count as witnessed: a simulated sensor that hears nothing has listened.
pub(super) fn trusting<P: Plan, J: Judge, const K: usize, const E: usize, const H: usize>(
    mut ring: Ring<P, J, K, E, H>,
) -> Ring<P, J, K, E, H> {
    ring.set_silence(Silence::Trusted);
    ring
}

/// Starts a robot's ring with this plan that remembers `H` firings of each sensor. The ring is no larger than needed,
/// since some steps take time for each possible sensor.
pub(super) fn run<P: SimulatedPlan, const H: usize>(
    plan: P,
    robot: &Robot,
    judging: &Judging,
    now: Instant,
) -> Started {
    Ok(match (judging.echoes, robot.sensors.len()) {
        (..=1, ..=8) => Box::new(ring::<P, 8, 1, H>(plan, robot, judging, now)?),
        (..=1, 9..=24) => Box::new(ring::<P, 24, 1, H>(plan, robot, judging, now)?),
        (..=1, _) => Box::new(ring::<P, MAX_SENSORS, 1, H>(plan, robot, judging, now)?),
        _ => Box::new(ring::<P, MAX_SENSORS, MAX_ECHOES, H>(plan, robot, judging, now)?),
    })
}

/// Makes a ring with room for `K` sensors and `E` echoes.
pub(super) fn ring<P: Plan, const K: usize, const E: usize, const H: usize>(
    plan: P,
    robot: &Robot,
    judging: &Judging,
    now: Instant,
) -> Result<Ring<P, RunningJudge<K, E>, K, E, H>, RingError> {
    let config = config_of(robot);
    let judge = RunningJudge::new(judging, &config)?;
    Ok(trusting(Ring::judged_by(plan, judge, config.with_echoes(), now)?))
}

/// Starts scheduled firing, along a ladder if there is one.
fn scheduled(start: &RingStart<'_>) -> Started {
    let &RingStart { robot, plan, ref judging, now, .. } = start;
    match judging.echoes {
        _ if plan.ladder.is_empty() => {
            let plan = TableFiring::holding(Arc::new(plan.schedule), plan.own_limits, now);
            run::<_, REMEMBERED>(plan, robot, judging, now)
        }
        ..=1 => adaptive::ring::<1>(start),
        _ => adaptive::ring::<MAX_ECHOES>(start),
    }
}

/// Plans the robot's own schedule, with the limits of each sensor if they are not all alike.
fn plan_own(robot: &Robot, schedule: AnySchedule) -> Result<FiringPlan, StartError> {
    if !robot.is_uneven() {
        return Ok(FiringPlan::new(schedule));
    }
    let own_limits = *robot.verified(&schedule)?.own_limits();
    Ok(FiringPlan { own_limits, ..FiringPlan::new(schedule) })
}

/// Starts immediate refiring.
fn immediate(start: &RingStart<'_>) -> Started {
    let &RingStart { robot, plan, ref judging, now, .. } = start;
    run::<_, REFIRED>(Refiring::new(Arc::new(plan.schedule), robot.min_refire, now), robot, judging, now)
}

/// Starts a robot's ring that fires as planned, with at least `refire` between two firings of a sensor.
pub(crate) fn planned(
    firing: Box<dyn FiringMethod>,
    robot: &Robot,
    judging: &Judging,
    refire: Micros,
    now: Instant,
) -> Started {
    let plan = PeriodFiring::new(firing, robot.sensors.len(), refire, now);
    if let Some(error) = plan.error() {
        return Err(StartError::Own(error.clone()));
    }
    run::<_, REMEMBERED>(plan, robot, judging, now)
}
