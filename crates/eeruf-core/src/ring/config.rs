//! [`RingConfig`]: how a ring listens and compares.

use crate::time::Micros;

/// How a [`Ring`](super::Ring) listens and compares; `E` is the number of echoes that a sensor reports of one firing.
///
/// ```
/// use eeruf_core::{Micros, RingConfig};
/// const CONFIG: RingConfig = RingConfig::new().with_blanking(Micros::new(500)).with_consecutive(3);
/// const EIGHT_ECHOES: RingConfig<8> = CONFIG.with_echoes();
/// assert_eq!(EIGHT_ECHOES.blanking, Micros::new(500));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct RingConfig<const E: usize = 1> {
    /// `T_delta`: consecutive readings that differ by no more are near-identical. `None` for what the schedule was
    /// verified for.
    pub t_delta: Option<Micros>,
    /// `T_wind`: how long a sensor listens after it has fired. An echo at exactly this time still counts. `None` for
    /// what the schedule was verified for.
    pub window: Option<Micros>,
    /// Edges sooner than this after firing are ringing of the transducer, not echoes.
    pub blanking: Micros,
    /// How many readings in a row must agree, 2 to 8.
    pub consecutive: u8,
    /// For how many firings an accepted echo that is missing is waited for, 0 to 15; see
    /// [`EchoFilter::with_patience`](crate::EchoFilter::with_patience).
    pub patience: u8,
}

impl RingConfig {
    /// The `t_delta` and window that the schedule was verified for, one echo, no blanking, two readings compared and no
    /// patience, as in the paper.
    pub const fn new() -> Self {
        Self { t_delta: None, window: None, blanking: Micros::ZERO, consecutive: 2, patience: 0 }
    }
}

impl Default for RingConfig {
    fn default() -> Self {
        Self::new()
    }
}

impl<const E: usize> RingConfig<E> {
    /// With this `t_delta`: at most what the schedule was verified for.
    #[must_use]
    pub const fn with_t_delta(self, t_delta: Micros) -> Self {
        Self { t_delta: Some(t_delta), ..self }
    }

    /// With this listening window: at most what the schedule was verified for.
    #[must_use]
    pub const fn with_window(self, window: Micros) -> Self {
        Self { window: Some(window), ..self }
    }

    /// Deaf for this long after firing; shorter than the window.
    #[must_use]
    pub const fn with_blanking(self, blanking: Micros) -> Self {
        Self { blanking, ..self }
    }

    /// With so many readings in a row that must agree, 2 to 8.
    #[must_use]
    pub const fn with_consecutive(self, consecutive: u8) -> Self {
        Self { consecutive, ..self }
    }

    /// With so much patience, 0 to 15 firings.
    #[must_use]
    pub const fn with_patience(self, patience: u8) -> Self {
        Self { patience, ..self }
    }

    /// For sensors that report up to `N` echoes of one firing.
    #[must_use]
    pub const fn with_echoes<const N: usize>(self) -> RingConfig<N> {
        let Self { t_delta, window, blanking, consecutive, patience } = self;
        RingConfig { t_delta, window, blanking, consecutive, patience }
    }
}
