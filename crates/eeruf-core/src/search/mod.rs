//! The paper's search for waits, exhaustive and proven.
//!
//! Lags are given, waits are sought on a grid: [`WaitSearch`] finds one table, all, how many, the best. It works in
//! memory that the caller lends, without recursion or a clock, so the same question has the same answer on each target.
//! Whatever it returns passes [`Schedule::verify`](crate::Schedule::verify), which shares nothing with it.
//!
//! | question | method | how |
//! |---|---|---|
//! | is there one? | [`WaitSearch::first`] | ranks of `|d|` over *difference constraints*: the tick does not matter |
//! | the best interval | [`WaitSearch::best_interval`] | the same, by bisection |
//! | the best `t_delta` | [`WaitSearch::best_t_delta`] | likewise |
//! | the front of both | [`WaitSearch::next_on_front`] | the best of one, then of the other |
//! | the shortest waits or period | [`WaitSearch::shortest_waits`], [`WaitSearch::shortest_period`] | by bisection |
//! | every one | [`WaitSearch::next_table`] | depth first over the values, in lexicographic order |
//! | how many? | [`WaitSearch::count`] | depth first, with what was counted before kept in memory |
//!
//! [`memory_words`] says how much memory is enough for all but counting, and counting is exact with any amount, faster
//! with more. Deciding about twelve sensors takes 13.4 KB of stack on a Cortex-M3 beside it, counting up to 64 KiB.
//!
//! Where firing times are free and the shortest period is sought, the crate `eeruf-period` has the search. How a search
//! ends ([`Outcome`], [`Found`]), who watches it ([`Control`], [`Progress`]) and why it cannot start ([`SearchError`])
//! are the same for both.

mod control;
mod error;
mod found;
mod grid;
mod members;
mod wait;
mod wait_problem;

pub use control::{Control, Outcome, Progress};
pub use error::SearchError;
pub use found::Found;
use members::Members;
pub use wait::{Budget, COUNT_WORDS, MEMORY_WORDS, memory_words};
pub use wait_problem::{FrontTable, Infeasible, WaitProblem, WaitSearch};
