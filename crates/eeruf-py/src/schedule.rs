//! `Schedule`.

use std::hash::{Hash, Hasher};

use eeruf_core::{Micros, Phase};
use eeruf_sim::{AnySchedule, ScheduleFile};
use pyo3::{prelude::*, types::PyTuple};

use crate::{
    arguments::{self, OwnedLayout, OwnedRequirements, micros, times, whole},
    errors::{Raise, ScheduleError},
    report::Report,
};

/// When each sensor fires, in the two phases that alternate.
#[pyclass(frozen, eq, hash, module = "eeruf")]
#[derive(Clone, PartialEq)]
pub(crate) struct Schedule(pub(crate) AnySchedule);

impl Hash for Schedule {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.0.hash(state);
    }
}

fn tuple<'py>(py: Python<'py>, times: &[Micros]) -> PyResult<Bound<'py, PyTuple>> {
    PyTuple::new(py, times.iter().map(|time| time.as_micros()))
}

impl Schedule {
    fn t_fire<'py>(&self, py: Python<'py>, phase: Phase) -> PyResult<Bound<'py, PyTuple>> {
        let fire = |sensor| self.0.t_fire(phase, sensor).unwrap_or_default().as_micros();
        PyTuple::new(py, (0..self.0.sensors()).map(fire))
    }

    fn has_lags(&self) -> bool {
        self.0.t_lag().iter().any(|&lag| lag != Micros::ZERO)
    }

    #[expect(clippy::too_many_arguments, reason = "the keyword arguments of verify")]
    fn requirements(
        &self,
        t_delta_us: Option<&Bound<'_, PyAny>>,
        min_interval_us: Option<&Bound<'_, PyAny>>,
        neighbours: Option<&Bound<'_, PyAny>>,
        layout: Option<&Bound<'_, PyAny>>,
        criterion: Option<&Bound<'_, PyAny>>,
        window_us: Option<&Bound<'_, PyAny>>,
        stale_echo: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<OwnedRequirements> {
        let or_zero =
            |name, value: Option<&Bound<'_, PyAny>>| value.map_or(Ok(Micros::ZERO), |value| micros(name, value));
        let mut requirements = OwnedRequirements {
            t_delta: or_zero("t_delta_us", t_delta_us)?,
            min_interval: or_zero("min_interval_us", min_interval_us)?,
            layout: OwnedLayout::new(layout, arguments::neighbours(neighbours)?)?,
            criterion: arguments::criterion(criterion)?,
            window: or_zero("window_us", window_us)?,
            stale_echo: arguments::flag("stale_echo", stale_echo, false)?,
        };
        if t_delta_us.is_none() {
            // The most that the schedule allows.
            requirements.t_delta = self.0.verify(&requirements.requirements()).max_t_delta().unwrap_or(Micros::ZERO);
        }
        Ok(requirements)
    }
}

#[pymethods]
impl Schedule {
    #[new]
    #[pyo3(signature = (period_us, t_lag_us, t_wait_a_us, t_wait_b_us))]
    fn new(
        period_us: &Bound<'_, PyAny>,
        t_lag_us: &Bound<'_, PyAny>,
        t_wait_a_us: &Bound<'_, PyAny>,
        t_wait_b_us: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let period = micros("period_us", period_us)?;
        let lag = times("t_lag_us", t_lag_us)?;
        let (a, b) = (times("t_wait_a_us", t_wait_a_us)?, times("t_wait_b_us", t_wait_b_us)?);
        AnySchedule::from_slices(period, &lag, [&a, &b]).map(Self).map_err(Raise::raise)
    }

    #[staticmethod]
    #[pyo3(signature = (period_us, t_fire_a_us, t_fire_b_us))]
    fn from_firing(
        period_us: &Bound<'_, PyAny>,
        t_fire_a_us: &Bound<'_, PyAny>,
        t_fire_b_us: &Bound<'_, PyAny>,
    ) -> PyResult<Self> {
        let period = micros("period_us", period_us)?;
        let (a, b) = (times("t_fire_a_us", t_fire_a_us)?, times("t_fire_b_us", t_fire_b_us)?);
        AnySchedule::from_slices(period, &vec![Micros::ZERO; a.len()], [&a, &b]).map(Self).map_err(Raise::raise)
    }

    #[staticmethod]
    #[pyo3(signature = (text))]
    fn from_toml(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        let text = arguments::text("text", text, "a schedule in TOML")?;
        let file: ScheduleFile =
            toml::from_str(&text).map_err(|error| ScheduleError::new_err(error.message().to_owned()))?;
        file.schedule().map(Self).map_err(ScheduleError::new_err)
    }

    #[staticmethod]
    #[pyo3(signature = (text))]
    fn from_json(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        let text = arguments::text("text", text, "a schedule in JSON")?;
        let file: ScheduleFile =
            serde_json::from_str(&text).map_err(|error| ScheduleError::new_err(error.to_string()))?;
        file.schedule().map(Self).map_err(ScheduleError::new_err)
    }

    #[getter]
    fn period_us(&self) -> u32 {
        self.0.period().as_micros()
    }

