//! `EchoTracker`.

use eeruf_core::{MAX_SENSORS, Micros, Phase, SensorError, judge::Firing};
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::prelude::*;

use crate::{
    arguments::{flag, items, matrix, micros, shown, whole, whole_or, wrong},
    columns::room,
    errors::{ArgumentError, Raise},
    exclusive::Exclusive,
    hopping_settings::tracker_settings,
    requirements,
    ring_events::Reading,
};

/// Believes an echo that readings from several phases support: the filter of a hopping ring, alone.
///
/// A path from another sensor repeats itself in its own phase for ever, but moves from phase to phase; so only support
/// from different phases counts. Use it where the sensors fire by a :class:`HoppingSchedule`, or replay a log of such.
///
/// Args:
///     sensors: how many, 1 to 64.
///     t_delta_us: ``T_delta``: a reading supports an echo that it differs from by no more, 1 to 65535; by default that
///         of the settings. It must be less than the schedule's step.
///     settings: a :class:`HoppingSettings`, or the name of one.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///     HoppingError: settings that contradict each other.
///
/// Example:
///     >>> import eeruf
///     >>> tracker = eeruf.EchoTracker(sensors=1)
///     >>> [tracker.push(0, phase, 9_000).kind for phase in range(6)]
///     ['first', 'tentative', 'tentative', 'tentative', 'accepted', 'accepted']
///     >>> {tracker.push(0, 3, 7_000).kind for _ in range(100)}  # one phase alone: crosstalk
///     {'rejected'}
#[pyclass(frozen, module = "eeruf")]
pub(crate) struct EchoTracker {
    tracker: Exclusive<Box<eeruf_core::judge::EchoTracker<MAX_SENSORS>>>,
    t_delta: Micros,
    /// Number of sensors.
    #[pyo3(get)]
    sensors: usize,
}

#[pymethods]
impl EchoTracker {
    #[new]
    #[pyo3(signature = (sensors, t_delta_us=None, *, settings=None))]
    #[pyo3(text_signature = "(sensors, t_delta_us=None, *, settings=\"balanced\")")]
    fn new(
        sensors: &Bound<'_, PyAny>,
        t_delta_us: Option<&Bound<'_, PyAny>>,
        settings: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let sensors = requirements::sensors(sensors)?;
        let t_delta = t_delta_us.map(|t_delta| micros("t_delta_us", t_delta)).transpose()?;
        let tracker = eeruf_core::judge::EchoTracker::new(tracker_settings(t_delta, settings)?);
        let tracker = Box::new(tracker.map_err(Raise::raise)?);
        let t_delta = tracker.settings().t_delta;
        Ok(Self { tracker: Exclusive::new("EchoTracker", tracker), t_delta, sensors })
    }

    /// ``T_delta``, in microseconds.
    #[getter]
    fn t_delta_us(&self) -> u32 {
        self.t_delta.as_micros()
    }

