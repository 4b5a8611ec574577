//! Search for schedules, exhaustive and proven.
//!
//! - [`PeriodProblem`]: the user's question. Firing times are free; the shortest period is sought, or the largest
//!   `t_delta` or interval at a given period.
//! - [`WaitSearch`]: the paper's question. Lags are given, waits are sought on a grid: one table, all, how many, the
//!   best.
//!
//! Both put their question on a grid of ticks and hand it to an engine that knows whole numbers only: [`design`], a
//! *simple temporal network* with *disjunctive* orders, and [`wait`], *difference constraints* with the same. The
//! engines share how a search ends ([`Outcome`]), who watches it ([`Control`], [`Progress`]) and why a problem makes no
//! sense ([`ProblemError`]); they do not know each other.
//!
//! The engines work in memory that the caller lends, without recursion or a clock, and the only random numbers come
//! from a fixed seed, so the same question has the same answer on each target. Whatever they return passes
//! [`Schedule::verify`](crate::Schedule::verify), which shares nothing with them.

mod common;
pub mod design;
mod error;
mod found;
mod grid;
mod period_problem;
pub mod wait;
mod wait_problem;

pub use common::{Control, Outcome, ProblemError, Progress};
pub use error::{GridError, SearchError};
pub use found::Found;
pub use period_problem::{PeriodProblem, Preferred, ShortestPeriod};
pub use wait_problem::{FrontTable, Infeasible, WaitFront, WaitProblem, WaitSearch};
