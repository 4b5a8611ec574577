//! The user's question, in microseconds: what a ring needs, and the best schedule that meets it.

use super::common::{Control, Outcome};
use super::design::{self, Explanation, Firing, InTime, Problem, Shortest};
use super::error::SearchError;
use super::found::Found;
use super::grid::Grid;
use crate::requirements::{Criterion, Requirements};
use crate::schedule::{MAX_PERIOD, MAX_SENSORS, Schedule};
use crate::time::Micros;

/// Needs of a ring. Firing times are free: every sensor fires once per period, whenever it suits all.
///
/// ```
/// use eeruf_core::search::{PeriodProblem, design};
/// use eeruf_core::{Micros, Requirements};
///
/// // The paper's half ring of twelve: 2 ms separation, any four neighbours 15 ms apart, listening for 30 ms.
/// let problem = PeriodProblem {
///     sensors: 12,
///     requirements: Requirements {
///         min_interval: Micros::from_millis(15),
///         window: Micros::from_millis(30),
///         ..Requirements::new(Micros::new(999))
///     },
///     tick: Micros::from_millis(1),
/// };
/// let mut memory = vec![0; design::memory_words(12)];
/// let shortest = problem.shortest::<12>(u64::MAX, &mut memory, &mut ())?;
/// // 65 ms instead of the paper's 100, and no schedule is shorter.
/// assert_eq!(shortest.found.value, Some(Micros::from_millis(65)));
/// assert!(shortest.found.proven);
/// assert!(shortest.found.schedule.unwrap().verify(&problem.requirements).ok());
/// # Ok::<(), eeruf_core::search::SearchError>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PeriodProblem<'a> {
    /// The number of sensors, 1 to 64.
    pub sensors: usize,
    /// Requirements on the schedule, under [`Criterion::Exact`].
    pub requirements: Requirements<'a>,
    /// All firing times and the period are multiples of this.
    pub tick: Micros,
}

/// The shortest period for a ring, or the best found, and why it is not shorter.
#[derive(Clone, Copy, Debug)]
pub struct ShortestPeriod<const K: usize> {
    /// The schedule, with the period as its value and the bound below which there is none.
    pub found: Found<K>,
    shortest: Shortest,
    grid: Grid,
}

impl<const K: usize> ShortestPeriod<K> {
    fn new(grid: Grid, shortest: Shortest) -> Result<Self, SearchError> {
        let found = Found {
            schedule: Some(schedule_of(grid, shortest.period, &shortest.firing)?),
            value: Some(grid.time(shortest.period)),
            bound: Some(grid.time(shortest.bound)),
            proven: shortest.proven(),
            nodes: shortest.nodes,
        };
        Ok(Self { found, shortest, grid })
    }

    /// Why the period is not shorter, in words; times in microseconds or milliseconds.
    pub const fn explanation(&self) -> InTime<'_> {
        self.shortest.explanation.in_ticks_of(self.grid.tick())
    }
}

/// Of all schedules with the shortest period, the one to prefer: see [`PeriodProblem::prefer`].
#[derive(Clone, Copy, Debug)]
pub struct Preferred<const K: usize> {
    /// The schedule.
    pub schedule: Schedule<K>,
    /// True if no other schedule of this period allows a larger `t_delta`.
    pub t_delta_proven: bool,
    /// True if none of this period and `t_delta` keeps neighbours further apart.
    pub min_interval_proven: bool,
    /// True if none of this period, `t_delta` and interval leaves a sensor more time between two firings.
    pub min_refire_proven: bool,
    /// Nodes visited.
    pub nodes: u64,
}

