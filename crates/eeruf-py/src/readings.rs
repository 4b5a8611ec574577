//! `sim.simulate` and the `Readings` it returns.

use eeruf_core::ReadingKind;
use eeruf_sim::{Cause, HeardPath, Method, NO_PATH, Options, SensorId, best_schedule_for, simulate_while};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{instance, number, text, whole, whole_or, wrong},
    errors::{ArgumentError, Raise},
    experiments::BEST_BUDGET,
    paths::{bounce, coded},
    scene::Scene,
    watch::aside,
};

/// The names of causes by their codes.
pub(crate) const CAUSES: [&str; 5] = ["nothing", "own", "stale", "crosstalk", "external"];
const CAUSE_OF: [Cause; 5] = [Cause::Nothing, Cause::Own, Cause::Stale, Cause::Crosstalk, Cause::External];

/// The method with a name.
pub(crate) fn method(argument: &str, name: &Bound<'_, PyAny>) -> PyResult<Method> {
    let name = text(argument, name, "a name of eeruf.sim.METHODS")?;
    name.parse().map_err(|error: eeruf_sim::UnknownMethod| ArgumentError::new_err(error.to_string()))
}

/// Every reading of a simulation: arrays of equal length, in the order in which the rings told them. Readings pickle.
///
/// Each reading comes with what caused it and with what the sensor would have read alone. Times without a value are NaN. The arrays
/// are copies.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
///     >>> len(readings), readings.summary()["wrong_of_all"] < 0.01
///     (800, True)
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Readings(eeruf_sim::Readings);

