//! `Paths`: arrays of equal length.

use std::sync::Arc;

use eeruf_sim::{Bounce, Point};
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::{
    prelude::*,
    types::{PyList, PyTuple},
};

use crate::{arguments::whole, contents::Contents};

/// Every path from a source to some receivers: arrays of equal length, sorted by receiver and then by length. The
/// arrays are copies.
///
/// Example:
///     >>> from eeruf import sim
///     >>> paths = sim.Scene([[5, 2, -5, 2]]).paths((0, 0), [(3, 0)], max_order=1)
///     >>> len(paths), paths.walls
///     (2, [(), (0,)])
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Paths {
    pub(crate) paths: eeruf_sim::Paths,
    pub(crate) source: Point,
    pub(crate) receivers: Vec<Point>,
    pub(crate) contents: Arc<Contents>,
    /// The `Scene` that was asked.
    pub(crate) scene: Py<PyAny>,
    pub(crate) max_order: u32,
    pub(crate) max_length_m: f64,
}

/// A wall by its index, a pole by -1 minus its index.
pub(crate) fn coded(bounces: &[Bounce]) -> impl ExactSizeIterator<Item = i64> {
    bounces.iter().map(|bounce| match *bounce {
        Bounce::Wall(wall) => i64::from(wall),
        Bounce::Pole(pole) => -1 - i64::from(pole),
    })
}

/// What [`coded`] meant.
pub(crate) fn bounce(code: i64) -> Bounce {
    if code < 0 { Bounce::Pole((-1 - code) as u32) } else { Bounce::Wall(code as u32) }
}

#[pymethods]
impl Paths {
    fn __len__(&self) -> usize {
        self.paths.len()
    }

    /// The index of the receiver: uint32.
    #[getter]
    fn receiver<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.paths.receiver)
    }

    /// The length in metres: float64.
    #[getter]
    fn length_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.paths.length_m)
    }

    /// How many bounces, those at poles included: uint32.
    #[getter]
    fn order<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.paths.order)
    }

    /// The direction in which the path leaves the source, in (-pi, pi]: float64.
    #[getter]
    fn departure_rad<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.paths.departure_rad)
    }

    /// The direction in which the receiver looks to see it, in (-pi, pi]: float64.
    #[getter]
    fn arrival_rad<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.paths.arrival_rad)
    }

    /// The amplitude relative to 1 m in free air, without the transducers' patterns: float64.
    #[getter]
    fn amplitude<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.paths.amplitude)
    }

    /// For each path its bounces from source to receiver, a list of tuples: a wall by its index, a pole by -1 minus its
    /// index.
    #[getter]
    fn walls<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let sequences = (0..self.paths.len()).map(|path| PyTuple::new(py, coded(self.paths.bounces(path))));
        PyList::new(py, sequences.collect::<PyResult<Vec<_>>>()?)
    }

    /// The corners of a path, from source to receiver.
    ///
    /// Args:
    ///     path: which one, from 0.
    ///
    /// Returns:
    ///     Array of shape (order + 2, 2), in metres.
    ///
    /// Raises:
    ///     ArgumentError: no such path.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> sim.Scene([[5, 2, -5, 2]]).paths((0, 0), (3, 0), max_order=1).points(1).tolist()
    ///     [[0.0, 0.0], [1.5, 2.0], [3.0, 0.0]]
    #[pyo3(signature = (path))]
    fn points<'py>(&self, path: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let py = path.py();
        let most = (self.paths.len() as u64).saturating_sub(1);
        let path = whole("path", path, 0..=most)? as usize;
        let receiver = self.paths.receiver.get(path).and_then(|&receiver| self.receivers.get(receiver as usize));
        let receiver = receiver.copied().unwrap_or(self.source);
        let scene = self.contents.scene();
        let corners = scene.bounce_points(self.source, receiver, self.paths.bounces(path)).unwrap_or_default();
        let flat: Vec<f64> = corners.iter().flat_map(|corner| [corner.x, corner.y]).collect();
        PyArray1::from_vec(py, flat).reshape([corners.len(), 2])
    }

    /// Found again: that is exact, and mostly faster than carrying all of them.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        let receivers: Vec<(f64, f64)> = this.receivers.iter().map(|at| (at.x, at.y)).collect();
        let arguments = ((this.source.x, this.source.y), receivers, this.max_order, this.max_length_m);
        Ok((this.scene.bind(py).getattr("paths")?, arguments.into_pyobject(py)?))
    }

    fn __repr__(&self) -> String {
        format!(
            "<Paths: {} from ({}, {}) to {} receivers>",
            self.paths.len(),
            self.source.x,
            self.source.y,
            self.receivers.len()
        )
    }
}
