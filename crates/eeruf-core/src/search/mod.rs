//! The paper's search for waits, exhaustive and proven.
//!
//! With the lags given, [`WaitSearch`] looks for waits on a grid: one table, all, their number, or the best. It works
//! in memory that the caller lends, without recursion or a clock, so the same question has the same answer on each
//! target. Whatever it returns passes [`Schedule::verify`](crate::Schedule::verify), which shares nothing with it.
//!
//! | question | method | how |
//! |---|---|---|
//! | is there one? | [`WaitSearch::first`] | ranks of `|d|` over *difference constraints*: the tick does not matter |
//! | the best interval | [`WaitSearch::best_interval`] | the same, by bisection |
//! | the best `t_delta` | [`WaitSearch::best_t_delta`] | likewise |
//! | the front of both | [`WaitSearch::next_on_front`] | the best of one, then of the other |
//! | the shortest waits or period | [`WaitSearch::shortest_waits`], [`WaitSearch::shortest_period`] | by bisection |
//! | every one | [`WaitSearch::next_table`] | depth first over the values, in lexicographic order |
//! | how many? | [`WaitSearch::count`] | depth first, with earlier counts kept in memory |
//!
//! [`memory_words`] gives the memory that suffices for everything but counting, which is exact with any amount and
//! faster with more. Twelve sensors also need stack on a Cortex-M3: 13.4 KB to find tables, up to 64 KiB to count them.
//!
//! The crate `eeruf-period` searches for the shortest period with free firing times. Both searches share the types for
//! their end ([`Outcome`], [`Found`]), their watcher ([`Control`], [`Progress`]) and their errors ([`SearchError`]).

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
