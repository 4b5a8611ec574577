//! The shortest period for a ring of sensors, proven.

mod bounds;
mod control;
mod frame;
mod hunt;
mod largest;
mod network;
mod packing;
mod problem;
mod propagate;
mod random;
mod schedule;
mod shortest;
mod symmetry;
mod tree;

pub use bounds::Bound;
pub use control::{Control, Flow, POLL, Progress};
pub use largest::{Choice, Largest, Preferred, largest_interval, largest_separation, prefer};
pub use problem::{MAX_SENSORS, MAX_TICKS, Problem, ProblemError};
pub use schedule::Firing;
pub use shortest::{Answer, Decision, Effect, Reason, Relaxations, Shortest, decide, relaxations, shortest};

/// The words of memory that every search over `sensors` sensors needs: 51 KiB for 12 sensors, 4.6 MiB for 64.
///
/// It can be a `static`: `static mut`-free programs lend a local or a `StaticCell` of `[i32; memory_words(12)]`.
#[must_use]
pub const fn memory_words(sensors: usize) -> usize {
    tree::words(sensors)
}

/// The memory, if it is large enough.
fn check_memory(memory: &mut [i32], sensors: usize) -> Result<&mut [i32], ProblemError> {
    let (words, needed) = (memory.len(), memory_words(sensors));
    if words < needed { Err(ProblemError::Memory { words, needed }) } else { Ok(memory) }
}
