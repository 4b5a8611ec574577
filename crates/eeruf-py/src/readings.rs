//! `Readings`: the result of `sim.simulate`, as arrays.

use eeruf_sim::NO_PATH;
use numpy::PyReadonlyArray1;
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{instance, items, number_or, shown, wrong},
    columns::{Codes, Columns, arrays, read_only},
    errors::EerufError,
    fields::attributes,
    paths::coded,
};

/// The names of causes by their codes.
pub(crate) const CAUSES: [&str; 5] = ["nothing", "own", "stale", "crosstalk", "external"];

/// Every reading of a simulation: arrays of equal length, in the order in which the rings emitted them. Readings
/// pickle.
///
/// Each reading comes with its cause and with the reading that the sensor would have had alone. Times without a value
/// are NaN. The arrays are read-only.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
///     >>> len(readings), readings.summary().wrong_of_all < 0.01
///     (800, True)
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Readings {
    pub(crate) readings: eeruf_sim::Readings,
    columns: Columns<17>,
}

fn tolerance(value: Option<&Bound<'_, PyAny>>) -> PyResult<f64> {
    number_or("tolerance_us", value, eeruf_sim::DEFAULT_TOLERANCE_US, 0.0..=f64::INFINITY)
}

impl Readings {
    pub(crate) fn new(readings: eeruf_sim::Readings) -> Self {
        Self { readings, columns: Columns::default() }
    }
}

