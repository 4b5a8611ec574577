//! `HoppingSchedule`.

use eeruf_core::{
    MAX_SENSORS, Micros,
    hopping::{HoppingCode, HoppingError as Error, HoppingSchedule as Core},
};
use eeruf_design::PhaseFile;
use eeruf_files::emit::Emit as _;
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{self, micros, times, whole, whole_or, wrong},
    errors::{HoppingError, Raise},
    fields::to_dict,
    requirements,
};

/// When the sensors of a hopping ring fire: a code of many phases, for sensors that two phases leave blind. Immutable.
///
/// The code is Welch's Costas sequence: the sensor that is ``i``th in the order of lags fires
/// ``step_us * (a * g ** (m - i) % q - 1)`` after its lag in phase ``m``, with ``q`` the prime above the number of
/// phases and ``g`` its least primitive root. Any path from one sensor to another moves by at least a step from each
/// phase to each other, and few phases lie along any line, as a robot's own speed would draw it. Schedules compare,
/// hash and pickle, and their ``repr`` can be pasted back.
///
/// Args:
///     sensors: how many, 1 to 64.
///     period_us: the period, ``T_p``; it must exceed the width of the code.
///     step_us: the least shift of crosstalk, 1 to 65535.
///     phases: at least this many, 2 to 67, as far as there are; there are more than sensors, and one less than a
///         prime. By default at least the 5 that confirm an echo.
///     t_lag_us: the lag of each sensor; by default they are spread evenly over the period.
///     first_multiplier: ``a``, below the number of phases, which are then exactly as many as asked for: one less than
///         a prime, or a prime for the linear congruence ``(x + a) * m % phases`` of sensor ``x``.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///     HoppingError: numbers that make no such schedule, such as a period too short for the code.
///
/// Example:
///     >>> import eeruf
///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
///     >>> schedule.phases, schedule.width_us, schedule.t_fire_us.shape
///     (10, 2160, (10, 8))
#[pyclass(frozen, eq, hash, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct HoppingSchedule(pub(crate) Core<MAX_SENSORS>);

/// As many as balanced settings want votes.
const PHASES: u8 = eeruf_core::judge::TrackerSettings::BALANCED.votes;

impl HoppingSchedule {
    /// A linear congruence: the narrowest with at least this many phases.
    pub(crate) fn congruence(
        sensors: &Bound<'_, PyAny>,
        period_us: &Bound<'_, PyAny>,
        step_us: &Bound<'_, PyAny>,
        phases: Option<&Bound<'_, PyAny>>,
        t_lag_us: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (sensors, period) = (requirements::sensors(sensors)?, micros("period_us", period_us)?);
        let phases = whole_or("phases", phases, PHASES, 2..=HoppingCode::MAX_PHASES)?;
        let step = micros("step_us", step_us)?;
        // At most 64 sensors.
        let mut primes = (phases.max(sensors as u8 + 1)..=HoppingCode::MAX_PHASES)
            .map(|phases| HoppingCode::of(sensors, phases, 1, step))
            .filter(|code| !code.is_ok_and(|code| code.is_welch()) && !matches!(code, Err(Error::NotPrime { .. })));
        let code = primes.next().unwrap_or_else(|| HoppingCode::new(sensors, phases, step));
        Self::with_lags(code.map_err(Raise::raise)?, period, t_lag_us)
    }

    fn with_lags(code: HoppingCode, period: Micros, t_lag_us: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        let sensors = code.sensors();
        let schedule = match t_lag_us {
            None => Core::spread(code, period),
            Some(given) => {
                let (given, mut lags) = (times("t_lag_us", given)?, [Micros::ZERO; MAX_SENSORS]);
                if given.len() != sensors {
                    let found = format_args!("{} times", given.len()).to_string();
                    return Err(wrong("t_lag_us", found, format_args!("one for each of {sensors} sensors")));
                }
                lags[..sensors].copy_from_slice(&given);
                Core::new(code, period, lags)
            }
        };
        schedule.map(Self).map_err(Raise::raise)
    }

    fn lags(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.sensors()).filter_map(|sensor| self.0.t_lag(sensor)).map(Micros::as_micros)
    }
}

