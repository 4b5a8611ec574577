//! `HoppingRing`.

use eeruf_core::{Instant, MAX_SENSORS, Micros, SensorError, hopping::HoppingListening};
use pyo3::{prelude::*, types::PyTuple};

use crate::{
    arguments::{instance, micros, whole, whole_or},
    errors::Raise,
    exclusive::Exclusive,
    hopping_schedule::HoppingSchedule,
    hopping_settings::HoppingSettings,
    moments::{expected_changes, instant, until},
    ring_events::to_python,
};

type Core = eeruf_core::hopping::HoppingRing<MAX_SENSORS>;

/// A ring that hops in time, as the firmware runs it: used as a :class:`Ring`; its readings can also be
/// ``"tentative"``.
///
/// No sensor stays blind: one that hears nothing of its own gets a period in which it fires alone, and one whose
/// readings keep disagreeing draws a new lag. ``docs/explanation/hopping.md`` has the rules, what they bring, and what
/// is not promised.
///
/// Args:
///     schedule: a :class:`HoppingSchedule`.
///     settings: a :class:`HoppingSettings`, or the name of one.
///     now_us: when the first period begins.
///     window_us: ``T_wind``: how long a sensor listens after it has fired, 1 to 16,711,679.
///     blanking_us: edges sooner than this after firing are ringing of the transducer, not echoes.
///     reach_us: after how long no sound is heard any more; by default the window.
///     seed: of the draws of new lags, below 2^32.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///     HoppingError: a ``T_delta`` that is not below the schedule's step, a period too short for window and code, a
///         window that is too long or ends within the blanking time.
///
/// Example:
///     >>> import eeruf
///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
///     >>> ring, kinds = eeruf.HoppingRing(schedule, "quick", window_us=36_000), []
///     >>> while len(kinds) < 40:
///     ...     now_us = ring.next_deadline_us
///     ...     while event := ring.poll(now_us):
///     ...         if isinstance(event, eeruf.Fire):
///     ...             ring.echo(event.sensor, now_us + 12_000)  # a wall 2 m away
///     ...         elif isinstance(event, eeruf.Reading):
///     ...             kinds.append(event.kind)
///     >>> kinds == ["first"] * 8 + ["tentative"] * 16 + ["accepted"] * 16
///     True
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct HoppingRing {
    ring: Exclusive<Box<Core>>,
    sensors: u8,
    schedule: HoppingSchedule,
    settings: HoppingSettings,
}

impl HoppingRing {
    fn sensor(&self, sensor: &Bound<'_, PyAny>) -> PyResult<u8> {
        whole("sensor", sensor, 0..=self.sensors - 1)
    }

    fn change(&self, change: impl FnOnce(&mut Core) -> Result<(), SensorError>) -> PyResult<()> {
        change(&mut **self.ring.get()?).map_err(Raise::raise)
    }
}