arrays! {
    Readings {
        /// The robot, from 0: int64.
        robot: |this, py| this.columns.get(py, 0, this.readings.robot.iter().map(|&robot| i64::from(robot)));
        /// The sensor on its ring, from 0: int64.
        sensor: |this, py| this.columns.get(py, 1, this.readings.sensor.iter().map(|&sensor| i64::from(sensor)));
        /// The period of the firing, from 0: int64.
        period: |this, py| this.columns.get(py, 2, this.readings.period.iter().map(|&period| i64::from(period)));
        /// The phase of the firing, 0 for a and 1 for b: int64.
        phase: |this, py| this.columns.get(py, 3, this.readings.phase.iter().map(|&phase| i64::from(phase)));
        /// Time of the firing, in seconds: float64.
        fired_s: |this, py| this.columns.get(py, 4, this.readings.fired_s.iter().copied());
        /// Where the sensor stood when it fired, in metres of the scene: float64.
        x_m: |this, py| this.columns.get(py, 13, this.readings.x_m.iter().copied());
        /// Where the sensor stood when it fired, in metres of the scene: float64.
        y_m: |this, py| this.columns.get(py, 14, this.readings.y_m.iter().copied());
        /// The sensor's heading when it fired, in radians of the scene, counter-clockwise from the x axis: float64.
        heading_rad: |this, py| this.columns.get(py, 15, this.readings.heading_rad.iter().copied());
        /// Verdict of the method, an index into ``eeruf.KINDS``: int8.
        kind: |this, py| this.columns.codes(py, 5, Codes::Kinds, this.readings.kind.iter().map(|&kind| kind as i8));
        /// The echo time that the method reports, in microseconds: float64.
        t_echo_us: |this, py| this.columns.get(py, 6, this.readings.t_echo_us.iter().copied());
        /// The earliest echo of the firing, in microseconds: float64.
        earliest_us: |this, py| this.columns.get(py, 7, this.readings.earliest_us.iter().copied());
        /// The reading that the sensor would have had alone in quiet air, in microseconds: float64.
        reference_us: |this, py| this.columns.get(py, 8, this.readings.reference_us.iter().copied());
        /// Cause of ``t_echo_us``, an index into ``CAUSES``: int8.
        cause: |this, py| {
            this.columns.codes(py, 9, Codes::Causes, this.readings.cause.iter().map(|&cause| cause as i8))
        };
        /// The index in ``paths`` of the sound's path, or -1 for none: int64.
        path: |this, py| {
            let index = |&path: &u32| if path == NO_PATH { -1 } else { i64::from(path) };
            this.columns.get(py, 10, this.readings.path.iter().map(index))
        };
        /// Time when the sound behind ``t_echo_us`` was sent, in seconds: float64.
        emitted_s: |this, py| this.columns.get(py, 11, this.readings.emitted_s.iter().copied());
        /// The change that odometry expects since the sensor's previous firing, in microseconds; 0 without odometry:
        /// int32.
        expected_change_us: |this, py| this.columns.get(py, 16, this.readings.expected_change_us.iter().copied());
        /// Returns true if the method accepts the reading, an echo or that nothing is in range: bool.
        is_accepted: |this, py| {
            this.columns.get(py, 12, (0..this.readings.len()).map(|reading| this.readings.is_accepted(reading)))
        };
    }

    fn __len__(&self) -> usize {
        self.readings.len()
    }

    /// The simulated method, one of ``METHODS``.
    #[getter]
    fn method(&self) -> &'static str {
        self.readings.method.as_str()
    }

    /// Duration, in seconds.
    #[getter]
    fn duration_s(&self) -> f64 {
        self.readings.duration_s
    }

    /// Number of sensors in the scene, over all robots.
    #[getter]
    fn sensors(&self) -> usize {
        self.readings.sensors
    }

    /// The paths of all readings: a dict of arrays of equal length.
    ///
    /// ``emitter_robot``, ``emitter``, ``receiver_robot``, ``receiver`` count from 0; ``order`` is the number of
    /// bounces; ``length_m``, ``departure_rad`` and ``arrival_rad`` are in metres and radians of the scene; ``walls``
    /// is a list of tuples as in ``Paths``.
    #[getter]
    fn paths<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (columns, paths) = (PyDict::new(py), &self.readings.paths);
        columns.set_item("emitter_robot", read_only(py, paths.iter().map(|path| i64::from(path.emitter.robot)))?)?;
        columns.set_item("emitter", read_only(py, paths.iter().map(|path| i64::from(path.emitter.sensor)))?)?;
        columns.set_item("receiver_robot", read_only(py, paths.iter().map(|path| i64::from(path.receiver.robot)))?)?;
        columns.set_item("receiver", read_only(py, paths.iter().map(|path| i64::from(path.receiver.sensor)))?)?;
        columns.set_item("order", read_only(py, paths.iter().map(|path| i64::from(path.order)))?)?;
        columns.set_item("length_m", read_only(py, paths.iter().map(|path| path.length_m))?)?;
        columns.set_item("departure_rad", read_only(py, paths.iter().map(|path| path.departure_rad))?)?;
        columns.set_item("arrival_rad", read_only(py, paths.iter().map(|path| path.arrival_rad))?)?;
        let walls = paths.iter().map(|path| PyTuple::new(py, coded(&path.bounces)));
        columns.set_item("walls", walls.collect::<PyResult<Vec<_>>>()?)?;
        Ok(columns)
    }

    /// Returns true if the reading, if accepted, would be wrong.
    ///
    /// Args:
    ///     tolerance_us: largest difference from the reference, in microseconds.
    ///
    /// Returns:
    ///     Array of bool, true for these.
    ///
    /// Raises:
    ///     EerufError: the tolerance is negative or not a number.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
    ///     >>> int(readings.is_wrong(tolerance_us=1e6).sum()) <= int(readings.is_wrong().sum())
    ///     True
    #[pyo3(signature = (tolerance_us=None), text_signature = "($self, tolerance_us=500.0)")]
    fn is_wrong<'py>(&self, py: Python<'py>, tolerance_us: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        let tolerance_us = tolerance(tolerance_us)?;
        read_only(py, (0..self.readings.len()).map(|reading| self.readings.is_wrong(reading, tolerance_us)))
    }

    /// The figures that are always reported together.
    ///
    /// Args:
    ///     tolerance_us: largest difference of a reading from the reference, in microseconds.
    ///
    /// Returns:
    ///     A ``Summary``.
    ///
    /// Raises:
    ///     EerufError: the tolerance is negative or not a number.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
    ///     >>> readings.summary().readings, readings.summary().wrong_of_all < 0.01
    ///     (800, True)
    #[pyo3(signature = (tolerance_us=None), text_signature = "($self, tolerance_us=500.0)")]
    fn summary<'py>(&self, py: Python<'py>, tolerance_us: Option<&Bound<'py, PyAny>>) -> PyResult<Bound<'py, PyAny>> {
        let tolerance_us = tolerance(tolerance_us)?;
        let summary = py.detach(|| self.readings.summary_within(tolerance_us));
        let json = serde_json::to_string(&summary).map_err(|error| EerufError::new_err(error.to_string()))?;
        py.import("eeruf._making")?.call_method1("summary", (json,))
    }

    /// All arrays, one entry for each reading, by their names: a dict.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
    ///     >>> readings.columns()["t_echo_us"] is readings.t_echo_us
    ///     True
    fn columns<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        attributes(slf, &COLUMNS)
    }

    /// All arrays as a ``pandas.DataFrame``: ``kind`` and ``cause`` are categoricals with their names, ``path`` is null
    /// where there is none, and times without a value are NaN.
    ///
    /// Raises:
    ///     ImportError: pandas is not installed.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
    ///     >>> readings.to_pandas()["kind"].dtype.name
    ///     'category'
    fn to_pandas<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("eeruf._frames")?.call_method1("to_pandas", (Self::columns(slf)?,))
    }

    /// All arrays as a ``polars.DataFrame``: ``kind`` and ``cause`` are enums with their names, and missing values
    /// are null.
    ///
    /// Raises:
    ///     ImportError: polars is not installed.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
    ///     >>> readings.to_polars().columns[:3]
    ///     ['robot', 'sensor', 'period']
    fn to_polars<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("eeruf._frames")?.call_method1("to_polars", (Self::columns(slf)?,))
    }

    /// Readings as an Arrow stream, for polars, pyarrow, DuckDB and others.
    ///
    /// Raises:
    ///     ImportError: polars is not installed.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        slf: &Bound<'py, Self>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        Self::to_polars(slf)?.call_method1("__arrow_c_stream__", (requested_schema,))
    }

    /// Write everything into one file, which :meth:`load` reads again.
    ///
    /// Args:
    ///     file: its path; NumPy's format ``.npz``, compressed.
    ///
    /// Raises:
    ///     OSError: the file cannot be written.
    ///
    /// Example:
    ///     >>> import io
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
    ///     >>> file = io.BytesIO()
    ///     >>> readings.save(file)
    ///     >>> _ = file.seek(0)
    ///     >>> sim.Readings.load(file).summary() == readings.summary()
    ///     True
    fn save<'py>(slf: &Bound<'py, Self>, file: &Bound<'py, PyAny>) -> PyResult<()> {
        let py = slf.py();
        let this = &slf.get().readings;
        let about = (this.method.as_str(), this.duration_s, this.sensors);
        let columns = Self::columns(slf)?;
        let paths = slf.get().paths(py)?;
        py.import("eeruf._frames")?.call_method1("save", (file, about, columns, paths)).map(drop)
    }

    /// Read readings that :meth:`save` wrote.
    ///
    /// Args:
    ///     file: its path.
    ///
    /// Raises:
    ///     OSError: the file cannot be read.
    ///     EerufError: the file holds no readings.
    ///
    /// Example:
    ///     >>> import pathlib, tempfile
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> file = pathlib.Path(tempfile.mkdtemp(), "readings.npz")
    ///     >>> sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100).save(file)
    ///     >>> len(sim.Readings.load(file))
    ///     800
    #[staticmethod]
    fn load<'py>(file: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        file.py().import("eeruf._frames")?.call_method1("load", (file,))
    }

    /// Join readings of consecutive steps or blocks, or of several robots' logs; durations add up.
    ///
    /// Args:
    ///     parts: readings of one method, all with the same number of sensors.
    ///
    /// Raises:
    ///     EerufError: not readings, or readings of different methods or numbers of sensors.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
    ///     >>> blocks = sim.simulate_blocks(scene, periods=100, block_periods=30)
    ///     >>> sim.Readings.concat(blocks).summary() == sim.simulate(scene, periods=100).summary()
    ///     True
    #[staticmethod]
    fn concat(parts: &Bound<'_, PyAny>) -> PyResult<Self> {
        let expected = "several eeruf.sim.Readings, one or more";
        let parts = items("parts", parts, expected)?;
        let each = parts.iter().map(|part| instance::<Self>("parts", part, expected).map(|part| &part.get().readings));
        let each = each.collect::<PyResult<Vec<_>>>()?;
        for (place, part) in each.iter().enumerate() {
            let (of, first) = ((part.method, part.sensors), (each[0].method, each[0].sensors));
            if of != first {
                let shown = |(method, sensors)| format!("{method} of {sensors} sensors");
                return Err(wrong(
                    &format!("parts[{place}]"),
                    shown(of),
                    format_args!("{}, as the first", shown(first)),
                ));
            }
        }
        let all = eeruf_sim::Readings::concat(&each).ok_or_else(|| wrong("parts", "[]", expected))?;
        Ok(Self::new(all))
    }

    /// Make readings from your own arrays, such as those of a drive, to summarize and save them.
    ///
    /// Args:
    ///     sensor: the sensor of each reading, from 0; the other arrays have the same length.
    ///     fired_s: the time of each firing, in seconds, in order.
    ///     t_echo_us: the echo times, NaN for none.
    ///     kind: the verdicts, indices into ``eeruf.KINDS``; by default echoes are accepted and silence is clear.
    ///     reference_us: the readings of the sensor alone; by default ``t_echo_us``, as if all readings were right.
    ///     duration_s: the duration; by default up to the last firing.
    ///     sensors: the number of sensors; by default one more than the highest index.
    ///     method: the method to record for them, one of ``METHODS``.
    ///     columns: other columns of :meth:`columns`, by name.
    ///
    /// Raises:
    ///     EerufError: an unknown column, arrays of different lengths, or values out of range.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> found = sim.Readings.from_arrays([0, 1, 0], [0.0, 0.03, 0.06], [9_000, float("nan"), 9_040])
    ///     >>> found.is_accepted.tolist(), found.sensors, found.summary().wrong_of_all
    ///     ([True, True, True], 2, 0.0)
    #[staticmethod]
    #[pyo3(signature = (sensor, fired_s, t_echo_us, *, kind=None, reference_us=None, duration_s=None, sensors=None,
        method=None, **columns))]
    #[pyo3(text_signature = "(sensor, fired_s, t_echo_us, *, kind=None, reference_us=None, duration_s=None, \
        sensors=None, method=\"eeruf\", **columns)")]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn from_arrays<'py>(
        sensor: &Bound<'py, PyAny>,
        fired_s: &Bound<'py, PyAny>,
        t_echo_us: &Bound<'py, PyAny>,
        kind: Option<&Bound<'py, PyAny>>,
        reference_us: Option<&Bound<'py, PyAny>>,
        duration_s: Option<&Bound<'py, PyAny>>,
        sensors: Option<&Bound<'py, PyAny>>,
        method: Option<&Bound<'py, PyAny>>,
        columns: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let given = (sensor, fired_s, t_echo_us, kind, reference_us, duration_s, sensors, method, columns);
        sensor.py().import("eeruf._frames")?.call_method1("from_arrays", given)
    }

    /// All arrays as an ``xarray.Dataset`` along ``reading``, with method, duration and sensors as attributes.
    ///
    /// Raises:
    ///     ImportError: xarray is not installed.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> readings = sim.simulate(sim.Scene([[5, 2, -5, 2]], robots=[robot]), periods=100)
    ///     >>> readings.to_xarray().sizes["reading"]
    ///     800
    fn to_xarray<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let this = &slf.get().readings;
        let about = (this.method.as_str(), this.duration_s, this.sensors);
        slf.py().import("eeruf._frames")?.call_method1("to_xarray", (Self::columns(slf)?, about))
    }

    /// Some of the readings, chosen by a slice, a mask or an array of indices. Duration and sensors are unchanged.
    fn __getitem__(&self, key: &Bound<'_, PyAny>) -> PyResult<Self> {
        let refused = || wrong("readings[..]", shown(key), "a slice, a mask of as many bools, or an array of indices");
        let all = key.py().import("numpy")?.call_method1("arange", (self.readings.len(),))?;
        let chosen = all.get_item(key).map_err(|_| refused())?;
        let places: PyReadonlyArray1<'_, i64> = chosen.extract().map_err(|_| refused())?;
        let places: Vec<usize> = places.as_array().iter().map(|&place| place as usize).collect();
        Ok(Self::new(self.readings.select(&places)))
    }

    fn __repr__(&self) -> String {
        format!(
            "<Readings: {} of {} sensors, {}, {:.3} s>",
            self.readings.len(),
            self.readings.sensors,
            self.readings.method,
            self.readings.duration_s
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), &slf.get().readings);
        let rebuild = py.import("eeruf._eeruf")?.getattr("_readings_from_columns")?;
        let (columns, paths) = (Self::columns(slf)?, slf.get().paths(py)?);
        Ok((rebuild, (this.method.as_str(), this.duration_s, this.sensors, columns, paths).into_pyobject(py)?))
    }
}

/// The arrays of equal length, one entry for each reading.
#[rustfmt::skip]
const COLUMNS: [&str; 16] = [
    "robot", "sensor", "period", "phase", "fired_s", "x_m", "y_m", "heading_rad", "kind", "t_echo_us", "earliest_us",
    "reference_us", "cause", "path", "emitted_s", "expected_change_us",
];
