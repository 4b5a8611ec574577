//! `sim.simulate` and the `Readings` it returns.

use eeruf_core::Kind;
use eeruf_sim::{Cause, Method, Options, SimulationError as Trouble, best::best_for, simulate_while};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{whole, whole_or, wrong},
    errors::{ArgumentError, Raise},
    scene::Scene,
    watch::{Watch, interrupted},
};

/// The names of causes by their codes.
pub(crate) const CAUSES: [&str; 5] = ["nothing", "own", "stale", "crosstalk", "external"];
const CAUSE_OF: [Cause; 5] = [Cause::Nothing, Cause::Own, Cause::Stale, Cause::Crosstalk, Cause::External];

/// The method with a name.
pub(crate) fn method(name: &str) -> PyResult<Method> {
    name.parse().map_err(|error: eeruf_sim::UnknownMethod| ArgumentError::new_err(error.to_string()))
}

/// Every reading of a simulation.
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Readings(eeruf_sim::Readings);

/// Runs a scene under a method.
#[pyfunction]
#[pyo3(signature = (scene, method="eeruf", periods=None, seed=None, *, progress=None))]
#[pyo3(text_signature = "(scene, method=\"eeruf\", periods=1000, seed=None, *, progress=None)")]
pub(crate) fn simulate(
    scene: &Bound<'_, Scene>,
    method: &str,
    periods: Option<&Bound<'_, PyAny>>,
    seed: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Readings> {
    let world = scene.get().world()?;
    let method = self::method(method)?;
    let mut options = Options {
        seed: seed.map(|seed| whole("seed", seed, 0..=u64::MAX)).transpose()?,
        ..Options::periods(whole_or("periods", periods, 1000, 1..=u32::MAX)?)
    };
    let mut watch = Watch::new(progress)?;
    let result = scene.py().detach(|| {
        if let (Method::EerufBest, Some(robot)) = (method, world.robots().first()) {
            let best = best_for(robot, BEST_BUDGET, |_| watch.go_on(None, || "designing".to_owned()));
            options.best = Some(best.map_err(Raise::raise)?.schedule);
        }
        let keep_going = |share| watch.go_on(Some(share), || format!("simulating {method}"));
        simulate_while(world, method, &options, keep_going).map(Readings).map_err(|error| match error {
            Trouble::Stopped => interrupted(),
            error => error.raise(),
        })
    });
    watch.outcome(result)
}

/// How many nodes the schedule of `eeruf_best` may cost, as in the program.
const BEST_BUDGET: u64 = 2_000_000;

impl Readings {
    fn array<'py, T: numpy::Element>(py: Python<'py>, values: impl Iterator<Item = T>) -> Bound<'py, PyAny> {
        PyArray1::from_iter(py, values).into_any()
    }
}

#[pymethods]
impl Readings {
    fn __len__(&self) -> usize {
        self.0.len()
    }

    #[getter]
    fn method(&self) -> &'static str {
        self.0.method.as_str()
    }

    #[getter]
    fn duration_s(&self) -> f64 {
        self.0.duration_s
    }

    #[getter]
    fn sensors(&self) -> usize {
        self.0.sensors
    }

    #[getter]
    fn robot<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.robot.iter().copied())
    }

    #[getter]
    fn sensor<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.sensor.iter().copied())
    }

    #[getter]
    fn period<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.period.iter().copied())
    }

    #[getter]
    fn phase<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.phase.iter().copied())
    }

    #[getter]
    fn fired_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.fired_s.iter().copied())
    }

    #[getter]
    fn kind<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.kind.iter().map(|&kind| kind as u8))
    }

    #[getter]
    fn t_echo_us<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.t_echo_us.iter().copied())
    }

    #[getter]
    fn earliest_us<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.earliest_us.iter().copied())
    }

    #[getter]
    fn reference_us<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.reference_us.iter().copied())
    }

    #[getter]
    fn cause<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.cause.iter().map(|&cause| cause as u8))
    }

    #[getter]
    fn emitted_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.emitted_s.iter().copied())
    }

    #[getter]
    fn is_accepted<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, (0..self.0.len()).map(|reading| self.0.is_accepted(reading)))
    }

    #[pyo3(signature = (tolerance_us=eeruf_sim::DEFAULT_TOLERANCE_US), text_signature = "($self, tolerance_us=500.0)")]
    fn is_wrong<'py>(&self, py: Python<'py>, tolerance_us: f64) -> Bound<'py, PyAny> {
        Self::array(py, (0..self.0.len()).map(|reading| self.0.is_wrong(reading, tolerance_us)))
    }

    #[pyo3(signature = (tolerance_us=eeruf_sim::DEFAULT_TOLERANCE_US), text_signature = "($self, tolerance_us=500.0)")]
    fn summary<'py>(&self, py: Python<'py>, tolerance_us: f64) -> PyResult<Bound<'py, PyAny>> {
        let summary = py.detach(|| self.0.summary_within(tolerance_us));
        let json = serde_json::to_string(&summary).map_err(|error| ArgumentError::new_err(error.to_string()))?;
        py.import("json")?.call_method1("loads", (json,))
    }

    fn columns<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(slf.py());
        for name in COLUMNS {
            columns.set_item(name, slf.getattr(name)?)?;
        }
        Ok(columns)
    }

    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("pandas")?.call_method1("DataFrame", (Self::columns(slf)?,))
    }

    fn to_polars<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("polars")?.call_method1("DataFrame", (Self::columns(slf)?,))
    }

    fn __repr__(&self) -> String {
        format!(
            "<Readings: {} of {} sensors, {}, {} s>",
            self.0.len(),
            self.0.sensors,
            self.0.method,
            self.0.duration_s
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), &slf.get().0);
        let rebuild = py.import("eeruf._eeruf")?.getattr("_readings_from_columns")?;
        let columns = Self::columns(slf)?;
        Ok((rebuild, (this.method.as_str(), this.duration_s, this.sensors, columns).into_pyobject(py)?))
    }
}