#[pymethods]
impl HoppingSchedule {
    #[new]
    #[pyo3(signature = (
        sensors, period_us, step_us, phases=None, t_lag_us=None, *, first_multiplier=None
    ))]
    #[pyo3(text_signature = "(sensors, period_us, step_us, phases=5, t_lag_us=None, *, first_multiplier=None)")]
    pub(crate) fn new(
        sensors: &Bound<'_, PyAny>,
        period_us: &Bound<'_, PyAny>,
        step_us: &Bound<'_, PyAny>,
        phases: Option<&Bound<'_, PyAny>>,
        t_lag_us: Option<&Bound<'_, PyAny>>,
        first_multiplier: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (sensors, period) = (requirements::sensors(sensors)?, micros("period_us", period_us)?);
        let phases = whole_or("phases", phases, PHASES, 2..=HoppingCode::MAX_PHASES)?;
        let step = micros("step_us", step_us)?;
        let code = match first_multiplier {
            None => HoppingCode::new(sensors, phases, step),
            Some(first) => {
                let first = whole("first_multiplier", first, 0..=HoppingCode::MAX_PHASES - 1)?;
                HoppingCode::of(sensors, phases, first, step)
            }
        };
        let code = code.map_err(Raise::raise)?;
        Self::with_lags(code, period, t_lag_us)
    }

    /// Read a schedule as ``eeruf design --phases M --emit toml`` and :meth:`to_toml` write it.
    ///
    /// Args:
    ///     text: the contents of a file: ``period_us``, ``step_us``, ``phases`` and ``t_lag_us``.
    ///
    /// Raises:
    ///     ArgumentError: not a text.
    ///     HoppingError: the text is no TOML, a key is missing, the numbers make no schedule, or it is a table of
    ///     firing
    ///         times, which no ring hops by.
    ///
    /// Example:
    ///     >>> from eeruf import HoppingSchedule
    ///     >>> keys = "period_us = 60000\nstep_us = 240\nphases = 5\nt_lag_us = [0, 9000]"
    ///     >>> HoppingSchedule.from_toml(keys).phases
    ///     5
    #[staticmethod]
    fn from_toml(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        let text = arguments::text("text", text, "a schedule in TOML")?;
        let schedule = eeruf_files::build(&text, |file: PhaseFile| file.schedule());
        let schedule = schedule.map_err(|error| HoppingError::new_err(error.to_string()))?;
        let hopping = schedule.hopping().copied().map(Self);
        hopping.ok_or_else(|| HoppingError::new_err("t_fire_us; expected step_us, phases and t_lag_us, to hop by"))
    }

    /// Multiply the period and the lags by a fraction, each rounded to the nearest microsecond. The code stays, so
    /// a ring may change to it.
    ///
    /// Args:
    ///     num: its numerator.
    ///     den: its denominator. If the fraction is 1 or more, it keeps all that the schedule keeps.
    ///
    /// Raises:
    ///     ArgumentError: no whole numbers.
    ///     HoppingError: the times make no schedule, such as a period too short for the code.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240).scaled(3, 2).period_us
    ///     90000
    fn scaled(&self, num: &Bound<'_, PyAny>, den: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (num, den) = (whole("num", num, 0..=u32::MAX)?, whole("den", den, 0..=u32::MAX)?);
        self.0.scaled(num, den).map(Self).map_err(Raise::raise)
    }

    /// Write a schedule file, as the program reads it.
    ///
    /// Example:
    ///     >>> from eeruf import HoppingSchedule
    ///     >>> schedule = HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> HoppingSchedule.from_toml(schedule.to_toml()) == schedule
    ///     True
    fn to_toml(&self) -> String {
        self.0.to_toml()
    }

    /// The period ``T_p``, in microseconds.
    #[getter]
    fn period_us(&self) -> u32 {
        self.0.period().as_micros()
    }

    /// Number of sensors that fire.
    #[getter]
    fn sensors(&self) -> usize {
        self.0.code().sensors()
    }

    /// Number of phases a cycle has: one less than a prime, or a prime for a linear congruence.
    #[getter]
    fn phases(&self) -> u8 {
        self.0.code().phases()
    }

    /// ``a``: what the first sensor's wait is multiplied by.
    #[getter]
    fn first_multiplier(&self) -> u8 {
        self.0.code().first_multiplier()
    }

    /// The least shift of crosstalk from one phase to another, in microseconds.
    #[getter]
    fn step_us(&self) -> u32 {
        self.0.code().step().as_micros()
    }

    /// The longest wait of the code, in microseconds.
    #[getter]
    fn width_us(&self) -> u32 {
        self.0.code().width().as_micros()
    }

    /// The lag of each sensor at the start, in microseconds; a ring may move them.
    #[getter]
    fn t_lag_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.lags().collect::<Vec<_>>())
    }

    /// When each sensor fires, in microseconds from the beginning of the period: an array of int64 of shape
    /// (phases, sensors).
    #[getter]
    fn t_fire_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        let times = |phase| (0..self.sensors()).filter_map(move |sensor| self.0.t_fire(phase, sensor));
        let all: Vec<_> = (0..self.phases()).flat_map(times).map(|time| i64::from(time.as_micros())).collect();
        PyArray1::from_vec(py, all).reshape([self.phases().into(), self.sensors()])
    }

    /// The period and the code with its lags by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> eeruf.HoppingSchedule(sensors=2, period_us=60_000, step_us=240, phases=5).to_dict()["t_lag_us"]
    ///     [0, 29400]
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &["period_us", "step_us", "phases", "first_multiplier", "t_lag_us"])
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (sensors, period, step, phases) = (self.sensors(), self.period_us(), self.step_us(), self.phases());
        let lags = self.t_lag_us(py)?;
        let first = self.first_multiplier();
        Ok(format!(
            "HoppingSchedule(sensors={sensors}, period_us={period}, step_us={step}, phases={phases}, t_lag_us={lags}, \
             first_multiplier={first})"
        ))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let arguments = (self.sensors(), self.period_us(), self.step_us(), self.phases(), self.t_lag_us(py)?);
        let first = PyDict::new(py);
        first.set_item("first_multiplier", self.first_multiplier())?;
        Ok((arguments.into_pyobject(py)?, first))
    }
}
