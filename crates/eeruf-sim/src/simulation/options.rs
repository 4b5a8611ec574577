//! What can be asked for besides the world and the method.

use eeruf_core::{
    MAX_SENSORS,
    flow::FlowSettings,
    hopping::{HoppingSchedule, HoppingSettings},
};

use crate::world::AnySchedule;

/// How long, with which seed, and what some methods need to know.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// For how many periods of the first robot (its `period`, whatever the method fires by), so that all methods run
    /// for the same time. The default is 1000.
    pub periods: u32,
    /// Another seed than the world's.
    pub seed: Option<u64>,
    /// What [`Method::EerufBest`](crate::Method::EerufBest) fires by, on every robot with as many sensors; the others
    /// and `None` fall back to [`Method::Eeruf`](crate::Method::Eeruf).
    pub best: Option<AnySchedule>,
    /// How many readings [`Method::Median`](crate::Method::Median) takes the median of, 1 to 15. The default is 3.
    pub median_of: u8,
    /// How [`Method::EerufHopping`](crate::Method::EerufHopping) fires and believes; how many sensors are neighbours,
    /// the robot says. The default is [`HoppingSettings::BALANCED`].
    pub hopping: HoppingSettings,
    /// What [`Method::EerufHopping`](crate::Method::EerufHopping) fires by, of as many
    /// sensors as every robot has; `None` for even lags over the robot's period.
    pub hopping_schedule: Option<HoppingSchedule<MAX_SENSORS>>,
    /// Settings of [`Method::Flow`](crate::Method::Flow); the robot's period is its shortest cycle. The
    /// default is [`FlowSettings::DEFAULT`].
    pub flow: FlowSettings,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            periods: 1000,
            seed: None,
            best: None,
            median_of: 3,
            hopping: HoppingSettings::BALANCED,
            hopping_schedule: None,
            flow: FlowSettings::DEFAULT,
        }
    }
}

impl Options {
    /// For this many periods.
    pub fn periods(periods: u32) -> Self {
        Self { periods, ..Self::default() }
    }
}
