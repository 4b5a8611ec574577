//! `Ring`: by a schedule, or by flow.

use eeruf_core::{
    EachSensor, Instant, MAX_SENSORS, Micros, RingEvent, Silence, flow::FlowRing, judge::Judge as _, watch::SensorWatch,
};
use eeruf_sim::AnySchedule;
use pyo3::prelude::*;

use crate::{
    arguments::{choice, whole},
    errors::{Raise, RingError},
    exclusive::Exclusive,
    flow_settings::FlowSettings,
    owned_ring::{MAX_ECHOES, OwnedRing},
    requirements,
    ring_arguments::FlowNeeds,
};

/// Plan and filter together, as the firmware runs them: the caller passes the time and gets back what to do.
///
/// Moments are microseconds on a clock that wraps at 2^32, as on a small microcontroller; larger numbers are taken
/// modulo that. ``Ring(schedule)`` fires by a schedule and compares two readings; :meth:`flow` gives a ring that fires
/// one sensor after the other, whenever it is quiet enough.
///
/// Args:
///     schedule: when the sensors fire.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11). One for all,
///         or a sequence with one for each sensor.
///     now_us: when the first period begins.
///     window_us: ``T_wind``: how long a sensor listens after it has fired, 1 or more. One for all, or a sequence.
///     blanking_us: edges sooner than this after firing are ringing of the transducer, not echoes.
///     consecutive: the number of consecutive readings that must agree, 2 to 8.
///     path_change_us: P: the largest change of a foreign sound's path from one reading to the next, at
///         most 65,534; None for ``t_delta_us``. Less makes fewer readings ambiguous where firings are late.
///     audible_us: R: how long sound is audible, at most 67 s; None for one period.
///     refire_us: how soon a sensor may be triggered again, as for :func:`design`. With this, with those below or with
///         a sequence above the ring is one of sensors that are not all alike: its schedule must keep what each needs,
///         each listens and compares by its own numbers, and ``t_delta_us`` and ``window_us`` say the largest.
///     intervals_us: pairs of sensors with the least time between their firings: ``[(0, 4, 9000)]``.
///     shared_lines: groups of sensors on one echo line, ``[(0, 3), (1, 4)]``: none fires while another listens.
///     together: groups of sensors that fire at the same instants, declared not to hear each other.
///     several_echoes: each sensor reports several echoes of a firing; of up to eight the earliest that repeats is
///         accepted.
///     silence: what a firing without an echo means whose sensor has not shown by :meth:`answered` or :meth:`measured`
///         that it listened: ``"never_free"``, ``"no_echo"`` however often; ``"needs_answer"``, ``"unanswered"``, a
///         fault; ``"trusted"``, ``"clear"`` once repeated, as a cut wire is then.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///     RingError: the ring cannot listen like that, such as longer than the schedule lets it; or the schedule does not
///         reject crosstalk at this ``t_delta_us`` (see ``Ring.unverified``), or breaks what a sensor needs.
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

/// The kinds: by a table, or by flow with one echo of a firing or several.
pub(crate) enum Fires {
    BySchedule(Box<OwnedRing>),
    Flow(Box<FlowRing<MAX_SENSORS, 1, EachSensor<MAX_SENSORS>>>),
    FlowSeveral(Box<FlowRing<MAX_SENSORS, MAX_ECHOES, EachSensor<MAX_SENSORS>>>),
}

impl Fires {
    pub(crate) fn flow(
        sensors: &Bound<'_, PyAny>,
        settings: Option<&Bound<'_, PyAny>>,
        needs: &FlowNeeds<'_, '_>,
        several: bool,
        now: Instant,
    ) -> PyResult<Self> {
        let (sensors, settings) = (requirements::sensors(sensors)?, FlowSettings::of(settings)?);
        let (turns, config, limits) = needs.of(sensors, &settings)?;
        let belief = settings.belief();
        if several {
            let ring = FlowRing::with_limits(sensors, limits, turns, belief, config, now).map_err(Raise::raise)?;
            return Ok(Self::FlowSeveral(Box::new(ring)));
        }
        let ring = FlowRing::with_limits(sensors, limits, turns, belief, config, now).map_err(Raise::raise)?;
        Ok(Self::Flow(Box::new(ring)))
    }
}

