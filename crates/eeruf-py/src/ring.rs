//! `Ring`: a ring with a schedule, or a flow ring.

use std::sync::Arc;

use eeruf_core::{
    EachSensor, EchoFilter, Instant, MAX_SENSORS, Micros, Requirements, RingConfig, RingEvent, Silence, flow::FlowRing,
    judge::Judge as _, plan::TableFiring, watch::SensorWatch,
};
use eeruf_design::RingSpec;
use eeruf_sim::AnySchedule;
use pyo3::prelude::*;

use crate::{
    arguments::{choice, whole, wrong},
    errors::Raise,
    exclusive::Exclusive,
    ring_arguments::FlowNeeds,
};

/// Plan and judge together, as the firmware runs them: the caller passes the time and gets events back.
///
/// Moments are microseconds on a clock that wraps at 2^32, as on a small microcontroller; larger numbers are taken
/// modulo that. ``Ring(schedule)`` fires by a schedule and compares two readings; :meth:`flow` makes a ring that fires
/// one sensor after the other, whenever it is quiet enough.
///
/// Args:
///     schedule: when the sensors fire.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for all,
///         or a sequence with one for each sensor; or a :class:`Needs`, or the path of a ring file, in place of it and
///         of all other needs.
///     now_us: when the first period begins.
///     window_us: ``T_wind``: how long a sensor listens after it has fired, 1 or more. One for all, or a sequence.
///         Required unless a :class:`Needs` is given.
///     blanking_us: edges sooner than this after firing are ringing of the transducer, not echoes.
///     consecutive: the number of consecutive readings that must agree, 2 to 8.
///     path_change_us: P: the largest change of a foreign sound's path from one reading to the next, at
///         most 65,534; None for ``t_delta_us``. Smaller values make fewer readings ambiguous if firings are late.
///     audible_us: R: how long sound is audible, at most 67 s; None for one period.
///     refire_us: how soon a sensor may be triggered again, as for :func:`design`. With this, the arguments below or a
///         sequence above, the sensors are not all alike: the schedule must meet the needs of each, each listens
///         and compares by its own numbers, and ``t_delta_us`` and ``window_us`` return the largest.
///     intervals_us: pairs of sensors with the least time between their firings: ``[(0, 4, 9000)]``.
///     shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
///     together: groups of sensors that fire at the same instants, declared not to hear each other.
///     several_echoes: each sensor reports several echoes of a firing; of up to eight the earliest that repeats is
///         accepted.
///     silence: how to read a firing without an echo if :meth:`answered` or :meth:`measured` has not shown that the
///         sensor listened: ``"never_free"`` always gives ``"no_echo"``; ``"needs_answer"`` gives ``"unanswered"``, a
///         fault; ``"trusted"`` gives ``"clear"`` once it is repeated, even for a cut wire.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range; invalid listening times, such as a window longer than
///         the schedule allows; or a schedule that does not reject crosstalk at this ``t_delta_us`` (see
///         ``Ring.unverified``) or does not meet a sensor's needs.
///
/// Example:
///     >>> import eeruf
///     >>> ring, kinds = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000), []
///     >>> while len(kinds) < 24:
///     ...     now_us = ring.next_deadline_us
///     ...     while event := ring.poll(now_us):
///     ...         if isinstance(event, eeruf.Fire):
///     ...             ring.echo(event.sensor, now_us + 9_000)  # a wall 1.5 m away
///     ...         elif isinstance(event, eeruf.Reading):
///     ...             kinds.append(event.kind)
///     >>> kinds == ["first"] * 12 + ["accepted"] * 12
///     True
///     >>> needs = dict(t_delta_us=[999, 999, 1500, 1500], window_us=[36_000, 36_000, 12_000, 12_000])
///     >>> found = eeruf.design(4, min_interval_us=15_000, shared_lines=[(0, 2)], **needs)
///     >>> ring = eeruf.Ring(found.schedule, shared_lines=[(0, 2)], **needs)
///     >>> ring.t_delta_us, ring.window_us
///     (1500, 36000)
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct Ring(pub(crate) Exclusive<AnyRing>);

/// Largest number of echoes of one firing.
pub(crate) const MAX_ECHOES: usize = 8;

/// A ring with a schedule, whose sensors are alike or not, with up to `E` echoes of a firing.
type TableRing<const E: usize> = eeruf_core::Ring<
    TableFiring<Arc<AnySchedule>, MAX_SENSORS, 2, EachSensor<MAX_SENSORS>>,
    EchoFilter<MAX_SENSORS, E>,
    MAX_SENSORS,
    E,
>;

