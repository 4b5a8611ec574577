//! [`check_plan`]: runs a plan and checks the contract of [`Plan`].

use core::fmt;

use super::contract::Plan;
use crate::filter::EchoFilter;
use crate::judging::Heard;
use crate::reading::ReadingKind;
use crate::schedule::MAX_SENSORS;
use crate::time::{Instant, Micros};

/// A promise of [`Plan`] that a plan broke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub enum BrokenPromise {
    /// The plan fires a sensor that it does not have, that is disabled, or that may still be listening within the
    /// longest window.
    WrongSensor {
        /// The sensor, from 0.
        sensor: u8,
    },
    /// The plan fires a sensor again sooner than `min_refire`.
    MinRefire {
        /// The sensor, from 0.
        sensor: u8,
        /// Time after the sensor's last firing.
        after: Micros,
    },
    /// A deadline lies further ahead than `horizon`.
    Horizon {
        /// Time from now to the deadline.
        ahead: Micros,
    },
    /// Polled at one instant, the plan never stops asking for steps.
    Endless,
    /// An enabled sensor did not fire within four horizons.
    Silent {
        /// The sensor, from 0.
        sensor: u8,
    },
    /// `is_enabled` differs from the last setting, or is true for a sensor beyond the last.
    Enabled {
        /// The sensor, from 0.
        sensor: u8,
    },
}

impl fmt::Display for BrokenPromise {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let number = |sensor: u8| u16::from(sensor) + 1;
        match *self {
            Self::WrongSensor { sensor } => write!(
                f,
                "it fires sensor {}; expected one that is there, enabled, and has stopped listening",
                number(sensor)
            ),
            Self::MinRefire { sensor, after } => {
                write!(f, "it fires sensor {} again after {after}; expected min_refire or more", number(sensor))
            }
            Self::Horizon { ahead } => write!(f, "a deadline {ahead} ahead; expected no more than the horizon"),
            Self::Endless => f.write_str("polled at one instant it never comes to rest; expected a later deadline"),
            Self::Silent { sensor } => {
                write!(f, "sensor {} does not fire within four horizons; expected it to", number(sensor))
            }
            Self::Enabled { sensor } => write!(f, "is_enabled of sensor {}; expected what was set", number(sensor)),
        }
    }
}

impl core::error::Error for BrokenPromise {}

/// Runs a plan for `polls` polls from `now` on under harder conditions than a ring's: late polls, late firings, sensors
/// that are disabled and enabled, restarts, and readings that are never accepted. Use it to test your own [`Plan`];
/// `seed` makes the calls reproducible.
///
/// ```
/// use eeruf_core::{Instant, plan::{ScheduledFiring, check_plan}, tables::TABLE_I_D};
/// let now = Instant::from_micros(0);
/// check_plan(&mut ScheduledFiring::new(&TABLE_I_D, now), now, 10_000, 1)?;
/// # Ok::<(), eeruf_core::plan::BrokenPromise>(())
/// ```
///
/// # Errors
/// The first [`BrokenPromise`].
pub fn check_plan<P: Plan>(plan: &mut P, now: Instant, polls: u32, seed: u32) -> Result<(), BrokenPromise> {
    let mut check = Check { now, seen: [Seen::default(); MAX_SENSORS], random: seed };
    for poll in 0..polls {
        check.poll(plan)?;
        check.act_at_random(plan, poll)?;
    }
    Ok(())
}

/// State of one sensor's line.
#[derive(Clone, Copy, Default)]
struct Seen {
    fired: Option<Instant>,
    /// Time when the sensor stops listening; `None` if it has stopped.
    ends: Option<Instant>,
    disabled: bool,
    /// Time from which the sensor could have fired.
    waits_since: Option<Instant>,
}

struct Check {
    now: Instant,
    seen: [Seen; MAX_SENSORS],
    random: u32,
}

impl Check {
    /// A number below `limit`, by a linear congruential sequence.
    fn below(&mut self, limit: u32) -> u32 {
        self.random = self.random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        ((u64::from(self.random) * u64::from(limit)) >> 32) as u32
    }

