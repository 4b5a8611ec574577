//! When to fire: the trait [`Scheduler`], *scheduled firing* and *immediate refiring*.
//!
//! The room uses [`time`](crate::time), [`schedule`](crate::schedule) and sets of sensors; it knows nothing of echoes.

mod check;
mod contract;
mod immediate;
mod scheduled;
mod uneven;

pub use check::{BrokenPromise, check_scheduler};
pub use contract::{Limits, Scheduler, SchedulerStep};
pub use immediate::ImmediateRefiring;
pub use scheduled::ScheduledFiring;
pub use uneven::UnevenFiring;
