//! [`Tolerance`]: when two readings are near-identical (Eq. 11), and how many consecutive readings must agree.

use super::echoes::NO_ECHO;
use crate::ring_error::RingError;
use crate::time::Micros;

/// The tolerance of Eq. (11), and the number of consecutive readings that confirm an echo.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Tolerance {
    pub(crate) t_delta: Micros,
    pub(super) consecutive: Consecutive,
}

/// The number of consecutive readings that must agree, 2 to 8.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Consecutive(u8);

impl Consecutive {
    pub(crate) const fn new(consecutive: u8) -> Result<Self, RingError> {
        if consecutive < 2 || consecutive > 8 {
            return Err(RingError::Consecutive { consecutive });
        }
        Ok(Self(consecutive))
    }

    pub(super) const fn get(self) -> u8 {
        self.0
    }
}

impl Tolerance {
    pub(crate) const fn new(t_delta: Micros, consecutive: Consecutive) -> Self {
        Self { t_delta, consecutive }
    }

    pub(super) const fn consecutive(self) -> u8 {
        self.consecutive.get()
    }

    /// Tests Eq. (11) after subtracting the expected change. Silence agrees with silence.
    pub(super) fn near_identical(self, echo: Micros, previous: Micros, expected_change_us: i32) -> bool {
        if echo == NO_ECHO || previous == NO_ECHO {
            return echo == previous;
        }
        if expected_change_us == 0 {
            return echo.abs_diff(previous) <= self.t_delta;
        }
        let change = i64::from(echo.as_micros()) - i64::from(previous.as_micros()) - i64::from(expected_change_us);
        change.unsigned_abs() <= u64::from(self.t_delta.as_micros())
    }
}
