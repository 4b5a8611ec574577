//! A ring with the schedules that it borrows, so that it can change from one to another.

use eeruf_core::{
    EachSensor, Instant, MAX_SENSORS, Micros, Requirements, RingConfig, ScheduledRing,
    plan::{EachInUse, ScheduledFiring},
};
use eeruf_sim::AnySchedule;
use elsa::sync::FrozenVec;
use pyo3::prelude::*;

use crate::{arguments::wrong, errors::Raise, requirements::OwnedRequirements};

/// A ring that fires by a schedule, whether sensors are alike or not.
pub(crate) type TableRing<'s> = ScheduledRing<'s, MAX_SENSORS, 1, EachInUse<'s, MAX_SENSORS>>;

/// A schedule, and what it allows each sensor.
type Kept = (AnySchedule, EachSensor<MAX_SENSORS>);

/// The schedules that a ring has fired by, each once.
struct Schedules {
    first: Box<Kept>,
    others: FrozenVec<Box<Kept>>,
}

self_cell::self_cell!(
    /// A ring with the schedules that it borrows.
    struct WithSchedules {
        owner: Schedules,
        #[covariant]
        dependent: TableRing,
    }
);

/// Requirements on a ring's schedules.
enum Promise {
    /// Nothing: crosstalk that the schedule repeats makes readings ambiguous.
    Nothing,
    /// They reject crosstalk at the ring's `t_delta`.
    TDelta,
    /// Needs of each sensor.
    EachSensor(OwnedRequirements),
}

/// A ring that owns its schedules, and knows what they have to keep.
pub(crate) struct OwnedRing {
    ring: WithSchedules,
    promise: Promise,
    /// Schedule from the end of the present period on.
    next: Box<AnySchedule>,
}

/// Returns true if a schedule rejects crosstalk.
fn verify(schedule: &AnySchedule, t_delta: Micros) -> PyResult<()> {
    let requirements = Requirements::new(t_delta);
    let verification = schedule.verify(&requirements);
    verification.violations().next().map_or(Ok(()), |violation| Err(violation.raise()))
}

impl Promise {
    /// The schedule as a ring may fire by it, with the limits of each sensor where it must keep those.
    fn keep(&self, schedule: &AnySchedule, t_delta: Micros) -> PyResult<Kept> {
        match self {
            Self::Nothing => Ok((*schedule, EachSensor::NONE)),
            Self::TDelta => verify(schedule, t_delta).map(|()| (*schedule, EachSensor::NONE)),
            Self::EachSensor(needs) => {
                let verified = schedule.verify(&needs.requirements()).verified_each().map_err(Raise::raise)?;
                Ok((*verified.schedule(), *verified.own_limits()))
            }
        }
    }
}

impl OwnedRing {
    fn begin(kept: Kept, promise: Promise, config: RingConfig, now: Instant) -> PyResult<Self> {
        let next = Box::new(kept.0);
        let schedules = Schedules { first: Box::new(kept), others: FrozenVec::new() };
        let ring = WithSchedules::try_new(schedules, |schedules| {
            let (schedule, own_limits) = &*schedules.first;
            TableRing::with_plan(ScheduledFiring::with_limits(schedule, own_limits, now), config, now)
        });
        Ok(Self { ring: ring.map_err(Raise::raise)?, promise, next })
    }

    /// With a schedule that need not reject crosstalk.
    pub(crate) fn new(schedule: AnySchedule, config: RingConfig, now: Instant) -> PyResult<Self> {
        Self::begin((schedule, EachSensor::NONE), Promise::Nothing, config, now)
    }

    /// With a schedule that keeps what each sensor needs; so must then all to which it changes.
    pub(crate) fn uneven(
        schedule: AnySchedule,
        needs: OwnedRequirements,
        config: RingConfig,
        now: Instant,
    ) -> PyResult<Self> {
        let promise = Promise::EachSensor(needs);
        Self::begin(promise.keep(&schedule, Micros::ZERO)?, promise, config, now)
    }

    /// The same, if its schedule rejects crosstalk; so must then all to which it changes.
    pub(crate) fn verified(self) -> PyResult<Self> {
        verify(self.ring().schedule(), self.ring().t_delta())?;
        Ok(Self { promise: Promise::TDelta, ..self })
    }

    pub(crate) fn ring(&self) -> &TableRing<'_> {
        self.ring.borrow_dependent()
    }

    pub(crate) fn with<T>(&mut self, call: impl FnOnce(&mut TableRing<'_>) -> T) -> T {
        self.ring.with_dependent_mut(|_, ring| call(ring))
    }

    /// Compares with another `t_delta`, at which what it fires by must reject crosstalk.
    pub(crate) fn set_t_delta(&mut self, t_delta: Micros) -> PyResult<()> {
        if matches!(self.promise, Promise::TDelta) {
            verify(self.ring().schedule(), t_delta)?;
            verify(&self.next, t_delta)?;
        }
        self.with(|ring| ring.set_t_delta(t_delta)).map_err(Raise::raise)
    }

    /// Fires by another schedule when the present period ends.
    pub(crate) fn change_to(&mut self, schedule: &AnySchedule) -> PyResult<()> {
        let sensors = self.ring().sensors();
        if schedule.sensors() != sensors {
            let expected = format!("one of {sensors} sensors, as the ring has");
            return Err(wrong("schedule", format!("one of {} sensors", schedule.sensors()), expected));
        }
        let next = self.promise.keep(schedule, self.ring().t_delta())?;
        let changed = self.ring.with_dependent_mut(|schedules, ring| {
            let mut known = core::iter::once(&*schedules.first).chain(&schedules.others);
            let borrowed = known.find(|&known| *known == next);
            let (schedule, own_limits) = borrowed.unwrap_or_else(|| schedules.others.push_get(Box::new(next)));
            ring.change_with_limits(schedule, own_limits)
        });
        changed.map_err(Raise::raise)?;
        *self.next = *schedule;
        Ok(())
    }
}
