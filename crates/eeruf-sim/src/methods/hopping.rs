//! Rings that hop in time: core's own, for a robot.

use eeruf_core::{
    Criterion, EachSensor, Instant, MAX_SENSORS, Micros, Requirements, RingEvent,
    adaptation::Adaptation,
    hopping::{
        HoppingCode, HoppingError, HoppingListening, HoppingPlan, HoppingRing, HoppingSchedule, HoppingSettings,
        Weighed,
    },
};

use super::adaptive::RUNGS;
use super::method::MAX_ECHOES;
use super::ring_runner::{
    FiringPlan, Hops, RingRunner, RingStart, SEVERAL_TRACKS, StartError, Started, TRACKS, trusting,
};
use crate::world::{AnySchedule, Robot};

/// The least shift of crosstalk from phase to phase: 90 us more than the tracker's `T_delta`, for jitter and lateness.
const STEP: Micros = Micros::new(240);

/// Least share of a period for each sensor, unless the robot drives: with less, more crosstalk comes first and what is
/// believed is right for less of the time (docs/explanation/hopping.md).
const TURN_US: u32 = 10_000;

/// A hopping ring, no larger than needed.
pub(super) fn hopping<'s>(start: &RingStart<'s>) -> Started<'s> {
    let RingStart { robot, hops, .. } = start;
    if keeps_limits(robot, hops) {
        let schedule = schedule_of::<MAX_SENSORS>(robot, hops)?;
        return Ok(Box::new(limited::<TRACKS, 1>(start, &schedule, own_limits(robot, hops, &schedule)?)?));
    }
    match robot.sensors.len() {
        ..=8 => ring::<8>(start),
        9..=24 => ring::<24>(start),
        _ => ring::<MAX_SENSORS>(start),
    }
}

fn ring<'s, const K: usize>(start: &RingStart<'s>) -> Started<'s> {
    let schedule = schedule_of::<K>(start.robot, &start.hops)?;
    let settings = start.hops.settings.with_neighbours(start.robot.neighbours);
    let ring = HoppingRing::<K>::hopping(&schedule, settings, listening(start.robot), seed(start), start.now)?;
    Ok(Box::new(trusting(ring)))
}

/// Returns true if its sensors have limits of their own in a schedule that may keep them.
fn keeps_limits(robot: &Robot, hops: &Hops) -> bool {
    hops.schedule.is_some() && robot.is_uneven()
}

/// The schedule that is given, for as many sensors as the robot has, or one of even lags.
fn schedule_of<const K: usize>(robot: &Robot, hops: &Hops) -> Result<HoppingSchedule<K>, StartError> {
    let sensors = robot.sensors.len();
    if let Some(given) = hops.schedule {
        let schedule = given.code().sensors();
        if schedule != sensors {
            return Err(StartError::Sensors { schedule, sensors });
        }
        let lags = core::array::from_fn(|sensor| given.t_lag(sensor).unwrap_or_default());
        return Ok(HoppingSchedule::<K>::new(*given.code(), given.period(), lags)?);
    }
    // Each phase gives one vote.
    let code = HoppingCode::new(sensors, hops.settings.tracker.votes, STEP)?;
    let stands = hops.settings.solo_rate > 0;
    let turns = Micros::new(if stands { TURN_US * sensors as u32 } else { 0 });
    Ok(HoppingSchedule::<K>::spread(code, robot.period.max(turns))?)
}

/// The robot's limits of each sensor, if the schedule keeps them; none where sensors are alike. Each compares by no
/// more than its own `T_delta` and the tracker's.
fn own_limits(
    robot: &Robot,
    hops: &Hops,
    schedule: &HoppingSchedule<MAX_SENSORS>,
) -> Result<EachSensor<MAX_SENSORS>, StartError> {
    if !keeps_limits(robot, hops) {
        return Ok(EachSensor::NONE);
    }
    let blanking = robot.blanking;
    let limits = robot.asking(hops.settings.tracker.t_delta, |requirements| {
        schedule.limits(&Requirements { criterion: Criterion::Margin(Micros::ZERO), blanking, ..*requirements })
    });
    Ok(limits?)
}

fn listening(robot: &Robot) -> HoppingListening {
    HoppingListening::new(robot.window).with_blanking(robot.blanking)
}

fn seed(start: &RingStart<'_>) -> u32 {
    start.random.of(0).bits() as u32
}

