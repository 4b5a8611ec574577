//! `Paths`: arrays of equal length.

use std::sync::Arc;

use eeruf_sim::{Bounce, Limits, Physics, Point, Stop, Tracer, Transducer};
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::{
    prelude::*,
    types::{PyList, PyTuple},
};

use crate::{
    arguments::{shown, whole, wrong},
    columns::Columns,
    contents::Contents,
    errors::Raise,
    watch::in_background,
};

/// Every path from a source to some receivers: arrays of equal length, sorted by receiver and then by length. The
/// arrays are read-only.
///
/// Example:
///     >>> from eeruf import sim
///     >>> paths = sim.Scene([[5, 2, -5, 2]], physics="plain").paths((0, 0), [(3, 0)], max_order=1)
///     >>> len(paths), paths.walls
///     (2, [(), (0,)])
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Paths {
    paths: eeruf_sim::Paths,
    source: Point,
    receivers: Vec<Point>,
    contents: Arc<Contents>,
    /// The `Scene` that was asked.
    scene: Py<PyAny>,
    limits: Limits,
    columns: Columns<6>,
}

/// Up to so many walls and receivers, and so many bounces, paths are found sooner than a thread would start, and before
/// anybody could press Ctrl-C.
const FEW: usize = 32;
const LOW_ORDER: u32 = 6;

impl Paths {
    /// Finds all paths within limits under a physics, in the background where that may take long. Frequency and burst
    /// are those of the first robot's transducers, of a Polaroid 6500 where there is no robot.
    pub(crate) fn find(
        scene: &Bound<'_, PyAny>,
        contents: Arc<Contents>,
        physics: Physics,
        source: Point,
        receivers: Vec<Point>,
        limits: Limits,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (py, scene, max_order) = (scene.py(), scene.clone().unbind(), limits.max_order);
        let standing = contents.scene();
        let few = standing.walls().len() + standing.poles().len() <= FEW && receivers.len() <= FEW;
        let find = move |stop: Stop| {
            let robot = contents.world().and_then(|world| world.robots().first());
            let module = robot.map_or(Transducer::POLAROID_6500, |robot| robot.transducer);
            let (mut paths, mut tracer) = (eeruf_sim::Paths::default(), Tracer::at(module.frequency_hz));
            tracer.follow(&physics);
            tracer.burst_cycles = module.cycles;
            tracer.stop = stop;
            tracer.trace(contents.scene(), source, &receivers, limits, &mut paths).map_err(Raise::raise)?;
            Ok(Self { paths, source, receivers, contents, scene, limits, columns: Columns::default() })
        };
        if few && max_order <= LOW_ORDER && progress.is_none() {
            return py.detach(|| find(Stop::default()));
        }
        in_background(py, progress, move |background| {
            background.go_on(None, || format!("paths up to order {max_order}"));
            find(background.stop().clone())
        })
    }
}

/// The number of the first edge, beyond all walls.
const EDGES: i64 = 1 << 32;

/// A wall by its index, a pole by -1 minus its index, an edge by 2^32 plus its index.
pub(crate) fn coded(bounces: &[Bounce]) -> impl ExactSizeIterator<Item = i64> {
    bounces.iter().map(|bounce| match *bounce {
        Bounce::Wall(wall) => i64::from(wall),
        Bounce::Pole(pole) => -1 - i64::from(pole),
        Bounce::Edge(edge) => EDGES + i64::from(edge),
    })
}

/// What [`coded`] meant.
pub(crate) fn bounce(code: i64) -> Bounce {
    match code {
        ..0 => Bounce::Pole((-1 - code) as u32),
        0..EDGES => Bounce::Wall(code as u32),
        EDGES.. => Bounce::Edge((code - EDGES) as u32),
    }
}

#[pymethods]
impl Paths {
    fn __len__(&self) -> usize {
        self.paths.len()
    }

    /// The index of the receiver: int64.
    #[getter]
    fn receiver<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, 0, self.paths.receiver.iter().map(|&index| i64::from(index)))
    }

    /// The length in metres: float64.
    #[getter]
    fn length_m<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, 1, self.paths.length_m.iter().copied())
    }

    /// How many bounces, those at poles included: int64.
    #[getter]
    fn order<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, 2, self.paths.order.iter().map(|&index| i64::from(index)))
    }

    /// The direction in which the path leaves the source, in (-pi, pi]: float64.
    #[getter]
    fn departure_rad<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, 3, self.paths.departure_rad.iter().copied())
    }

    /// The direction in which the receiver looks to see it, in (-pi, pi]: float64.
    #[getter]
    fn arrival_rad<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, 4, self.paths.arrival_rad.iter().copied())
    }

    /// The amplitude relative to 1 m in free air, without the transducers' patterns: float64.
    #[getter]
    fn amplitude<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, 5, self.paths.amplitude.iter().copied())
    }

    /// For each path its bounces from source to receiver, a list of tuples: a wall by its index, a pole by -1 minus its
    /// index, an edge by 2^32 plus its index.
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
    ///     >>> wall = sim.Scene([[5, 2, -5, 2]], physics="plain")
    ///     >>> wall.paths((0, 0), (3, 0), max_order=1).points(1).tolist()
    ///     [[0.0, 0.0], [1.5, 2.0], [3.0, 0.0]]
    #[pyo3(signature = (path))]
    fn points<'py>(&self, path: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let py = path.py();
        let Some(last) = self.paths.len().checked_sub(1) else {
            return Err(wrong("path", shown(path), "no index where there are no paths"));
        };
        let path = whole("path", path, 0..=last as u64)? as usize;
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
        let arguments = ((this.source.x, this.source.y), receivers, this.limits.max_order, this.limits.max_length_m);
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
