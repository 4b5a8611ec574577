//! When to fire: the trait [`Plan`], *scheduled firing* and *immediate refiring*.
//!
//! The room uses [`time`](crate::time), [`schedule`](crate::schedule) and sets of sensors; it knows nothing of echoes.

mod check;
mod contract;
mod immediate;
mod scheduled;

pub use check::{BrokenPromise, check_plan};
pub use contract::{Limits, Plan, PlanStep};
pub use immediate::ImmediateRefiring;
pub use scheduled::ScheduledFiring;
