//! Firing like today's sketches and modules: a [`LanePlan`] lets sets of sensors take turns in parallel lanes. Each
//! turn ends with the last echo or the time-out.

use eeruf_core::{
    Instant, MAX_PHASES, MAX_SENSORS, Micros, Phase,
    plan::{Plan, PlanLimits},
};

use super::firing::{FiringMethod, FiringPeriod, OwnError};
use super::judges::Judging;
use super::ring_runner::{self, REMEMBERED, RingStart, SimulatedPlan, Started, Way, planned};
use super::schedules;
use crate::world::{FiringTable, Robot, Sketch};

/// Makes a way whose turns end when sensors answer.
pub(super) const fn way(ring: fn(&RingStart<'_>) -> Started) -> Way {
    Way { ring, refire: |_, _, _| Micros::ZERO, ..Way::by_table(schedules::together) }
}

/// A way that fires by a table of any number of phases.
pub(super) const TABLE: Way = Way { ring: table, refire: |robot, _, _| robot.window, ..Way::by_table(schedules::own) };

/// Fires one sensor after the other, each as soon as the previous one has answered or timed out.
pub(super) fn in_turn(start: &RingStart<'_>) -> Started {
    lanes(start, vec![singly(0..start.robot.sensors.len() as u8)])
}

/// Time for which a blocking loop waits for an echo: an HC-SR04 without an echo holds its line for that long.
const BLOCKS: Micros = Micros::from_millis(38);
/// Pause of a blocking loop.
const BLOCKING_PAUSE: Micros = Micros::from_millis(10);

/// Fires one sensor after the other with the waits of a blocking loop.
pub(super) fn blocking(start: &RingStart<'_>) -> Started {
    let mut robot = start.robot.clone();
    robot.window = robot.window.min(BLOCKS);
    robot.firing = Sketch { pause: BLOCKING_PAUSE, ..Sketch::default() };
    let lane =
        Lane { silent: Some((robot.window, BLOCKS)), ..Lane::new(singly(0..robot.sensors.len() as u8), start.now) };
    run(&robot, &start.judging, start.now, vec![lane], Micros::ZERO)
}

/// Fires arrays in parallel, each one sensor after the other.
pub(super) fn arrays(start: &RingStart<'_>) -> Started {
    let sensors = start.robot.sensors.len() as u8;
    let half = sensors.div_ceil(2);
    let halves = || [(0..half).collect(), (half..sensors).collect()].into();
    let arrays = given_or(&start.robot.firing.arrays, halves);
    lanes(start, arrays.into_iter().filter(|array| !array.is_empty()).map(singly).collect())
}

/// Fires groups of sensors in turn, each group together.
pub(super) fn groups(start: &RingStart<'_>) -> Started {
    let Robot { ref sensors, neighbours, .. } = *start.robot;
    let (sensors, apart) = (sensors.len() as u8, neighbours.min(sensors.len() as u8).max(1));
    let far = || (0..apart).map(|first| (first..sensors).step_by(apart.into()).collect()).collect();
    lanes(start, vec![given_or(&start.robot.firing.groups, far)])
}

/// Fires all sensors at once, and again when the slowest is ready.
pub(super) fn sync_line(start: &RingStart<'_>) -> Started {
    lanes_resting(start, vec![vec![(0..start.robot.sensors.len() as u8).collect()]], start.robot.module_rest())
}

/// Fires each module by its own clock.
pub(super) fn free_running(start: &RingStart<'_>) -> Started {
    let Robot { ref sensors, ref firing, .. } = *start.robot;
    let rest = firing.rest.unwrap_or_else(|| start.robot.module_rest());
    let cycle = f64::from(rest.max(firing.turn).max(start.robot.window).as_micros());
    let mut random = start.random;
    let lane = |sensor: usize| {
        let deviation = random.between(-firing.drift_ppm, firing.drift_ppm);
        let first = Micros::new(random.between(0.0, cycle) as u32);
        let cycle = Micros::new((cycle * (1.0 + 1e-6 * deviation)).round() as u32);
        Lane { cycle: Some(cycle), ..Lane::new(vec![vec![sensor as u8]], start.now + first) }
    };
    run(start.robot, &start.judging, start.now, (0..sensors.len()).map(lane).collect(), Micros::ZERO)
}

/// Fires by a table of any number of phases.
fn table(start: &RingStart<'_>) -> Started {
    let table = start.robot.firing.table.clone().unwrap_or_else(|| {
        let schedule = &start.plan.schedule;
        let row = |phase| {
            let times = (0..schedule.sensors()).map(|x| schedule.t_fire(phase, x).unwrap_or_default());
            times.collect()
        };
        FiringTable { period: schedule.period(), rows: [Phase::A, Phase::B].map(row).into() }
    });
    planned(Box::new(ByTable(table)), &listening(start.robot), &start.judging, start.robot.window, start.now)
}

fn singly(sensors: impl IntoIterator<Item = u8>) -> Vec<Vec<u8>> {
    sensors.into_iter().map(|sensor| vec![sensor]).collect()
}

fn given_or(given: &[Vec<u8>], default: impl FnOnce() -> Vec<Vec<u8>>) -> Vec<Vec<u8>> {
    if given.is_empty() { default() } else { given.to_vec() }
}

/// Returns the robot with its sketch's settings for listening and comparing.
fn listening(robot: &Robot) -> Robot {
    let Sketch { timeout, consecutive, .. } = robot.firing;
    Robot { window: timeout.unwrap_or(robot.window), consecutive: consecutive.max(2), ..robot.clone() }
}

fn lanes(start: &RingStart<'_>, lanes: Vec<Vec<Vec<u8>>>) -> Started {
    lanes_resting(start, lanes, Micros::ZERO)
}

fn lanes_resting(start: &RingStart<'_>, lanes: Vec<Vec<Vec<u8>>>, rest: Micros) -> Started {
    let lanes = lanes.into_iter().map(|sets| Lane::new(sets, start.now)).collect();
    run(start.robot, &start.judging, start.now, lanes, start.robot.firing.rest.unwrap_or(rest))
}

fn run(robot: &Robot, judging: &Judging, now: Instant, lanes: Vec<Lane>, rest: Micros) -> Started {
    let Robot { ref sensors, ref firing, period, .. } = *robot;
    let plan = LanePlan {
        lanes,
        pause: firing.pause,
        turn: firing.turn,
        rest,
        sensors: sensors.len(),
        triggered: [None; MAX_SENSORS],
        enabled: [true; MAX_SENSORS],
        paused: false,
        period,
        period_start: now,
    };
    ring_runner::run::<_, REMEMBERED>(plan, &listening(robot), judging, now)
}

/// Fires by a table of any number of phases, period after period.
#[derive(Clone)]
struct ByTable(FiringTable);

impl FiringMethod for ByTable {
    fn plan(&mut self, period: u32) -> Result<FiringPeriod, OwnError> {
        let FiringTable { period: length, rows } = &self.0;
        let phase = period as usize % rows.len().max(1);
        let times = rows.get(phase).map_or(&[][..], Vec::as_slice);
        // At most 64 sensors. A reading's number has eight phases, but nothing compares by them here.
        let firings = times.iter().zip(0..).map(|(&time, sensor)| (time, sensor)).collect();
        Ok(FiringPeriod { length: *length, phase: Phase((phase % MAX_PHASES) as u8), firings })
    }

    fn copy(&self) -> Option<Box<dyn FiringMethod>> {
        Some(Box::new(self.clone()))
    }
}

/// Sets of sensors that take turns: the next set fires when every sensor of the current one has ended.
#[derive(Clone, Debug)]
struct Lane {
    sets: Vec<Vec<u8>>,
    /// The current set, and the number of its sensors that have had their turn.
    set: usize,
    place: usize,
    /// Time when the turn began or begins.
    due: Instant,
    /// Sensors of the set that still listen, bit x for sensor x.
    pending: u64,
    /// The time from one turn to the next, if it is fixed.
    cycle: Option<Micros>,
    /// The listening time of its sensors and, if longer, the time that a turn takes if they hear nothing.
    silent: Option<(Micros, Micros)>,
}

impl Lane {
    fn new(sets: Vec<Vec<u8>>, due: Instant) -> Self {
        Self { sets, set: 0, place: 0, due, pending: 0, cycle: None, silent: None }
    }

    /// Returns the sensor of the current set that fires next; `None` while the set listens.
    fn next(&self) -> Option<u8> {
        self.sets.get(self.set)?.get(self.place).copied()
    }

    fn holds(&self, sensor: u8) -> bool {
        self.sets.iter().flatten().any(|&member| member == sensor)
    }
}

/// Parallel lanes.
#[derive(Clone, Debug)]
struct LanePlan {
    lanes: Vec<Lane>,
    pause: Micros,
    turn: Micros,
    /// The least time from one trigger of a sensor to its next.
    rest: Micros,
    sensors: usize,
    triggered: [Option<Instant>; MAX_SENSORS],
    enabled: [bool; MAX_SENSORS],
    paused: bool,
    /// Time between ends of periods, which do not affect the firing.
    period: Micros,
    period_start: Instant,
}

impl LanePlan {
    fn period_end(&self) -> Instant {
        self.period_start + self.period
    }

    /// Returns the lane that is due first, measured from the start of the period like its end.
    fn first(&self) -> Option<usize> {
        if self.paused {
            return None;
        }
        let waiting = self.lanes.iter().enumerate().filter(|(_, lane)| lane.next().is_some());
        let first = waiting.reduce(|first, lane| if lane.1.due.has_reached(first.1.due) { first } else { lane });
        first.map(|(index, _)| index).filter(|&index| self.period_end().has_reached(self.lanes[index].due))
    }

    /// Skips disabled sensors, and moves on to the next set once all of the current one have ended, no sooner than
    /// `soonest`.
    fn settle(&mut self, index: usize, soonest: Instant) {
        let enabled = self.enabled;
        let may_fire = |sensor: u8| enabled.get(usize::from(sensor)).is_some_and(|&enabled| enabled);
        let Some(lane) = self.lanes.get_mut(index) else { return };
        // Each set is visited once, so that a lane without enabled sensors stops.
        for _ in 0..=lane.sets.len() {
            while lane.next().is_some_and(|sensor| !may_fire(sensor)) {
                lane.place += 1;
            }
            if lane.next().is_some() || lane.pending != 0 {
                return;
            }
            (lane.set, lane.place) = ((lane.set + 1) % lane.sets.len().max(1), 0);
            lane.due = later(lane.due, soonest);
            for &sensor in lane.sets.get(lane.set).into_iter().flatten() {
                if let Some(triggered) = self.triggered.get(usize::from(sensor)).copied().flatten() {
                    lane.due = later(lane.due, triggered + self.rest);
                }
            }
        }
        // No sensor of the lane is enabled: it waits at the end of a set.
        lane.place = lane.sets.get(lane.set).map_or(0, Vec::len);
    }
}

/// Returns the later of two instants that lie within half a turn of the clock.
fn later(one: Instant, other: Instant) -> Instant {
    if one.has_reached(other) { one } else { other }
}

impl Plan for LanePlan {
    fn deadline(&self) -> Instant {
        self.first().map_or(self.period_end(), |index| self.lanes[index].due)
    }

    fn next_firing(&self) -> Option<(u8, Phase)> {
        self.first().and_then(|index| self.lanes[index].next()).map(|sensor| (sensor, Phase::A))
    }

    fn fire(&mut self, now: Instant) {
        let Some((index, sensor)) = self.first().and_then(|index| Some((index, self.lanes[index].next()?))) else {
            return;
        };
        let lane = &mut self.lanes[index];
        lane.due = now;
        lane.place += 1;
        lane.pending |= 1 << sensor;
        self.triggered[usize::from(sensor)] = Some(now);
        self.settle(index, now);
    }

    fn postpone(&mut self, sensor: u8, by: Micros) {
        if let Some(Some(triggered)) = self.triggered.get_mut(usize::from(sensor)) {
            *triggered += by;
        }
        for lane in self.lanes.iter_mut().filter(|lane| lane.holds(sensor)) {
            lane.due += by;
        }
    }

    fn end_period(&mut self, now: Instant) -> (Phase, bool) {
        self.period_start = self.period_end();
        // After a long silence the missed periods are skipped, not ended one by one.
        if now.has_reached(self.period_end()) {
            self.period_start = now;
        }
        // A waiting lane stays due, but must not fall half a turn of the clock behind.
        for lane in self.lanes.iter_mut().filter(|lane| lane.pending == 0) {
            lane.due = later(lane.due, now);
        }
        (Phase::A, false)
    }

    fn ended(&mut self, sensor: u8, at: Instant) {
        let Some(index) = self.lanes.iter().position(|lane| lane.holds(sensor)) else { return };
        let (lane, bit) = (&mut self.lanes[index], 1_u64 << sensor);
        if lane.pending & bit == 0 {
            return;
        }
        lane.pending &= !bit;
        let at = match lane.silent {
            Some((window, lasts)) if at.has_reached(lane.due + window) => later(at, lane.due + lasts),
            _ => at,
        };
        let soonest = match lane.cycle {
            Some(cycle) => later(lane.due + cycle, at),
            None => later(lane.due + self.turn, at + self.pause),
        };
        self.settle(index, soonest);
    }

    fn sensors(&self) -> usize {
        self.sensors
    }

    fn set_enabled(&mut self, sensor: u8, enabled: bool) {
        let Some(entry) = self.enabled.get_mut(usize::from(sensor)) else { return };
        *entry = enabled;
        for index in 0..self.lanes.len() {
            let due = self.lanes[index].due;
            self.settle(index, due);
        }
    }

    fn set_paused(&mut self, paused: bool) {
        self.paused = paused;
    }

    fn is_enabled(&self, sensor: u8) -> bool {
        usize::from(sensor) < self.sensors && self.enabled.get(usize::from(sensor)).is_some_and(|&enabled| enabled)
    }

    fn restart(&mut self, now: Instant) {
        self.period_start = now;
        let horizon = self.horizon();
        for triggered in &mut self.triggered {
            // After a jump of the clock the time of a sensor's trigger is unknown.
            let recent = triggered.filter(|&at| now.has_reached(at) && now.since(at) <= horizon);
            *triggered = recent;
        }
        for index in 0..self.lanes.len() {
            let lane = &mut self.lanes[index];
            let last = lane.sets.len().saturating_sub(1);
            (lane.set, lane.place, lane.pending, lane.due) = (last, usize::MAX, 0, now);
            self.settle(index, now);
        }
    }

    fn last_firing(&self, _sensor: u8, _periods_ago: u8) -> eeruf_core::judge::FiringContext {
        eeruf_core::judge::FiringContext::new(Phase::A)
    }

    fn limits(&self) -> PlanLimits<'_> {
        // The plan fires only sensors that have ended.
        PlanLimits { longest_window: Micros::MAX, verified_for: None, audible: None }
    }

    fn min_refire(&self) -> Micros {
        self.rest
    }

    fn horizon(&self) -> Micros {
        // The end of the period is always among the deadlines.
        self.period.saturating_add(self.period)
    }
}

