//! `Ring`: by a schedule, hopping, or by flow.

use eeruf_core::{
    Instant, MAX_SENSORS, Micros, RingEvent,
    flow::FlowRing,
    hopping::{HoppingListening, HoppingRing},
    watch::SensorWatch,
};
use eeruf_sim::AnySchedule;
use pyo3::prelude::*;

use crate::{
    arguments::{instance, whole},
    errors::{Raise, RingError},
    exclusive::Exclusive,
    flow_settings,
    hopping_schedule::HoppingSchedule,
    hopping_settings::HoppingSettings,
    owned_ring::OwnedRing,
    requirements,
};

/// Plan and filter together, as the firmware runs them: the caller passes the time and gets back what to do.
///
/// Moments are microseconds on a clock that wraps at 2^32, as on a small microcontroller; larger numbers are taken
/// modulo that. ``Ring(schedule)`` fires by a schedule and compares two readings; :meth:`flow` and :meth:`hopping`
/// give rings that fire otherwise and count votes.
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

impl Ring {
    pub(crate) fn of(fires: Fires, now: Instant) -> Self {
        Self(Exclusive::new("Ring", AnyRing::new(fires, now)))
    }
}

/// The three kinds, and the `t_delta` by which two count votes.
pub(crate) enum Fires {
    BySchedule(Box<OwnedRing>),
    Hopping(Box<HoppingRing<MAX_SENSORS>>, Micros),
    ByFlow(Box<FlowRing<MAX_SENSORS>>, Micros),
}

impl Fires {
    pub(crate) fn hopping(
        schedule: &Bound<'_, PyAny>,
        settings: Option<&Bound<'_, PyAny>>,
        listening: HoppingListening,
        seed: u32,
        now: Instant,
    ) -> PyResult<Self> {
        let settings = HoppingSettings::of("settings", settings)?;
        let schedule = &instance::<HoppingSchedule>("schedule", schedule, "an eeruf.HoppingSchedule")?.get().0;
        let ring = HoppingRing::hopping(schedule, settings, listening, seed, now).map_err(Raise::raise)?;
        Ok(Self::Hopping(Box::new(ring), settings.tracker.t_delta))
    }

    pub(crate) fn by_flow(
        sensors: &Bound<'_, PyAny>,
        settings: Option<&Bound<'_, PyAny>>,
        listening: HoppingListening,
        now: Instant,
    ) -> PyResult<Self> {
        let (sensors, settings) = (requirements::sensors(sensors)?, flow_settings::of(settings)?);
        let ring = FlowRing::flow(sensors, settings, listening, now).map_err(Raise::raise)?;
        Ok(Self::ByFlow(Box::new(ring), settings.tracker.t_delta))
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
            $crate::ring::Fires::BySchedule(owned) => {
                let $ring = owned.ring();
                $call
            }
            $crate::ring::Fires::Hopping($ring, _) => $call,
            $crate::ring::Fires::ByFlow($ring, _) => $call,
        }
    };
}

/// Does the same to whichever ring it is.
macro_rules! act {
    ($any:expr, |$ring:ident| $call:expr) => {
        match &mut $any.fires {
            $crate::ring::Fires::BySchedule(owned) => owned.with(|$ring| $call),
            $crate::ring::Fires::Hopping($ring, _) => $call,
            $crate::ring::Fires::ByFlow($ring, _) => $call,
        }
    };
}

pub(crate) use {act, ask};

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
            Fires::Hopping(..) | Fires::ByFlow(..) => Err(RingError::new_err(format!(
                "{what} of a ring that counts votes; expected a ring by an eeruf.Schedule: this one has settings"
            ))),
        }
    }

    pub(crate) fn t_delta(&self) -> Micros {
        match &self.fires {
            Fires::BySchedule(owned) => owned.ring().t_delta(),
            Fires::Hopping(_, t_delta) | Fires::ByFlow(_, t_delta) => *t_delta,
        }
    }

    /// The lags of a ring that hops, as they are now.
    pub(crate) fn lags(&self) -> impl Iterator<Item = Micros> {
        let hopping = if let Fires::Hopping(ring, _) = &self.fires { Some(ring.plan()) } else { None };
        (0..self.sensors()).filter_map(move |sensor| hopping?.t_lag(sensor))
    }

    /// The echo that votes have confirmed.
    pub(crate) fn confirmed(&self, sensor: u8) -> Option<Micros> {
        match &self.fires {
            Fires::BySchedule(_) => None,
            Fires::Hopping(ring, _) => ring.judge().confirmed(sensor.into()),
            Fires::ByFlow(ring, _) => ring.judge().confirmed(sensor.into()),
        }
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
