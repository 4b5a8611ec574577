//! [`Plan`]: what a ring asks of whatever decides when to fire.
//!
//! A plan never reads a clock. The caller passes `now` and gets the next deadline back.

use crate::judging::{FiringContext, Heard, Judge, Pace};
use crate::own_limits::SensorLimits;
use crate::reading::Verdict;
use crate::schedule::{Phase, VerifiedFor};
use crate::time::{Instant, Micros};

/// A firing to come, or one that is due.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Upcoming {
    /// The sensor, from 0.
    pub sensor: u8,
    /// The phase its wait belongs to.
    pub phase: Phase,
    /// Time when it is due.
    pub due: Instant,
}

/// Limits that a plan sets to the ring it fires.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PlanLimits<'s> {
    /// Longest listening time of a sensor: it does not fire again within this time of firing, unless it has ended.
    pub longest_window: Micros,
    /// Requirements that the schedule was verified for, if it was: the ring may ask for less, and not for more.
    pub verified_for: Option<&'s VerifiedFor>,
    /// Time for which sound is taken to be audible: that of the verified requirements, or the period. `None` without a
    /// common period.
    pub audible: Option<Micros>,
}

/// Decides when each sensor of a ring fires: [`ScheduledFiring`](super::ScheduledFiring),
/// [`ImmediateRefiring`](super::ImmediateRefiring), [`InTurn`](crate::flow::InTurn), or one of the caller's own.
pub trait Plan {
    /// The next firing of a plan that is run without a ring, if one is due; periods end as they come. Call again until
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
    /// The sensor that fires next and the phase of its wait; none if the period ends next.
    fn next_firing(&self) -> Option<(u8, Phase)>;
    /// The firings to come, in their order, if none is late: as many as are decided, at least the next one of this
    /// period.
    fn upcoming(&self) -> impl Iterator<Item = Upcoming> {
        let due = self.deadline();
        self.next_firing().map(|(sensor, phase)| Upcoming { sensor, phase, due }).into_iter()
    }
    /// Fires that sensor, `now`. To be called when it is due.
    fn fire(&mut self, now: Instant);
    /// A sensor has fired this much later than [`fire`](Self::fire) was called for: what follows from its firing moves
    /// by as much, and no interval that is still to come gets shorter.
    fn postpone(&mut self, sensor: u8, by: Micros);
    /// Ends the period, `now`. Returns its phase, and whether the next one does not follow on it as the schedule says:
    /// because another schedule begins, or because periods were left out. To be called when that is due.
    fn end_period(&mut self, now: Instant) -> (Phase, bool);
    /// Takes in a sensor's reading with its verdict, and the judge, for plans that fire by what is believed.
    fn judged(&mut self, _heard: &Heard<'_>, _verdict: &Verdict, _judge: &impl Judge) {}
    /// A sensor turns out to have fired `at` this instant.
    fn fired(&mut self, _sensor: u8, _at: Instant) {}
    /// A sensor has stopped listening: its echo came in, or its window closed, `at` this instant.
    fn ended(&mut self, sensor: u8, at: Instant);
    /// The next firing is due no sooner than this, by what it was told just now: late counts from then.
    fn due_from(&mut self, _soonest: Instant) {}
    /// A sensor's readings are forgotten: what follows from them begins again.
    fn forget(&mut self, _sensor: u8) {}
    /// Number of sensors it fires.
    fn sensors(&self) -> usize;
    /// Lets a sensor fire from its next turn on, or stops it.
    fn set_enabled(&mut self, sensor: u8, enabled: bool);
    /// Lets no sensor fire until it is unset; periods go on.
    fn set_paused(&mut self, paused: bool);
    /// Returns true if a sensor fires, but for a pause.
    fn is_enabled(&self, sensor: u8) -> bool;
    /// The robot moves so, or stands.
    fn set_pace(&mut self, _pace: Pace) {}
    /// Starts again with phase a, no sooner than `now`.
    fn restart(&mut self, now: Instant);
    /// Properties of a sensor's last firing, `periods_ago` periods before the present one.
    fn last_firing(&self, sensor: u8, periods_ago: u8) -> FiringContext;
    /// Limits in the present period.
    fn limits(&self) -> PlanLimits<'_>;
    /// Limits from the next period on, if the schedule changes with it.
    fn next_limits(&self) -> Option<PlanLimits<'_>> {
        None
    }
    /// Returns true if `receiver` can hear `emitter`, which is so for all sensors but those that were declared not to
    /// hear each other because they fire together.
    fn hears(&self, _receiver: u8, _emitter: u8) -> bool {
        true
    }
    /// Limits of one sensor, where sensors are not all alike; the ring asks for no more than this either. `None` for
    /// every sensor where they are.
    fn limits_of(&self, _sensor: u8) -> Option<SensorLimits> {
        None
    }
    /// No sensor fires again within this time of firing.
    fn min_refire(&self) -> Micros;
    /// Longest time to a deadline, unless the clock has jumped.
    fn horizon(&self) -> Micros;
}
