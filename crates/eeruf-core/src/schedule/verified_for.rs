//! [`VerifiedFor`]: what a schedule was verified for.

use crate::time::Micros;

/// Requirements that a schedule was verified for, where it was. Only
/// [`Schedule::verified`](crate::Schedule::verified) makes one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct VerifiedFor {
    /// `T_delta`, for which (13a), (13b) hold; the smallest where sensors have their own.
    pub t_delta: Micros,
    /// The least interval between neighbours; where sensors are not all alike, the longest time that any pair, or any
    /// sensor for itself, keeps between firings: a period that another schedule begins waits for it.
    pub min_interval: Micros,
    /// `T_wind`; the shortest refire time where no window was asked for, the smallest where sensors have their own.
    pub window: Micros,
    /// The least shift of crosstalk from one reading to the next, `2 t_delta + 1 us` or more.
    pub separation: Micros,
    /// P: the largest change of a path from one reading to the next; `None` for as much as `t_delta`.
    pub path_change: Option<Micros>,
    /// R: how long sound may be audible.
    pub audible: Micros,
}

impl VerifiedFor {
    /// The requirements of a schedule that was not verified: none.
    pub(crate) const NOTHING: Self = Self {
        t_delta: Micros::ZERO,
        min_interval: Micros::ZERO,
        window: Micros::ZERO,
        separation: Micros::ZERO,
        path_change: None,
        audible: Micros::ZERO,
    };
}