/// A ring, and the state of each of its sensors by its events.
pub(crate) struct AnyRing {
    pub(crate) fires: Fires,
    pub(crate) watch: SensorWatch<MAX_SENSORS>,
    /// The instant of the last poll, or of the beginning.
    pub(crate) now: Instant,
}

/// Asks the same of whichever ring it is.
macro_rules! ask {
    ($any:expr, |$ring:ident| $call:expr) => {
        match &$any.fires {
            $crate::ring::Fires::BySchedule(owned) => $crate::owned_ring::table!(owned.ring(), |$ring| $call),
            $crate::ring::Fires::Flow($ring) => $call,
            $crate::ring::Fires::FlowSeveral($ring) => $call,
        }
    };
}

/// Does the same to whichever ring it is.
macro_rules! act {
    ($any:expr, |$ring:ident| $call:expr) => {
        match &mut $any.fires {
            $crate::ring::Fires::BySchedule(owned) => owned.with(|any| $crate::owned_ring::table!(any, |$ring| $call)),
            $crate::ring::Fires::Flow($ring) => $call,
            $crate::ring::Fires::FlowSeveral($ring) => $call,
        }
    };
}

/// Does something to the sensor that a caller names.
macro_rules! of_sensor {
    ($this:expr, $sensor:ident, |$ring:ident| $call:expr) => {{
        let mut any = $this.0.get()?;
        let $sensor = any.sensor($sensor)?;
        $crate::ring::AnyRing::raised($crate::ring::act!(any, |$ring| $call))
    }};
}

pub(crate) use {act, ask, of_sensor};

impl Ring {
    pub(crate) fn of(fires: Fires, silence: Option<&Bound<'_, PyAny>>, now: Instant) -> PyResult<Self> {
        let names =
            [("never_free", Silence::NeverFree), ("needs_answer", Silence::NeedsAnswer), ("trusted", Silence::Trusted)];
        let silence = choice("silence", silence, &names)?;
        let mut ring = AnyRing::new(fires, now);
        act!(ring, |ring| ring.set_silence(silence));
        Ok(Self(Exclusive::new("Ring", ring)))
    }
}

impl AnyRing {
    pub(crate) fn new(fires: Fires, now: Instant) -> Self {
        Self { fires, watch: SensorWatch::new(0, now), now }
    }

    pub(crate) fn sensors(&self) -> usize {
        ask!(self, |ring| ring.sensors())
    }

    /// The number of one of its sensors.
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

    /// The ring by a schedule, of which alone something is known or can be changed.
    pub(crate) fn by_schedule(&mut self, what: &str) -> PyResult<&mut OwnedRing> {
        match &mut self.fires {
            Fires::BySchedule(owned) => Ok(owned),
            _ => Err(RingError::new_err(format!(
                "{what} of a ring by flow; expected a ring by an eeruf.Schedule: this one has settings"
            ))),
        }
    }

    pub(crate) fn t_delta(&self) -> Micros {
        match &self.fires {
            Fires::BySchedule(owned) => owned.t_delta(),
            Fires::Flow(ring) => ring.judge().t_delta(),
            Fires::FlowSeveral(ring) => ring.judge().t_delta(),
        }
    }

    /// The largest P of a sensor, its own `T_delta` where it was not said, of a ring by a schedule.
    pub(crate) fn path_change(&mut self) -> PyResult<Micros> {
        // At most 64 sensors.
        let (sensors, owned) = (self.sensors() as u8, self.by_schedule("path_change_us")?);
        let of = |sensor| crate::owned_ring::table!(owned.ring(), |ring| ring.path_change_of(sensor));
        Ok((0..sensors).map(of).max().unwrap_or_default())
    }

    /// Fires by another schedule when the present period ends.
    pub(crate) fn change_schedule(&mut self, schedule: &AnySchedule) -> PyResult<()> {
        self.by_schedule("schedule")?.change_to(schedule)
    }

    /// Raises what a change of the ring answers.
    pub(crate) fn raised<E: Raise>(changed: Result<(), E>) -> PyResult<()> {
        changed.map_err(Raise::raise)
    }
}
