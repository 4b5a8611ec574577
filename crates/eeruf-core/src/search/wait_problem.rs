//! [`WaitProblem`]: the paper's question in microseconds: given the lags, find two waits for each sensor.

use core::fmt;

use super::control::Outcome;
use super::error::SearchError;
use super::found::Found;
use super::grid::Grid;
use super::wait::{Best, Budget, MAX_PERIOD, Objective, Problem, Search};
use crate::layout::Layout;
use crate::requirements::Criterion;
use crate::schedule::{MAX_SENSORS, Phase, Schedule};
use crate::time::Micros;

/// Requirements on a table of waits (Sec. 3.1).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WaitProblem<'a> {
    /// The number of sensors, 1 to 64.
    pub sensors: usize,
    /// `T_p`, a whole number of ticks.
    pub period: Micros,
    /// Waits are 0, one tick, two ticks, .. up to this.
    pub wait_max: Micros,
    /// The grid of the waits.
    pub tick: Micros,
    /// `T_lag` of each sensor, in whole ticks; `None` spreads each group of [`neighbours`](Self::neighbours) sensors
    /// over the period, as Table I-a does.
    pub t_lag: Option<&'a [Micros]>,
    /// `T_delta`: the greatest difference between near-identical readings.
    pub t_delta: Micros,
    /// The least time between the firings of two neighbours.
    pub min_interval: Micros,
    /// Number of adjacent sensors in a group of the default lags.
    pub neighbours: u8,
    /// Pairs of neighbours.
    pub layout: Layout<'a>,
    /// The interpretation of (13a), (13b).
    pub criterion: Criterion,
}

/// A search for tables of waits, in memory that the caller lends ([`memory_words`](super::memory_words)).
///
/// ```
/// use eeruf_core::search::{Budget, WaitProblem, WaitSearch, memory_words};
/// use eeruf_core::{Criterion, Layout, Micros};
///
/// let problem = WaitProblem {
///     sensors: 12,
///     period: Micros::from_millis(100),
///     wait_max: Micros::from_millis(24),
///     tick: Micros::from_millis(1),
///     t_lag: None,
///     t_delta: Micros::new(999),
///     min_interval: Micros::from_millis(15),
///     neighbours: 4,
///     layout: Layout::Line(4),
///     criterion: Criterion::Exact,
/// };
/// let search = WaitSearch::new(&problem)?;
/// let mut memory = vec![0; memory_words(12)];
/// let best = search.best_interval::<12>(&mut memory, &mut Budget::unlimited())?;
/// // n I + D (K - 1) <= T_p: no table keeps any four neighbours further apart than 19 ms.
/// assert_eq!(best.value, Some(Micros::from_millis(19)));
/// assert!(best.proven);
/// # Ok::<(), eeruf_core::search::SearchError>(())
/// ```
#[derive(Clone, Debug)]
pub struct WaitSearch {
    grid: Grid,
    sensors: usize,
    period: u32,
    wait_max: u32,
    separation: u32,
    interval: u32,
    criterion: Criterion,
    lag: [u32; MAX_SENSORS],
    rows: [u64; MAX_SENSORS],
}

/// Reason why there is no table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Infeasible {
    /// `t_delta` alone cannot be met.
    Separation {
        /// K, the number of sensors.
        sensors: usize,
        /// D, the separation of two values `|d|` that `t_delta` needs.
        separation: Micros,
        /// The longest wait.
        wait_max: Micros,
    },
    /// The smallest interval alone cannot be met.
    Interval {
        /// I, the smallest interval.
        interval: Micros,
        /// The longest wait.
        wait_max: Micros,
        /// `T_p`.
        period: Micros,
    },
    /// Both needs together cannot be met; neither alone is known to be the reason.
    Together,
}

impl fmt::Display for Infeasible {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Separation { sensors, separation, wait_max } => write!(
                f,
                "t_delta alone cannot be met: {sensors} sensors need waits that differ by amounts \
                 {separation} apart from each other, and no wait is longer than {wait_max}"
            ),
            Self::Interval { interval, wait_max, period } => write!(
                f,
                "the smallest interval alone cannot be met: with these lags and waits of at most \
                 {wait_max}, neighbours cannot keep {interval} in a period of {period}"
            ),
            Self::Together => f.write_str("t_delta and the smallest interval cannot be met together"),
        }
    }
}

