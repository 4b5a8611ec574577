//! The firing methods that are compared: one table of them, the schedules that they fire by, and core's ring behind
//! each. It uses `world` for the robots that fire; to add a method, add a row to the table in `method`.

mod adaptive;
mod best_schedule;
mod dither;
mod firing;
mod flow;
mod judges;
mod method;
mod ring_runner;
mod schedules;
mod sketch;

pub use best_schedule::{TICK, best_schedule_for, requirements_of, shortest_schedule_for};
pub use firing::{Firing, FiringPeriod, OwnError};
pub use flow::FlowOptions;
pub(crate) use judges::{Judging, MAX_MEDIAN};
pub(crate) use method::MAX_ECHOES;
pub use method::{Method, UnknownMethod};
pub(crate) use ring_runner::{ChangeError, FiringPlan, RingRunner, RingStart, StartError, planned};
pub use schedules::table_i_d_for;
