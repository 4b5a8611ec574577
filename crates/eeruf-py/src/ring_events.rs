//! Events of a `Ring`: `Fire`, `Reading` and `PeriodEnded`.

use std::ops::RangeInclusive;

use eeruf_core::{
    Instant, MAX_SENSORS, Micros, PeriodStats, Phase, ReadingKind, RingEvent, Tally,
    judge::{Explanation, Verdict},
    plan::Upcoming,
};
use pyo3::{IntoPyObjectExt, prelude::*, types::PyDict};

use crate::{
    arguments::{choice, instance, shown, whole, whole_or, whole_or_none, wrong},
    fields::{Reduced, reduce, repr, to_dict},
};

/// Valid indices of sensors.
const SENSORS: RangeInclusive<u8> = 0..=MAX_SENSORS as u8 - 1;

/// Fire this sensor, now.
///
/// Example:
///     >>> import eeruf
///     >>> eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000).poll(24_000)
///     Fire(sensor=0, phase=0, due_us=24000)
#[pyclass(frozen, eq, hash, get_all, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct Fire {
    /// The sensor, from 0.
    sensor: u8,
    /// The phase of the firing's wait: 0 for a, 1 for b.
    phase: u8,
    /// Time when the firing was due, on the ring's clock; earlier than the poll if the poll was late.
    due_us: u32,
}

impl Fire {
    /// A firing to come.
    pub(crate) fn of(upcoming: Upcoming) -> Self {
        let Upcoming { sensor, phase, due } = upcoming;
        Self { sensor, phase: phase.0, due_us: due.as_micros() }
    }
}

const FIRE: [&str; 3] = ["sensor", "phase", "due_us"];

#[pymethods]
impl Fire {
    #[new]
    #[pyo3(signature = (sensor, phase=None, due_us=None))]
    #[pyo3(text_signature = "(sensor, phase=0, due_us=0)")]
    fn new(
        sensor: &Bound<'_, PyAny>,
        phase: Option<&Bound<'_, PyAny>>,
        due_us: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        Ok(Self {
            sensor: whole("sensor", sensor, SENSORS)?,
            phase: whole_or("phase", phase, 0, 0..=u8::MAX)?,
            due_us: whole_or("due_us", due_us, 0, 0..=u32::MAX)?,
        })
    }

    /// The fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.Fire(3, phase=1).to_dict()
    ///     {'sensor': 3, 'phase': 1, 'due_us': 0}
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &FIRE)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &FIRE)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &FIRE)
    }
}

/// The outcome of one firing of one sensor.
///
/// Example:
///     >>> import eeruf
///     >>> reading = eeruf.EchoFilter(1, 500).push(0, 9_000)
///     >>> reading.sensor, reading.kind, reading.t_echo_us, reading.explained_by
///     (0, 'first', 9000, None)
#[pyclass(frozen, eq, hash, get_all, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct Reading {
    /// The sensor, from 0.
    sensor: u8,
    /// The outcome, one of ``eeruf.KINDS``; only ``"accepted"`` and ``"clear"`` (nothing in range) can be trusted.
    kind: &'static str,
    /// The time of the echo after firing, in microseconds; None without echo.
    t_echo_us: Option<u32>,
    /// The earlier echo time that this one was compared with, in microseconds; None if there was none.
    previous_us: Option<u32>,
    /// Number of firings since the sensor's last accepted reading: 0 for this one, None if there never was one.
    age: Option<u16>,
    /// The phase in which the sensor fired: 0 for a, 1 for b; None from a filter alone.
    phase: Option<u8>,
    /// The period in which the sensor fired, from 0; None from a filter alone.
    period: Option<u32>,
    /// Reason of an ambiguity: the sensor, from 0, whose sound explains this reading and the one before, or
    /// ``"history"`` for a firing that is no longer remembered; None for every other kind.
    explained_by: Option<ExplainedBy>,
}

/// An [`Explanation`] in Python's form.
#[derive(Clone, Copy, PartialEq, Eq, Hash, IntoPyObject)]
pub(crate) enum ExplainedBy {
    Sensor(u8),
    History(&'static str),
}

const HISTORY: &str = "history";

impl ExplainedBy {
    pub(crate) fn of(explanation: Explanation) -> Self {
        match explanation {
            Explanation::Sensor(sensor) => Self::Sensor(sensor),
            Explanation::History => Self::History(HISTORY),
        }
    }

