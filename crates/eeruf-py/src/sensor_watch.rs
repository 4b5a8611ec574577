//! `SensorWatch`: which sensors are blind, and what was last accepted of each.

use eeruf_core::{MAX_SENSORS, Micros};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{whole, whole_or},
    fields::to_dict,
    moments::instant,
    ring_events::to_core,
};

/// Watches the events of a ring, a hopping one too: what was last accepted of each sensor, how old it is, and which
/// sensors hear echoes none of which is accepted.
///
/// Args:
///     sensors: how many, 1 to 64.
///     blind_after: a sensor counts as blind when nothing was accepted for so many firings with an echo, 1 to 255;
///         0: never.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
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
///     >>> watch.last_accepted(4, now_us).t_echo_us, watch.last_accepted(5, now_us)
///     (9000, None)
#[pyclass(module = "eeruf")]
pub(crate) struct SensorWatch {
    watch: eeruf_core::SensorWatch<MAX_SENSORS>,
    sensors: u8,
}

#[pymethods]
impl SensorWatch {
    #[new]
    #[pyo3(signature = (sensors, blind_after=None), text_signature = "(sensors, blind_after=20)")]
    fn new(sensors: &Bound<'_, PyAny>, blind_after: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let sensors = whole("sensors", sensors, 1..=MAX_SENSORS as u8)?;
        let blind_after = whole_or("blind_after", blind_after, 20, 0..=u8::MAX)?;
        Ok(Self { watch: eeruf_core::SensorWatch::new(blind_after), sensors })
    }

    /// How many sensors it watches.
    #[getter]
    fn sensors(&self) -> u8 {
        self.sensors
    }

    /// Take in what a poll returned. Observe every event, or at least readings and the ends of periods.
    ///
    /// Args:
    ///     event: of ``Ring.poll`` or ``HoppingRing.poll``.
    ///     now_us: the time of that poll, 0 or more.
    ///
    /// Returns:
    ///     A ``Blind`` when a sensor has just become blind, once, and again only after something was accepted; else
    ///     None.
    ///
    /// Raises:
    ///     ArgumentError: no event, or not such a time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> watch = eeruf.SensorWatch(sensors=12, blind_after=1)
    ///     >>> watch.observe(eeruf.Reading(3, "rejected", 9_000, 7_000), now_us=100_000)
    ///     Blind(sensor=3, firings=1)
    #[pyo3(signature = (event, now_us))]
    fn observe(&mut self, event: &Bound<'_, PyAny>, now_us: &Bound<'_, PyAny>) -> PyResult<Option<Blind>> {
        let (event, now) = (to_core("event", event)?, instant("now_us", now_us)?);
        let blind = self.watch.observe(&event, now);
        Ok(blind.map(|blind| Blind { sensor: blind.sensor, firings: blind.firings }))
    }

    /// What was last accepted of a sensor, however long ago.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     now_us: the present, 0 or more.
    ///
    /// Returns:
    ///     A ``LastAccepted``, or None if no echo ever was.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> watch = eeruf.SensorWatch(sensors=12)
    ///     >>> watch.observe(eeruf.Reading(3, "accepted", 9_000, 9_100), now_us=102_400)
    ///     >>> watch.last_accepted(3, now_us=153_600)
    ///     LastAccepted(t_echo_us=9000, age_us=51200)
    #[pyo3(signature = (sensor, now_us))]
    fn last_accepted(&self, sensor: &Bound<'_, PyAny>, now_us: &Bound<'_, PyAny>) -> PyResult<Option<LastAccepted>> {
        let (sensor, now) = (whole("sensor", sensor, 0..=self.sensors - 1)?, instant("now_us", now_us)?);
        // There are as many as it has room for.
        let last = self.watch.last_accepted(sensor, now).ok().flatten();
        Ok(last.map(|last| LastAccepted { t_echo_us: last.t_echo.as_micros(), age_us: last.age.as_micros() }))
    }

    fn __repr__(&self) -> String {
        format!("<SensorWatch: {} sensors>", self.sensors)
    }
}

/// A sensor that hears echoes, none of which was accepted for so many firings.
///
/// Example:
///     >>> import eeruf
///     >>> eeruf.Blind(sensor=3, firings=20).to_dict()
///     {'sensor': 3, 'firings': 20}
#[pyclass(frozen, eq, hash, get_all, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct Blind {
    /// Which sensor, from 0.
    sensor: u8,
    /// For how many firings with an echo nothing was accepted.
    firings: u8,
}

#[pymethods]
impl Blind {
    #[new]
    #[pyo3(signature = (sensor, firings))]
    fn new(sensor: &Bound<'_, PyAny>, firings: &Bound<'_, PyAny>) -> PyResult<Self> {
        let sensor = whole("sensor", sensor, 0..=MAX_SENSORS as u8 - 1)?;
        Ok(Self { sensor, firings: whole("firings", firings, 1..=u8::MAX)? })
    }

    fn __repr__(&self) -> String {
        format!("Blind(sensor={}, firings={})", self.sensor, self.firings)
    }

    /// Its fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.Blind(3, 20).to_dict()
    ///     {'sensor': 3, 'firings': 20}
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &["sensor", "firings"])
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Self { sensor, firings } = slf.get();
        Ok((slf.get_type().into_any(), (sensor, firings).into_pyobject(slf.py())?))
    }
}

/// The last accepted echo of a sensor.
///
/// Example:
///     >>> import eeruf
///     >>> eeruf.LastAccepted(t_echo_us=9_000, age_us=51_200).to_dict()
///     {'t_echo_us': 9000, 'age_us': 51200}
#[pyclass(frozen, eq, hash, get_all, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct LastAccepted {
    /// Its echo time, in microseconds.
    t_echo_us: u32,
    /// How long ago it was accepted, in microseconds, to 256; at most 2^31 (36 minutes), which stands for all longer
    /// times.
    age_us: u32,
}

#[pymethods]
impl LastAccepted {
    #[new]
    #[pyo3(signature = (t_echo_us, age_us))]
    fn new(t_echo_us: &Bound<'_, PyAny>, age_us: &Bound<'_, PyAny>) -> PyResult<Self> {
        let micros = |name, value| crate::arguments::micros(name, value).map(Micros::as_micros);
        Ok(Self { t_echo_us: micros("t_echo_us", t_echo_us)?, age_us: micros("age_us", age_us)? })
    }

    fn __repr__(&self) -> String {
        format!("LastAccepted(t_echo_us={}, age_us={})", self.t_echo_us, self.age_us)
    }

    /// Its fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.LastAccepted(9_000, 0).to_dict()
    ///     {'t_echo_us': 9000, 'age_us': 0}
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &["t_echo_us", "age_us"])
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Self { t_echo_us, age_us } = slf.get();
        Ok((slf.get_type().into_any(), (t_echo_us, age_us).into_pyobject(slf.py())?))
    }
}
