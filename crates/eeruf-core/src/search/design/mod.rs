//! The shortest period for a ring of sensors, proven; and how much separation or interval fits into a given one.
//!
//! Firing times that keep given distances from each other are a *simple temporal network* (Dechter, Meiri and Pearl
//! 1991). Which of two neighbours fires first, and which sensor has the larger `|d|`, is *disjunctive*: the search
//! branches on it. In detail:
//!
//! - the network is a *difference-bound matrix* (Dill 1989), kept closed as each bound is added;
//! - *Hall intervals* (Puget 1998) space the `|d|` of all sensors, as unary tasks of equal length;
//! - short descents from a fixed seed find schedules, with *Luby restarts* (Luby, Sinclair and Zuckerman 1993), and a
//!   full depth-first search proves that there are none;
//! - the period is found by galloping up from a bound that follows by counting ([`Bound`]), and by bisection: what is
//!   possible at one period is possible at any longer one;
//! - fine ticks start with what coarse ones have found.
//!
//! `docs/explanation/theory.md`, sections 5 and 6, has the arguments. The answer depends on the problem and the budget
//! alone.
//!
//! Each sensor fires once in phase a and once in phase b, and `d` is the difference of the two times. A [`Problem`]
//! says, in ticks, how far apart all `|d|` must be (the separation), how far apart conflicting sensors fire (the
//! interval) and how long each listens (the window).
//!
//! - [`shortest()`] minimises the period and says why it is not shorter ([`Explanation`]).
//! - [`decide()`] answers for one period: found, exhausted (a proof that there is none), or budget spent.
//! - [`maximize_separation`] and [`maximize_interval`] take the period as given.
//! - [`prefer()`] picks, among the schedules with the shortest period, the one with most to spare.
//!
//! All memory is lent by the caller, see [`memory_words`]; besides that a search needs less than 12 KiB of stack. The
//! room uses nothing but the common vocabulary of the searches.
//!
//! References: R. Dechter, I. Meiri, J. Pearl, *Temporal constraint networks*, Artificial Intelligence 49 (1991). D. L.
//! Dill, *Timing assumptions and verification of finite-state concurrent systems*, LNCS 407 (1989). J.-F. Puget, *A
//! fast algorithm for the bound consistency of alldiff constraints*, AAAI (1998). M. Luby, A. Sinclair, D. Zuckerman,
//! *Optimal speedup of Las Vegas algorithms*, Information Processing Letters 47 (1993).
//!
//! ```
//! use eeruf_core::search::design::{Problem, memory_words, shortest};
//!
//! // Four sensors side by side, none of which may fire within 15 ms of another; different readings differ by 2 ms.
//! let problem = Problem {
//!     sensors: 4,
//!     conflicts: &[0b1110, 0b1101, 0b1011, 0b0111],
//!     separation: 2,
//!     interval: 15,
//!     window: 60,
//!     stale_echo: false,
//! };
//! let mut memory = [0; memory_words(4)];
//! let found = shortest(&problem, 100_000, &mut memory, &mut ())?;
//! assert!(found.proven());
//! assert_eq!(found.period, 66);
//! # Ok::<(), eeruf_core::search::ProblemError>(())
//! ```

mod bisect;
mod bounds;
mod construct;
mod decide;
mod explanation;
mod firing;
mod maximize;
mod prefer;
mod problem;
mod random;
mod shortest;
mod solver;
mod symmetry;
#[cfg(test)]
mod tests;

pub use bounds::Bound;
pub use decide::{Decided, decide};
pub use explanation::{Explanation, InTime};
pub use firing::Firing;
pub use maximize::{Maximum, maximize_interval, maximize_separation};
pub use prefer::{Optimum, Preferred, prefer};
pub(super) use problem::one_by_one;
pub use problem::{MAX_TICKS, Problem};
pub use shortest::{Shortest, shortest};

/// The words of memory that every search over `sensors` sensors needs: 52 KiB for 12 sensors, 4.4 MiB for 64.
///
/// It is `const`, so the memory can be an array of `[i32; memory_words(12)]`, in a `static` or on the stack.
#[must_use]
pub const fn memory_words(sensors: usize) -> usize {
    solver::memory_words(sensors)
}
