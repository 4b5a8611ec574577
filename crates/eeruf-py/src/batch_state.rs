//! `typing.BatchState`: the state of a batch's worlds, as arrays.

use numpy::{Element, PyArray1};
use pyo3::{
    prelude::*,
    types::{IntoPyDict, PyTuple},
};

use crate::columns::arrays;

/// The latest accepted reading of a sensor, and counts of the last step.
#[derive(Clone, Copy)]
pub(crate) struct Known {
    pub(crate) t_echo_us: f64,
    pub(crate) fired_s: f64,
    pub(crate) is_clear: bool,
    pub(crate) is_wrong: bool,
    pub(crate) readings: i64,
    pub(crate) accepted: i64,
}

impl Known {
    pub(crate) const NOTHING: Self = Self {
        t_echo_us: f64::NAN,
        fired_s: f64::NEG_INFINITY,
        is_clear: false,
        is_wrong: false,
        readings: 0,
        accepted: 0,
    };
}

/// The worlds of a :class:`Batch` at one moment: arrays with a row for each world and, for sensor data, a column for
/// each sensor of its first robot. The arrays are read-only.
///
/// Example:
///     >>> from eeruf import experiments, sim
///     >>> state = sim.Batch(experiments.courses(0, 5)).step(0.6)
///     >>> state.pose.shape, state.age_s.shape, bool(state.touches.any())
///     ((5, 3), (5, 8), False)
#[pyclass(frozen, module = "eeruf.typing")]
pub(crate) struct BatchState {
    worlds: usize,
    sensors: usize,
    time_s: Vec<f64>,
    pose: Vec<f64>,
    touches: Vec<bool>,
    known: Vec<Known>,
}

impl BatchState {
    pub(crate) fn with_room(worlds: usize, sensors: usize) -> Self {
        let known = Vec::with_capacity(worlds * sensors);
        Self { worlds, sensors, time_s: Vec::new(), pose: Vec::new(), touches: Vec::new(), known }
    }

    /// Adds the next world.
    pub(crate) fn push(&mut self, time_s: f64, pose: [f64; 3], touches: bool, known: &[Known]) {
        self.time_s.push(time_s);
        self.pose.extend(pose);
        self.touches.push(touches);
        self.known.extend(known);
    }

    fn of_sensors<'py, T: Element>(&self, py: Python<'py>, of: impl Fn(&Known) -> T) -> PyResult<Bound<'py, PyAny>> {
        shaped(py, self.known.iter().map(of).collect(), (self.worlds, self.sensors))
    }
}

/// A read-only array.
fn shaped<'py, T: Element>(
    py: Python<'py>,
    values: Vec<T>,
    shape: impl IntoPyObject<'py, Target = PyTuple>,
) -> PyResult<Bound<'py, PyAny>> {
    let array = PyArray1::from_vec(py, values).call_method1("reshape", (shape,))?;
    array.call_method("setflags", (), Some(&[("write", false)].into_py_dict(py)?))?;
    Ok(array)
}

arrays! {
    BatchState {
        /// The time that has passed in each world, in seconds: float64.
        time_s: |this, py| shaped(py, this.time_s.clone(), (this.worlds,));
        /// Where the first robots are, x, y and heading in metres and radians: float64 of shape (worlds, 3).
        pose: |this, py| shaped(py, this.pose.clone(), (this.worlds, 3));
        /// True where the disc that holds the first robot's sensors touches a wall or a pole: bool.
        touches: |this, py| shaped(py, this.touches.clone(), (this.worlds,));
        /// Echo times of the latest accepted readings, in microseconds, NaN where there is none or nothing was in
        /// range: float64 of shape (worlds, sensors).
        t_echo_us: |this, py| this.of_sensors(py, |known| known.t_echo_us);
        /// Time since the latest accepted reading fired, in seconds, infinite where there is none: float64 of shape
        /// (worlds, sensors).
        age_s: |this, py| {
            let age = |(index, known): (usize, &Known)| this.time_s[index / this.sensors] - known.fired_s;
            shaped(py, this.known.iter().enumerate().map(age).collect(), (this.worlds, this.sensors))
        };
        /// True where the latest accepted reading says that nothing is in range: bool of shape (worlds, sensors).
        is_clear: |this, py| this.of_sensors(py, |known| known.is_clear);
        /// True where the latest accepted reading is wrong, as :meth:`Readings.is_wrong` judges: bool of shape
        /// (worlds, sensors).
        is_wrong: |this, py| this.of_sensors(py, |known| known.is_wrong);
        /// Number of readings in the last step: int64 of shape (worlds, sensors).
        readings: |this, py| this.of_sensors(py, |known| known.readings);
        /// Number of accepted readings in the last step: int64 of shape (worlds, sensors).
        accepted: |this, py| this.of_sensors(py, |known| known.accepted);
    }

    fn __len__(&self) -> usize {
        self.worlds
    }

    fn __repr__(&self) -> String {
        format!("<BatchState: {} worlds of {} sensors>", self.worlds, self.sensors)
    }
}