    #[getter]
    fn sensors(&self) -> usize {
        self.0.sensors()
    }

    #[getter]
    fn t_lag_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.t_lag())
    }

    #[getter]
    fn t_wait_a_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.t_wait(Phase::A))
    }

    #[getter]
    fn t_wait_b_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        tuple(py, self.0.t_wait(Phase::B))
    }

    #[getter]
    fn t_fire_a_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.t_fire(py, Phase::A)
    }

    #[getter]
    fn t_fire_b_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        self.t_fire(py, Phase::B)
    }

    #[pyo3(signature = (num, den))]
    fn scaled(&self, num: &Bound<'_, PyAny>, den: &Bound<'_, PyAny>) -> PyResult<Self> {
        let (num, den) = (whole("num", num, 0..=u32::MAX)?, whole("den", den, 0..=u32::MAX)?);
        self.0.scaled(num, den).map(Self).map_err(Raise::raise)
    }

    #[pyo3(signature = (t_delta_us, min_interval_us=None, neighbours=None, layout=None, criterion=None, window_us=None, stale_echo=None))]
    #[pyo3(
        text_signature = "($self, t_delta_us, min_interval_us=0, neighbours=4, layout=\"line\", criterion=\"exact\", window_us=0, stale_echo=False)"
    )]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn verify(
        &self,
        t_delta_us: &Bound<'_, PyAny>,
        min_interval_us: Option<&Bound<'_, PyAny>>,
        neighbours: Option<&Bound<'_, PyAny>>,
        layout: Option<&Bound<'_, PyAny>>,
        criterion: Option<&Bound<'_, PyAny>>,
        window_us: Option<&Bound<'_, PyAny>>,
        stale_echo: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Report> {
        let t_delta = Some(t_delta_us);
        let owned =
            self.requirements(t_delta, min_interval_us, neighbours, layout, criterion, window_us, stale_echo)?;
        Ok(Report::of(&self.0.verify(&owned.requirements())))
    }

    fn to_toml(&self) -> String {
        self.0.to_toml().to_string()
    }

    fn to_json(&self) -> PyResult<String> {
        serde_json::to_string(&ScheduleFile::from(&self.0)).map_err(|error| ScheduleError::new_err(error.to_string()))
    }

    #[pyo3(signature = (t_delta_us=None, min_interval_us=None, neighbours=None, layout=None, criterion=None, window_us=None, stale_echo=None))]
    #[pyo3(
        text_signature = "($self, t_delta_us=None, min_interval_us=0, neighbours=4, layout=\"line\", criterion=\"exact\", window_us=0, stale_echo=False)"
    )]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn to_rust(
        &self,
        t_delta_us: Option<&Bound<'_, PyAny>>,
        min_interval_us: Option<&Bound<'_, PyAny>>,
        neighbours: Option<&Bound<'_, PyAny>>,
        layout: Option<&Bound<'_, PyAny>>,
        criterion: Option<&Bound<'_, PyAny>>,
        window_us: Option<&Bound<'_, PyAny>>,
        stale_echo: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        let owned =
            self.requirements(t_delta_us, min_interval_us, neighbours, layout, criterion, window_us, stale_echo)?;
        Ok(self.0.to_rust(&owned.requirements()).to_string())
    }

    #[pyo3(signature = (t_delta_us=None, min_interval_us=None, neighbours=None, layout=None, criterion=None, window_us=None, stale_echo=None))]
    #[pyo3(
        text_signature = "($self, t_delta_us=None, min_interval_us=0, neighbours=4, layout=\"line\", criterion=\"exact\", window_us=0, stale_echo=False)"
    )]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn to_c(
        &self,
        t_delta_us: Option<&Bound<'_, PyAny>>,
        min_interval_us: Option<&Bound<'_, PyAny>>,
        neighbours: Option<&Bound<'_, PyAny>>,
        layout: Option<&Bound<'_, PyAny>>,
        criterion: Option<&Bound<'_, PyAny>>,
        window_us: Option<&Bound<'_, PyAny>>,
        stale_echo: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        let owned =
            self.requirements(t_delta_us, min_interval_us, neighbours, layout, criterion, window_us, stale_echo)?;
        Ok(self.0.to_c(&owned.requirements()).to_string())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let period = self.period_us();
        Ok(if self.has_lags() {
            let (lag, a, b) = (self.t_lag_us(py)?, self.t_wait_a_us(py)?, self.t_wait_b_us(py)?);
            format!("Schedule(period_us={period}, t_lag_us={lag}, t_wait_a_us={a}, t_wait_b_us={b})")
        } else {
            let (a, b) = (self.t_fire_a_us(py)?, self.t_fire_b_us(py)?);
            format!("Schedule.from_firing(period_us={period}, t_fire_a_us={a}, t_fire_b_us={b})")
        })
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        let arguments = (this.period_us(), this.t_lag_us(py)?, this.t_wait_a_us(py)?, this.t_wait_b_us(py)?);
        Ok((slf.get_type().into_any(), arguments.into_pyobject(py)?))
    }
}
