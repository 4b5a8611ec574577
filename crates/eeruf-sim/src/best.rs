//! The best schedule for a robot's ring: the shortest period that guarantees what the robot's own schedule does.

use eeruf_core::{
    Criterion, Layout, MAX_SENSORS, Micros, Requirements,
    search::{PeriodProblem, Progress, SearchError, design},
};
use std::ops::ControlFlow;

use crate::{
    method::{AnySchedule, table_i_d_for},
    robot::Robot,
};

/// The grid on which firing times are sought.
pub const TICK: Micros = Micros::new(100);

/// What [`Method::EerufBest`](crate::Method::EerufBest) fires by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Best {
    /// The schedule.
    pub schedule: AnySchedule,
    /// Whether no schedule for the same needs has a shorter period.
    pub proven: bool,
}

/// What a ring must not give up against the schedule that it fires by: the robot's `t_delta` and window, the interval that
/// its schedule (or the paper's table at its period) keeps between neighbours, and that a sensor's own stale echoes are
/// rejected.
pub fn needs_of(robot: &Robot) -> Requirements<'static> {
    let own = robot.schedule.or_else(|| table_i_d_for(robot.sensors.len(), robot.period, robot.neighbours).ok());
    let layout = layout_of(robot);
    let interval = own.and_then(|schedule| schedule.min_interval(layout));
    Requirements {
        t_delta: robot.t_delta,
        criterion: Criterion::Exact,
        min_interval: interval.map_or(Micros::ZERO, |interval| interval.value),
        layout,
        window: robot.window,
        stale_echo: true,
    }
}

/// Searches `budget` nodes for the schedule with the shortest period that meets [`needs_of`] a robot, and of all schedules of
/// that period for the one to prefer. `keep_going` is asked now and then.
///
/// # Errors
/// [`SearchError`] if the ring is too large to search.
///
/// ```
/// use eeruf_sim::{best::best_for, experiments::set_one::Alcove};
/// let best = best_for(&Alcove::random(0).robot(), 100_000, |_| true)?;
/// assert!(best.proven && best.schedule.period().as_micros() < 60_000);
/// # Ok::<(), eeruf_core::search::SearchError>(())
/// ```
pub fn best_for(
    robot: &Robot,
    budget: u64,
    mut keep_going: impl FnMut(&Progress) -> bool,
) -> Result<Best, SearchError> {
    let sensors = robot.sensors.len();
    let needs = PeriodProblem { sensors, requirements: needs_of(robot), tick: TICK };
    let mut memory = vec![0; design::memory_words(sensors)];
    let mut control =
        |progress: &Progress| if keep_going(progress) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
    let designed = needs.shortest::<MAX_SENSORS>(budget, &mut memory, &mut control)?;
    let proven = designed.found.proven;
    let found = designed.found.schedule.filter(|_| !proven);
    let schedule = match found {
        Some(schedule) => schedule,
        None => needs.prefer(&designed, budget, &mut memory, &mut control)?.schedule,
    };
    Ok(Best { schedule, proven })
}

/// A ring if the sensors go all the way round, or else a line.
fn layout_of(robot: &Robot) -> Layout<'static> {
    let turn = |from: usize, to: usize| match (robot.sensors.get(from), robot.sensors.get(to)) {
        (Some(from), Some(to)) => (from.rotation.inverse() * to.rotation).angle().abs(),
        _ => 0.0,
    };
    let closes = robot.sensors.len() > 2 && turn(robot.sensors.len() - 1, 0) <= 1.5 * turn(0, 1);
    if closes { Layout::Ring(robot.neighbours) } else { Layout::Line(robot.neighbours) }
}
