//! The paper's wait-time problem: constant lags, and for each sensor two waits on a grid of ticks.
//!
//! Sensor `i` fires at `t_lag + t_wait_a` in phase a and at `T_p + t_lag + t_wait_b` in phase b, and so on with a cycle
//! of `2 T_p` (Sec. 3.1). A table of waits `(a_i, b_i)` solves the problem when
//!
//! ```text
//! | |d_x| - |d_y| | >= D   with d = a - b      for all x != y      both criteria, (13a) and (13b)
//! |  s_x  -  s_y  | >= D   with s = a + b      for all x != y      Criterion::Paper alone
//! firings of conflicting sensors lie at least I apart on the circle of 2 T_p, in every phase and over every border
//! ```
//!
//! All times are whole ticks, whatever a tick is; `D = 2 t_delta + 1 tick`, as near-identical is `<= t_delta`.
//!
//! | question | method | how |
//! |---|---|---|
//! | is there one? | [`Search::first`] | ranks of `|d|` over *difference constraints*: the tick does not matter |
//! | the best interval or separation | [`Search::best`] | the same, by bisection |
//! | the front of both | [`Search::pareto`] | the best of one, then of the other |
//! | every one | [`Search::enumerate`] | depth first over the values, in lexicographic order |
//! | how many? | [`Search::count`] | depth first, with what was counted before kept in memory |
//! | these pairs, over any sensors | [`Search::assign`] | an *assignment* problem, depth first over the pairs |
//!
//! Once orders are decided, waits are a system of difference constraints, which Bellman and Ford's algorithm solves or
//! refutes (T. H. Cormen and others, *Introduction to Algorithms*, chapter on shortest paths); which order, rank or
//! sign is *disjunctive*, so the search branches on it. `docs/explanation/theory.md`, section 7, has the arguments.
//!
//! Nothing here allocates, recurses, reads a clock or draws random numbers. The caller lends memory: [`MEMORY_WORDS`]
//! says how much is enough for all but counting, and counting is exact with any amount, faster with more. What the
//! searches keep on the stack is below 8 KiB (64 KiB in counting) at any size: twelve sensors are decided in 16 KiB of
//! RAM in total. The room uses nothing but the common vocabulary of the searches.
//!
//! ```
//! use eeruf_core::Criterion;
//! use eeruf_core::search::Outcome;
//! use eeruf_core::search::wait::{Budget, Objective, Problem, Search, memory_words};
//!
//! // Four sensors that all conflict, lags 0, 25, 50, 75 and waits up to 24 ms; t_delta just below 1 ms, so D = 2 ms.
//! let problem = Problem {
//!     period: 100,
//!     lag: &[0, 25, 50, 75],
//!     wait_max: 24,
//!     separation: 2,
//!     interval: 15,
//!     conflicts: &[0b1110, 0b1101, 0b1011, 0b0111],
//!     criterion: Criterion::Paper,
//! };
//! let search = Search::new(problem).unwrap();
//! let (mut a, mut b) = ([0; 4], [0; 4]);
//! let best = search
//!     .best(Objective::Interval, &mut [0; memory_words(4)], &mut Budget::unlimited(), &mut a, &mut b)
//!     .unwrap();
//! // n I + D (K - 1) <= T_p: 23 ms, with 2 ms to spare.
//! assert_eq!((best.outcome, best.value), (Outcome::Found(()), Some(23)));
//! assert_eq!(search.smallest_interval(&a, &b), 23);
//! ```

mod assignment;
mod budget;
mod count;
mod difference_constraints;
mod enumerate;
mod feasibility;
mod maximize;
mod pareto;
mod problem;

use crate::schedule::MAX_SENSORS;

pub use assignment::Assignment;
pub use budget::Budget;
pub use count::{COUNT_WORDS, Count};
pub use enumerate::Enumeration;
pub use feasibility::memory_words;
pub use maximize::{Best, Objective};
pub use pareto::{Pareto, ParetoPoint};
pub use problem::{MAX_PERIOD, Problem, Search};

/// Words of memory that suffice for every search but counting, with up to [`MAX_SENSORS`] sensors; [`memory_words`]
/// says it for fewer.
pub const MEMORY_WORDS: usize = memory_words(MAX_SENSORS);