#[pymethods]
impl HoppingRing {
    #[new]
    #[pyo3(signature = (
        schedule, settings=None, now_us=None, *, window_us, blanking_us=None, reach_us=None, seed=None
    ))]
    #[pyo3(text_signature = "(schedule, settings=\"balanced\", now_us=0, *, window_us, blanking_us=0, \
            reach_us=None, seed=1)")]
    fn new(
        schedule: &Bound<'_, PyAny>,
        settings: Option<&Bound<'_, PyAny>>,
        now_us: Option<&Bound<'_, PyAny>>,
        window_us: &Bound<'_, PyAny>,
        blanking_us: Option<&Bound<'_, PyAny>>,
        reach_us: Option<&Bound<'_, PyAny>>,
        seed: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let window = micros("window_us", window_us)?;
        let listening = HoppingListening::new(window)
            .with_blanking(blanking_us.map_or(Ok(Micros::ZERO), |value| micros("blanking_us", value))?)
            .with_reach(reach_us.map_or(Ok(window), |value| micros("reach_us", value))?);
        let now = now_us.map_or(Ok(Instant::from_micros(0)), |now| instant("now_us", now))?;
        let seed = whole_or("seed", seed, 1, 0..=u32::MAX)?;
        let settings = HoppingSettings::of("settings", settings)?;
        let schedule = instance::<HoppingSchedule>("schedule", schedule, "an eeruf.HoppingSchedule")?.get().clone();
        let ring = Core::hopping(&schedule.0, settings, listening, seed, now).map_err(Raise::raise)?;
        // At most 64.
        let sensors = ring.sensors() as u8;
        Ok(Self {
            ring: Exclusive::new("HoppingRing", Box::new(ring)),
            sensors,
            schedule,
            settings: HoppingSettings(settings),
        })
    }

    /// The next event at a time. Call again until there is none, then wait until ``next_deadline_us``.
    ///
    /// Hand in the echoes you know of before you poll: one that comes after the poll that closed its window is not
    /// heard.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///     expected_change_us: for each sensor, the expected change of a good reading from the one before, by the
    ///         robot's own motion: ``-2 v dt / c`` for an object approached at ``v``. None for a robot that stands.
    ///
    /// Returns:
    ///     A ``Fire``, a ``Reading``, a ``PeriodEnded``, or None if there is nothing to do now.
    ///
    /// Raises:
    ///     ArgumentError: not such a time, or not one change for each sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.poll(0)
    ///     Fire(sensor=0, phase=0, due_us=0)
    #[pyo3(signature = (now_us, expected_change_us=None))]
    fn poll<'py>(
        &self,
        now_us: &Bound<'py, PyAny>,
        expected_change_us: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let (py, now) = (now_us.py(), instant("now_us", now_us)?);
        let changes = expected_changes(expected_change_us, self.sensors.into())?;
        let change = |sensor: u8| changes.get(usize::from(sensor)).copied().unwrap_or(0);
        let event = self.ring.get()?.poll_expecting(now, change);
        event.map(|event| to_python(py, &event)).transpose()
    }

    /// When to poll next, in microseconds of the clock that wraps at 2^32; in the past if an event is pending.
    #[getter]
    fn next_deadline_us(&self) -> PyResult<u32> {
        Ok(self.ring.get()?.next_deadline().as_micros())
    }

    /// Time to wait before polling next, in microseconds, right across the clock's wrap: 0 if an event is pending.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///
    /// Raises:
    ///     ArgumentError: not such a time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.poll(0).sensor
    ///     0
    ///     >>> ring.wait_us(0)
    ///     8430
    #[pyo3(signature = (now_us))]
    fn wait_us(&self, now_us: &Bound<'_, PyAny>) -> PyResult<u32> {
        let now = instant("now_us", now_us)?;
        Ok(until(self.ring.get()?.next_deadline(), now))
    }

    /// Its schedule, with the lags of the start.
    #[getter]
    fn schedule(&self) -> HoppingSchedule {
        self.schedule.clone()
    }

    /// Its settings for firing and weighing readings.
    #[getter]
    fn settings(&self) -> HoppingSettings {
        self.settings.clone()
    }

    /// The lag of each sensor as it is now, in microseconds.
    #[getter]
    fn t_lag_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let ring = self.ring.get()?;
        let lags = (0..ring.sensors()).filter_map(|sensor| ring.plan().t_lag(sensor));
        PyTuple::new(py, lags.map(Micros::as_micros).collect::<Vec<_>>())
    }

    /// The sensor that the present period belongs to alone, from 0; None if it belongs to all.
    #[getter]
    fn solo(&self) -> PyResult<Option<u8>> {
        Ok(self.ring.get()?.plan().solo())
    }

    /// The confirmed echo time of a sensor.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Returns:
    ///     Microseconds; None if none is confirmed, and where it is confirmed that nothing is in range (``is_clear``).
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.confirmed_us(3) is None
    ///     True
    #[pyo3(signature = (sensor))]
    fn confirmed_us(&self, sensor: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
        let sensor = self.sensor(sensor)?.into();
        Ok(self.ring.get()?.judge().confirmed(sensor).map(Micros::as_micros))
    }

    /// Returns true if it is confirmed that nothing is in a sensor's range.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.is_clear(3)
    ///     False
    #[pyo3(signature = (sensor))]
    fn is_clear(&self, sensor: &Bound<'_, PyAny>) -> PyResult<bool> {
        let sensor = self.sensor(sensor)?.into();
        Ok(self.ring.get()?.judge().is_clear(sensor))
    }

    /// An edge on the echo line of a sensor. Edges may come in any order, at any time, wanted or not.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     at_us: when, 0 or more.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.poll(0).sensor
    ///     0
    ///     >>> ring.echo(0, 6_000)
    ///     >>> ring.poll(6_000).t_echo_us
    ///     6000
    #[pyo3(signature = (sensor, at_us))]
    fn echo(&self, sensor: &Bound<'_, PyAny>, at_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let (sensor, at) = (self.sensor(sensor)?, instant("at_us", at_us)?);
        self.change(|ring| ring.echo(sensor, at))
    }

    /// The sensor of the last ``Fire`` has really fired at this time, later than the poll said. Optional: echo times
    /// count from then.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     at_us: when, 0 or more; a time before the poll is ignored.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.poll(0).sensor
    ///     0
    ///     >>> ring.fired(0, 100)
    ///     >>> ring.echo(0, 6_000)
    ///     >>> ring.poll(6_000).t_echo_us
    ///     5900
    #[pyo3(signature = (sensor, at_us))]
    fn fired(&self, sensor: &Bound<'_, PyAny>, at_us: &Bound<'_, PyAny>) -> PyResult<()> {
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
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.poll(0).sensor
    ///     0
    ///     >>> ring.stuck(0)
    ///     >>> while not isinstance(event := ring.poll(ring.next_deadline_us), eeruf.Reading):
    ///     ...     pass
    ///     >>> event.sensor, event.kind
    ///     (0, 'stuck')
    #[pyo3(signature = (sensor))]
    fn stuck(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
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
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.disable(0)
    ///     >>> ring.is_enabled(0)
    ///     False
    #[pyo3(signature = (sensor))]
    fn disable(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.change(|ring| ring.disable(sensor))
    }

    /// Let a sensor fire again, from the next period on. What was known of its echo is forgotten.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.disable(0)
    ///     >>> ring.enable(0)
    ///     >>> ring.is_enabled(0)
    ///     True
    #[pyo3(signature = (sensor))]
    fn enable(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.change(|ring| ring.enable(sensor))
    }

    /// Returns true if a sensor fires.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.is_enabled(7)
    ///     True
    #[pyo3(signature = (sensor))]
    fn is_enabled(&self, sensor: &Bound<'_, PyAny>) -> PyResult<bool> {
        let sensor = self.sensor(sensor)?;
        Ok(self.ring.get()?.is_enabled(sensor))
    }

    /// Let no sensor fire until :meth:`resume`. Readings of firings under way are still emitted, and periods go on.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.pause()
    ///     >>> type(ring.poll(ring.next_deadline_us)).__name__
    ///     'PeriodEnded'
    fn pause(&self) -> PyResult<()> {
        self.ring.get()?.pause();
        Ok(())
    }

    /// Let sensors fire again, as of the next period. What was known of their echoes is forgotten.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.pause()
    ///     >>> ring.resume()
    ///     >>> _ = ring.poll(ring.next_deadline_us)  # the period ends
    ///     >>> type(ring.poll(ring.next_deadline_us)).__name__
    ///     'Fire'
    fn resume(&self) -> PyResult<()> {
        self.ring.get()?.resume();
        Ok(())
    }

    /// Number of sensors it has.
    #[getter]
    fn sensors(&self) -> u8 {
        self.sensors
    }

    /// Start again at a time, or as soon as the last firings allow: after a long sleep. Firings under way are dropped.
    ///
    /// Args:
    ///     now_us: the present, 0 or more.
    ///
    /// Raises:
    ///     ArgumentError: not such a time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> ring = eeruf.HoppingRing(schedule, window_us=36_000)
    ///     >>> ring.restart(3_600_000_000)
    ///     >>> ring.wait_us(3_600_000_000)
    ///     0
    #[pyo3(signature = (now_us))]
    fn restart(&self, now_us: &Bound<'_, PyAny>) -> PyResult<()> {
        let now = instant("now_us", now_us)?;
        self.ring.get()?.restart(now);
        Ok(())
    }

    fn __repr__(&self) -> PyResult<String> {
        Ok(format!("<HoppingRing: {} sensors, next deadline at {} us>", self.sensors, self.next_deadline_us()?))
    }
}
