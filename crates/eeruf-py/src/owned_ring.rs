//! A ring with the schedules that it borrows, so that it can change from one to another.

use eeruf_core::{
    EchoFilter, Instant, MAX_SENSORS, Micros, Requirements, Ring, RingConfig, RingError, RingEvent, ScheduledRing,
    SensorError, SensorWatch, UnevenFiring, UnevenSchedule,
};
use eeruf_sim::AnySchedule;
use elsa::sync::FrozenVec;
use pyo3::prelude::*;

use crate::{
    arguments::{whole, wrong},
    errors::Raise,
    requirements::OwnedRequirements,
};

/// A ring of sensors that are alike, or of some that are not.
pub(crate) enum AnyRing<'s> {
    Even(ScheduledRing<'s, MAX_SENSORS>),
    Uneven(Ring<UnevenFiring<'s, MAX_SENSORS>, EchoFilter<MAX_SENSORS>, MAX_SENSORS>),
}

/// Hands calls on to the ring, whichever it is.
macro_rules! either {
    ($(fn $name:ident(&self $(, $argument:ident: $type:ty)*) -> $returns:ty;)*
     $(mut fn $name_mut:ident(&mut self $(, $argument_mut:ident: $type_mut:ty)*) -> $returns_mut:ty;)*) => {
        impl AnyRing<'_> {
            $(pub(crate) fn $name(&self $(, $argument: $type)*) -> $returns {
                match self {
                    Self::Even(ring) => ring.$name($($argument),*),
                    Self::Uneven(ring) => ring.$name($($argument),*),
                }
            })*
            $(pub(crate) fn $name_mut(&mut self $(, $argument_mut: $type_mut)*) -> $returns_mut {
                match self {
                    Self::Even(ring) => ring.$name_mut($($argument_mut),*),
                    Self::Uneven(ring) => ring.$name_mut($($argument_mut),*),
                }
            })*
        }
    };
}

either! {
    fn next_deadline(&self) -> Instant;
    fn sensors(&self) -> usize;
    fn t_delta(&self) -> Micros;
    fn window(&self) -> Micros;
    fn blanking(&self) -> Micros;
    fn audible(&self) -> Micros;
    fn path_change_of(&self, sensor: u8) -> Micros;
    fn is_enabled(&self, sensor: u8) -> bool;
    mut fn poll_expecting(&mut self, now: Instant, change: impl FnMut(u8) -> i32) -> Option<RingEvent>;
    mut fn set_t_delta(&mut self, t_delta: Micros) -> Result<(), RingError>;
    mut fn set_window(&mut self, window: Micros) -> Result<(), RingError>;
    mut fn set_blanking(&mut self, blanking: Micros) -> Result<(), RingError>;
    mut fn set_path_change(&mut self, path_change: Micros) -> Result<(), RingError>;
    mut fn set_audible(&mut self, audible: Micros) -> Result<(), RingError>;
    mut fn echo(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError>;
    mut fn fired(&mut self, sensor: u8, at: Instant) -> Result<(), SensorError>;
    mut fn stuck(&mut self, sensor: u8) -> Result<(), SensorError>;
    mut fn expect_answers(&mut self) -> ();
    mut fn answered(&mut self, sensor: u8) -> Result<(), SensorError>;
    mut fn unanswered(&mut self, sensor: u8) -> Result<(), SensorError>;
    mut fn measured(&mut self, sensor: u8, t_echo: Option<Micros>) -> Result<(), SensorError>;
    mut fn forget(&mut self, sensor: u8) -> Result<(), SensorError>;
    mut fn disable(&mut self, sensor: u8) -> Result<(), SensorError>;
    mut fn enable(&mut self, sensor: u8) -> Result<(), SensorError>;
    mut fn pause(&mut self) -> ();
    mut fn resume(&mut self) -> ();
    mut fn restart(&mut self, now: Instant) -> ();
}

impl AnyRing<'_> {
    /// The schedule of the present period.
    pub(crate) fn schedule(&self) -> &AnySchedule {
        match self {
            Self::Even(ring) => ring.schedule(),
            Self::Uneven(ring) => ring.schedule().verified().schedule(),
        }
    }
}

/// A schedule as a ring borrows it.
#[derive(PartialEq)]
enum Borrowed {
    Even(Box<AnySchedule>),
    Uneven(Box<UnevenSchedule<MAX_SENSORS>>),
}

/// The schedules that a ring has fired by, each once.
struct Schedules {
    first: Borrowed,
    others: FrozenVec<Box<Borrowed>>,
}

self_cell::self_cell!(
    /// A ring with the schedules that it borrows.
    struct WithSchedules {
        owner: Schedules,
        #[covariant]
        dependent: AnyRing,
    }
);

/// What a ring's schedules must keep.
enum Promise {
    /// Nothing: crosstalk that the schedule repeats makes readings ambiguous.
    Nothing,
    /// They reject crosstalk at the ring's `t_delta`.
    TDelta,
    /// What each sensor needs.
    EachSensor(OwnedRequirements),
}