/// The settings of a ring by its robot: drawn lags keep no limits, and know the neighbours of a ring without any.
fn settings_for(start: &RingStart<'_>) -> HoppingSettings {
    let settings = start.hops.settings;
    if keeps_limits(start.robot, &start.hops) { settings } else { settings.with_neighbours(start.robot.neighbours) }
}

/// A ring with these limits.
fn limited<const H: usize, const E: usize>(
    start: &RingStart<'_>,
    schedule: &HoppingSchedule<MAX_SENSORS>,
    limits: EachSensor<MAX_SENSORS>,
) -> Result<LimitedRing<H, E>, HoppingError> {
    let (settings, listening) = (settings_for(start), listening(start.robot));
    LimitedRing::with_limits(schedule, limits, settings, listening, seed(start), start.now).map(trusting)
}

/// A ring whose sensors may have limits of their own.
type LimitedRing<const H: usize = TRACKS, const E: usize = 1> = HoppingRing<MAX_SENSORS, H, E, EachSensor<MAX_SENSORS>>;

/// A ring that hops, with sensors that report several echoes.
pub(super) fn several<'s>(start: &RingStart<'s>) -> Started<'s> {
    let schedule = schedule_of::<MAX_SENSORS>(start.robot, &start.hops)?;
    let limits = own_limits(start.robot, &start.hops, &schedule)?;
    Ok(Box::new(limited::<SEVERAL_TRACKS, MAX_ECHOES>(start, &schedule, limits)?))
}

/// The ladder of a ring that hops: what it would hop by, scaled, as far as that can be done.
pub(super) fn plan(robot: &Robot, base: AnySchedule, hops: &Hops) -> Result<FiringPlan, StartError> {
    let schedule = schedule_of::<MAX_SENSORS>(robot, hops)?;
    let own_limits = own_limits(robot, hops, &schedule)?;
    let fits = |rung: &HoppingSchedule<MAX_SENSORS>| {
        let (settings, now) = (hops.settings, Instant::default());
        let limits = self::own_limits(robot, hops, rung);
        limits.is_ok_and(|own| HoppingPlan::with_limits(rung, own, settings, listening(robot), 0, now).is_ok())
    };
    let scaled = RUNGS.iter().filter_map(|&(num, den)| schedule.scaled(num, den).ok());
    let mut hopping_ladder: Vec<_> = scaled.filter(fits).collect();
    if hopping_ladder.is_empty() {
        // Why it cannot hop is said when it starts.
        hopping_ladder.push(schedule);
    }
    Ok(FiringPlan { hopping_ladder, own_limits, ..FiringPlan::new(base) })
}

/// A ring that hops and moves along a ladder.
struct AdaptiveHoppingRing<'s> {
    ring: LimitedRing,
    adaptation: Adaptation<'s, HoppingSchedule<MAX_SENSORS>>,
}

/// A ring on the ladder of its plan.
pub(super) fn adaptive<'s>(start: &RingStart<'s>) -> Started<'s> {
    let FiringPlan { hopping_ladder, own_limits, .. } = start.plan;
    let adaptation = Adaptation::hopping(hopping_ladder).map_err(StartError::Ladder)?;
    // A ladder has a rung.
    Ok(Box::new(AdaptiveHoppingRing { ring: limited(start, &hopping_ladder[0], *own_limits)?, adaptation }))
}

impl<'s> RingRunner<'s> for AdaptiveHoppingRing<'s> {
    fn poll(&mut self, now: Instant, expected_change_us: &dyn Fn(u8) -> i32) -> Option<RingEvent> {
        let event = self.ring.poll_expecting(now, expected_change_us)?;
        if let RingEvent::PeriodEnded(stats) = event {
            // Every rung has the ring's code and was tried with its window, so this cannot fail.
            _ = self.adaptation.adapt(&stats, |schedule| self.ring.change_hopping(schedule));
        }
        Some(event)
    }

    fn next_deadline(&self) -> Instant {
        self.ring.next_deadline()
    }

    fn echo(&mut self, sensor: u8, at: Instant) {
        RingRunner::echo(&mut self.ring, sensor, at);
    }

    fn weighed(&self, sensor: u8, expected_change_us: i32) -> Option<Weighed> {
        RingRunner::weighed(&self.ring, sensor, expected_change_us)
    }
}
