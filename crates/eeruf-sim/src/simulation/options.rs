//! Options of a simulation besides the world and the method.

use crate::{methods::FlowOptions, world::AnySchedule};

/// Duration, seed, and settings of some methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Number of periods of the first robot. Its own `period` counts under any method, so that all methods run for the
    /// same time. The default is 1000.
    pub periods: u32,
    /// A seed that replaces the world's.
    pub seed: Option<u64>,
    /// Schedule of [`Method::EerufBest`](crate::Method::EerufBest), for every robot with its number of sensors. Other
    /// robots, and all with `None`, use [`Method::Eeruf`](crate::Method::Eeruf).
    pub best: Option<AnySchedule>,
    /// Number of readings of which [`Method::Median`](crate::Method::Median) takes the median, 1 to 15. The default is
    /// 3.
    pub median_of: u8,
    /// Settings of [`Method::Flow`](crate::Method::Flow) that override those of the robot.
    pub flow: FlowOptions,
}

impl Default for Options {
    fn default() -> Self {
        Self { periods: 1000, seed: None, best: None, median_of: 3, flow: FlowOptions::default() }
    }
}

impl Options {
    /// Makes options for this many periods.
    pub fn periods(periods: u32) -> Self {
        Self { periods, ..Self::default() }
    }
}
