//! `HoppingSchedule`.

use eeruf_core::{
    MAX_SENSORS, Micros,
    hopping::{HoppingCode, HoppingSchedule as Core},
};
use eeruf_design::PhaseFile;
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
/// Sensor ``x`` fires ``t_lag_us[x] + step_us * ((x + a) * m % phases)`` after the beginning of a period of phase
/// ``m``; the number of phases is prime, so that any path from one sensor to another moves by at least a step from each
/// phase to each other. Schedules compare, hash and pickle, and their ``repr`` can be pasted back.
///
/// Args:
///     sensors: how many, 1 to 64.
///     period_us: the period, ``T_p``; it must exceed the width of the code.
///     step_us: by how much crosstalk moves at least, 1 to 65535.
///     phases: at least so many, 2 to 67; there are as many as the next prime above the sensors' number. By default
///         at least the 5 that confirm an echo.
///     t_lag_us: the lag of each sensor; by default ``neighbours`` adjacent ones are spread evenly over the period.
///     neighbours: how many, 1 to 64.
///     first_multiplier: ``a``, below the number of phases.
///
/// Raises:
///     ArgumentError: something of the wrong type or out of range.
///     HoppingError: numbers that make no such schedule, such as a period too short for the code.
///
/// Example:
///     >>> import eeruf
///     >>> schedule = eeruf.HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
///     >>> schedule.phases, schedule.width_us, schedule.t_fire_us.shape
///     (11, 2400, (11, 8))
#[pyclass(frozen, eq, hash, module = "eeruf")]
#[derive(Clone, PartialEq, Eq, Hash)]
pub(crate) struct HoppingSchedule(pub(crate) Core<MAX_SENSORS>);

/// As many as balanced settings want votes.
const PHASES: u8 = eeruf_core::judge::TrackerSettings::BALANCED.votes;

impl HoppingSchedule {
    fn lags(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.sensors()).filter_map(|sensor| self.0.t_lag(sensor)).map(Micros::as_micros)
    }
}

#[pymethods]
impl HoppingSchedule {
    #[new]
    #[pyo3(signature = (
        sensors, period_us, step_us, phases=None, t_lag_us=None, *, neighbours=None, first_multiplier=None
    ))]
    #[pyo3(text_signature = "(sensors, period_us, step_us, phases=5, t_lag_us=None, *, neighbours=4, \
            first_multiplier=1)")]
    pub(crate) fn new(
        sensors: &Bound<'_, PyAny>,
        period_us: &Bound<'_, PyAny>,
        step_us: &Bound<'_, PyAny>,
        phases: Option<&Bound<'_, PyAny>>,
        t_lag_us: Option<&Bound<'_, PyAny>>,
        neighbours: Option<&Bound<'_, PyAny>>,
        first_multiplier: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (sensors, period) = (requirements::sensors(sensors)?, micros("period_us", period_us)?);
        let phases = whole_or("phases", phases, PHASES, 2..=HoppingCode::MAX_PHASES)?;
        let neighbours = whole_or("neighbours", neighbours, 4, 1..=MAX_SENSORS as u8)?;
        let mut code = HoppingCode::new(sensors, phases, micros("step_us", step_us)?).map_err(Raise::raise)?;
        if let Some(first) = first_multiplier {
            let first = whole("first_multiplier", first, 0..=code.phases() - 1)?;
            code = HoppingCode::of(sensors, code.phases(), first, code.step()).map_err(Raise::raise)?;
        }
        let schedule = match t_lag_us {
            None => Core::spread(code, period, neighbours),
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
    #[pyo3(signature = (text))]
    fn from_toml(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        let text = arguments::text("text", text, "a schedule in TOML")?;
        let file = eeruf_design::parse::<PhaseFile>(&text).map_err(|error| HoppingError::new_err(error.to_string()))?;
        let schedule = file.schedule().map_err(HoppingError::new_err)?;
        let hopping = schedule.hopping().copied().map(Self);
        hopping.ok_or_else(|| HoppingError::new_err("t_fire_us; expected step_us, phases and t_lag_us, to hop by"))
    }

    /// Write a schedule file, as the program reads it.
    ///
    /// Example:
    ///     >>> from eeruf import HoppingSchedule
    ///     >>> schedule = HoppingSchedule(sensors=8, period_us=60_000, step_us=240)
    ///     >>> HoppingSchedule.from_toml(schedule.to_toml()) == schedule
    ///     True
    fn to_toml(&self) -> String {
        self.0.to_toml().to_string()
    }

    /// The period ``T_p``, in microseconds.
    #[getter]
    fn period_us(&self) -> u32 {
        self.0.period().as_micros()
    }

    /// How many sensors fire.
    #[getter]
    fn sensors(&self) -> usize {
        self.0.code().sensors()
    }

    /// How many phases a cycle has: a prime.
    #[getter]
    fn phases(&self) -> u8 {
        self.0.code().phases()
    }

    /// ``a``: by what the phase is multiplied for sensor 0.
    #[getter]
    fn first_multiplier(&self) -> u8 {
        self.0.code().first_multiplier()
    }

    /// By how much crosstalk moves at least from one phase to another, in microseconds.
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
    ///     [0, 14760]
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &["period_us", "step_us", "phases", "first_multiplier", "t_lag_us"])
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let (sensors, period, step, phases) = (self.sensors(), self.period_us(), self.step_us(), self.phases());
        let lags = self.t_lag_us(py)?;
        let first = match self.first_multiplier() {
            1 => String::new(),
            first => format!(", first_multiplier={first}"),
        };
        Ok(format!(
            "HoppingSchedule(sensors={sensors}, period_us={period}, step_us={step}, phases={phases}, t_lag_us={lags}\
             {first})"
        ))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyTuple>, Bound<'py, PyDict>)> {
        let arguments = (self.sensors(), self.period_us(), self.step_us(), self.phases(), self.t_lag_us(py)?);
        let first = PyDict::new(py);
        first.set_item("first_multiplier", self.first_multiplier())?;
        Ok((arguments.into_pyobject(py)?, first))
    }
}
