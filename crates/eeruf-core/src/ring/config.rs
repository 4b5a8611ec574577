//! [`RingConfig`]: the settings of a ring.

use crate::filter::{Consecutive, Tolerance};
use crate::plan::Plan;
use crate::ring_error::RingError;
use crate::time::Micros;

/// The meaning of a firing without an echo whose sensor has not shown that it listened
/// ([`Ring::answered`](super::Ring::answered), [`Ring::measured`](super::Ring::measured)).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum Silence {
    /// Neither free space nor a fault: always [`NoEcho`](crate::ReadingKind::NoEcho), however often it repeats.
    #[default]
    NeverFree,
    /// A fault, [`Unanswered`](crate::ReadingKind::Unanswered), for drivers whose sensors show that they listen, for
    /// instance by a line that rises.
    NeedsAnswer,
    /// Silence counts as if the sensor had shown that it listened: [`Clear`](crate::ReadingKind::Clear) once repeated.
    /// For simulations, and sensors that cannot fail silently: a cut wire counts as free space.
    Trusted,
}

/// Settings by which a [`Ring`](super::Ring) listens and compares; `E` is the number of echoes that a sensor reports
/// per firing.
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
    /// `T_delta`: the greatest difference between near-identical consecutive readings. `None` for the verified
    /// schedule's.
    pub t_delta: Option<Micros>,
    /// `T_wind`: how long a sensor listens after it has fired. An echo at exactly this time still counts. `None` for
    /// the verified schedule's.
    pub window: Option<Micros>,
    /// Time after a firing in which edges count as ringing of the transducer, not as echoes.
    pub blanking: Micros,
    /// The number of consecutive readings that must agree, 2 to 8.
    pub consecutive: u8,
    /// P: the largest change, in time, of the length of a foreign sound's path from one reading to the next. Crosstalk
    /// that changes by no more is never accepted. `None` for `T_delta`, as in the paper. A robot that moves at `v`
    /// needs the jitter plus `2 v dt / c`. A value below `T_delta` makes fewer readings ambiguous if firings are late.
    /// At most 65,534 us.
    pub path_change: Option<Micros>,
    /// R: how long sound is audible after its firing. `None` for the verified schedule's; without one, the period
    /// or, with immediate refiring, the listening time or the least refire time. 1 ms to 67 s.
    pub audible: Option<Micros>,
}

impl RingConfig {
    /// Settings with the `t_delta` and window that the schedule was verified for, one echo, no blanking, and two
    /// readings compared, as in the paper.
    pub const fn new() -> Self {
        Self { t_delta: None, window: None, blanking: Micros::ZERO, consecutive: 2, path_change: None, audible: None }
    }
}

impl Default for RingConfig {
    fn default() -> Self {
        Self::new()
    }
}

impl<const E: usize> RingConfig<E> {
    /// The tolerance of comparison; defaults come from the plan's verified schedule.
    pub(super) fn tolerance(&self, plan: &impl Plan) -> Result<Tolerance, RingError> {
        let verified_for = plan.limits().verified_for;
        let t_delta = self.t_delta.or(verified_for.map(|verified_for| verified_for.t_delta));
        let t_delta = t_delta.ok_or(RingError::Unverified)?;
        Ok(Tolerance::new(t_delta, Consecutive::new(self.consecutive)?))
    }

    /// Sets `t_delta`: at most what the schedule was verified for.
    #[must_use]
    pub const fn with_t_delta(self, t_delta: Micros) -> Self {
        Self { t_delta: Some(t_delta), ..self }
    }

    /// Sets the listening window: at most what the schedule was verified for.
    #[must_use]
    pub const fn with_window(self, window: Micros) -> Self {
        Self { window: Some(window), ..self }
    }

    /// Sets the blanking time, shorter than the window.
    #[must_use]
    pub const fn with_blanking(self, blanking: Micros) -> Self {
        Self { blanking, ..self }
    }

    /// Sets the number of consecutive readings that must agree, 2 to 8.
    #[must_use]
    pub const fn with_consecutive(self, consecutive: u8) -> Self {
        Self { consecutive, ..self }
    }

    /// Sets the largest change of a foreign path from one reading to the next.
    #[must_use]
    pub const fn with_path_change(self, path_change: Micros) -> Self {
        Self { path_change: Some(path_change), ..self }
    }

    /// Sets how long sound is audible.
    #[must_use]
    pub const fn with_audible(self, audible: Micros) -> Self {
        Self { audible: Some(audible), ..self }
    }

    /// Sets the number of echoes that a sensor reports per firing.
    #[must_use]
    pub const fn with_echoes<const N: usize>(self) -> RingConfig<N> {
        let Self { t_delta, window, blanking, consecutive, path_change, audible } = self;
        RingConfig { t_delta, window, blanking, consecutive, path_change, audible }
    }
}
