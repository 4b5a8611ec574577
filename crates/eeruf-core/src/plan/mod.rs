//! When sensors fire: the trait [`Plan`], with *scheduled firing* and *immediate refiring* (Sec. 3.1, Figs. 2, 3), and
//! whether sensors have limits of their own.
//!
//! A plan knows nothing of echoes but what a ring tells it. [`check_plan`] tries what a plan of the caller's own has to
//! keep.

mod check;
mod contract;
mod immediate;
mod scheduled;

pub use check::{BrokenPromise, check_plan};
pub use contract::{Plan, PlanLimits, Upcoming};
pub use immediate::{ImmediateRefiring, Refiring};
pub use scheduled::{ScheduledFiring, TableFiring};

pub use crate::own_limits::OwnLimits;
