//! `Paths`: arrays of equal length.

use eeruf_sim::{Bounce, Point};
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::{
    prelude::*,
    types::{PyList, PyTuple},
};

use crate::{arguments::whole, scene::Scene};

/// Every path from a source to some receivers.
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Paths {
    pub(crate) paths: eeruf_sim::Paths,
    pub(crate) source: Point,
    pub(crate) receivers: Vec<Point>,
    pub(crate) scene: Py<Scene>,
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

    #[getter]
    fn receiver<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.paths.receiver)
    }

    #[getter]
    fn length_m<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.paths.length_m)
    }

    #[getter]
    fn order<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u32>> {
        PyArray1::from_slice(py, &self.paths.order)
    }

    #[getter]
    fn departure_rad<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.paths.departure_rad)
    }

    #[getter]
    fn arrival_rad<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.paths.arrival_rad)
    }

    #[getter]
    fn amplitude<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, &self.paths.amplitude)
    }

    #[getter]
    fn walls<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let sequences = (0..self.paths.len()).map(|path| PyTuple::new(py, coded(self.paths.bounces(path))));
        PyList::new(py, sequences.collect::<PyResult<Vec<_>>>()?)
    }

    #[pyo3(signature = (path))]
    fn points<'py>(&self, path: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let py = path.py();
        let most = (self.paths.len() as u64).saturating_sub(1);
        let path = whole("path", path, 0..=most)? as usize;
        let receiver = self.paths.receiver.get(path).and_then(|&receiver| self.receivers.get(receiver as usize));
        let receiver = receiver.copied().unwrap_or(self.source);
        let scene = self.scene.get().scene();
        let corners = scene.polyline(self.source, receiver, self.paths.bounces(path)).unwrap_or_default();
        let flat: Vec<f64> = corners.iter().flat_map(|corner| [corner.x, corner.y]).collect();
        PyArray1::from_vec(py, flat).reshape([corners.len(), 2])
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