impl SimulatedPlan for LanePlan {}

#[cfg(test)]
mod tests {
    use super::*;
    use eeruf_core::plan::check_plan;

    #[test]
    fn lanes_keep_the_contract_of_plans() {
        let ms = Micros::from_millis;
        for seed in 0..40_u32 {
            let now = Instant::from_micros(u32::MAX - 500_000);
            let rest = ms(seed % 3 * 20);
            let lanes = match seed % 4 {
                0 => vec![Lane::new(singly(0..4), now)],
                1 => vec![Lane::new(singly(0..2), now), Lane::new(singly(2..4), now)],
                2 => vec![Lane::new(vec![vec![0, 2], vec![3], vec![1]], now)],
                _ => {
                    let cycle = |sensor: u8| Some(ms(20 + u32::from(sensor)));
                    (0..4).map(|sensor| Lane { cycle: cycle(sensor), ..Lane::new(singly([sensor]), now) }).collect()
                }
            };
            let mut plan = LanePlan {
                lanes,
                pause: ms(2),
                turn: ms(5),
                rest,
                sensors: 4,
                triggered: [None; MAX_SENSORS],
                enabled: [true; MAX_SENSORS],
                paused: false,
                period: ms(60),
                period_start: now,
            };
            if let Err(broken) = check_plan(&mut plan, now, 2_000, seed) {
                panic!("{seed}: {broken}");
            }
        }
    }
}
