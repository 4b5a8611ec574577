//! The best schedule for a robot's ring: the shortest period with the same guarantees as the robot's own schedule.

use eeruf_core::search::{Progress, SearchError};
use eeruf_core::{Layout, Micros, Requirements};
use eeruf_period::{PeriodProblem, ShortestPeriod};
use std::ops::ControlFlow;

use super::schedules::table_i_d_for;
use crate::world::Robot;

/// Grid of firing times in a search: a choice; finer ticks seldom gain (`docs/explanation/theory.md`, section 5.6).
pub const TICK: Micros = Micros::new(100);

/// Returns the requirements that any schedule of a robot's ring must keep: the robot's `t_delta` and window, the
/// interval between neighbours in its own schedule (or in the paper's table at its period), and rejection of a sensor's
/// own stale echoes.
pub fn requirements_of(robot: &Robot) -> Requirements<'static> {
    let own = robot.schedule.or_else(|| table_i_d_for(robot.sensors.len(), robot.period, robot.neighbours).ok());
    let layout = layout_of(robot);
    let interval = own.and_then(|schedule| schedule.min_interval(layout));
    Requirements {
        min_interval: interval.map_or(Micros::ZERO, |interval| interval.value),
        layout,
        window: robot.window,
        stale_echo: true,
        ..Requirements::new(robot.t_delta)
    }
}

/// Searches `budget` nodes for the schedule with the shortest period that meets the [requirements](requirements_of) of
/// a robot. `keep_going` is called from time to time, and may end the search.
///
/// # Errors
/// [`SearchError`] if the ring is too large to search.
pub fn shortest_schedule_for(
    robot: &Robot,
    budget: u64,
    keep_going: impl FnMut(&Progress) -> bool,
) -> Result<ShortestPeriod, SearchError> {
    problem_of(robot).shortest(budget, &mut control(keep_going))
}

/// Returns the [shortest schedule](shortest_schedule_for); if its period is proven, the preferred one of that period.
///
/// # Errors
/// [`SearchError`] if the ring is too large to search.
///
/// ```
/// use eeruf_sim::{best_schedule_for, experiments::set_one::Alcove};
/// let best = best_schedule_for(&Alcove::random(0).robot(), 100_000, |_| true)?;
/// assert!(best.proven() && best.schedule.period().as_micros() < 60_000);
/// # Ok::<(), eeruf_core::search::SearchError>(())
/// ```
pub fn best_schedule_for(
    robot: &Robot,
    budget: u64,
    keep_going: impl FnMut(&Progress) -> bool,
) -> Result<ShortestPeriod, SearchError> {
    let (problem, mut control) = (problem_of(robot), control(keep_going));
    let mut found = problem.shortest(budget, &mut control)?;
    if found.proven() {
        found.schedule = problem.prefer(&found.schedule, budget, &mut control)?.0;
    }
    Ok(found)
}

fn problem_of(robot: &Robot) -> PeriodProblem<'static> {
    PeriodProblem { sensors: robot.sensors.len(), requirements: requirements_of(robot), tick: TICK }
}

fn control(mut keep_going: impl FnMut(&Progress) -> bool) -> impl FnMut(&Progress) -> ControlFlow<()> {
    move |progress| if keep_going(progress) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
}

/// Returns a ring if the sensors go all the way round, otherwise a line.
fn layout_of(robot: &Robot) -> Layout<'static> {
    let turn = |from: usize, to: usize| match (robot.sensors.get(from), robot.sensors.get(to)) {
        (Some(from), Some(to)) => (from.rotation.inverse() * to.rotation).angle().abs(),
        _ => 0.0,
    };
    let closes = robot.sensors.len() > 2 && turn(robot.sensors.len() - 1, 0) <= 1.5 * turn(0, 1);
    if closes { Layout::Ring(robot.neighbours) } else { Layout::Line(robot.neighbours) }
}