    /// Advances to the deadline or later, and takes all steps that are due.
    fn poll<P: Plan>(&mut self, plan: &mut P) -> Result<(), BrokenPromise> {
        let deadline = plan.deadline();
        if !self.now.has_reached(deadline) {
            let ahead = deadline.since(self.now);
            if ahead > plan.horizon() {
                return Err(BrokenPromise::Horizon { ahead });
            }
            self.end_until(plan, deadline);
            self.now = deadline;
        }
        if self.below(4) == 0 {
            let late = self.below(3_000);
            self.now += Micros::new(late);
        }
        let most = 4 * plan.sensors() + 8;
        for _ in 0..most {
            let until = self.now;
            self.end_until(plan, until);
            if !self.now.has_reached(plan.deadline()) {
                return self.nobody_is_silent(plan);
            }
            match plan.next_firing() {
                Some((sensor, _)) => self.fire(plan, sensor)?,
                None => {
                    _ = plan.end_period(self.now);
                }
            }
        }
        Err(BrokenPromise::Endless)
    }

    fn fire<P: Plan>(&mut self, plan: &mut P, sensor: u8) -> Result<(), BrokenPromise> {
        let longest = plan.limits_of(sensor).map_or(plan.limits().longest_window, |limits| limits.window);
        let window = longest.min(plan.horizon());
        let (listens, comes_late) = (self.below(window.as_micros().saturating_add(1)), self.below(8) == 0);
        let later = Micros::new(if comes_late { self.below(500) } else { 0 });
        let there = usize::from(sensor) < plan.sensors();
        let seen = match self.seen.get_mut(usize::from(sensor)) {
            Some(seen) if there && !seen.disabled && seen.ends.is_none() => seen,
            _ => return Err(BrokenPromise::WrongSensor { sensor }),
        };
        if let Some(fired) = seen.fired {
            let after = self.now.since(fired);
            if after < plan.min_refire() {
                return Err(BrokenPromise::MinRefire { sensor, after });
            }
        }
        plan.fire(self.now);
        if comes_late {
            plan.postpone(sensor, later);
            self.now += later;
        }
        *seen = Seen {
            fired: Some(self.now),
            ends: Some(self.now + Micros::new(listens)),
            waits_since: Some(self.now),
            ..*seen
        };
        Ok(())
    }

    /// Ends the windows that are over.
    fn end_until<P: Plan>(&mut self, plan: &mut P, until: Instant) {
        // A judge that accepts nothing.
        let Ok(judge) = EchoFilter::<0>::new(Micros::new(1), 2) else { return };
        for (x, seen) in (0..).zip(&mut self.seen) {
            if let (Some(at), Some(fired)) = (seen.ends, seen.fired) {
                if until.has_reached(at) {
                    seen.ends = None;
                    let (firing, t_delta) = (plan.last_firing(x, 0), Micros::new(1));
                    let since_before = Micros::MAX;
                    let heard = Heard { sensor: x, fired, since_before, echoes: &[at.since(fired)], firing, t_delta };
                    plan.judged(&heard, &heard.unjudged(Some(ReadingKind::Rejected)), &judge);
                    plan.ended(x, at);
                }
            }
        }
    }

    fn nobody_is_silent<P: Plan>(&mut self, plan: &P) -> Result<(), BrokenPromise> {
        let longest = Micros::new(plan.horizon().as_micros().saturating_mul(4));
        for (x, seen) in self.seen.iter_mut().enumerate().take(plan.sensors()) {
            let since = *seen.waits_since.get_or_insert(self.now);
            if !seen.disabled && self.now.since(since) > longest {
                return Err(BrokenPromise::Silent { sensor: x as u8 });
            }
        }
        Ok(())
    }

    /// Disables, enables or restarts sensors at random.
    fn act_at_random<P: Plan>(&mut self, plan: &mut P, poll: u32) -> Result<(), BrokenPromise> {
        if self.below(20) > 0 {
            return Ok(());
        }
        // At most 64 sensors.
        let sensor = self.below(plan.sensors() as u32) as u8;
        let now = self.now;
        match (self.below(8), self.seen.get_mut(usize::from(sensor))) {
            (0, _) if poll % 3 == 0 => {
                plan.restart(now);
                for seen in &mut self.seen {
                    (seen.ends, seen.waits_since) = (None, Some(now));
                }
            }
            (choice, Some(seen)) => {
                seen.disabled = choice % 2 == 0;
                seen.waits_since = Some(now);
                plan.set_enabled(sensor, !seen.disabled);
            }
            (_, None) => {}
        }
        let beyond = plan.sensors() as u8;
        if plan.is_enabled(beyond) {
            return Err(BrokenPromise::Enabled { sensor: beyond });
        }
        match self.seen.get(usize::from(sensor)) {
            Some(seen) if plan.is_enabled(sensor) == seen.disabled => Err(BrokenPromise::Enabled { sensor }),
            _ => Ok(()),
        }
    }
}
