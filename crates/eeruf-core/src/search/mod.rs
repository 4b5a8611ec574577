//! Search for schedules, exhaustive and proven.
//!
//! - [`PeriodProblem`]: the user's question. Firing times are free; the shortest period is sought, or the largest `t_delta` or
//!   interval at a given period.
//! - [`WaitSearch`]: the paper's question. Lags are given, waits are sought on a grid: one table, all, how many, the best.
//!
//! Both put their question on a grid of ticks and hand it to an engine that knows whole numbers only: [`design`] and
//! [`wait`]. The engines work in memory that the caller lends, without recursion, clock or chance, so the same question has
//! the same answer on each target. Whatever they return passes [`Schedule::verify`], which shares nothing with them.

pub mod design;
mod error;
mod grid;
mod period_problem;
pub mod wait;
mod wait_problem;

pub use error::SearchError;
pub use grid::GridError;
pub use period_problem::{PeriodProblem, Preferred, ShortestPeriod};
pub use wait_problem::{Infeasible, WaitProblem, WaitSearch};

use crate::schedule::Schedule;
use crate::time::Micros;

/// The best schedule that a search came to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found<const K: usize> {
    /// The schedule; `None` if there is none, or none was found within the budget.
    pub schedule: Option<Schedule<K>>,
    /// What was sought of it: the period, the smallest interval or `t_delta`.
    pub value: Option<Micros>,
    /// No schedule is better than this; `None` if it is proven that there is none.
    pub bound: Option<Micros>,
    /// Whether no better schedule exists (or none at all, without a schedule).
    pub proven: bool,
    /// Nodes visited: the same on each machine.
    pub nodes: u64,
}
