//! The shortest period for a ring of sensors, proven; and how much separation or interval fits into a given one.
//!
//! Each sensor fires once in phase a and once in phase b, and `d` is the difference of the two times. A [`Problem`] says, in ticks, how far
//! apart all `|d|` must be (the separation), how far apart conflicting sensors fire (the interval) and how long each listens (the window).
//!
//! - [`shortest`] minimises the period and says why it is not shorter ([`Reason`]); [`relaxations`] tells which need is the one to relax.
//! - [`decide`] answers for one period: found, exhausted (a proof that there is none), or budget spent.
//! - [`largest_separation`] and [`largest_interval`] turn the question round.
//! - [`prefer`] picks, among the schedules with the shortest period, the one with most to spare.
//!
//! How it works: bounds that follow by counting ([`Bound`]) give the lowest period worth trying, and for most lines, rings and blocks they
//! are met. One period is decided by a depth-first search over firing orders, then ranks of `|d|`; times stay intervals in a matrix of
//! differences, and fine ticks begin with what coarse ones have found. What is possible at one period is possible at any longer one, so halving
//! is exact. Descents of a few hundred nodes from a fixed seed find schedules, the full search proves that there are none; the answer depends
//! on the problem and the budget alone.
//!
//! With the feature `std`, `shortest_on_threads` comes to the same answer on several threads.
//!
//! All memory is lent by the caller, see [`memory_words`]; besides that a search needs less than 12 KiB of stack.
//!
//! ```
//! use eeruf_core::search::design::{Problem, memory_words, shortest};
//!
//! // Four sensors side by side, none of which may fire within 15 ms of another; readings are told apart by 2 ms.
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
//! # Ok::<(), eeruf_core::search::design::ProblemError>(())
//! ```

mod bounds;
mod changes;
mod choose;
mod classes;
mod control;
mod frame;
mod hunt;
mod largest;
mod network;
mod packing;
mod place;
mod problem;
mod propagate;
mod random;
mod ranks;
mod reason;
mod schedule;
mod shortest;
mod symmetry;
#[cfg(feature = "std")]
mod threads;
mod tree;

pub use bounds::Bound;
pub use control::{Control, POLL, Progress};
pub use largest::{Choice, Largest, Preferred, largest_interval, largest_separation, prefer};
pub(super) use problem::one_by_one;
pub use problem::{MAX_TICKS, Problem, ProblemError};
pub use reason::{InTime, Reason};
pub use schedule::Firing;
pub use shortest::{Answer, Decision, Effect, Relaxations, Shortest, decide, relaxations, shortest};
#[cfg(feature = "std")]
pub use threads::shortest_on_threads;

use crate::schedule::MAX_SENSORS;

/// The words of memory that every search over `sensors` sensors needs: 52 KiB for 12 sensors, 4.4 MiB for 64.
///
/// It is `const`, so the memory can be an array of `[i32; memory_words(12)]`, in a `static` or on the stack.
#[must_use]
pub const fn memory_words(sensors: usize) -> usize {
    tree::words(sensors)
}

/// The memory, if it is large enough.
fn check_memory(memory: &mut [i32], sensors: usize) -> Result<&mut [i32], ProblemError> {
    let (words, needed) = (memory.len(), memory_words(sensors));
    if words < needed { Err(ProblemError::Memory { words, needed }) } else { Ok(memory) }
}
