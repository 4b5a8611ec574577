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
//! Once orders are decided, waits are a system of difference constraints, which Bellman and Ford's algorithm solves or
//! refutes (T. H. Cormen and others, *Introduction to Algorithms*, chapter on shortest paths); order, rank and sign are
//! *disjunctive* choices, so the search branches on them. `docs/explanation/theory.md`, section 7, has the arguments.
//!
//! Nothing here allocates, recurses, reads a clock or draws random numbers.

mod budget;
mod count;
mod difference_constraints;
mod enumerate;
mod feasibility;
mod maximize;
mod pareto;
mod problem;
#[cfg(test)]
mod tests;

use crate::schedule::MAX_SENSORS;

pub use budget::Budget;
pub use count::COUNT_WORDS;
pub use feasibility::memory_words;
pub(crate) use maximize::{Best, Objective};
pub(crate) use problem::{MAX_PERIOD, Problem, Search};

/// Words of memory that suffice for every search but counting, with up to [`MAX_SENSORS`] sensors; [`memory_words`] is
/// the number for fewer.
pub const MEMORY_WORDS: usize = memory_words(MAX_SENSORS);
