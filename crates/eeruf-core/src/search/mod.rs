//! Search for schedules, exhaustive and proven.
//!
//! - [`wait`]: the paper's problem: lags are given, waits are sought on a grid.
//! - [`design`]: the user's problem: firing times are free, the shortest period is sought.
//!
//! Both work in whole ticks and in memory that the caller lends, without recursion, clock or chance.

pub mod design;
pub mod wait;
