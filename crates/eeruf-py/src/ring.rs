//! `Ring` and its events.

use std::ops::RangeInclusive;

use eeruf_core::{Instant, MAX_SENSORS, Micros, ReadingKind, RingConfig, RingEvent, ScheduledRing, Verdict};
use eeruf_sim::AnySchedule;
use pyo3::{
    IntoPyObjectExt,
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{choice, instance, items, micros, shown, whole, whole_or, whole_or_none, wrong},
    errors::Raise,
    schedule::Schedule,
};

/// Sensors that can be.
const SENSORS: RangeInclusive<u8> = 0..=MAX_SENSORS as u8 - 1;

/// The ring is to fire a sensor, now.
///
/// Example:
///     >>> import eeruf
///     >>> eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000).poll(24_000)
///     Fire(sensor=0)
#[pyclass(frozen, eq, hash, get_all, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct Fire {
    /// Which sensor, from 0.
    sensor: u8,
}

#[pymethods]
impl Fire {
    #[new]
    #[pyo3(signature = (sensor))]
    fn new(sensor: &Bound<'_, PyAny>) -> PyResult<Self> {
        Ok(Self { sensor: whole("sensor", sensor, SENSORS)? })
    }

    fn __repr__(&self) -> String {
        format!("Fire(sensor={})", self.sensor)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        Ok((slf.get_type().into_any(), (slf.get().sensor,).into_pyobject(slf.py())?))
    }
}

/// What one firing of one sensor told.
///
/// Example:
///     >>> import eeruf
///     >>> eeruf.EchoFilter(1, 500).push(0, 9_000)
///     Reading(sensor=0, kind='first', t_echo_us=9000, previous_us=None, age=None, phase=None, period=None)
#[pyclass(frozen, eq, hash, get_all, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct Reading {
    /// Which sensor, from 0.
    sensor: u8,
    /// What became of it, one of ``eeruf.KINDS``: ``"accepted"`` and ``"clear"`` (nothing in range) are to be believed.
    kind: &'static str,
    /// The time of the echo after firing, in microseconds; None without echo.
    t_echo_us: Option<u32>,
    /// What it was compared with, in microseconds; None if with nothing.
    previous_us: Option<u32>,
    /// How many firings ago the sensor's last accepted reading was: 0 for this one, None if there never was one.
    age: Option<u16>,
    /// The phase in which the sensor fired: 0 for a, 1 for b; None from a filter alone.
    phase: Option<u8>,
    /// The period in which the sensor fired, from 0; None from a filter alone.
    period: Option<u32>,
}

impl Reading {
    /// From a filter alone, which knows no phases.
    pub(crate) fn of_filter(sensor: usize, verdict: &Verdict) -> Self {
        Self {
            // Below 64.
            sensor: sensor as u8,
            kind: verdict.kind.as_str(),
            t_echo_us: verdict.t_echo.map(Micros::as_micros),
            previous_us: verdict.previous.map(Micros::as_micros),
            age: verdict.age,
            phase: None,
            period: None,
        }
    }
}

#[pymethods]
impl Reading {
    #[new]
    #[pyo3(signature = (sensor, kind, t_echo_us=None, previous_us=None, age=None, phase=None, period=None))]
    fn new(
        sensor: &Bound<'_, PyAny>,
        kind: &Bound<'_, PyAny>,
        t_echo_us: Option<&Bound<'_, PyAny>>,
        previous_us: Option<&Bound<'_, PyAny>>,
        age: Option<&Bound<'_, PyAny>>,
        phase: Option<&Bound<'_, PyAny>>,
        period: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        Ok(Self {
            sensor: whole("sensor", sensor, SENSORS)?,
            kind: choice("kind", Some(kind), &ReadingKind::ALL.map(|kind| (kind.as_str(), kind.as_str())))?,
            t_echo_us: whole_or_none("t_echo_us", t_echo_us, 0..=u32::MAX)?,
            previous_us: whole_or_none("previous_us", previous_us, 0..=u32::MAX)?,
            age: whole_or_none("age", age, 0..=u16::MAX)?,
            phase: whole_or_none("phase", phase, 0..=u8::MAX)?,
            period: whole_or_none("period", period, 0..=u32::MAX)?,
        })
    }

