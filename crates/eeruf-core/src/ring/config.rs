//! [`RingConfig`]: how a ring listens and compares.

use crate::time::Micros;

/// How a [`Ring`](super::Ring) listens and compares.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RingConfig {
    /// `T_delta`: consecutive readings that differ by no more are near-identical.
    pub t_delta: Micros,
    /// `T_wind`: how long a sensor listens after it has fired. An echo at exactly this time still counts.
    pub window: Micros,
    /// Edges sooner than this after firing are ringing of the transducer, not echoes.
    pub blanking: Micros,
    /// How many readings in a row must agree, 2 to 8.
    pub consecutive: u8,
    /// For how many firings an accepted echo that is missing is waited for, 0 to 15; see
    /// [`EchoFilter::with_patience`](crate::EchoFilter::with_patience).
    pub patience: u8,
}

impl RingConfig {
    /// This `t_delta` and window, no blanking, two readings compared and no patience, as in the paper.
    pub const fn new(t_delta: Micros, window: Micros) -> Self {
        Self { t_delta, window, blanking: Micros::ZERO, consecutive: 2, patience: 0 }
    }
}
