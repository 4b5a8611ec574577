//! [`Plan`]: the interface between a ring and the rule that decides when it fires.
//!
//! A plan never reads a clock. The caller passes `now` and gets the next deadline back.

use crate::judging::{FiringContext, Heard, Judge, Pace};
use crate::own_limits::SensorLimits;
use crate::reading::Verdict;
use crate::schedule::{Phase, VerifiedFor};
use crate::time::{Instant, Micros};

/// A firing that is planned or due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Upcoming {
    /// The sensor, from 0.
    pub sensor: u8,
    /// The phase whose wait applies to the firing.
    pub phase: Phase,
    /// Time when the firing is due.
    pub due: Instant,
}

/// Limits that a plan sets for its ring.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlanLimits<'s> {
    /// Longest listening time of a sensor: it does not fire again within this time unless it has stopped listening.
    pub longest_window: Micros,
    /// Requirements that the schedule was verified for, if it was: the ring may ask for less but not for more.
    pub verified_for: Option<&'s VerifiedFor>,
    /// Time for which sound is assumed audible: the verified requirements' time, or the period. `None` without a
    /// common period.
    pub audible: Option<Micros>,
}

/// Decides when each sensor of a ring fires: [`ScheduledFiring`](super::ScheduledFiring),
/// [`ImmediateRefiring`](super::ImmediateRefiring), [`InTurn`](crate::flow::InTurn), or one of your own.
pub trait Plan {
    /// The next firing that is due, for a plan that runs without a ring; periods end by themselves. Call again until
    /// there is none.
    #[inline]
    fn poll(&mut self, now: Instant) -> Option<Upcoming> {
        loop {
            let due = self.deadline();
            if !now.has_reached(due) {
                if due.since(now) > self.horizon() {
                    // The clock has jumped, or the ring was not polled for half a turn of it.
                    self.restart(now);
                }
                return None;
            }
            if let Some((sensor, phase)) = self.next_firing() {
                self.fire(now);
                return Some(Upcoming { sensor, phase, due });
            }
            self.end_period(now);
        }
    }
    /// Returns the time when the next step is due.
    fn deadline(&self) -> Instant;
    /// The sensor that fires next and the phase of its wait; `None` if the period ends next.
    fn next_firing(&self) -> Option<(u8, Phase)>;
    /// The next firings in order, assuming that none is late: all that are decided, at least this period's next one.
    fn upcoming(&self) -> impl Iterator<Item = Upcoming> {
        let due = self.deadline();
        self.next_firing().map(|(sensor, phase)| Upcoming { sensor, phase, due }).into_iter()
    }
    /// Fires the next sensor, at `now`. Call it when the firing is due.
    fn fire(&mut self, now: Instant);
    /// Postpones a sensor's firing, which happened later than the call of [`fire`](Self::fire): everything that depends
    /// on it moves by as much, and no later interval gets shorter.
    fn postpone(&mut self, sensor: u8, by: Micros);
    /// Ends the period at `now` and returns its phase. The flag is true if the next period does not follow as
    /// scheduled, because another schedule begins or periods were skipped. Call it when the end is due.
    fn end_period(&mut self, now: Instant) -> (Phase, bool);
    /// Notes a sensor's reading with its verdict, and the judge, for plans that depend on beliefs.
    fn judged(&mut self, _heard: &Heard<'_>, _verdict: &Verdict, _judge: &impl Judge) {}
    /// Corrects a sensor's last firing to this instant.
    fn fired(&mut self, _sensor: u8, _at: Instant) {}
    /// Notes that a sensor stopped listening `at` this instant: its echo came in, or its window closed.
    fn ended(&mut self, sensor: u8, at: Instant);
    /// Counts the next firing as due no sooner than this instant, from which its lateness is measured.
    fn due_from(&mut self, _soonest: Instant) {}
    /// Forgets a sensor's readings, and all that depends on them.
    fn forget(&mut self, _sensor: u8) {}
    /// Number of sensors that the plan fires.
    fn sensors(&self) -> usize;
    /// Enables a sensor from its next turn on, or disables it.
    fn set_enabled(&mut self, sensor: u8, enabled: bool);
    /// Pauses all sensors, or resumes them; periods continue.
    fn set_paused(&mut self, paused: bool);
    /// Returns true if a sensor is enabled, whether or not the plan is paused.
    fn is_enabled(&self, sensor: u8) -> bool;
    /// Tells the plan how the robot moves.
    fn set_pace(&mut self, _pace: Pace) {}
    /// Starts again with phase a, at `now` or later.
    fn restart(&mut self, now: Instant);
    /// The context of a sensor's last firing, which was `periods_ago` periods before the current one.
    fn last_firing(&self, sensor: u8, periods_ago: u8) -> FiringContext;
    /// Limits in the current period.
    fn limits(&self) -> PlanLimits<'_>;
    /// Limits from the next period on, if the schedule changes then.
    fn next_limits(&self) -> Option<PlanLimits<'_>> {
        None
    }
    /// Returns true if `receiver` can hear `emitter`: always, except for sensors that fire together and were declared
    /// not to hear each other.
    fn hears(&self, _receiver: u8, _emitter: u8) -> bool {
        true
    }
    /// Limits of one sensor if sensors differ, which the ring respects too; `None` if all are alike.
    fn limits_of(&self, _sensor: u8) -> Option<SensorLimits> {
        None
    }
    /// The least time between two firings of a sensor.
    fn min_refire(&self) -> Micros;
    /// Longest time to a deadline, unless the clock has jumped.
    fn horizon(&self) -> Micros;
}