impl WaitSearch {
    /// Checks the problem and puts it on the grid.
    ///
    /// # Errors
    /// [`SearchError`] if a number is out of range, a period or lag is not a whole number of ticks, or a sensor could
    /// fire after its period has ended. An infeasible problem is not an error: the searches prove that.
    pub fn new(problem: &WaitProblem<'_>) -> Result<Self, SearchError> {
        let (grid, sensors) = (Grid::new(problem.tick)?, problem.sensors);
        if sensors == 0 || sensors > MAX_SENSORS {
            return Err(SearchError::Sensors(sensors));
        }
        if let Some(lags) = problem.t_lag.map(<[Micros]>::len).filter(|&lags| lags != sensors) {
            return Err(SearchError::Lags { sensors, lags });
        }
        problem.layout.check(sensors)?;
        let mut lag = [0; MAX_SENSORS];
        for (x, lag) in lag.iter_mut().enumerate().take(sensors) {
            *lag = match problem.t_lag {
                Some(lags) => grid.exactly("a lag", lags.get(x).copied().unwrap_or(Micros::ZERO))?,
                None => grid.exactly("a lag", default_lag(problem, x))?,
            };
        }
        let (period, wait_max) = (grid.exactly("the period", problem.period)?, grid.at_most(problem.wait_max));
        if period == 0 || period > MAX_PERIOD {
            return Err(SearchError::Period { period, most: MAX_PERIOD });
        }
        for (sensor, &lag) in lag.iter().enumerate().take(sensors) {
            if u64::from(lag) + u64::from(wait_max) >= u64::from(period) {
                return Err(SearchError::OutsidePeriod { sensor, lag, wait_max, period });
            }
        }
        Ok(Self {
            grid,
            sensors,
            period,
            wait_max,
            separation: grid.separation(problem.t_delta),
            interval: grid.at_least(problem.min_interval),
            criterion: problem.criterion,
            lag,
            rows: problem.layout.rows(sensors),
        })
    }