/// Drive the rings of a scene through simulated time by a method: core's own scheduler and filter, as on the target.
///
/// The same scene, method and seed give the same readings, bit for bit. It runs on one core, without the interpreter lock; Ctrl-C
/// ends it.
///
/// Args:
///     scene: with one robot or more.
///     method: one of ``METHODS``.
///     periods: for how many periods of the first robot, 1 or more.
///     seed: of the noise, 0 to 2^64 - 1; the scene's by default.
///     progress: True for a bar (tqdm if it is installed), or a callable that takes the share done and a text.
///
/// Returns:
///     Every reading.
///
/// Raises:
///     ArgumentError: no such method, or something of the wrong type or out of range.
///     SceneError: the scene has no robot.
///     SimulationError: a ring cannot fire by the method as it should listen.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
///     >>> sim.simulate(scene, method="conventional", periods=10)
///     <Readings: 80 of 8 sensors, conventional, 0.600 s>
#[pyfunction]
#[pyo3(signature = (scene, method=None, periods=None, seed=None, *, progress=None))]
#[pyo3(text_signature = "(scene, method=\"eeruf\", periods=1000, seed=None, *, progress=None)")]
pub(crate) fn simulate(
    scene: &Bound<'_, PyAny>,
    method: Option<&Bound<'_, PyAny>>,
    periods: Option<&Bound<'_, PyAny>>,
    seed: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<Readings> {
    let scene = instance::<Scene>("scene", scene, "an eeruf.sim.Scene")?;
    scene.get().world()?;
    let method = method.map_or(Ok(Method::Eeruf), |name| self::method("method", name))?;
    let mut options = Options {
        seed: seed.map(|seed| whole("seed", seed, 0..=u64::MAX)).transpose()?,
        ..Options::periods(whole_or("periods", periods, 1000, 1..=u32::MAX)?)
    };
    let (py, scene) = (scene.py(), scene.clone().unbind());
    aside(py, progress, move |aside| {
        let world = scene.get().world()?;
        if let (Method::EerufBest, Some(robot)) = (method, world.robots().first()) {
            let best = best_schedule_for(robot, BEST_BUDGET, |_| aside.go_on(None, || "designing".to_owned()));
            options.best = Some(best.map_err(Raise::raise)?.schedule);
        }
        let keep_going = |share| aside.go_on(Some(share), || format!("simulating {method}"));
        simulate_while(world, method, &options, keep_going).map(Readings).map_err(Raise::raise)
    })
}

fn tolerance(value: Option<&Bound<'_, PyAny>>) -> PyResult<f64> {
    value.map_or(Ok(eeruf_sim::DEFAULT_TOLERANCE_US), |us| number("tolerance_us", us, 0.0..=f64::INFINITY))
}

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

    /// The method that was simulated, one of ``METHODS``.
    #[getter]
    fn method(&self) -> &'static str {
        self.0.method.as_str()
    }

    /// For how long, in seconds.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.0.duration_s
    }

    /// How many sensors the scene has, of all robots together.
    #[getter]
    fn sensors(&self) -> usize {
        self.0.sensors
    }

    /// The robot, from 0: uint16.
    #[getter]
    fn robot<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.robot.iter().copied())
    }

    /// The sensor on its ring, from 0: uint8.
    #[getter]
    fn sensor<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.sensor.iter().copied())
    }

    /// The period in which it fired, from 0: uint32.
    #[getter]
    fn period<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.period.iter().copied())
    }

    /// The phase in which it fired, 0 for a and 1 for b: uint8.
    #[getter]
    fn phase<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.phase.iter().copied())
    }

    /// When it fired, in seconds: float64.
    #[getter]
    fn fired_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.fired_s.iter().copied())
    }

    /// What the method made of it, an index into ``eeruf.KINDS``: uint8.
    #[getter]
    fn kind<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.kind.iter().map(|&kind| kind as u8))
    }

    /// The echo time that the method tells, in microseconds: float64.
    #[getter]
    fn t_echo_us<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.t_echo_us.iter().copied())
    }

    /// The earliest echo of the firing, in microseconds: float64.
    #[getter]
    fn earliest_us<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.earliest_us.iter().copied())
    }

    /// What the sensor would have read alone in quiet air, in microseconds: float64.
    #[getter]
    fn reference_us<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.reference_us.iter().copied())
    }

    /// What ``t_echo_us`` came from, an index into ``CAUSES``: uint8.
    #[getter]
    fn cause<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.cause.iter().map(|&cause| cause as u8))
    }

    /// Along which of ``paths`` the sound came, an index, or -1 for none: int64.
    #[getter]
    fn path<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        let index = |&path: &u32| if path == NO_PATH { -1 } else { i64::from(path) };
        Self::array(py, self.0.path.iter().map(index))
    }

    /// Every path that some reading came along: a dict of arrays of equal length.
    ///
    /// ``emitter_robot``, ``emitter``, ``receiver_robot``, ``receiver`` count from 0; ``order`` is the number of bounces; ``length_m``,
    /// ``departure_rad`` and ``arrival_rad`` are in metres and radians of the scene; ``walls`` is a list of tuples as in ``Paths``.
    #[getter]
    fn paths<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (columns, paths) = (PyDict::new(py), &self.0.paths);
        columns.set_item("emitter_robot", Self::array(py, paths.iter().map(|path| path.emitter.robot)))?;
        columns.set_item("emitter", Self::array(py, paths.iter().map(|path| path.emitter.sensor)))?;
        columns.set_item("receiver_robot", Self::array(py, paths.iter().map(|path| path.receiver.robot)))?;
        columns.set_item("receiver", Self::array(py, paths.iter().map(|path| path.receiver.sensor)))?;
        columns.set_item("order", Self::array(py, paths.iter().map(|path| path.order)))?;
        columns.set_item("length_m", Self::array(py, paths.iter().map(|path| path.length_m)))?;
        columns.set_item("departure_rad", Self::array(py, paths.iter().map(|path| path.departure_rad)))?;
        columns.set_item("arrival_rad", Self::array(py, paths.iter().map(|path| path.arrival_rad)))?;
        let walls = paths.iter().map(|path| PyTuple::new(py, coded(&path.bounces)));
        columns.set_item("walls", walls.collect::<PyResult<Vec<_>>>()?)?;
        Ok(columns)
    }

    /// When the sound behind ``t_echo_us`` was sent, in seconds: float64.
    #[getter]
    fn emitted_s<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, self.0.emitted_s.iter().copied())
    }

    /// Whether the method believes the reading, an echo or that nothing is in range: bool.
    #[getter]
    fn is_accepted<'py>(&self, py: Python<'py>) -> Bound<'py, PyAny> {
        Self::array(py, (0..self.0.len()).map(|reading| self.0.is_accepted(reading)))
    }

    /// Whether what the reading says is wrong, believed or not.
    ///
    /// Args:
    ///     tolerance_us: by how much it may miss the reference, in microseconds.
    ///
    /// Returns:
    ///     Array of bool.
    ///
    /// Raises:
    ///     ArgumentError: the tolerance is negative or not a number.
    #[pyo3(signature = (tolerance_us=None), text_signature = "($self, tolerance_us=500.0)")]
    fn is_wrong<'py>(&self, py: Python<'py>, tolerance_us: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        let tolerance_us = tolerance(tolerance_us)?;
        Ok(Self::array(py, (0..self.0.len()).map(|reading| self.0.is_wrong(reading, tolerance_us))))
    }

    /// The figures that are always reported together.
    ///
    /// Args:
    ///     tolerance_us: by how much a reading may miss the reference, in microseconds.
    ///
    /// Returns:
    ///     A dict: ``readings``, ``accepted``; as fractions of 1 ``wrong_of_all``, ``crosstalk_of_all``, ``wrong_of_accepted``,
    ///     ``rejected``, ``good_lost``, ``wrong_before_filter``; ``age_ms`` with ``median`` and ``p99``; ``readings_per_s``;
    ///     ``starved``: how many sensors never had a reading accepted.
    ///
    /// Raises:
    ///     ArgumentError: the tolerance is negative or not a number.
    #[pyo3(signature = (tolerance_us=None), text_signature = "($self, tolerance_us=500.0)")]
    fn summary<'py>(&self, py: Python<'py>, tolerance_us: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        let tolerance_us = tolerance(tolerance_us)?;
        let summary = py.detach(|| self.0.summary_within(tolerance_us));
        let json = serde_json::to_string(&summary).map_err(|error| ArgumentError::new_err(error.to_string()))?;
        py.import("json")?.call_method1("loads", (json,))
    }

    /// All arrays, one entry for each reading, by their names: a dict.
    fn columns<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let columns = PyDict::new(slf.py());
        for name in COLUMNS {
            columns.set_item(name, slf.getattr(name)?)?;
        }
        Ok(columns)
    }

    /// All arrays as a ``pandas.DataFrame``.
    ///
    /// Raises:
    ///     ImportError: pandas is not installed.
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("pandas")?.call_method1("DataFrame", (Self::columns(slf)?,))
    }

    /// All arrays as a ``polars.DataFrame``.
    ///
    /// Raises:
    ///     ImportError: polars is not installed.
    fn to_polars<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("polars")?.call_method1("DataFrame", (Self::columns(slf)?,))
    }

    fn __repr__(&self) -> String {
        format!(
            "<Readings: {} of {} sensors, {}, {:.3} s>",
            self.0.len(),
            self.0.sensors,
            self.0.method,
            self.0.duration_s
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), &slf.get().0);
        let rebuild = py.import("eeruf._eeruf")?.getattr("_readings_from_columns")?;
        let (columns, paths) = (Self::columns(slf)?, slf.get().paths(py)?);
        Ok((rebuild, (this.method.as_str(), this.duration_s, this.sensors, columns, paths).into_pyobject(py)?))
    }
}

