//! One robot's running ring: core's ring, the robot's clock, and the times of its next events.

use std::sync::Arc;

use eeruf_core::{EachSensor, Micros, flow::BeliefSettings};

use super::own::Own;
use crate::simulation::channels::Channels;
use crate::simulation::error::SimulationError;
use crate::simulation::kinematics::Kinematics;
use crate::simulation::options::Options;
use crate::simulation::receiver::{Hearing, NEVER};
use crate::{
    geometry::Pose,
    methods::{FiringPlan, Judging, MAX_MEDIAN, Method, RingRunner, RingStart, planned},
    world::{FaultKind, Random, Robot, Ticker, World},
};

/// Purpose of the stream of random numbers.
const DITHER: u64 = 3;

/// A running ring.
pub(crate) struct RunningRing {
    pub(crate) world: Arc<World>,
    /// The number of the ring's robot.
    pub(crate) robot: usize,
    pub(crate) ring: Box<dyn RingRunner>,
    pub(crate) clock: Ticker,
    /// Hearing of each sensor.
    hearings: Vec<Hearing>,
    /// The range of the ring's sensors among all sensors of the world.
    pub(crate) sensors: core::ops::Range<usize>,
    /// Time when the ring is due.
    pub(crate) wakes: u64,
    /// Time when a sensor of the ring next hears something.
    pub(crate) hears: u64,
    /// Time when the control loop next reports the robot's motion.
    pub(crate) tells: u64,
}

impl RunningRing {
    /// Returns a ring in the same state; `None` if its firing method cannot be copied.
    pub(crate) fn copy(&self) -> Option<Self> {
        let (world, hearings, sensors) = (Arc::clone(&self.world), self.hearings.clone(), self.sensors.clone());
        Some(Self { world, ring: self.ring.copy()?, hearings, sensors, ..*self })
    }

    /// Returns the hearing of a sensor, given by its number in the world.
    pub(crate) fn hearing_of(&self, number: usize) -> &Hearing {
        // The ring has one entry for each of its sensors.
        &self.hearings[number - self.sensors.start]
    }

    /// Returns the longest listening time of the ring's sensors.
    pub(crate) fn longest_window(&self) -> u64 {
        self.hearings.iter().map(|hearing| hearing.window).max().unwrap_or(0)
    }
}

/// A robot's method, judge and plan; no plan if the caller's own code fires.
pub(crate) struct Plan {
    pub(crate) method: Method,
    judging: Judging,
    pub(crate) firing: Option<FiringPlan>,
}

/// Returns the plan of each robot, except those that fire by the caller's `own`.
pub(crate) fn plans(
    world: &World,
    method: Method,
    options: &Options,
    kinematics: &impl Kinematics,
    own: &Own,
) -> Result<Vec<Plan>, SimulationError> {
    if !(1..=MAX_MEDIAN).contains(&usize::from(options.median_of)) {
        return Err(SimulationError::Median { median_of: options.median_of });
    }
    let (asked, robots) = (method.judge(), world.robots());
    let plan = |(index, robot): (usize, &Robot)| {
        let method = kinematics.method(index, method);
        let judging = Judging {
            kind: method.judge().of_robot(asked, robot, own.filters(index)),
            median_of: options.median_of,
            belief: BeliefSettings {
                alone: robots.len() == 1 && !robot.others,
                ..options.flow.belief.unwrap_or_default()
            },
            echoes: method.echoes(),
        };
        if own.fires(index) {
            return Ok(Plan { method, judging, firing: None });
        }
        let first = method.schedule(robot, options.best.as_ref()).map_err(|error| SimulationError::Schedule {
            robot: index,
            method,
            error,
        })?;
        let plan = method.plan(robot, first).map_err(|error| SimulationError::start(index, method, error))?;
        Ok(Plan { method, judging, firing: Some(plan) })
    };
    robots.iter().enumerate().map(plan).collect()
}