    fn __repr__(&self) -> String {
        let shown = |value: Option<u32>| value.map_or_else(|| "None".to_owned(), |value| value.to_string());
        format!(
            "Reading(sensor={}, kind='{}', t_echo_us={}, previous_us={}, age={}, phase={}, period={})",
            self.sensor,
            self.kind,
            shown(self.t_echo_us),
            shown(self.previous_us),
            shown(self.age.map(u32::from)),
            shown(self.phase.map(u32::from)),
            shown(self.period)
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Self { sensor, kind, t_echo_us, previous_us, age, phase, period } = slf.get();
        let arguments = (sensor, kind, t_echo_us, previous_us, age, phase, period).into_pyobject(slf.py())?;
        Ok((slf.get_type().into_any(), arguments))
    }
}

/// A period of the ring has ended.
///
/// Example:
///     >>> import eeruf
///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
///     >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.PeriodEnded):
///     ...     pass
///     >>> event.period, event.phase, event.tally["no_echo"] <= 12
///     (0, 0, True)
#[pyclass(frozen, get_all, module = "eeruf")]
pub(crate) struct PeriodEnded {
    /// Which period, from 0.
    period: u32,
    /// Its phase: 0 for a, 1 for b.
    phase: u8,
    /// How long after it was due the latest firing was polled for, in microseconds, at most 65,535.
    max_late_us: u32,
    /// How many readings of each kind were told since the period before ended: a dict by the names in ``eeruf.KINDS``.
    tally: Py<PyDict>,
}

#[pymethods]
impl PeriodEnded {
    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let Self { period, phase, max_late_us, tally } = self;
        let tally = tally.bind(py).repr()?;
        Ok(format!("<PeriodEnded period={period} phase={phase} max_late_us={max_late_us} tally={tally}>"))
    }
}

type Scheduled<'s> = ScheduledRing<'s, MAX_SENSORS>;

self_cell::self_cell!(
    /// A ring with the schedule that it borrows.
    struct Owned {
        owner: Box<AnySchedule>,
        #[covariant]
        dependent: Scheduled,
    }
);

/// Scheduler and filter together, as the firmware runs them: the caller passes the time and is told what to do.
///
/// Moments are microseconds on a clock that wraps at 2^32, as on a small microcontroller; larger numbers are taken modulo that.
///
/// Args:
///     schedule: when the sensors fire.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11).
///     now_us: when the first period begins.
///     window_us: ``T_wind``: how long a sensor listens after it has fired, 1 or more.
///     blanking_us: edges sooner than this after firing are ringing of the transducer, not echoes.
///     consecutive: how many readings running must agree, 2 to 8.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///     RingError: the ring cannot listen like that, such as longer than the schedule lets it.
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
#[pyclass(module = "eeruf")]
pub(crate) struct Ring {
    ring: Owned,
    sensors: u32,
}

impl Ring {
    fn sensor(&self, sensor: &Bound<'_, PyAny>) -> PyResult<u8> {
        whole("sensor", sensor, 0..=self.sensors - 1).map(|sensor| sensor as u8)
    }