/// The arrays of equal length, one entry for each reading.
const COLUMNS: [&str; 12] = [
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
    "path",
    "emitted_s",
];

fn column<T: numpy::Element + Copy>(columns: &Bound<'_, PyDict>, name: &str) -> PyResult<Vec<T>> {
    let column = columns.as_any().get_item(name)?;
    let array: PyReadonlyArray1<'_, T> = column.extract().map_err(|_| wrong(name, &column, "a column of Readings"))?;
    Ok(array.as_array().iter().copied().collect())
}

fn heard_paths(columns: &Bound<'_, PyDict>) -> PyResult<Vec<HeardPath>> {
    let ends = |robot, sensor| -> PyResult<Vec<SensorId>> {
        let (robots, sensors): (Vec<u16>, Vec<u8>) = (column(columns, robot)?, column(columns, sensor)?);
        Ok(robots.into_iter().zip(sensors).map(|(robot, sensor)| SensorId { robot, sensor }).collect())
    };
    let walls: Vec<Vec<i64>> = columns.as_any().get_item("walls")?.extract()?;
    let (emitter, receiver) = (ends("emitter_robot", "emitter")?, ends("receiver_robot", "receiver")?);
    let (order, length_m): (Vec<u32>, Vec<f64>) = (column(columns, "order")?, column(columns, "length_m")?);
    let angles: (Vec<f64>, Vec<f64>) = (column(columns, "departure_rad")?, column(columns, "arrival_rad")?);
    let lengths = [emitter.len(), receiver.len(), order.len(), length_m.len(), angles.0.len(), angles.1.len()];
    equally_long(walls.len(), &lengths)?;
    let path = |path: usize| HeardPath {
        emitter: emitter[path],
        receiver: receiver[path],
        order: order[path],
        length_m: length_m[path],
        departure_rad: angles.0[path],
        arrival_rad: angles.1[path],
        bounces: walls[path].iter().map(|&code| bounce(code)).collect(),
    };
    Ok((0..walls.len()).map(path).collect())
}