    /// Take in one firing of a sensor.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///     phase: the phase in which it fired, 0 to 255.
    ///     t_echo_us: the time of its echo after firing in whole microseconds, or None for no echo.
    ///     expected_change_us: expected change of a good reading since this sensor's firing before, by
    ///         the robot's own motion: ``-2 v dt / c`` for an object approached at ``v``.
    ///     solo: whether no other sensor's sound could be heard.
    ///     steady: whether firings were so punctual that crosstalk moved as the schedule says; else it supports
    ///         nothing.
    ///
    /// Returns:
    ///     The reading, without the period, which a tracker does not know.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor, phase or time.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.EchoTracker(1).push(0, 0, 9_000, solo=True).kind
    ///     'tentative'
    #[pyo3(signature = (sensor, phase, t_echo_us, expected_change_us=None, *, solo=None, steady=None))]
    #[pyo3(text_signature = "($self, sensor, phase, t_echo_us, expected_change_us=0, *, solo=False, steady=True)")]
    fn push(
        &self,
        sensor: &Bound<'_, PyAny>,
        phase: &Bound<'_, PyAny>,
        t_echo_us: Option<&Bound<'_, PyAny>>,
        expected_change_us: Option<&Bound<'_, PyAny>>,
        solo: Option<&Bound<'_, PyAny>>,
        steady: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Reading> {
        let (sensor, phase) = (self.sensor(sensor)?, Phase(whole("phase", phase, 0..=u8::MAX)?));
        let t_echo = t_echo_us.map(|echo| micros("t_echo_us", echo)).transpose()?;
        let change = whole_or("expected_change_us", expected_change_us, 0, i32::MIN..=i32::MAX)?;
        let (solo, steady) = (flag("solo", solo, false)?, flag("steady", steady, true)?);
        let firing = Firing { phase, solo, steady, expected_change_us: change };
        let verdict = self.tracker.get()?.push(sensor.into(), t_echo.as_slice(), firing).map_err(Raise::raise)?;
        Ok(Reading::of_tracker(sensor, phase, &verdict))
    }

    /// Take in many firings at once, without the interpreter lock.
    ///
    /// Args:
    ///     phase: the phase of each period, 0 to 255.
    ///     t_echo_us: array of shape (periods, sensors): echo times in microseconds, rounded to whole ones; NaN for no
    ///         echo.
    ///
    /// Returns:
    ///     Array of int8 of the same shape: indices into ``eeruf.KINDS``.
    ///
    /// Raises:
    ///     ArgumentError: another shape, or a time that is negative or 2^32 or more; nothing has been taken in then.
    ///
    /// Example:
    ///     >>> import eeruf, numpy
    ///     >>> kinds = eeruf.EchoTracker(1).push_many(range(5), numpy.full((5, 1), 9_000.0))
    ///     >>> eeruf.KINDS[kinds[-1, 0]]
    ///     'accepted'
    fn push_many<'py>(
        &self,
        py: Python<'py>,
        phase: &Bound<'py, PyAny>,
        t_echo_us: &Bound<'py, PyAny>,
    ) -> PyResult<Bound<'py, PyArray2<i8>>> {
        let echoes = matrix("t_echo_us", t_echo_us, self.sensors)?;
        let echoes = echoes.as_slice().map_err(|error| ArgumentError::new_err(error.to_string()))?;
        let rows = echoes.len() / self.sensors;
        let expected = format!("a sequence of {rows} phases, one for each row of t_echo_us");
        let given = items("phase", phase, &expected)?;
        if given.len() != rows {
            return Err(wrong("phase", shown(phase), expected));
        }
        let each = |(index, item)| whole(&format!("phase[{index}]"), item, 0..=u8::MAX);
        let phases = given.iter().enumerate().map(each).collect::<PyResult<Vec<u8>>>()?;
        if let Some(at) = echoes.iter().position(|&us| !(us.is_nan() || (0.0..=f64::from(u32::MAX)).contains(&us))) {
            let name = format!("t_echo_us[{}, {}]", at / self.sensors, at % self.sensors);
            return Err(wrong(&name, echoes[at], format_args!("0 to {} microseconds, or nan for no echo", u32::MAX)));
        }
        let mut kinds = room(echoes.len())?;
        kinds.resize(echoes.len(), 0_i8);
        let (mut tracker, sensors) = (self.tracker.get()?, self.sensors);
        let tracker = &mut *tracker;
        let pushed = py.detach(|| {
            let rows = echoes.chunks_exact(sensors).zip(kinds.chunks_exact_mut(sensors));
            for ((row, kinds), &phase) in rows.zip(&phases) {
                for ((sensor, &us), kind) in row.iter().enumerate().zip(kinds) {
                    // Rounded to whole microseconds, which core counts in; in range, as was just checked.
                    let echo = (!us.is_nan()).then(|| Micros::new(us.round() as u32));
                    *kind = tracker.push(sensor, echo.as_slice(), Firing::new(Phase(phase)))?.kind as i8;
                }
            }
            Ok(())
        });
        pushed.map_err(|error: SensorError| error.raise())?;
        PyArray1::from_vec(py, kinds).reshape([rows, self.sensors])
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
    ///     >>> tracker = eeruf.EchoTracker(1)
    ///     >>> kinds = [tracker.push(0, phase, 9_000).kind for phase in range(5)]
    ///     >>> tracker.confirmed_us(0)
    ///     9000
    fn confirmed_us(&self, sensor: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
        Ok(self.tracker.get()?.confirmed(self.sensor(sensor)?.into()).map(Micros::as_micros))
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
    ///     >>> tracker = eeruf.EchoTracker(1)
    ///     >>> kinds = [tracker.push(0, phase, 9_000).kind for phase in range(5)]
    ///     >>> tracker.is_clear(0)
    ///     False
    fn is_clear(&self, sensor: &Bound<'_, PyAny>) -> PyResult<bool> {
        Ok(self.tracker.get()?.is_clear(self.sensor(sensor)?.into()))
    }

    /// Forget what is known of a sensor's echo. Its age goes on.
    ///
    /// Args:
    ///     sensor: which one, from 0.
    ///
    /// Raises:
    ///     ArgumentError: no such sensor.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> tracker = eeruf.EchoTracker(1)
    ///     >>> kinds = [tracker.push(0, phase, 9_000).kind for phase in range(5)]
    ///     >>> tracker.forget(0)
    ///     >>> tracker.confirmed_us(0) is None
    ///     True
    fn forget(&self, sensor: &Bound<'_, PyAny>) -> PyResult<()> {
        let sensor = self.sensor(sensor)?;
        self.tracker.get()?.forget(sensor.into());
        Ok(())
    }

    /// Say that firing times have changed against each other otherwise than by the phase, such as by a new lag: what is
    /// not confirmed starts over.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> tracker = eeruf.EchoTracker(1)
    ///     >>> kinds = [tracker.push(0, phase, 9_000).kind for phase in range(5)]
    ///     >>> tracker.firing_changed()
    ///     >>> tracker.confirmed_us(0)
    ///     9000
    fn firing_changed(&self) -> PyResult<()> {
        self.tracker.get()?.firing_changed();
        Ok(())
    }

    fn __repr__(&self) -> String {
        format!("<EchoTracker: {} sensors, t_delta of {} us>", self.sensors, self.t_delta_us())
    }
}

impl EchoTracker {
    fn sensor(&self, sensor: &Bound<'_, PyAny>) -> PyResult<u8> {
        // At most 64.
        whole("sensor", sensor, 0..=self.sensors as u8 - 1)
    }
}
