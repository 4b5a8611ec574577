//! Flow: one sensor after the other, each with as much quiet around its firing as it has needed.
//!
//! A sensor that other sensors fool gains quiet, one whose readings are believed gives it back, so that a ring in the
//! open fires fast and one in a closed room nearly one by one. Firing times lie on a grid, and on it move by
//! [Welch's sequence](crate::hopping::HoppingCode): crosstalk of one path never repeats from phase to phase, however
//! gaps change. An [`EchoTracker`] believes what several phases support.
//!
//! Rules and measurements: `docs/explanation/flow.md`.

mod plan;
mod planning;
mod settings;
mod slot;
#[cfg(test)]
mod tests;

use crate::hopping::{HoppingError, HoppingListening};
use crate::own_limits::OwnLimits;
use crate::ring::{Ring, RingConfig};
use crate::time::Instant;
use crate::tracker::EchoTracker;

pub use plan::FlowPlan;
pub use settings::FlowSettings;

/// A ring of up to `K` sensors that fires by flow, with `H` hypotheses for each and up to `E` echoes of a firing. `U`
/// is [`EachSensor`](crate::EachSensor) where sensors have limits of their own.
pub type FlowRing<const K: usize, const H: usize = 4, const E: usize = 1, U = ()> =
    Ring<FlowPlan<K, U>, EchoTracker<K, H, E>, K, E, 1>;

impl<const K: usize, const H: usize, const E: usize> FlowRing<K, H, E> {
    /// A ring of `sensors` sensors that begins at `now`.
    ///
    /// # Errors
    /// [`HoppingError`] for a setting out of its range, as for [`FlowPlan::new`]; or for a window that ends within the
    /// blanking time.
    pub fn flow(
        sensors: usize,
        settings: FlowSettings,
        listening: HoppingListening,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        Self::with_limits(sensors, (), settings, listening, now)
    }
}

impl<const K: usize, const H: usize, const E: usize, U: OwnLimits> FlowRing<K, H, E, U> {
    /// As [`flow`](FlowRing::flow), for sensors that have limits of their own, by [`FlowSettings::limits`]. What
    /// `listening` and the tracker's `t_delta` say is the most for all.
    ///
    /// # Errors
    /// As there.
    #[inline(always)]
    pub fn with_limits(
        sensors: usize,
        own_limits: U,
        settings: FlowSettings,
        listening: HoppingListening,
        now: Instant,
    ) -> Result<Self, HoppingError> {
        let tracker = EchoTracker::new(settings.tracker)?;
        let plan = FlowPlan::with_limits(sensors, own_limits, settings, listening, now)?;
        let config = RingConfig::new().with_window(listening.window).with_blanking(listening.blanking);
        Ok(Self::judged_by(plan, tracker, config.with_echoes::<E>(), now)?)
    }
}
