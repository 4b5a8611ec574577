//! Settings of sensors that report several echoes.

use eeruf_core::Micros;

use crate::world::Robot;

/// Settings for the comparison of several echoes by [`Method::MultiEcho`](crate::Method::MultiEcho). With up to eight
/// echoes per firing, a larger `t_delta` lets more pairs agree by accident; at rest it covers the jitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MultiEcho {
    /// Number of readings that must agree, 2 to 8. A new echo is believed after as many periods.
    pub consecutive: u8,
    /// Greatest difference of readings that agree.
    pub t_delta: Micros,
}

impl MultiEcho {
    /// The best settings of a grid, on alcoves below 2,000, by the sum of wrong and lost readings.
    pub const TUNED: Self = Self { consecutive: 2, t_delta: Micros::new(200) };

    /// Returns the robot with these settings.
    pub(super) fn of(self, robot: Robot) -> Robot {
        let Self { consecutive, t_delta } = self;
        Robot { consecutive, t_delta, ..robot }
    }
}