/// The kinds of rings: by table or by flow, each with one echo per firing (smaller and faster) or several.
#[derive(Clone)]
pub(crate) enum Fires {
    Table(Box<TableRing<1>>),
    TableSeveral(Box<TableRing<MAX_ECHOES>>),
    Flow(Box<FlowRing<MAX_SENSORS, 1, EachSensor<MAX_SENSORS>>>),
    FlowSeveral(Box<FlowRing<MAX_SENSORS, MAX_ECHOES, EachSensor<MAX_SENSORS>>>),
}

/// Requirements on a ring's schedules.
#[derive(Clone)]
pub(crate) enum Promise {
    /// No requirement: crosstalk that the schedule repeats makes readings ambiguous.
    Nothing,
    /// The waits reject crosstalk at the ring's `t_delta`.
    TDelta,
    /// The needs of each sensor are met.
    EachSensor(Arc<RingSpec>),
}

/// A ring, its requirements on schedules, and each sensor's state according to the ring's events.
#[derive(Clone)]
pub(crate) struct AnyRing {
    pub(crate) fires: Fires,
    promise: Promise,
    pub(crate) watch: SensorWatch<MAX_SENSORS>,
    /// The instant of the last poll, or of the start.
    pub(crate) now: Instant,
}

/// Calls the ring, whatever its kind.
macro_rules! each {
    ($fires:expr, |$ring:ident| $call:expr) => {
        match $fires {
            $crate::ring::Fires::Table($ring) => $call,
            $crate::ring::Fires::TableSeveral($ring) => $call,
            $crate::ring::Fires::Flow($ring) => $call,
            $crate::ring::Fires::FlowSeveral($ring) => $call,
        }
    };
}

/// Calls an operation that only a ring with a schedule has.
macro_rules! table {
    ($any:expr, $what:expr, |$ring:ident| $call:expr) => {
        match &mut $any.fires {
            $crate::ring::Fires::Table($ring) => Ok($call),
            $crate::ring::Fires::TableSeveral($ring) => Ok($call),
            _ => Err($crate::errors::EerufError::new_err(format!(
                "{} of a ring by flow; expected a ring by an eeruf.Schedule: this one has settings",
                $what
            ))),
        }
    };
}

/// Calls an operation of a ring.
macro_rules! ask {
    ($any:expr, |$ring:ident| $call:expr) => {
        $crate::ring::each!(&$any.fires, |$ring| $call)
    };
}
macro_rules! act {
    ($any:expr, |$ring:ident| $call:expr) => {
        $crate::ring::each!(&mut $any.fires, |$ring| $call)
    };
}

/// Calls an operation on a sensor that the caller names.
macro_rules! of_sensor {
    ($this:expr, $sensor:ident, |$ring:ident| $call:expr) => {{
        let mut any = $this.0.get()?;
        let $sensor = any.sensor($sensor)?;
        $crate::ring::AnyRing::raised($crate::ring::act!(any, |$ring| $call))
    }};
}

pub(crate) use {act, ask, each, of_sensor, table};

/// Checks that a schedule rejects crosstalk.
fn verify(schedule: &AnySchedule, t_delta: Micros) -> PyResult<()> {
    let requirements = Requirements::new(t_delta);
    let verification = schedule.verify(&requirements);
    verification.violations().next().map_or(Ok(()), |violation| Err(violation.raise()))
}

impl Promise {
    /// The schedule in the form for firing, with the limits of each sensor if these must be kept.
    fn keep(&self, schedule: &AnySchedule, t_delta: Micros) -> PyResult<(Arc<AnySchedule>, EachSensor<MAX_SENSORS>)> {
        match self {
            Self::Nothing => Ok((Arc::new(*schedule), EachSensor::NONE)),
            Self::TDelta => verify(schedule, t_delta).map(|()| (Arc::new(*schedule), EachSensor::NONE)),
            Self::EachSensor(needs) => {
                let verified = schedule.verified_each(&needs.problem().requirements).map_err(Raise::raise)?;
                Ok((Arc::new(*verified.schedule()), *verified.own_limits()))
            }
        }
    }
}

impl Ring {
    pub(crate) fn of(mut ring: AnyRing, silence: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let names =
            [("never_free", Silence::NeverFree), ("needs_answer", Silence::NeedsAnswer), ("trusted", Silence::Trusted)];
        let silence = choice("silence", silence, &names)?;
        act!(ring, |ring| ring.set_silence(silence));
        Ok(Self(Exclusive::new("Ring", ring)))
    }
}

impl AnyRing {
    fn new(fires: Fires, promise: Promise, now: Instant) -> Self {
        Self { fires, promise, watch: SensorWatch::new(0, now), now }
    }

