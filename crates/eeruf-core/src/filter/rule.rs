//! [`Rule`]: when two readings are near-identical (Eq. 11).

use super::agreement::Agreement;
use super::echoes::NO_ECHO;
use crate::time::Micros;

/// When two readings agree, and how often they must.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub(crate) struct Rule {
    pub(crate) t_delta: Micros,
    pub(crate) agreement: Agreement,
}

impl Rule {
    /// Eq. (11), after taking off the change that is expected.
    pub(super) fn near_identical(self, echo: u32, previous: u32, expected_change_us: i32) -> bool {
        if echo == NO_ECHO || previous == NO_ECHO {
            return echo == previous;
        }
        let change = i64::from(echo) - i64::from(previous) - i64::from(expected_change_us);
        change.unsigned_abs() <= u64::from(self.t_delta.as_micros())
    }
}