    fn to_core(self) -> Explanation {
        match self {
            Self::Sensor(sensor) => Explanation::Sensor(sensor),
            Self::History(_) => Explanation::History,
        }
    }

    pub(crate) fn from_python(value: &Bound<'_, PyAny>) -> PyResult<Self> {
        if value.extract::<String>().is_ok_and(|said| said == HISTORY) {
            return Ok(Self::History(HISTORY));
        }
        let refused = |_| wrong("explained_by", shown(value), "0 to 63, \"history\" or None");
        whole("explained_by", value, SENSORS).map(Self::Sensor).map_err(refused)
    }
}

impl Reading {
    /// Converts a ring's reading.
    pub(crate) fn of_ring(reading: &eeruf_core::Reading) -> Self {
        let &eeruf_core::Reading { sensor, phase, period, kind, t_echo, previous, age, explained_by } = reading;
        let verdict = Verdict { kind, t_echo, previous, age, explained_by };
        Self { phase: Some(phase.0), period: Some(period), ..Self::of_filter(sensor, &verdict) }
    }

    /// A filter's verdict on a firing.
    pub(crate) fn kind_and_t_echo(&self) -> (ReadingKind, Option<Micros>) {
        let kind = ReadingKind::ALL.into_iter().find(|kind| kind.as_str() == self.kind);
        // Every reading has one of the kinds.
        (kind.unwrap_or(ReadingKind::First), self.t_echo_us.map(Micros::new))
    }

    /// Converts the verdict of a filter alone, which has no phases.
    pub(crate) fn of_filter(sensor: u8, verdict: &Verdict) -> Self {
        Self {
            sensor,
            kind: verdict.kind.as_str(),
            t_echo_us: verdict.t_echo.map(Micros::as_micros),
            previous_us: verdict.previous.map(Micros::as_micros),
            age: verdict.age,
            phase: None,
            period: None,
            explained_by: verdict.explained_by.map(ExplainedBy::of),
        }
    }
}

const READING: [&str; 8] = ["sensor", "kind", "t_echo_us", "previous_us", "age", "phase", "period", "explained_by"];

#[pymethods]
impl Reading {
    #[new]
    #[pyo3(signature = (
        sensor, kind, t_echo_us=None, previous_us=None, age=None, phase=None, period=None, explained_by=None
    ))]
    #[expect(clippy::too_many_arguments, reason = "one for each field")]
    fn new(
        sensor: &Bound<'_, PyAny>,
        kind: &Bound<'_, PyAny>,
        t_echo_us: Option<&Bound<'_, PyAny>>,
        previous_us: Option<&Bound<'_, PyAny>>,
        age: Option<&Bound<'_, PyAny>>,
        phase: Option<&Bound<'_, PyAny>>,
        period: Option<&Bound<'_, PyAny>>,
        explained_by: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        Ok(Self {
            sensor: whole("sensor", sensor, SENSORS)?,
            kind: choice("kind", Some(kind), &ReadingKind::ALL.map(|kind| (kind.as_str(), kind.as_str())))?,
            t_echo_us: whole_or_none("t_echo_us", t_echo_us, 0..=u32::MAX)?,
            previous_us: whole_or_none("previous_us", previous_us, 0..=u32::MAX)?,
            age: whole_or_none("age", age, 0..=u16::MAX)?,
            phase: whole_or_none("phase", phase, 0..=u8::MAX)?,
            period: whole_or_none("period", period, 0..=u32::MAX)?,
            explained_by: explained_by.map(ExplainedBy::from_python).transpose()?,
        })
    }

    /// The fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.EchoFilter(1, 500).push(0, 9_000).to_dict()["t_echo_us"]
    ///     9000
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &READING)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &READING)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &READING)
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
#[pyclass(frozen, eq, module = "eeruf")]
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct PeriodEnded(PeriodStats);

const PERIOD_ENDED: [&str; 5] = ["period", "phase", "max_late_us", "sum_late_us", "tally"];

#[pymethods]
impl PeriodEnded {
    #[new]
    #[pyo3(signature = (period, phase=None, max_late_us=None, sum_late_us=None, tally=None))]
    #[pyo3(text_signature = "(period, phase=0, max_late_us=0, sum_late_us=0, tally={})")]
    fn new(
        period: &Bound<'_, PyAny>,
        phase: Option<&Bound<'_, PyAny>>,
        max_late_us: Option<&Bound<'_, PyAny>>,
        sum_late_us: Option<&Bound<'_, PyAny>>,
        tally: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let late = |name, value| Ok::<_, PyErr>(Micros::new(whole_or(name, value, 0, 0..=u32::from(u16::MAX))?));
        Ok(Self(PeriodStats {
            period: whole("period", period, 0..=u32::MAX)?,
            phase: Phase(whole_or("phase", phase, 0, 0..=u8::MAX)?),
            tally: tally.map_or_else(|| Ok(Tally::default()), counted)?,
            max_late: late("max_late_us", max_late_us)?,
            sum_late: late("sum_late_us", sum_late_us)?,
        }))
    }

