//! Options of a simulation besides the world and the method.

use crate::{methods::FlowOptions, world::AnySchedule};

/// Duration, seed, and settings of some methods.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Number of periods of the first robot (of its `period`, whatever the method), so that all methods run for the
    /// same time. The default is 1000.
    pub periods: u32,
    /// A seed other than the world's.
    pub seed: Option<u64>,
    /// Schedule of [`Method::EerufBest`](crate::Method::EerufBest), on every robot with as many sensors; the others and
    /// `None` fall back to [`Method::Eeruf`](crate::Method::Eeruf).
    pub best: Option<AnySchedule>,
    /// Number of readings that [`Method::Median`](crate::Method::Median) takes the median of, 1 to 15. The default is
    /// 3.
    pub median_of: u8,
    /// Settings of [`Method::Flow`](crate::Method::Flow) that differ from the robot's.
    pub flow: FlowOptions,
}

impl Default for Options {
    fn default() -> Self {
        Self { periods: 1000, seed: None, best: None, median_of: 3, flow: FlowOptions::default() }
    }
}

impl Options {
    /// Options for this many periods.
    pub fn periods(periods: u32) -> Self {
        Self { periods, ..Self::default() }
    }
}