/// Starts every robot's ring as planned; if `keeps_schedules`, no schedule changes later.
pub(crate) fn start_all(
    world: &Arc<World>,
    plans: &[Plan],
    options: &Options,
    channels: &Channels,
    seed: Random,
    own: &mut Own,
    keeps_schedules: bool,
) -> Result<Vec<RunningRing>, SimulationError> {
    let steady = keeps_schedules && world.faults().is_empty();
    let mut rings = Vec::with_capacity(plans.len());
    for (index, (robot, Plan { method, judging, firing: plan })) in world.robots().iter().zip(plans).enumerate() {
        let mut clock = Ticker::new(robot.clock);
        for fault in world.faults().iter().filter(|fault| fault.robot == index) {
            if let FaultKind::ClockDrift { ppm } = fault.kind {
                let ns = |time_s: f64| if time_s.is_finite() { (time_s * 1e9).round() as u64 } else { NEVER };
                clock = clock.drifting(ppm, ns(fault.from_s), ns(fault.to_s));
            }
        }
        let start = u64::from(robot.start.as_micros());
        let random = seed.of(DITHER).of(index as u64);
        let now = clock.instant(start);
        let ring = match (plan, own.take_firing(index)) {
            (Some(plan), None) => {
                method.start(&RingStart { robot, plan, judging: *judging, flow: options.flow, random, now })
            }
            (_, Some(firing)) => planned(firing, robot, judging, robot.window, now),
            // Every robot has either a plan or its own firing.
            (None, None) => continue,
        };
        let ring = ring.map_err(|error| SimulationError::start(index, *method, error))?;
        let true_ns = |time: Micros| clock.true_ns(time.as_micros());
        let soonest = |sensor: usize| match plan {
            Some(plan) if steady => method.soonest_refire(robot, &plan.schedule, sensor),
            Some(plan) => method.soonest_refire(robot, &plan.schedule, sensor).min(robot.window),
            None => robot.window,
        };
        let first = channels.first_of(index);
        let sensors = first..first + robot.sensors.len();
        let keeps_limits = |plan: &FiringPlan| plan.own_limits != EachSensor::NONE || !plan.ladder.is_empty();
        let has_limits = plan.as_ref().is_some_and(keeps_limits);
        let limits = if has_limits { &robot.limits[..] } else { &[] };
        let hearing_of = |sensor: usize| {
            // Two ticks are subtracted, since the clock rounds.
            let refire = true_ns(soonest(sensor)).saturating_sub(2000);
            let hearing = Hearing::new(world, robot, sensor, method.echoes(), refire, true_ns);
            // A later firing is deaf at first too.
            let hearing = Hearing { refire: if steady { refire + hearing.blanking } else { refire }, ..hearing };
            match limits.get(sensor).map(|limits| true_ns(limits.window)) {
                Some(window) => Hearing { window, refire: window.saturating_sub(2000), ..hearing },
                None => hearing,
            }
        };
        let hearings = (0..robot.sensors.len()).map(hearing_of).collect();
        rings.push(RunningRing {
            world: Arc::clone(world),
            robot: index,
            ring,
            clock,
            hearings,
            sensors,
            wakes: clock.reaches(start),
            hears: NEVER,
            tells: 0,
        });
    }
    Ok(rings)
}

/// Returns the expected change of a sensor's good reading since its previous firing: `-2 d / c`, where `d` is the
/// distance by which the robot's odometry says it moved forward; 0 without odometry.
pub(crate) fn expected_change_us(robot: &Robot, sensor: u8, before: &Pose, fired: &Pose, speed_of_sound: f64) -> i32 {
    let Some(pose) = robot.sensors.get(usize::from(sensor)).filter(|_| robot.odometry) else { return 0 };
    let (before, fired) = (before * pose, fired * pose);
    let way = fired.translation.vector - before.translation.vector;
    // Forward is the sensor's mean direction between the two firings.
    let heading = before.rotation.slerp(&fired.rotation, 0.5);
    let forward = way.x * heading.re + way.y * heading.im;
    (-2e6 * forward / speed_of_sound).round() as i32
}