    /// A ring with a schedule that meets the requirements; later schedules must meet them too.
    pub(crate) fn by_schedule(
        schedule: &AnySchedule,
        promise: Promise,
        config: RingConfig,
        several: bool,
        now: Instant,
    ) -> PyResult<Self> {
        let (kept, own_limits) = promise.keep(schedule, config.t_delta.unwrap_or_default())?;
        let plan = TableFiring::holding(kept, own_limits, now);
        let fires = if several {
            TableRing::with_plan(plan, config.with_echoes(), now).map(|ring| Fires::TableSeveral(Box::new(ring)))
        } else {
            TableRing::with_plan(plan, config, now).map(|ring| Fires::Table(Box::new(ring)))
        };
        Ok(Self::new(fires.map_err(Raise::raise)?, promise, now))
    }

    pub(crate) fn flow(
        sensors: &Bound<'_, PyAny>,
        settings: Option<&Bound<'_, PyAny>>,
        needs: &FlowNeeds<'_, '_>,
        several: bool,
        now: Instant,
    ) -> PyResult<Self> {
        let (sensors, belief, turns, config, limits) = needs.of(sensors, settings)?;
        let fires = if several {
            let ring = FlowRing::with_limits(sensors, limits, turns, belief, config, now);
            ring.map(|ring| Fires::FlowSeveral(Box::new(ring)))
        } else {
            let ring = FlowRing::with_limits(sensors, limits, turns, belief, config, now);
            ring.map(|ring| Fires::Flow(Box::new(ring)))
        };
        Ok(Self::new(fires.map_err(Raise::raise)?, Promise::Nothing, now))
    }

    pub(crate) fn sensors(&self) -> usize {
        ask!(self, |ring| ring.sensors())
    }

    /// The checked number of one of its sensors.
    pub(crate) fn sensor(&self, sensor: &Bound<'_, PyAny>) -> PyResult<u8> {
        // At most 64.
        whole("sensor", sensor, 0..=self.sensors() as u8 - 1)
    }

    /// The next event, if there is one.
    pub(crate) fn poll(&mut self, now: Instant, change: impl FnMut(u8) -> i32) -> Option<RingEvent> {
        let event = act!(self, |ring| ring.poll_expecting(now, change));
        self.now = now;
        if let Some(event) = &event {
            _ = self.watch.observe(event, now);
        }
        event
    }

    /// The schedule of the current period.
    pub(crate) fn schedule(&mut self) -> PyResult<AnySchedule> {
        table!(self, "schedule", |ring| **ring.plan().table())
    }

    pub(crate) fn t_delta(&self) -> Micros {
        match &self.fires {
            Fires::Table(ring) => ring.t_delta(),
            Fires::TableSeveral(ring) => ring.t_delta(),
            Fires::Flow(ring) => ring.judge().t_delta(),
            Fires::FlowSeveral(ring) => ring.judge().t_delta(),
        }
    }

    /// Sets another `t_delta`, at which the schedules of this period and the next must reject crosstalk.
    pub(crate) fn set_t_delta(&mut self, t_delta: Micros) -> PyResult<()> {
        let schedules =
            table!(self, "t_delta_us", |ring| [ring.plan().table(), ring.plan().next_table()].map(Arc::clone))?;
        if matches!(self.promise, Promise::TDelta) {
            schedules.iter().try_for_each(|schedule| verify(schedule, t_delta))?;
        }
        Self::raised(table!(self, "t_delta_us", |ring| ring.set_t_delta(t_delta))?)
    }

    /// The largest P of a sensor, for a ring with a schedule; its own `T_delta` by default.
    pub(crate) fn path_change(&mut self) -> PyResult<Micros> {
        // At most 64 sensors.
        let sensors = 0..self.sensors() as u8;
        table!(self, "path_change_us", |ring| sensors.map(|of| ring.path_change_of(of)).max().unwrap_or_default())
    }

    /// Changes the schedule when the current period ends.
    pub(crate) fn change_schedule(&mut self, schedule: &AnySchedule) -> PyResult<()> {
        let sensors = self.schedule()?.sensors();
        if schedule.sensors() != sensors {
            let expected = format!("one of {sensors} sensors, as the ring has");
            return Err(wrong("schedule", format!("one of {} sensors", schedule.sensors()), expected));
        }
        let (kept, own_limits) = self.promise.keep(schedule, self.t_delta())?;
        Self::raised(table!(self, "schedule", |ring| ring.change_to(kept, own_limits))?)
    }

    /// Raises the error of a change, if it failed.
    pub(crate) fn raised<E: Raise>(changed: Result<(), E>) -> PyResult<()> {
        changed.map_err(Raise::raise)
    }
}
