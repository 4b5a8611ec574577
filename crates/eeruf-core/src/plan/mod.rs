//! When sensors fire: the trait [`Plan`], with *scheduled firing* and *immediate refiring* (Sec. 3.1, Figs. 2, 3), and
//! the limits of single sensors.
//!
//! A plan learns of echoes only from its ring. [`check_plan`] tests a plan of your own against the contract.

mod check;
mod contract;
mod immediate;
mod scheduled;

pub use check::{BrokenPromise, check_plan};
pub use contract::{Plan, PlanLimits, Upcoming};
pub use immediate::{ImmediateRefiring, Refiring};
pub use scheduled::{ScheduledFiring, TableFiring};

pub use crate::own_limits::OwnLimits;
