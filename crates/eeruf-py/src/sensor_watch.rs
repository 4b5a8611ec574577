//! `SensorWatch`: the known state of the space in front of each sensor, and blind sensors.

use eeruf_core::{
    Instant, MAX_SENSORS, Micros,
    watch::{Doubt, SensorState},
};
use pyo3::prelude::*;

use crate::{
    arguments::{whole, whole_or},
    exclusive::Exclusive,
    fields::record,
    moments::instant,
    ring_arguments::begins,
    ring_events::{ExplainedBy, to_core},
};

/// Watches the events of a ring for the state of the space in front of each sensor, and for sensors whose echoes are
/// never accepted.
///
/// Args:
///     sensors: how many, 1 to 64.
///     blind_after: a sensor counts as blind when nothing was accepted for this many firings with an echo, 1 to 255;
///         0: never.
///     now_us: the current time, 0 or more.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range.
///
/// Example:
///     >>> import eeruf
///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
///     >>> watch, blind, far_us = eeruf.SensorWatch(sensors=12, blind_after=4), [], 0
///     >>> for _ in range(400):
///     ...     now_us = ring.next_deadline_us
///     ...     while event := ring.poll(now_us):
///     ...         if isinstance(event, eeruf.Fire):
///     ...             far_us = (far_us + 700) % 9_000  # what sensor 5 hears moves on and on
///     ...             ring.echo(event.sensor, now_us + 9_000 + (far_us if event.sensor == 5 else 0))
///     ...         if found := watch.observe(event, now_us):
///     ...             blind.append(found)
///     >>> blind
///     [Blind(sensor=5, firings=4)]
///     >>> watch.state(4, now_us).t_echo_us, watch.state(5, now_us).kind
///     (9000, 'unknown')
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct SensorWatch {
    watch: Exclusive<eeruf_core::watch::SensorWatch<MAX_SENSORS>>,
    sensors: u8,
    blind_after: u8,
}

#[pymethods]
impl SensorWatch {
    #[new]
    #[pyo3(signature = (sensors, blind_after=None, now_us=None))]
    #[pyo3(text_signature = "(sensors, blind_after=20, now_us=0)")]
    fn new(
        sensors: &Bound<'_, PyAny>,
        blind_after: Option<&Bound<'_, PyAny>>,
        now_us: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let sensors = whole("sensors", sensors, 1..=MAX_SENSORS as u8)?;
        let blind_after = whole_or("blind_after", blind_after, 20, 0..=u8::MAX)?;
        let watch = eeruf_core::watch::SensorWatch::new(blind_after, begins(now_us)?);
        Ok(Self { watch: Exclusive::new("SensorWatch", watch), sensors, blind_after })
    }

    /// Number of sensors watched.
    #[getter]
    fn sensors(&self) -> u8 {
        self.sensors
    }

    /// Read an event that a poll returned. Observe every event, or at least readings and the ends of periods.
    ///
    /// Args:
    ///     event: an event that ``Ring.poll`` returned.
    ///     now_us: the time of that poll, 0 or more.
    ///
    /// Returns:
    ///     A ``Blind`` when a sensor has just become blind, once until one of its readings is accepted again; else
    ///     None.
    ///
    /// Raises:
    ///     EerufError: not an event, or an invalid time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> watch = eeruf.SensorWatch(sensors=12, blind_after=1)
    ///     >>> watch.observe(eeruf.Reading(3, "rejected", 9_000, 7_000), now_us=100_000)
    ///     Blind(sensor=3, firings=1)
    fn observe<'py>(
        &self,
        event: &Bound<'py, PyAny>,
        now_us: &Bound<'_, PyAny>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (py, event, now) = (event.py(), to_core("event", event)?, instant("now_us", now_us)?);
        let blind = self.watch.get()?.observe(&event, now);
        blind.map(|sensor| record(py, "Blind", (sensor, self.blind_after))).transpose()
    }

    /// The state of the space in front of a sensor.
    ///
    /// Args:
    ///     sensor: its index, from 0.
    ///     now_us: the current time, 0 or more.
    ///
    /// Raises:
    ///     EerufError: an invalid sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> watch = eeruf.SensorWatch(sensors=12)
    ///     >>> watch.observe(eeruf.Reading(3, "accepted", 9_000, 9_100), now_us=102_400)
    ///     >>> watch.state(3, now_us=153_600)
    ///     State(kind='obstacle', t_echo_us=9000, age_us=51200, why=None, explained_by=None)
    fn state<'py>(&self, sensor: &Bound<'py, PyAny>, now_us: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let (py, now) = (sensor.py(), instant("now_us", now_us)?);
        let sensor = whole("sensor", sensor, 0..=self.sensors - 1)?;
        State::of(&*self.watch.get()?, sensor, now).into_python(py)
    }

    fn __copy__(&self) -> PyResult<Self> {
        Ok(Self { watch: Exclusive::new("SensorWatch", self.watch.get()?.clone()), ..*self })
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.__copy__()
    }

    fn __repr__(&self) -> String {
        format!("<SensorWatch: {} sensors>", self.sensors)
    }
}

/// The state of the space in front of a sensor, before conversion to Python.
pub(crate) struct State {
    kind: &'static str,
    t_echo_us: Option<u32>,
    age_us: u32,
    why: Option<&'static str>,
    explained_by: Option<ExplainedBy>,
}

const KINDS: [&str; 5] = ["obstacle", "clear", "too_close", "unanswered", "unknown"];
const WHYS: [&str; 5] = ["no_firing", "unsure", "rejected", "ambiguous", "no_witness"];

impl State {
    /// The state of the space in front of a sensor that exists.
    pub(crate) fn of(watch: &eeruf_core::watch::SensorWatch<MAX_SENSORS>, sensor: u8, now: Instant) -> Self {
        let [obstacle, clear, too_close, unanswered, unknown] = KINDS;
        let known =
            |kind, age: Micros| Self { kind, t_echo_us: None, age_us: age.as_micros(), why: None, explained_by: None };
        match watch.state(sensor, now) {
            Ok(SensorState::Obstacle { t_echo, age }) => {
                Self { t_echo_us: Some(t_echo.as_micros()), ..known(obstacle, age) }
            }
            Ok(SensorState::Clear { age }) => known(clear, age),
            Ok(SensorState::TooClose { age }) => known(too_close, age),
            Ok(SensorState::Unanswered { since }) => known(unanswered, since),
            Ok(SensorState::Unknown { since, why }) => {
                let (why, by) = match why {
                    Doubt::NoFiring => (0, None),
                    Doubt::Rejected => (2, None),
                    Doubt::Ambiguous(by) => (3, Some(ExplainedBy::of(by))),
                    Doubt::NoWitness => (4, None),
                    _ => (1, None),
                };
                Self { why: WHYS.get(why).copied(), explained_by: by, ..known(unknown, since) }
            }
            _ => known(unknown, Micros::ZERO),
        }
    }

    /// The state in Python's form.
    pub(crate) fn into_python(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let Self { kind, t_echo_us, age_us, why, explained_by } = self;
        record(py, "State", (kind, t_echo_us, age_us, why, explained_by))
    }
}
