//! [`Listening`]: the checked listening times and tolerances of a ring.

use super::config::{RingConfig, Silence};
use super::sensor::UNANSWERED;
use crate::plan::{Plan, PlanLimits};
use crate::reading::ReadingKind;
use crate::ring_error::{LONGEST, MAX_AUDIBLE, PLAUSIBLE, RingError, within};
use crate::time::{Micros, shorter};

/// Window, `t_delta` and blanking time, none of them more than the plan allows, and the limits of sound.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub(crate) struct Listening {
    window: Micros,
    audible: Micros,
    t_delta: u16,
    blanking: u16,
    /// Largest change of a path; [`AS_T_DELTA`] for the receiver's `t_delta`.
    path_change: u16,
    /// Initial flag of firings: set if silence counts only after the sensor has shown that it listens, else 0.
    unanswered: u8,
    /// The kind of silence without a witness.
    unwitnessed: ReadingKind,
}

const AS_T_DELTA: u16 = u16::MAX;

impl Listening {
    pub(super) fn new<const E: usize>(
        config: &RingConfig<E>,
        t_delta: Micros,
        plan: &impl Plan,
    ) -> Result<Self, RingError> {
        within("audible", config.audible.unwrap_or(PLAUSIBLE), PLAUSIBLE, Micros::MAX)?;
        let verified_for = plan.limits().verified_for;
        let window = config.window.or(verified_for.map(|verified_for| verified_for.window));
        let window = window.ok_or(RingError::Unverified)?;
        let longest = || plan.limits().audible.unwrap_or(window.max(plan.min_refire())).min(MAX_AUDIBLE);
        let audible = config.audible.unwrap_or_else(longest);
        let path_change = config.path_change.or(verified_for.and_then(|verified_for| verified_for.path_change));
        Self::checked(t_delta, window, config.blanking, plan)?.with_sound(path_change, audible)
    }

    /// Returns a copy with another change of paths (`None` for `t_delta`) and another time for which sound is audible.
    pub(crate) const fn with_sound(self, path_change: Option<Micros>, audible: Micros) -> Result<Self, RingError> {
        if audible.as_micros() > MAX_AUDIBLE.as_micros() {
            return Err(RingError::Audible { audible });
        }
        let path_change = match path_change {
            None => AS_T_DELTA,
            Some(change) if change.as_micros() < AS_T_DELTA as u32 => change.as_micros() as u16,
            Some(path_change) => return Err(RingError::PathChange { path_change }),
        };
        Ok(Self { audible, path_change, ..self })
    }

    /// Checks listening times against the limits of a plan.
    pub(super) fn checked<P: Plan>(
        t_delta: Micros,
        window: Micros,
        blanking: Micros,
        plan: &P,
    ) -> Result<Self, RingError> {
        allowed(t_delta, window, plan.limits())?;
        if let Some(next) = plan.next_limits() {
            allowed(t_delta, window, next)?;
        }
        // At most 64 sensors.
        let limits = (0..plan.sensors() as u8).filter_map(|x| plan.limits_of(x));
        let shortest = limits.map(|limits| limits.window).fold(window, Micros::min);
        Self::of(t_delta, window, shortest, blanking)
    }

    /// Listening times as requested; `shortest` is the shortest window of all sensors.
    pub(crate) const fn of(
        t_delta: Micros,
        window: Micros,
        shortest: Micros,
        blanking: Micros,
    ) -> Result<Self, RingError> {
        let most = shorter(shortest, Micros::new(LONGEST.as_micros() + 1)).as_micros();
        if blanking.as_micros() >= most {
            return Err(RingError::Blanking { blanking, window: shortest });
        }
        if t_delta.as_micros() >= most {
            return Err(RingError::CoarseTDelta { t_delta, window: shortest });
        }
        // Both fit, as checked above.
        let (t_delta, blanking) = (t_delta.as_micros() as u16, blanking.as_micros() as u16);
        let (audible, path_change) = (MAX_AUDIBLE, AS_T_DELTA);
        // As for `Silence::NeverFree`.
        let (unanswered, unwitnessed) = (UNANSWERED, ReadingKind::NoEcho);
        Ok(Self { window, audible, t_delta, blanking, path_change, unanswered, unwitnessed })
    }

    /// Returns the time for which one sensor listens: no longer than the plan allows it.
    #[inline]
    pub(super) fn window_of<P: Plan>(&self, plan: &P, sensor: u8) -> Micros {
        match plan.limits_of(sensor) {
            Some(limits) => limits.window.min(self.window),
            None => self.window,
        }
    }

