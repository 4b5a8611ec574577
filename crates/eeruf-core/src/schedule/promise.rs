//! [`Promise`]: what a schedule was verified for.

use crate::time::Micros;

/// What a schedule was verified for, where it was.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Promise {
    /// `T_delta`.
    pub(crate) t_delta: Micros,
    /// The least interval between neighbours.
    pub(crate) min_interval: Micros,
    /// `T_wind`.
    pub(crate) window: Micros,
    /// By how much crosstalk moves at least from one reading to the next, `2 t_delta + 1 us` or more.
    pub(crate) separation: Micros,
}