fn equally_long(expected: usize, lengths: &[usize]) -> PyResult<()> {
    match lengths.iter().find(|&&length| length != expected) {
        Some(length) => Err(wrong("length of a column", length, expected)),
        None => Ok(()),
    }
}

/// Readings from their columns, as a pickle holds them.
#[pyfunction]
#[pyo3(name = "_readings_from_columns", signature = (method, duration_s, sensors, columns, paths))]
pub(crate) fn readings_from_columns(
    method: &Bound<'_, PyAny>,
    duration_s: f64,
    sensors: usize,
    columns: &Bound<'_, PyDict>,
    paths: &Bound<'_, PyDict>,
) -> PyResult<Readings> {
    let robot: Vec<u16> = column(columns, "robot")?;
    let code = |name, codes: usize| -> PyResult<Vec<usize>> {
        let values: Vec<u8> = column(columns, name)?;
        match values.iter().find(|&&value| usize::from(value) >= codes) {
            Some(value) => Err(wrong(name, value, format_args!("0 to {}", codes - 1))),
            None => Ok(values.into_iter().map(usize::from).collect()),
        }
    };
    let paths = heard_paths(paths)?;
    let path = |index: i64| match u32::try_from(index) {
        Ok(path) if (path as usize) < paths.len() => Ok(path),
        Err(_) if index == -1 => Ok(NO_PATH),
        _ => Err(wrong("path", index, format_args!("-1 to {}", paths.len() as i64 - 1))),
    };
    let path = column::<i64>(columns, "path")?.into_iter().map(path).collect::<PyResult<Vec<_>>>()?;
    let readings = eeruf_sim::Readings {
        method: self::method("method", method)?,
        duration_s,
        sensors,
        sensor: column(columns, "sensor")?,
        period: column(columns, "period")?,
        phase: column(columns, "phase")?,
        fired_s: column(columns, "fired_s")?,
        kind: code("kind", ReadingKind::ALL.len())?.into_iter().map(|kind| ReadingKind::ALL[kind]).collect(),
        t_echo_us: column(columns, "t_echo_us")?,
        earliest_us: column(columns, "earliest_us")?,
        reference_us: column(columns, "reference_us")?,
        cause: code("cause", CAUSES.len())?.into_iter().map(|cause| CAUSE_OF[cause]).collect(),
        emitted_s: column(columns, "emitted_s")?,
        path,
        paths,
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
        readings.path.len(),
        readings.emitted_s.len(),
    ];
    equally_long(readings.robot.len(), &lengths)?;
    Ok(Readings(readings))
}
