//! [`Scheduler`]: what a ring asks of whatever decides when to fire.
//!
//! A scheduler never reads a clock. The caller passes `now` and gets the next deadline back.

use crate::schedule::Phase;
use crate::time::{Instant, Micros};

/// What a scheduler wants done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SchedulerStep {
    /// Fire this sensor, now.
    Fire {
        /// The sensor, from 0.
        sensor: u8,
        /// The phase its wait belongs to.
        phase: Phase,
        /// How long ago it was due.
        late: Micros,
    },
    /// A period has ended.
    PeriodEnded {
        /// Its phase.
        phase: Phase,
        /// Whether another schedule begins with the next one.
        changed: bool,
    },
}

/// Decides when each sensor of a ring fires: [`ScheduledFiring`](super::ScheduledFiring) or
/// [`ImmediateRefiring`](super::ImmediateRefiring).
pub trait Scheduler {
    /// The next step, if one is due. Call again until there is none.
    #[inline]
    fn poll(&mut self, now: Instant) -> Option<SchedulerStep> {
        let due = self.deadline();
        if !now.has_reached(due) {
            return None;
        }
        let Some((sensor, phase)) = self.next_firing() else {
            let (phase, changed) = self.end_period(now);
            return Some(SchedulerStep::PeriodEnded { phase, changed });
        };
        self.fire(now);
        Some(SchedulerStep::Fire { sensor, phase, late: now.since(due) })
    }
    /// When the next step is due.
    fn deadline(&self) -> Instant;
    /// The sensor that fires next and the phase of its wait; none if the period ends next.
    fn next_firing(&self) -> Option<(u8, Phase)>;
    /// Fires that sensor, `now`. To be called when it is due.
    fn fire(&mut self, now: Instant);
    /// Ends the period, `now`. Returns its phase, and whether another schedule begins with the next one. To be called
    /// when that is due.
    fn end_period(&mut self, now: Instant) -> (Phase, bool);
    /// A sensor has stopped listening: its echo came in, or its window closed, `at` this instant.
    fn ended(&mut self, sensor: u8, at: Instant);
    /// Lets a sensor fire from its next turn on, or stops it.
    fn set_enabled(&mut self, sensor: u8, enabled: bool);
    /// Whether a sensor fires.
    fn is_enabled(&self, sensor: u8) -> bool;
    /// Starts again with phase a, no sooner than `now`.
    fn restart(&mut self, now: Instant);
    /// How many periods ago the last period with this phase was, 0 for the present one; 0 without common phases.
    fn periods_since(&self, phase: Phase) -> u8;
    /// How long a sensor may listen: it never fires again within this time of firing, unless it has ended.
    fn longest_window(&self) -> Micros;
    /// No deadline lies further ahead than this, unless the clock has jumped.
    fn horizon(&self) -> Micros;
}