impl PeriodProblem<'_> {
    /// The shortest period, proven unless `budget` nodes are spent first; then the shortest found.
    ///
    /// There is always a schedule, since firing one by one meets any needs. `memory` of
    /// [`design::memory_words`] words.
    ///
    /// # Errors
    /// [`SearchError`] for needs that make no sense or are too large to search, and for too little memory.
    pub fn shortest<const K: usize>(
        &self,
        budget: u64,
        memory: &mut [i32],
        control: &mut impl Control,
    ) -> Result<ShortestPeriod<K>, SearchError> {
        let (grid, rows) = self.grid()?;
        ShortestPeriod::new(grid, design::shortest(&self.problem(grid, &rows), budget, memory, control)?)
    }

    /// Why no schedule is shorter than this, in a time of which it is known that it is the shortest period.
    ///
    /// # Errors
    /// As for [`shortest`](Self::shortest), and if the period is not a whole number of ticks.
    pub fn why_shortest(&self, period: Micros) -> Result<Explanation, SearchError> {
        let (grid, rows) = self.grid()?;
        let ticks = grid.exactly("the period", period)?;
        Ok(Explanation::of(&self.problem(grid, &rows).checked()?, ticks))
    }

    /// Decides whether some schedule has this period, within `budget` nodes, and counts the nodes visited.
    ///
    /// # Errors
    /// As for [`shortest`](Self::shortest), and if the period is not a whole number of ticks.
    pub fn decide<const K: usize>(
        &self,
        period: Micros,
        budget: u64,
        memory: &mut [i32],
        control: &mut impl Control,
    ) -> Result<(Outcome<Schedule<K>>, u64), SearchError> {
        let (grid, rows) = self.grid()?;
        let ticks = grid.exactly("the period", period)?;
        let decided = design::decide(&self.problem(grid, &rows), ticks, budget, memory, control)?;
        let outcome = match decided.outcome {
            Outcome::Found(firing) => Outcome::Found(schedule_of(grid, ticks, &firing)?),
            Outcome::Exhausted => Outcome::Exhausted,
            Outcome::BudgetSpent => Outcome::BudgetSpent,
        };
        Ok((outcome, decided.nodes))
    }

    /// Of all schedules with the period found, the one with the largest `t_delta`; of these, the one with the largest
    /// smallest interval; of these, the one with the longest time before a sensor fires again. A gain in a later one
    /// never makes up for a loss in an earlier one. What is not proven within the budget is the best found.
    ///
    /// # Errors
    /// As for [`shortest`](Self::shortest).
    pub fn prefer<const K: usize>(
        &self,
        designed: &ShortestPeriod<K>,
        budget: u64,
        memory: &mut [i32],
        control: &mut impl Control,
    ) -> Result<Preferred<K>, SearchError> {
        let (grid, rows) = self.grid()?;
        let preferred = design::prefer(&self.problem(grid, &rows), &designed.shortest, budget, memory, control)?;
        Ok(Preferred {
            schedule: schedule_of(grid, designed.shortest.period, &preferred.firing)?,
            t_delta_proven: preferred.separation.proven(),
            min_interval_proven: preferred.interval.proven(),
            min_refire_proven: preferred.window.proven(),
            nodes: preferred.nodes,
        })
    }

    /// The largest `t_delta` at a given period; that of the requirements is not looked at.
    ///
    /// # Errors
    /// As for [`shortest`](Self::shortest), and if the period is not a whole number of ticks.
    pub fn largest_t_delta<const K: usize>(
        &self,
        period: Micros,
        budget: u64,
        memory: &mut [i32],
        control: &mut impl Control,
    ) -> Result<Found<K>, SearchError> {
        let (grid, rows) = self.with(Requirements { t_delta: Micros::ZERO, ..self.requirements }).grid()?;
        let ticks = grid.exactly("the period", period)?;
        let largest = design::maximize_separation(&self.problem(grid, &rows), ticks, budget, memory, control)?;
        largest_found(grid, ticks, largest, |separation| grid.t_delta(separation))
    }

    /// The largest interval between neighbours at a given period; that of the requirements is not looked at.
    ///
    /// # Errors
    /// As for [`largest_t_delta`](Self::largest_t_delta).
    pub fn largest_interval<const K: usize>(
        &self,
        period: Micros,
        budget: u64,
        memory: &mut [i32],
        control: &mut impl Control,
    ) -> Result<Found<K>, SearchError> {
        let (grid, rows) = self.with(Requirements { min_interval: Micros::ZERO, ..self.requirements }).grid()?;
        let ticks = grid.exactly("the period", period)?;
        let largest = design::maximize_interval(&self.problem(grid, &rows), ticks, budget, memory, control)?;
        largest_found(grid, ticks, largest, |interval| Some(grid.time(interval)))
    }

    fn grid(&self) -> Result<(Grid, [u64; MAX_SENSORS]), SearchError> {
        if self.requirements.criterion == Criterion::Paper {
            return Err(SearchError::PaperCriterion);
        }
        if self.requirements.uneven.is_some() {
            return Err(SearchError::Uneven);
        }
        self.requirements.layout.check(self.sensors)?;
        let (grid, rows) = (Grid::new(self.tick)?, self.requirements.layout.rows(self.sensors));
        let one_by_one = |grid: Grid| {
            let period_us = design::one_by_one(&self.problem(grid, &rows)).saturating_mul(grid.tick_us());
            (period_us > u64::from(MAX_PERIOD.as_micros())).then_some(period_us)
        };
        // What is too long in ticks, and not in time, is for the search to refuse.
        if let Some(period_us) = one_by_one(Grid::FINEST) {
            return Err(SearchError::TooLong { period_us });
        }
        if let Some(period_us) = one_by_one(grid) {
            return Err(SearchError::CoarseTick { tick: self.tick, period_us });
        }
        Ok((grid, rows))
    }

    /// The same for other requirements.
    fn with<'r>(&self, requirements: Requirements<'r>) -> PeriodProblem<'r> {
        PeriodProblem { sensors: self.sensors, requirements, tick: self.tick }
    }

    fn problem<'r>(&self, grid: Grid, rows: &'r [u64; MAX_SENSORS]) -> Problem<'r> {
        let Requirements { t_delta, min_interval, window, stale_echo, .. } = self.requirements;
        Problem {
            sensors: self.sensors,
            // Too many sensors are for the search to refuse.
            conflicts: rows.get(..self.sensors).unwrap_or(rows),
            separation: grid.separation(t_delta),
            interval: grid.at_least(min_interval),
            window: grid.at_least(window),
            stale_echo,
        }
    }
}

fn largest_found<const K: usize>(
    grid: Grid,
    period: u32,
    largest: design::Maximum,
    value_of: impl Fn(u32) -> Option<Micros>,
) -> Result<Found<K>, SearchError> {
    let schedule = match &largest.found {
        Some((_, firing)) => Some(schedule_of(grid, period, firing)?),
        None => None,
    };
    Ok(Found {
        schedule,
        value: largest.found.and_then(|(value, _)| value_of(value)),
        bound: largest.bound.and_then(value_of),
        proven: largest.proven(),
        nodes: largest.nodes,
    })
}

fn schedule_of<const K: usize>(grid: Grid, period: u32, firing: &Firing) -> Result<Schedule<K>, SearchError> {
    let lags = [0; MAX_SENSORS];
    let lags = lags.get(..firing.fire_a().len()).unwrap_or(&lags);
    grid.schedule(period, lags, firing.fire_a(), firing.fire_b())
}
