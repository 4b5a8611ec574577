//! The paper's search for waits, exhaustive and proven.
//!
//! Lags are given, waits are sought on a grid: [`WaitSearch`] finds one table, all, how many, the best. It puts the
//! question on a grid of ticks and hands it to an engine that knows whole numbers only, [`wait`]: *difference
//! constraints* with *disjunctive* orders. It works in memory that the caller lends, without recursion or a clock, so
//! the same question has the same answer on each target. Whatever it returns passes
//! [`Schedule::verify`](crate::Schedule::verify), which shares nothing with it.
//!
//! Where firing times are free and the shortest period is sought, the crate `eeruf-period` has the search. How a search
//! ends ([`Outcome`], [`Found`]), who watches it ([`Control`], [`Progress`]) and why it cannot start ([`SearchError`])
//! are the same for both.

mod control;
mod error;
mod found;
mod grid;
mod members;
mod problem_error;
pub mod wait;
mod wait_problem;

pub use control::{Control, Outcome, Progress};
pub use error::{GridError, SearchError};
pub use found::Found;
use members::Members;
pub use problem_error::ProblemError;
use problem_error::check_conflicts;
pub use wait_problem::{FrontTable, Infeasible, WaitFront, WaitProblem, WaitSearch};