/// A ring that owns its schedules, and knows what they have to keep.
pub(crate) struct OwnedRing {
    ring: WithSchedules,
    promise: Promise,
    /// What it fires by from the end of the present period on.
    next: Box<AnySchedule>,
    /// The state of each sensor by its events.
    pub(crate) watch: SensorWatch<MAX_SENSORS>,
    /// The instant of the last poll, or of the beginning.
    pub(crate) now: Instant,
}

/// Whether a schedule rejects crosstalk.
fn verify(schedule: &AnySchedule, t_delta: Micros) -> PyResult<()> {
    let requirements = Requirements::new(t_delta);
    let verification = schedule.verify(&requirements);
    verification.violations().next().map_or(Ok(()), |violation| Err(violation.raise()))
}

impl OwnedRing {
    fn begin(
        schedule: AnySchedule,
        borrowed: Borrowed,
        promise: Promise,
        config: RingConfig,
        now: Instant,
    ) -> PyResult<Self> {
        let schedules = Schedules { first: borrowed, others: FrozenVec::new() };
        let ring = WithSchedules::try_new(schedules, |schedules| match &schedules.first {
            Borrowed::Even(schedule) => ScheduledRing::unverified(schedule, config, now).map(AnyRing::Even),
            Borrowed::Uneven(schedule) => Ring::uneven(schedule, config, now).map(AnyRing::Uneven),
        });
        let watch = SensorWatch::new(0, now);
        Ok(Self { ring: ring.map_err(Raise::raise)?, promise, next: Box::new(schedule), watch, now })
    }

    /// With a schedule that need not reject crosstalk.
    pub(crate) fn new(schedule: AnySchedule, config: RingConfig, now: Instant) -> PyResult<Self> {
        Self::begin(schedule, Borrowed::Even(Box::new(schedule)), Promise::Nothing, config, now)
    }

    /// With a schedule that keeps what each sensor needs; so must then all to which it changes.
    pub(crate) fn uneven(
        schedule: AnySchedule,
        needs: OwnedRequirements,
        config: RingConfig,
        now: Instant,
    ) -> PyResult<Self> {
        let borrowed = schedule.verify(&needs.requirements()).verified_uneven().map_err(Raise::raise)?;
        Self::begin(schedule, Borrowed::Uneven(Box::new(borrowed)), Promise::EachSensor(needs), config, now)
    }

    /// The same, if its schedule rejects crosstalk; so must then all to which it changes.
    pub(crate) fn verified(self) -> PyResult<Self> {
        verify(self.ring().schedule(), self.ring().t_delta())?;
        Ok(Self { promise: Promise::TDelta, ..self })
    }

    /// The number of one of its sensors.
    pub(crate) fn sensor(&self, sensor: &Bound<'_, PyAny>) -> PyResult<u8> {
        // At most 64.
        whole("sensor", sensor, 0..=self.ring().sensors() as u8 - 1)
    }

    pub(crate) fn ring(&self) -> &AnyRing<'_> {
        self.ring.borrow_dependent()
    }

    pub(crate) fn with<T>(&mut self, call: impl FnOnce(&mut AnyRing<'_>) -> T) -> T {
        self.ring.with_dependent_mut(|_, ring| call(ring))
    }

    /// The next event, if there is one.
    pub(crate) fn poll(&mut self, now: Instant, change: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let event = self.with(|ring| ring.poll_expecting(now, change));
        self.now = now;
        if let Some(event) = &event {
            _ = self.watch.observe(event, now);
        }
        event
    }

    pub(crate) fn change<E: Raise>(&mut self, change: impl FnOnce(&mut AnyRing<'_>) -> Result<(), E>) -> PyResult<()> {
        self.with(change).map_err(Raise::raise)
    }

    /// Compares with another `t_delta`, at which what it fires by must reject crosstalk.
    pub(crate) fn set_t_delta(&mut self, t_delta: Micros) -> PyResult<()> {
        if matches!(self.promise, Promise::TDelta) {
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
        let next = match &self.promise {
            Promise::EachSensor(needs) => {
                let verified = schedule.verify(&needs.requirements()).verified_uneven().map_err(Raise::raise)?;
                Borrowed::Uneven(Box::new(verified))
            }
            Promise::TDelta => {
                verify(schedule, self.ring().t_delta())?;
                Borrowed::Even(Box::new(*schedule))
            }
            Promise::Nothing => Borrowed::Even(Box::new(*schedule)),
        };
        let changed = self.ring.with_dependent_mut(|schedules, ring| {
            let mut known = core::iter::once(&schedules.first).chain(&schedules.others);
            let borrowed = known.find(|known| **known == next);
            match (borrowed.unwrap_or_else(|| schedules.others.push_get(Box::new(next))), ring) {
                (Borrowed::Even(schedule), AnyRing::Even(ring)) => ring.change_to_unverified(schedule),
                (Borrowed::Uneven(schedule), AnyRing::Uneven(ring)) => ring.change_schedule(schedule),
                // All of a ring's schedules keep the same promise.
                _ => Err(RingError::Unverified),
            }
        });
        changed.map_err(Raise::raise)?;
        *self.next = *schedule;
        Ok(())
    }
}