    /// The period, from 0.
    #[getter]
    fn period(&self) -> u32 {
        self.0.period
    }

    /// The phase: 0 for a, 1 for b.
    #[getter]
    fn phase(&self) -> u8 {
        self.0.phase.0
    }

    /// Largest delay of the polls for the period's firings and its end, in microseconds, at most 65,535.
    #[getter]
    fn max_late_us(&self) -> u32 {
        self.0.max_late.as_micros()
    }

    /// The sum of the lateness of the period's firings, in microseconds, at most 65,535.
    #[getter]
    fn sum_late_us(&self) -> u32 {
        self.0.sum_late.as_micros()
    }

    /// Number of readings of each kind that were emitted since the previous period ended: a dict by the names in
    /// ``eeruf.KINDS``.
    #[getter]
    fn tally<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let tally = PyDict::new(py);
        for kind in ReadingKind::ALL {
            tally.set_item(kind.as_str(), self.0.tally.of(kind))?;
        }
        Ok(tally)
    }

    /// The fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000)
    ///     >>> ring.pause()
    ///     >>> ring.poll(ring.next_deadline_us).to_dict()["max_late_us"]
    ///     0
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &PERIOD_ENDED)
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        repr(slf, &PERIOD_ENDED)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce(slf, &PERIOD_ENDED)
    }
}

/// Number of readings of each kind, as a dict.
fn counted(tally: &Bound<'_, PyAny>) -> PyResult<Tally<u8>> {
    let expected = "a dict of counts by the names in eeruf.KINDS";
    let mut counted = Tally::default();
    for (name, count) in tally.cast::<PyDict>().map_err(|_| wrong("tally", shown(tally), expected))? {
        let kind = ReadingKind::ALL.into_iter().find(|kind| name.eq(kind.as_str()).unwrap_or(false));
        let kind = kind.ok_or_else(|| wrong("tally", shown(&name), expected))?;
        for _ in 0..whole("tally", &count, 0..=u8::MAX)? {
            counted.count(kind);
        }
    }
    Ok(counted)
}

/// An event in Python's form.
pub(crate) fn to_python<'py>(py: Python<'py>, event: &RingEvent) -> PyResult<Bound<'py, PyAny>> {
    match *event {
        RingEvent::Fire { sensor, phase, due } => {
            Fire { sensor, phase: phase.0, due_us: due.as_micros() }.into_bound_py_any(py)
        }
        RingEvent::Reading(reading) => Reading::of_ring(&reading).into_bound_py_any(py),
        RingEvent::PeriodEnded(stats) => PeriodEnded(stats).into_bound_py_any(py),
    }
}

/// An event in core's form, from Python's.
pub(crate) fn to_core(name: &str, event: &Bound<'_, PyAny>) -> PyResult<RingEvent> {
    if let Ok(ended) = event.cast::<PeriodEnded>() {
        return Ok(RingEvent::PeriodEnded(ended.get().0));
    }
    if let Ok(fire) = event.cast::<Fire>() {
        let Fire { sensor, phase, due_us } = *fire.get();
        return Ok(RingEvent::Fire { sensor, phase: Phase(phase), due: Instant::from_micros(due_us) });
    }
    let expected = "an eeruf.Fire, Reading or PeriodEnded";
    let reading = instance::<Reading>(name, event, expected)?.get();
    let kind = ReadingKind::ALL.into_iter().find(|kind| kind.as_str() == reading.kind);
    Ok(RingEvent::Reading(eeruf_core::Reading {
        sensor: reading.sensor,
        phase: Phase(reading.phase.unwrap_or(0)),
        period: reading.period.unwrap_or(0),
        kind: kind.ok_or_else(|| wrong(name, shown(event), expected))?,
        t_echo: reading.t_echo_us.map(Micros::new),
        previous: reading.previous_us.map(Micros::new),
        age: reading.age,
        explained_by: reading.explained_by.map(ExplainedBy::to_core),
    }))
}
