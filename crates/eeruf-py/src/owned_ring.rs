//! A ring with the schedules that it borrows, so that it can change from one to another.

use eeruf_core::{Instant, MAX_SENSORS, Micros, Requirements, RingConfig, ScheduledRing};
use eeruf_sim::AnySchedule;
use elsa::sync::FrozenVec;
use pyo3::prelude::*;

use crate::{arguments::wrong, errors::Raise};

type Scheduled<'s> = ScheduledRing<'s, MAX_SENSORS>;

/// The schedules that a ring has fired by, each once.
struct Schedules {
    first: AnySchedule,
    others: FrozenVec<Box<AnySchedule>>,
}

self_cell::self_cell!(
    /// A ring with the schedules that it borrows.
    struct WithSchedules {
        owner: Schedules,
        #[covariant]
        dependent: Scheduled,
    }
);

/// A ring that owns its schedules, and knows whether they have to reject crosstalk.
pub(crate) struct OwnedRing {
    ring: WithSchedules,
    /// Whether its schedules have to reject crosstalk at its `t_delta`.
    verified: bool,
    /// What it fires by from the end of the present period on.
    next: Box<AnySchedule>,
}

/// Whether a schedule rejects crosstalk.
fn verify(schedule: &AnySchedule, t_delta: Micros) -> PyResult<()> {
    let requirements = Requirements::new(t_delta);
    let verification = schedule.verify(&requirements);
    verification.violations().next().map_or(Ok(()), |violation| Err(violation.raise()))
}

impl OwnedRing {
    /// With a schedule that need not reject crosstalk.
    pub(crate) fn new(schedule: AnySchedule, config: RingConfig, now: Instant) -> PyResult<Self> {
        let schedules = Schedules { first: schedule, others: FrozenVec::new() };
        let ring = WithSchedules::try_new(schedules, |schedules| Scheduled::unverified(&schedules.first, config, now));
        Ok(Self { ring: ring.map_err(Raise::raise)?, verified: false, next: Box::new(schedule) })
    }

    /// The same, if its schedule rejects crosstalk; so must then all to which it changes.
    pub(crate) fn verified(self) -> PyResult<Self> {
        verify(self.ring().schedule(), self.ring().t_delta())?;
        Ok(Self { verified: true, ..self })
    }

    pub(crate) fn ring(&self) -> &Scheduled<'_> {
        self.ring.borrow_dependent()
    }

    pub(crate) fn with<T>(&mut self, call: impl FnOnce(&mut Scheduled<'_>) -> T) -> T {
        self.ring.with_dependent_mut(|_, ring| call(ring))
    }

    pub(crate) fn change<E: Raise>(
        &mut self,
        change: impl FnOnce(&mut Scheduled<'_>) -> Result<(), E>,
    ) -> PyResult<()> {
        self.with(change).map_err(Raise::raise)
    }

    /// Compares with another `t_delta`, at which what it fires by must reject crosstalk.
    pub(crate) fn set_t_delta(&mut self, t_delta: Micros) -> PyResult<()> {
        if self.verified {
            verify(self.ring().schedule(), t_delta)?;
            verify(&self.next, t_delta)?;
        }
        self.change(|ring| ring.set_t_delta(t_delta))
    }

    /// Fires by another schedule when the present period ends.
    pub(crate) fn change_to(&mut self, schedule: &AnySchedule) -> PyResult<()> {
        let sensors = self.ring().sensors();
        if schedule.sensors() != sensors {
            let expected = format!("one of {sensors} sensors, as the ring has");
            return Err(wrong("schedule", format!("one of {} sensors", schedule.sensors()), expected));
        }
        if self.verified {
            verify(schedule, self.ring().t_delta())?;
        }
        let changed = self.ring.with_dependent_mut(|schedules, ring| {
            let mut known = core::iter::once(&schedules.first).chain(&schedules.others);
            let kept = known.find(|known| *known == schedule);
            ring.change_to_unverified(kept.unwrap_or_else(|| schedules.others.push_get(Box::new(*schedule))))
        });
        changed.map_err(Raise::raise)?;
        *self.next = *schedule;
        Ok(())
    }
}
