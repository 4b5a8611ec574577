//! [`VerifiedFor`]: the requirements that a schedule was verified for.

use crate::time::Micros;

/// Requirements that a schedule was verified for. Only [`Schedule::verified`](crate::Schedule::verified) makes one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct VerifiedFor {
    /// `T_delta`, for which (13a), (13b) hold; the smallest if sensors have their own.
    pub t_delta: Micros,
    /// The least interval between neighbours; if sensors differ, the longest time between firings that any pair or any
    /// single sensor keeps. The first period of another schedule waits for it.
    pub min_interval: Micros,
    /// `T_wind`; the smallest if sensors have their own, and the shortest refire time if no window was asked for.
    pub window: Micros,
    /// The least shift of crosstalk from one reading to the next, `2 t_delta + 1 us` or more.
    pub separation: Micros,
    /// P: the largest change of a path from one reading to the next; `None` for `t_delta`.
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