    /// `T_delta` of one sensor: no more than the plan allows it.
    #[inline]
    pub(super) fn t_delta_of<P: Plan>(&self, plan: &P, sensor: u8) -> Micros {
        match plan.limits_of(sensor) {
            Some(limits) => limits.t_delta.min(self.t_delta()),
            None => self.t_delta(),
        }
    }

    /// Returns a copy with another `t_delta`, window and blanking time.
    pub(super) fn changed<P: Plan>(
        &self,
        t_delta: Micros,
        window: Micros,
        blanking: Micros,
        plan: &P,
    ) -> Result<Self, RingError> {
        let Self { audible, path_change, unanswered, unwitnessed, .. } = *self;
        Ok(Self { audible, path_change, unanswered, unwitnessed, ..Self::checked(t_delta, window, blanking, plan)? })
    }

    pub(super) fn set_silence(&mut self, silence: Silence) {
        self.unanswered = if silence == Silence::Trusted { 0 } else { UNANSWERED };
        let needs_answer = silence == Silence::NeedsAnswer;
        self.unwitnessed = if needs_answer { ReadingKind::Unanswered } else { ReadingKind::NoEcho };
    }

    /// [`UNANSWERED`] if silence needs a witness.
    #[inline]
    pub(super) const fn unanswered(&self) -> u8 {
        self.unanswered
    }

    pub(super) const fn unwitnessed(&self) -> ReadingKind {
        self.unwitnessed
    }

    /// R: how long sound is audible.
    pub(super) const fn audible(&self) -> Micros {
        self.audible
    }

    /// Returns a copy with another R.
    pub(super) fn with_audible(&self, audible: Micros) -> Result<Self, RingError> {
        self.with_sound(self.asked_path_change(), audible)
    }

    /// Returns a copy with another P.
    pub(super) fn with_path_change(&self, path_change: Micros) -> Result<Self, RingError> {
        self.with_sound(Some(path_change), self.audible)
    }

    fn asked_path_change(&self) -> Option<Micros> {
        (self.path_change != AS_T_DELTA).then_some(Micros::new(self.path_change.into()))
    }

    /// P: the largest change of a path from one reading of a sensor to the next.
    pub(super) fn path_change_of<P: Plan>(&self, plan: &P, sensor: u8) -> Micros {
        match self.asked_path_change() {
            Some(path_change) => path_change,
            None => self.t_delta_of(plan, sensor),
        }
    }

    /// Returns true if the plan's timetable was verified for the limits of sound.
    pub(super) fn is_proven(&self, plan: &impl Plan) -> bool {
        let limits = plan.limits();
        let Some(verified_for) = limits.verified_for else { return false };
        let allowed = verified_for.path_change.unwrap_or(verified_for.t_delta);
        let change = self.asked_path_change();
        // Sound sent two periods apart moves by at least the shortest time between a sensor's firings.
        let two_periods = self.t_delta().saturating_add(change.unwrap_or(self.t_delta()));
        change.unwrap_or(Micros::ZERO) <= allowed
            && limits.audible.is_some_and(|audible| self.audible <= audible)
            && two_periods < plan.min_refire()
    }

    /// Total lateness that the firings of one period may have while crosstalk still moves far enough: a quarter of the
    /// margin, since two readings span at most four periods.
    pub(super) fn spare(&self, limits: PlanLimits<'_>) -> u16 {
        let Some(verified_for) = limits.verified_for else { return 0 };
        let change = self.asked_path_change().unwrap_or(self.t_delta());
        let needed = self.t_delta().saturating_add(change).saturating_add(Micros::new(1));
        let quarter = verified_for.separation.saturating_sub(needed).as_micros() / 4;
        u16::try_from(quarter).unwrap_or(u16::MAX)
    }

    pub(super) const fn window(&self) -> Micros {
        self.window
    }

    pub(super) const fn t_delta(&self) -> Micros {
        Micros::new(self.t_delta as u32)
    }

    pub(super) const fn blanking(&self) -> Micros {
        Micros::new(self.blanking as u32)
    }
}

fn allowed(t_delta: Micros, window: Micros, limits: PlanLimits<'_>) -> Result<(), RingError> {
    if let Some(verified_for) = limits.verified_for {
        if t_delta > verified_for.t_delta {
            return Err(RingError::TDelta { t_delta, verified: verified_for.t_delta });
        }
        if window > verified_for.window {
            return Err(RingError::VerifiedWindow { window, verified: verified_for.window });
        }
    }
    // No echo time within a window can then be mistaken for an instant before the firing.
    let longest = limits.longest_window.min(Micros::new(u32::MAX / 2));
    if window > longest {
        return Err(RingError::Window { window, min_refire: longest });
    }
    Ok(())
}
