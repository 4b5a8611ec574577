//! A ring with the schedules that it borrows, so that it can change from one to another.

use eeruf_core::{
    EachSensor, EchoFilter, Instant, MAX_SENSORS, Micros, Requirements, Ring, RingConfig, plan::ScheduledFiring,
};
use eeruf_sim::AnySchedule;
use elsa::sync::FrozenVec;
use pyo3::prelude::*;

use crate::{arguments::wrong, errors::Raise, requirements::OwnedRequirements};

/// Most echoes of one firing.
pub(crate) const MAX_ECHOES: usize = 8;

/// A ring that fires by a schedule, whether sensors are alike or not, with up to `E` echoes of a firing.
pub(crate) type TableRing<'s, const E: usize> =
    Ring<ScheduledFiring<'s, MAX_SENSORS, 2, &'s EachSensor<MAX_SENSORS>>, EchoFilter<MAX_SENSORS, E>, MAX_SENSORS, E>;

/// A schedule, and what it allows each sensor.
type Kept = (AnySchedule, EachSensor<MAX_SENSORS>);

/// The schedules that a ring has fired by, each once.
struct Schedules {
    first: Box<Kept>,
    others: FrozenVec<Box<Kept>>,
}

/// The ring for sensors of one echo, or of several.
#[expect(clippy::large_enum_variant, reason = "every ring is behind a pointer of its own")]
pub(crate) enum AnyTableRing<'s> {
    One(TableRing<'s, 1>),
    Several(TableRing<'s, MAX_ECHOES>),
}

/// Asks the same of whichever ring it is, or does it.
macro_rules! table {
    ($any:expr, |$ring:ident| $call:expr) => {
        match $any {
            $crate::owned_ring::AnyTableRing::One($ring) => $call,
            $crate::owned_ring::AnyTableRing::Several($ring) => $call,
        }
    };
}

pub(crate) use table;

self_cell::self_cell!(
    /// A ring with the schedules that it borrows.
    struct WithSchedules {
        owner: Schedules,
        #[covariant]
        dependent: AnyTableRing,
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
                let verified = schedule.verified_each(&needs.requirements()).map_err(Raise::raise)?;
                Ok((*verified.schedule(), *verified.own_limits()))
            }
        }
    }
}

impl OwnedRing {
    fn begin(kept: Kept, promise: Promise, config: RingConfig, several: bool, now: Instant) -> PyResult<Self> {
        let next = Box::new(kept.0);
        let schedules = Schedules { first: Box::new(kept), others: FrozenVec::new() };
        let ring = WithSchedules::try_new(schedules, |schedules| {
            let (schedule, own_limits) = &*schedules.first;
            let plan = ScheduledFiring::with_limits(schedule, own_limits, now);
            if several {
                return Ring::with_plan(plan, config.with_echoes::<MAX_ECHOES>(), now).map(AnyTableRing::Several);
            }
            Ring::with_plan(plan, config, now).map(AnyTableRing::One)
        });
        Ok(Self { ring: ring.map_err(Raise::raise)?, promise, next })
    }

    /// With a schedule that need not reject crosstalk.
    pub(crate) fn new(schedule: AnySchedule, config: RingConfig, several: bool, now: Instant) -> PyResult<Self> {
        Self::begin((schedule, EachSensor::NONE), Promise::Nothing, config, several, now)
    }

    /// With a schedule that keeps what each sensor needs; so must then all to which it changes.
    pub(crate) fn uneven(
        schedule: AnySchedule,
        needs: OwnedRequirements,
        config: RingConfig,
        several: bool,
        now: Instant,
    ) -> PyResult<Self> {
        let promise = Promise::EachSensor(needs);
        Self::begin(promise.keep(&schedule, Micros::ZERO)?, promise, config, several, now)
    }

    /// The same, if its schedule rejects crosstalk; so must then all to which it changes.
    pub(crate) fn verified(self) -> PyResult<Self> {
        verify(self.schedule(), self.t_delta())?;
        Ok(Self { promise: Promise::TDelta, ..self })
    }

    pub(crate) fn ring(&self) -> &AnyTableRing<'_> {
        self.ring.borrow_dependent()
    }

    pub(crate) fn schedule(&self) -> &AnySchedule {
        table!(self.ring(), |ring| ring.schedule())
    }

    pub(crate) fn t_delta(&self) -> Micros {
        table!(self.ring(), |ring| ring.t_delta())
    }

    pub(crate) fn with<T>(&mut self, call: impl FnOnce(&mut AnyTableRing<'_>) -> T) -> T {
        self.ring.with_dependent_mut(|_, ring| call(ring))
    }

    /// Compares with another `t_delta`, at which what it fires by must reject crosstalk.
    pub(crate) fn set_t_delta(&mut self, t_delta: Micros) -> PyResult<()> {
        if matches!(self.promise, Promise::TDelta) {
            verify(self.schedule(), t_delta)?;
            verify(&self.next, t_delta)?;
        }
        self.with(|any| table!(any, |ring| ring.set_t_delta(t_delta))).map_err(Raise::raise)
    }

    /// Fires by another schedule when the present period ends.
    pub(crate) fn change_to(&mut self, schedule: &AnySchedule) -> PyResult<()> {
        let sensors = self.schedule().sensors();
        if schedule.sensors() != sensors {
            let expected = format!("one of {sensors} sensors, as the ring has");
            return Err(wrong("schedule", format!("one of {} sensors", schedule.sensors()), expected));
        }
        let next = self.promise.keep(schedule, self.t_delta())?;
        let changed = self.ring.with_dependent_mut(|schedules, any| {
            let mut known = core::iter::once(&*schedules.first).chain(&schedules.others);
            let borrowed = known.find(|&known| *known == next);
            let (schedule, own_limits) = borrowed.unwrap_or_else(|| schedules.others.push_get(Box::new(next)));
            table!(any, |ring| ring.change_with_limits(schedule, own_limits))
        });
        changed.map_err(Raise::raise)?;
        *self.next = *schedule;
        Ok(())
    }
}
