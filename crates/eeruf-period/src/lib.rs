//! The shortest period of a firing schedule for a ring of ultrasonic sensors, proven.
//!
//! [`PeriodProblem`] is the user's question, in microseconds: every sensor fires once per period, at any multiple of a
//! tick; which schedule that meets the [`Requirements`](eeruf_core::Requirements) has the shortest period? Sensors may
//! be alike or not, share echo lines or fire together. [`engine`] is the search, in whole ticks, and the proofs.
//!
//! | To .. | there is |
//! |---|---|
//! | find the shortest period | [`PeriodProblem::shortest`] |
//! | decide whether a period is possible | [`PeriodProblem::decide`] |
//! | choose among the schedules of a period | [`PeriodProblem::prefer`] |
//! | find the largest `t_delta` of a period | [`PeriodProblem::largest_t_delta`] |
//! | explain why nothing is shorter | [`ShortestPeriod::reason`] |
//! | prove it to others | [`PeriodProblem::claim`], [`engine::prove`] |
//!
//! The outcome, the watcher and the errors of a search are those of [`eeruf_core::search`]. The same question has the
//! same answer on each machine: there is no clock, and random numbers come from a fixed seed.

pub mod engine;
mod period_problem;
mod random;
mod reason;

pub use period_problem::{PeriodProblem, ShortestPeriod, ToSpare};
pub use random::Random;

/// Doctest of the crate's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
