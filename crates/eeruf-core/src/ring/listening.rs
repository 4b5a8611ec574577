//! [`Listening`]: for how long a ring listens, and what it takes for the same echo; checked, also while it runs.

use super::config::RingConfig;
use super::error::RingError;
use crate::scheduler::{Limits, Scheduler};
use crate::time::Micros;

/// Window, `t_delta` and blanking time, none of them more than the scheduler allows.
#[derive(Clone, Copy, Debug)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(C)]
pub(super) struct Listening {
    window: Micros,
    t_delta: u16,
    blanking: u16,
}

impl Listening {
    pub(super) fn new<const E: usize>(config: &RingConfig<E>, scheduler: &impl Scheduler) -> Result<Self, RingError> {
        let verified_for = scheduler.limits().verified_for;
        let t_delta = config.t_delta.or(verified_for.map(|verified_for| verified_for.t_delta));
        let window = config.window.or(verified_for.map(|verified_for| verified_for.window));
        let (Some(t_delta), Some(window)) = (t_delta, window) else { return Err(RingError::Unverified) };
        Self::checked(t_delta, window, config.blanking, scheduler)
    }

    /// With some of it changed.
    pub(super) fn checked<S: Scheduler>(
        t_delta: Micros,
        window: Micros,
        blanking: Micros,
        scheduler: &S,
    ) -> Result<Self, RingError> {
        allowed(t_delta, window, scheduler.limits())?;
        if let Some(next) = scheduler.next_limits() {
            allowed(t_delta, window, next)?;
        }
        let mut shortest = window;
        if S::UNEVEN {
            // At most 64 sensors.
            let sensors = 0..scheduler.sensors() as u8;
            shortest =
                sensors.filter_map(|x| scheduler.limits_of(x)).map(|limits| limits.window).fold(window, Micros::min);
        }
        let narrow = |time: Micros| u16::try_from(time.as_micros()).ok().filter(|_| time < shortest);
        let blanking = narrow(blanking).ok_or(RingError::Blanking { blanking, window: shortest })?;
        let t_delta = narrow(t_delta).ok_or(RingError::CoarseTDelta { t_delta, window: shortest })?;
        Ok(Self { window, t_delta, blanking })
    }

    /// For how long one sensor listens: no longer than the scheduler allows it.
    #[inline]
    pub(super) fn window_of<S: Scheduler>(&self, scheduler: &S, sensor: u8) -> Micros {
        match if S::UNEVEN { scheduler.limits_of(sensor) } else { None } {
            Some(limits) => limits.window.min(self.window),
            None => self.window,
        }
    }

    /// What counts as the same echo for one sensor: no more than the scheduler allows it.
    #[inline]
    pub(super) fn t_delta_of<S: Scheduler>(&self, scheduler: &S, sensor: u8) -> Micros {
        match if S::UNEVEN { scheduler.limits_of(sensor) } else { None } {
            Some(limits) => limits.t_delta.min(self.t_delta()),
            None => self.t_delta(),
        }
    }

    /// Whether another schedule allows it.
    pub(super) fn is_allowed(&self, limits: Limits<'_>) -> Result<(), RingError> {
        allowed(self.t_delta(), self.window, limits)
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

fn allowed(t_delta: Micros, window: Micros, limits: Limits<'_>) -> Result<(), RingError> {
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