    fn change(&mut self, change: impl FnOnce(&mut Scheduled<'_>)) {
        self.ring.with_dependent_mut(|_, ring| change(ring));
    }

    fn changes(&self, changes: &Bound<'_, PyAny>) -> PyResult<Vec<i32>> {
        let name = "expected_change_us";
        let expected = format!("a sequence of {} whole numbers of microseconds, one for each sensor", self.sensors);
        let items = items(name, changes, &expected)?;
        if items.len() != self.sensors as usize {
            return Err(wrong(name, shown(changes), expected));
        }
        let each = |(index, item)| whole(&format!("{name}[{index}]"), item, i32::MIN..=i32::MAX);
        items.iter().enumerate().map(each).collect()
    }
}

/// A moment on a clock that wraps at 2^32 us: larger numbers are what such a clock would show.
fn instant(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Instant> {
    whole(name, value, 0..=u64::MAX).map(|us| Instant::from_micros(us as u32))
}

#[pymethods]
impl Ring {
    #[new]
    #[pyo3(signature = (schedule, t_delta_us, now_us=None, *, window_us, blanking_us=None, consecutive=None))]
    #[pyo3(text_signature = "(schedule, t_delta_us, now_us=0, *, window_us, blanking_us=0, consecutive=2)")]
    fn new(
        schedule: &Bound<'_, PyAny>,
        t_delta_us: &Bound<'_, PyAny>,
        now_us: Option<&Bound<'_, PyAny>>,
        window_us: &Bound<'_, PyAny>,
        blanking_us: Option<&Bound<'_, PyAny>>,
        consecutive: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let config = RingConfig {
            blanking: blanking_us.map_or(Ok(Micros::ZERO), |value| micros("blanking_us", value))?,
            consecutive: whole_or("consecutive", consecutive, 2, 0..=u8::MAX)?,
            ..RingConfig::new(micros("t_delta_us", t_delta_us)?, micros("window_us", window_us)?)
        };
        let now = now_us.map_or(Ok(Instant::from_micros(0)), |now| instant("now_us", now))?;
        let schedule = instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?.get().0;
        let ring = Owned::try_new(Box::new(schedule), |schedule| Scheduled::new(schedule, config, now));
        // At most 64.
        Ok(Self { ring: ring.map_err(Raise::raise)?, sensors: schedule.sensors() as u32 })
    }

    /// The next thing to do or to know at a time. Call again until there is none, then wait until ``next_deadline_us``.
    ///
    /// Hand in the echoes you know of before you poll: one that comes after the poll that closed its window is not heard.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///     expected_change_us: for each sensor, by how much a good reading should differ from the one before, from the robot's own
    ///         motion: ``-2 v dt / c`` for an object approached at ``v``. None for a robot that stands.
    ///
    /// Returns:
    ///     A ``Fire``, a ``Reading``, a ``PeriodEnded``, or None if there is nothing to do now.
    ///
    /// Raises:
    ///     ArgumentError: not such a time, or not one change for each sensor.
    #[pyo3(signature = (now_us, expected_change_us=None))]
    fn poll<'py>(
        &mut self,
        now_us: &Bound<'py, PyAny>,
        expected_change_us: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (py, now) = (now_us.py(), instant("now_us", now_us)?);
        let changes = expected_change_us.map(|changes| self.changes(changes)).transpose()?.unwrap_or_default();
        let change = |sensor: u8| changes.get(usize::from(sensor)).copied().unwrap_or(0);
        let event = self.ring.with_dependent_mut(|_, ring| ring.poll_expecting(now, change));
        let event = match event {
            None => return Ok(None),
            Some(RingEvent::Fire(sensor)) => Fire { sensor }.into_bound_py_any(py),
            Some(RingEvent::Reading(reading)) => Reading {
                sensor: reading.sensor,
                kind: reading.kind.as_str(),
                t_echo_us: reading.t_echo.map(Micros::as_micros),
                previous_us: reading.previous.map(Micros::as_micros),
                age: reading.age,
                phase: Some(reading.phase.0),
                period: Some(reading.period),
            }
            .into_bound_py_any(py),
            Some(RingEvent::PeriodEnded(stats)) => {
                let tally = PyDict::new(py);
                for kind in ReadingKind::ALL {
                    tally.set_item(kind.as_str(), stats.tally.of(kind))?;
                }
                let (period, phase, max_late_us) = (stats.period, stats.phase.0, stats.max_late.as_micros());
                PeriodEnded { period, phase, max_late_us, tally: tally.unbind() }.into_bound_py_any(py)
            }
        };
        event.map(Some)
    }

    fn __repr__(&self) -> String {
        format!("<Ring: {} sensors, next deadline at {} us>", self.sensors, self.next_deadline_us())
    }

    /// When to poll next, in microseconds of the clock that wraps at 2^32; in the past if something is waiting to be told.
    #[getter]
    fn next_deadline_us(&self) -> u32 {
        self.ring.borrow_dependent().next_deadline().as_micros()
    }

    /// What it fires by.
    #[getter]
    fn schedule(&self) -> Schedule {
        Schedule(**self.ring.borrow_owner())
    }

    /// An edge on the echo line of a sensor. Edges may come in any order, at any time, wanted or not.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     at_us: when, 0 or more.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor or time.
    #[pyo3(signature = (sensor, at_us))]
    fn echo(&mut self, sensor: &Bound<'_, PyAny>, at_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (sensor, at) = (self.sensor(sensor)?, instant("at_us", at_us)?);
        self.change(|ring| ring.echo(sensor, at));
        Ok(())
    }

    /// The echo line of a sensor was already high when it was to fire: the firing just told counts as ``"stuck"``.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    #[pyo3(signature = (sensor))]
    fn stuck(&mut self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.change(|ring| ring.stuck(sensor));
        Ok(())
    }

    /// Have a sensor fire no more. A firing of it that is under way is still told.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    #[pyo3(signature = (sensor))]
    fn disable(&mut self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.change(|ring| ring.disable(sensor));
        Ok(())
    }

    /// Have a sensor fire again, from its next turn on. Its readings from before are forgotten.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    #[pyo3(signature = (sensor))]
    fn enable(&mut self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.change(|ring| ring.enable(sensor));
        Ok(())
    }
}
