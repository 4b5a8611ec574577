//! `Ring`.

use eeruf_core::{Instant, MAX_SENSORS, Micros, Requirements, RingConfig, ScheduledRing, SensorError};
use eeruf_sim::AnySchedule;
use pyo3::prelude::*;

use crate::{
    arguments::{instance, items, micros, shown, whole, whole_or, wrong},
    errors::Raise,
    ring_events::to_python,
    schedule::Schedule,
};

type Scheduled<'s> = ScheduledRing<'s, MAX_SENSORS>;

self_cell::self_cell!(
    /// A ring with the schedule that it borrows.
    struct Owned {
        owner: Box<AnySchedule>,
        #[covariant]
        dependent: Scheduled,
    }
);

/// Scheduler and filter together, as the firmware runs them: the caller passes the time and gets back what to do.
///
/// Moments are microseconds on a clock that wraps at 2^32, as on a small microcontroller; larger numbers are taken
/// modulo that.
///
/// Args:
///     schedule: when the sensors fire.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical (Eq. 11).
///     now_us: when the first period begins.
///     window_us: ``T_wind``: how long a sensor listens after it has fired, 1 or more.
///     blanking_us: edges sooner than this after firing are ringing of the transducer, not echoes.
///     consecutive: how many readings in a row must agree, 2 to 8.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///     RingError: the ring cannot listen like that, such as longer than the schedule lets it; or the schedule does not
///         reject crosstalk at this ``t_delta_us`` (see ``Ring.unverified``).
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

    fn change(&mut self, change: impl FnOnce(&mut Scheduled<'_>) -> Result<(), SensorError>) -> PyResult<()> {
        self.ring.with_dependent_mut(|_, ring| change(ring)).map_err(Raise::raise)
    }
}

/// What is expected to change of each sensor's readings, of the argument `expected_change_us`.
pub(crate) fn expected_changes(changes: Option<&Bound<'_, PyAny>>, sensors: usize) -> PyResult<Vec<i32>> {
    let Some(changes) = changes else { return Ok(Vec::new()) };
    let name = "expected_change_us";
    let expected = format!("a sequence of {sensors} whole numbers of microseconds, one for each sensor");
    let items = items(name, changes, &expected)?;
    if items.len() != sensors {
        return Err(wrong(name, shown(changes), expected));
    }
    let each = |(index, item)| whole(&format!("{name}[{index}]"), item, i32::MIN..=i32::MAX);
    items.iter().enumerate().map(each).collect()
}

/// How long from now until a deadline, in microseconds; 0 if it has been reached.
pub(crate) fn until(deadline: Instant, now: Instant) -> u32 {
    if now.has_reached(deadline) { 0 } else { deadline.since(now).as_micros() }
}

