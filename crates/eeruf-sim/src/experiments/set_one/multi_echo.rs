//! Settings of sensors that report several echoes.

use eeruf_core::Micros;

use crate::world::Robot;

/// The settings by which [`Method::MultiEcho`](crate::Method::MultiEcho) compares. With up to eight echoes a firing,
/// pairs of them agree by accident in proportion to `t_delta`; a robot that stands needs only the jitter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MultiEcho {
    /// Number of readings that must agree, 2 to 8. As many periods pass before a new echo is believed.
    pub consecutive: u8,
    /// Greatest difference of readings that agree.
    pub t_delta: Micros,
}

impl MultiEcho {
    /// The best of the grid that `cargo lab tune` tries on alcoves below 2,000, by the sum of wrong and lost readings.
    pub const TUNED: Self = Self { consecutive: 2, t_delta: Micros::new(200) };

    /// The robot with these settings.
    pub(super) fn of(self, robot: Robot) -> Robot {
        let Self { consecutive, t_delta } = self;
        Robot { consecutive, t_delta, ..robot }
    }
}