/// The arrays of equal length, one entry for each reading.
const COLUMNS: [&str; 11] = [
    "robot",
    "sensor",
    "period",
    "phase",
    "fired_s",
    "kind",
    "t_echo_us",
    "earliest_us",
    "reference_us",
    "cause",
    "emitted_s",
];

fn column<T: numpy::Element + Copy>(columns: &Bound<'_, PyDict>, name: &str) -> PyResult<Vec<T>> {
    let column = columns.as_any().get_item(name)?;
    let array: PyReadonlyArray1<'_, T> = column.extract().map_err(|_| wrong(name, &column, "a column of Readings"))?;
    Ok(array.as_array().iter().copied().collect())
}

/// Readings from their columns, as a pickle holds them.
#[pyfunction]
#[pyo3(name = "_readings_from_columns", signature = (method, duration_s, sensors, columns))]
pub(crate) fn readings_from_columns(
    method: &str,
    duration_s: f64,
    sensors: usize,
    columns: &Bound<'_, PyDict>,
) -> PyResult<Readings> {
    let robot: Vec<u16> = column(columns, "robot")?;
    let code = |name, codes: usize| -> PyResult<Vec<usize>> {
        let values: Vec<u8> = column(columns, name)?;
        match values.iter().find(|&&value| usize::from(value) >= codes) {
            Some(value) => Err(wrong(name, value, format_args!("0 to {}", codes - 1))),
            None => Ok(values.into_iter().map(usize::from).collect()),
        }
    };
    let readings = eeruf_sim::Readings {
        method: self::method(method)?,
        duration_s,
        sensors,
        sensor: column(columns, "sensor")?,
        period: column(columns, "period")?,
        phase: column(columns, "phase")?,
        fired_s: column(columns, "fired_s")?,
        kind: code("kind", Kind::ALL.len())?.into_iter().map(|kind| Kind::ALL[kind]).collect(),
        t_echo_us: column(columns, "t_echo_us")?,
        earliest_us: column(columns, "earliest_us")?,
        reference_us: column(columns, "reference_us")?,
        cause: code("cause", CAUSES.len())?.into_iter().map(|cause| CAUSE_OF[cause]).collect(),
        emitted_s: column(columns, "emitted_s")?,
        path: vec![eeruf_sim::NO_PATH; robot.len()],
        paths: vec![],
        robot,
    };
    let lengths = [
        readings.sensor.len(),
        readings.period.len(),
        readings.phase.len(),
        readings.fired_s.len(),
        readings.kind.len(),
        readings.t_echo_us.len(),
        readings.earliest_us.len(),
        readings.reference_us.len(),
        readings.cause.len(),
        readings.emitted_s.len(),
    ];
    match lengths.iter().find(|&&length| length != readings.robot.len()) {
        Some(length) => Err(wrong("length of a column", length, readings.robot.len())),
        None => Ok(Readings(readings)),
    }
}