/// A moment on a clock that wraps at 2^32 us: larger numbers are what such a clock would show.
pub(crate) fn instant(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Instant> {
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
        let ring = Self::unverified(schedule, t_delta_us, now_us, window_us, blanking_us, consecutive)?;
        let requirements = Requirements::new(ring.ring.borrow_dependent().t_delta());
        match ring.ring.borrow_owner().verify(&requirements).violations().next() {
            Some(violation) => Err(violation.raise()),
            None => Ok(ring),
        }
    }

    /// A ring whose schedule need not reject crosstalk: the conventional method, for comparison.
    ///
    /// Args:
    ///     schedule: when the sensors fire.
    ///     t_delta_us: as for ``Ring``, as are all others.
    ///     now_us: when the first period begins.
    ///     window_us: how long a sensor listens after it has fired, 1 or more.
    ///     blanking_us: edges sooner than this after firing are no echoes.
    ///     consecutive: how many readings in a row must agree, 2 to 8.
    ///
    /// Raises:
    ///     ArgumentError: something of the wrong type or out of range.
    ///     RingError: the ring cannot listen like that.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> constant = eeruf.Schedule(60_000, [0, 15_000], [0, 0], [0, 0])
    ///     >>> eeruf.Ring.unverified(constant, 500, window_us=36_000).poll(0)
    ///     Fire(sensor=0, phase=0, due_us=0)
    #[staticmethod]
    #[pyo3(signature = (schedule, t_delta_us, now_us=None, *, window_us, blanking_us=None, consecutive=None))]
    #[pyo3(text_signature = "(schedule, t_delta_us, now_us=0, *, window_us, blanking_us=0, consecutive=2)")]
    fn unverified(
        schedule: &Bound<'_, PyAny>,
        t_delta_us: &Bound<'_, PyAny>,
        now_us: Option<&Bound<'_, PyAny>>,
        window_us: &Bound<'_, PyAny>,
        blanking_us: Option<&Bound<'_, PyAny>>,
        consecutive: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let config = RingConfig::new()
            .with_blanking(blanking_us.map_or(Ok(Micros::ZERO), |value| micros("blanking_us", value))?)
            .with_consecutive(whole_or("consecutive", consecutive, 2, 0..=u8::MAX)?)
            .with_t_delta(micros("t_delta_us", t_delta_us)?)
            .with_window(micros("window_us", window_us)?);
        let now = now_us.map_or(Ok(Instant::from_micros(0)), |now| instant("now_us", now))?;
        let schedule = instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?.get().0;
        let ring = Owned::try_new(Box::new(schedule), |schedule| Scheduled::unverified(schedule, config, now));
        // At most 64.
        Ok(Self { ring: ring.map_err(Raise::raise)?, sensors: schedule.sensors() as u32 })
    }

    /// The next event at a time. Call again until there is none, then wait until ``next_deadline_us``.
    ///
    /// Hand in the echoes you know of before you poll: one that comes after the poll that closed its window is not
    /// heard.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///     expected_change_us: for each sensor, by how much a good reading should differ from the one before, from the
    ///         robot's own motion: ``-2 v dt / c`` for an object approached at ``v``. None for a robot that stands.
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
        let changes = expected_changes(expected_change_us, self.sensors as usize)?;
        let change = |sensor: u8| changes.get(usize::from(sensor)).copied().unwrap_or(0);
        let event = self.ring.with_dependent_mut(|_, ring| ring.poll_expecting(now, change));
        event.map(|event| to_python(py, &event)).transpose()
    }

    fn __repr__(&self) -> String {
        format!("<Ring: {} sensors, next deadline at {} us>", self.sensors, self.next_deadline_us())
    }

    /// When to poll next, in microseconds of the clock that wraps at 2^32; in the past if an event is pending.
    #[getter]
    fn next_deadline_us(&self) -> u32 {
        self.ring.borrow_dependent().next_deadline().as_micros()
    }

    /// How long to wait before polling next, in microseconds: 0 if an event is pending.
    ///
    /// This is right across the wrap of the clock at 2^32, where ``next_deadline_us`` and a ``now_us`` that goes on
    /// growing no longer compare.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///
    /// Raises:
    ///     ArgumentError: not such a time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> ring = eeruf.Ring(eeruf.tables.TABLE_I_D, t_delta_us=500, window_us=36_000, now_us=2**32 - 1_000)
    ///     >>> ring.wait_us(2**32 - 1_000), ring.wait_us(2**32 + 23_000)
    ///     (24000, 0)
    #[pyo3(signature = (now_us))]
    fn wait_us(&self, now_us: &Bound<'_, PyAny>) -> PyResult<u32> {
        Ok(until(self.ring.borrow_dependent().next_deadline(), instant("now_us", now_us)?))
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
        self.change(|ring| ring.echo(sensor, at))
    }

    /// The sensor of the last ``Fire`` has really fired at this time, later than the poll said. Optional: echo times
    /// count from then, and all later firings move by as much.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     at_us: when, 0 or more; a time before the poll is ignored.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor or time.
    #[pyo3(signature = (sensor, at_us))]
    fn fired(&mut self, sensor: &Bound<'_, PyAny>, at_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (sensor, at) = (self.sensor(sensor)?, instant("at_us", at_us)?);
        self.change(|ring| ring.fired(sensor, at))
    }

    /// The echo line of a sensor was already high when it was to fire: the firing just emitted counts as ``"stuck"``.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    #[pyo3(signature = (sensor))]
    fn stuck(&mut self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.change(|ring| ring.stuck(sensor))
    }

    /// Stop a sensor from firing. The reading of a firing that is under way is still emitted.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    #[pyo3(signature = (sensor))]
    fn disable(&mut self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.change(|ring| ring.disable(sensor))
    }

    /// Let a sensor fire again, from its next turn on. Its readings from before are forgotten.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    #[pyo3(signature = (sensor))]
    fn enable(&mut self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.change(|ring| ring.enable(sensor))
    }
}
