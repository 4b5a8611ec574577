//! The engine: search, proof and preference over one difference-bound matrix.
//!
//! | file | content |
//! |---|---|
//! | `problem` | the problem in ticks, a claim about its period; groups that fire together as one sensor |
//! | `bounds`, `state` | the difference-bound matrix; the knowledge at a node |
//! | `rules` | propagation; in searches by more than a certificate's rules |
//! | `counting`, `classes`, `sets` | bounds by counting |
//! | `construct` | schedules without a search |
//! | `branching`, `turns`, `symmetry` | case distinctions; firings in the order of time; assumptions at the root |
//! | `schedule` | a schedule, checked longhand |
//! | `descent` | the branchings of short descents, which look for schedules |
//! | `repair` | a local search for schedules |
//! | `search`, `shortest`, `spare` | one period, the shortest, the schedule with most to spare |
//! | `prove` | certificates |
//!
//! # The engine and the checker
//!
//! `checker/check_period.py` has a matrix, a state and rules of its own, in another language: a mistake in one is not
//! repeated in the other. Both implement the rules of docs/reference/certificate.md, since a certificate contains only
//! the tree, and a checker must reach the same refutations. They differ on purpose:
//!
//! - The checker reads each assumption about symmetry from the text and verifies it; the engine constructs those that
//!   turns, reflections and exchanges give, and keeps them as data.
//! - The checker says which line is wrong and why; the engine only checks that a schedule keeps the needs.
//! - The checker replays branchings; the engine chooses them, and a search takes the times at the bounds as a schedule
//!   as soon as they meet all needs.
//! - The checker keeps a matrix in one integer for each open node; the engine has one matrix and a log that restores
//!   it.
//! - With `State::goes_further`, a search concludes more from Hall intervals. Certificates are written without this, so
//!   a mistake there shows when one is written.

mod bounds;
mod branching;
mod classes;
mod construct;
pub(crate) mod counting;
mod descent;
mod problem;
pub mod prove;
mod repair;
mod rules;
mod schedule;
pub mod search;
mod sets;
pub mod shortest;
pub mod spare;
mod state;
mod symmetry;
mod turns;

pub use problem::{Claim, MAX_NUMBER, MAX_SENSORS, Problem};