    /// Returns the problem in ticks.
    fn ticks(&self) -> Search<'_> {
        Search::new(Problem {
            period: self.period,
            lag: self.lag.get(..self.sensors).unwrap_or(&[]),
            wait_max: self.wait_max,
            separation: self.separation,
            interval: self.interval,
            conflicts: self.rows.get(..self.sensors).unwrap_or(&[]),
            criterion: self.criterion,
        })
    }

    /// Finds one table, or proves that there is none.
    ///
    /// # Errors
    /// [`SearchError`] for too little memory or a capacity `K` below the number of sensors.
    pub fn first<const K: usize>(
        &self,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<Outcome<Schedule<K>>, SearchError> {
        let (mut a, mut b) = ([0; MAX_SENSORS], [0; MAX_SENSORS]);
        let outcome = self.ticks().first(memory, budget, &mut a, &mut b)?;
        self.schedule_if_found(outcome, &a, &b)
    }

    /// Names the need that cannot be met, separation or interval, if there is no table. It searches with one of them at
    /// a time, within one budget for both.
    ///
    /// # Errors
    /// As for [`first`](Self::first).
    pub fn why_none(&self, memory: &mut [u32], budget: &mut Budget<'_>) -> Result<Infeasible, SearchError> {
        let search = self.ticks();
        let (mut a, mut b) = ([0; MAX_SENSORS], [0; MAX_SENSORS]);
        let mut without =
            |separation, interval| search.with(separation, interval).first(memory, budget, &mut a, &mut b);
        if without(self.separation, 0)? == Outcome::Exhausted {
            let (separation, wait_max) = (self.grid.time(self.separation), self.grid.time(self.wait_max));
            return Ok(Infeasible::Separation { sensors: self.sensors, separation, wait_max });
        }
        if without(0, self.interval)? == Outcome::Exhausted {
            let (interval, wait_max) = (self.grid.time(self.interval), self.grid.time(self.wait_max));
            return Ok(Infeasible::Interval { interval, wait_max, period: self.grid.time(self.period) });
        }
        Ok(Infeasible::Together)
    }

    /// Counts the tables; stops early when there are `limit` or more. More `memory` makes it faster
    /// ([`COUNT_WORDS`](super::COUNT_WORDS)); it may be empty.
    ///
    /// The count is exact with [`Outcome::Exhausted`], otherwise a lower bound: with [`Outcome::Found`] it reached the
    /// limit, or `u128::MAX` without one.
    pub fn count(&self, limit: Option<u128>, memory: &mut [u32], budget: &mut Budget<'_>) -> (Outcome, u128) {
        self.ticks().count(limit, memory, budget)
    }

    /// Finds the table whose smallest interval is largest at the `t_delta` of the problem, and proves that none is
    /// better. Without neighbours the interval is the period.
    ///
    /// # Errors
    /// As for [`first`](Self::first).
    pub fn best_interval<const K: usize>(
        &self,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<Found<K>, SearchError> {
        self.best(Objective::Interval, memory, budget, |ticks| Some(self.grid.time(ticks)))
    }

    /// Finds the table with the largest `t_delta` at the smallest interval of the problem, and proves that none is
    /// better. For a single sensor only `wait_max` limits it.
    ///
    /// # Errors
    /// As for [`first`](Self::first).
    pub fn best_t_delta<const K: usize>(
        &self,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<Found<K>, SearchError> {
        self.best(Objective::Separation, memory, budget, |ticks| self.grid.t_delta(ticks))
    }

    fn best<const K: usize>(
        &self,
        objective: Objective,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
        time: impl Fn(u32) -> Option<Micros>,
    ) -> Result<Found<K>, SearchError> {
        let (mut a, mut b) = ([0; MAX_SENSORS], [0; MAX_SENSORS]);
        let best @ Best { value, bound, nodes, .. } = self.ticks().best(objective, memory, budget, &mut a, &mut b)?;
        let schedule = if value.is_some() { Some(self.schedule(&a, &b)?) } else { None };
        let bound = if best.outcome == Outcome::Exhausted { None } else { time(bound) };
        Ok(Found { schedule, value: value.and_then(time), bound, proven: best.proven(), nodes })
    }

    /// Finds the table whose longest wait is shortest at the period of the problem, and proves that none is shorter.
    ///
    /// # Errors
    /// As for [`first`](Self::first).
    pub fn shortest_waits<const K: usize>(
        &self,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<Found<K>, SearchError> {
        self.shortest(0, self.wait_max, memory, budget, |wait_max| Self { wait_max, ..self.clone() })
    }

    /// Finds the table with the shortest period for the lags and the longest wait of the problem, and proves that none
    /// is shorter.
    ///
    /// # Errors
    /// As for [`first`](Self::first).
    pub fn shortest_period<const K: usize>(
        &self,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<Found<K>, SearchError> {
        let latest = self.lag.iter().take(self.sensors).copied().max().unwrap_or(0);
        let least = latest.saturating_add(self.wait_max).saturating_add(1);
        self.shortest(least, self.period, memory, budget, |period| Self { period, ..self.clone() })
    }

    /// Bisection: a table for some waits and period also serves for longer ones. Neither exceeds the problem's.
    fn shortest<const K: usize>(
        &self,
        mut least: u32,
        mut most: u32,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
        with: impl Fn(u32) -> Self,
    ) -> Result<Found<K>, SearchError> {
        let mut found = Found { schedule: None, value: None, bound: None, proven: true, nodes: 0 };
        let mut next = most;
        while found.proven && least <= most && (found.schedule.is_none() || least < most) {
            match with(next).first(memory, budget)? {
                Outcome::Found(schedule) => (found.schedule, most) = (Some(schedule), next),
                Outcome::Exhausted => least = next + 1,
                Outcome::BudgetSpent => found.proven = false,
            }
            next = least + most.saturating_sub(least) / 2;
        }
        found.value = found.schedule.is_some().then(|| self.grid.time(most));
        found.bound = (least <= most).then(|| self.grid.time(least));
        found.nodes = budget.nodes();
        Ok(found)
    }

    /// Finds the next table of the Pareto front, from the largest interval to the largest `t_delta`; both are at least
    /// those of the problem. No other table improves one without losing in the other. The table follows `after`, or is
    /// the first; `Exhausted` after the last, `BudgetSpent` if the budget ended before it was proven.
    ///
    /// # Errors
    /// As for [`first`](Self::first).
    pub fn next_on_front<const K: usize>(
        &self,
        after: Option<&FrontTable<K>>,
        memory: &mut [u32],
        budget: &mut Budget<'_>,
    ) -> Result<Outcome<FrontTable<K>>, SearchError> {
        let from = match after {
            None => self.separation,
            // A single sensor is at no distance from another: its one table is the whole front.
            Some(_) if self.sensors == 1 => return Ok(Outcome::Exhausted),
            Some(&FrontTable { separation: u32::MAX, .. }) => return Ok(Outcome::Exhausted),
            Some(table) => table.separation + 1,
        };
        let (mut a, mut b) = ([0; MAX_SENSORS], [0; MAX_SENSORS]);
        Ok(match self.ticks().front_from(from, memory, budget, &mut a, &mut b)? {
            Outcome::Found((interval, separation)) => Outcome::Found(FrontTable {
                schedule: self.schedule(&a, &b)?,
                min_interval: self.grid.time(interval),
                t_delta: self.grid.t_delta(separation),
                separation,
            }),
            Outcome::Exhausted => Outcome::Exhausted,
            Outcome::BudgetSpent => Outcome::BudgetSpent,
        })
    }

    /// Finds the first of all tables, in lexicographic order of `a_0, b_0, a_1, b_1, ..`, or the one that follows
    /// `after`; `Exhausted` after the last. It takes no memory from the caller.
    ///
    /// # Errors
    /// [`SearchError::Schedule`] for a capacity `K` below the number of sensors.
    pub fn next_table<const K: usize>(
        &self,
        after: Option<&Schedule<K>>,
        budget: &mut Budget<'_>,
    ) -> Result<Outcome<Schedule<K>>, SearchError> {
        let mut tables = match after {
            None => self.ticks().enumerate(),
            Some(table) => {
                let [a, b] = [Phase::A, Phase::B].map(|phase| {
                    let mut ticks = [0; MAX_SENSORS];
                    for (ticks, &wait) in ticks.iter_mut().zip(table.t_wait(phase)) {
                        *ticks = self.grid.at_most(wait);
                    }
                    ticks
                });
                self.ticks().enumerate_after(a, b)
            }
        };
        let outcome = tables.advance(budget);
        let (a, b) = tables.waits();
        self.schedule_if_found(outcome, a, b)
    }

    fn schedule_if_found<const K: usize>(
        &self,
        outcome: Outcome,
        wait_a: &[u32; MAX_SENSORS],
        wait_b: &[u32; MAX_SENSORS],
    ) -> Result<Outcome<Schedule<K>>, SearchError> {
        Ok(match outcome {
            Outcome::Found(()) => Outcome::Found(self.schedule(wait_a, wait_b)?),
            Outcome::Exhausted => Outcome::Exhausted,
            Outcome::BudgetSpent => Outcome::BudgetSpent,
        })
    }

    /// The schedule with these waits, in ticks; [`SearchError::Schedule`] for a capacity `K` below the number of
    /// sensors.
    fn schedule<const K: usize>(
        &self,
        wait_a: &[u32; MAX_SENSORS],
        wait_b: &[u32; MAX_SENSORS],
    ) -> Result<Schedule<K>, SearchError> {
        let of_all = |ticks: &'_ [u32; MAX_SENSORS]| ticks.map(|ticks| self.grid.time(ticks));
        let (lag, a, b) = (of_all(&self.lag), of_all(wait_a), of_all(wait_b));
        let [lag, a, b] = [&lag, &a, &b].map(|times| times.get(..self.sensors).unwrap_or(times));
        Ok(Schedule::from_slices(self.grid.time(self.period), lag, [a, b])?)
    }
}

/// A table of the Pareto front.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FrontTable<const K: usize> {
    /// The table.
    pub schedule: Schedule<K>,
    /// The smallest interval between neighbours; no table with at least this `t_delta` has a larger one.
    pub min_interval: Micros,
    /// `T_delta`; no table with at least this interval has a larger one. `None` if the separation is zero.
    pub t_delta: Option<Micros>,
    separation: u32,
}

/// Lags of Table I-a: sensor `x` in groups of `n` lags by `x mod n` n-ths of the period.
fn default_lag(problem: &WaitProblem<'_>, x: usize) -> Micros {
    let n = u64::from(problem.neighbours.max(1));
    let part = u64::from(problem.period.as_micros()) * (x as u64 % n) / n;
    // Below the period.
    Micros::new(part as u32)
}
