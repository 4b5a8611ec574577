//! `Paths`: arrays of equal length.

use std::sync::Arc;

use eeruf_sim::{Bounce, Heights, Limits, Physics, Point, Stop, Tracer, Transducer};
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::{
    prelude::*,
    types::{PyList, PyTuple},
};

use crate::{
    arguments::{shown, whole, wrong},
    columns::{Columns, arrays},
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
#[pyclass(frozen, module = "eeruf.typing")]
pub(crate) struct Paths {
    paths: eeruf_sim::Paths,
    ends: Ends,
    contents: Arc<Contents>,
    /// The `Scene` in which the paths were found.
    scene: Py<PyAny>,
    limits: Limits,
    columns: Columns<8>,
}

/// A source and receivers, with their heights, which are used only in a scene that is not flat.
pub(crate) struct Ends {
    pub(crate) source: Point,
    pub(crate) source_m: f64,
    pub(crate) receivers: Vec<Point>,
    pub(crate) receivers_m: Vec<f64>,
}

/// Numbers of walls and receivers, and of bounces, up to which finding paths is faster than starting a thread.
const FEW: usize = 32;
const LOW_ORDER: u32 = 6;

impl Paths {
    /// Finds all paths within limits under a physics, in the background if that may take long. Frequency and burst are
    /// taken from the first robot's transducers, or a Polaroid 6500 if there is no robot.
    pub(crate) fn find(
        scene: &Bound<'_, PyAny>,
        contents: Arc<Contents>,
        physics: Physics,
        ends: Ends,
        limits: Limits,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let (py, scene, max_order) = (scene.py(), scene.clone().unbind(), limits.max_order);
        let standing = contents.scene();
        let few = standing.walls().len() + standing.poles().len() <= FEW && ends.receivers.len() <= FEW;
        let find = move |stop: Stop| {
            let robot = contents.world().and_then(|world| world.robots().first());
            let module = robot.map_or(Transducer::POLAROID_6500, |robot| robot.transducer);
            let mut paths = eeruf_sim::Paths::default();
            // If another thread uses the tracer, this one makes its own.
            let (mut kept, mut own) = (contents.tracer.try_lock(), Tracer::new());
            let tracer = kept.as_deref_mut().unwrap_or(&mut own);
            tracer.frequency_hz = module.frequency_hz;
            tracer.follow(&physics);
            tracer.burst_cycles = module.cycles;
            tracer.stop = stop;
            let Ends { source, source_m, receivers, receivers_m } = &ends;
            let heights = Heights { source_m: *source_m, receivers_m };
            let traced = tracer.trace_at(contents.scene(), *source, receivers, heights, limits, &mut paths);
            traced.map_err(Raise::raise)?;
            drop(kept);
            Ok(Self { paths, ends, contents, scene, limits, columns: Columns::default() })
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

/// The number of each bounce, see [`Bounce::number`].
pub(crate) fn coded(bounces: &[Bounce]) -> impl ExactSizeIterator<Item = i64> {
    bounces.iter().map(|bounce| bounce.number())
}

arrays! {
    Paths {
        /// The index of the receiver: int64.
        receiver: |this, py| this.columns.get(py, 0, this.paths.receiver.iter().map(|&index| i64::from(index)));
        /// The length in metres: float64.
        length_m: |this, py| this.columns.get(py, 1, this.paths.length_m.iter().copied());
        /// Number of bounces, those at poles included: int64.
        order: |this, py| this.columns.get(py, 2, this.paths.order.iter().map(|&index| i64::from(index)));
        /// The direction from the receiver to the path's last bounce, in (-pi, pi]: float64.
        departure_rad: |this, py| this.columns.get(py, 3, this.paths.departure_rad.iter().copied());
        /// The direction in which the receiver sees the path, in (-pi, pi]: float64.
        arrival_rad: |this, py| this.columns.get(py, 4, this.paths.arrival_rad.iter().copied());
        /// The amplitude relative to 1 m in free air, without the transducers' patterns: float64.
        amplitude: |this, py| this.columns.get(py, 5, this.paths.amplitude.iter().copied());
        /// The elevation at which the path leaves the source, in radians, upwards positive; 0 in a flat scene: float64.
        departure_elevation_rad: |this, py| {
            this.columns.get(py, 6, (0..this.paths.len()).map(|path| this.paths.elevations_rad(path)[0]))
        };
        /// The elevation in which the receiver sees it, in radians, upwards positive; 0 in a flat scene: float64.
        arrival_elevation_rad: |this, py| {
            this.columns.get(py, 7, (0..this.paths.len()).map(|path| this.paths.elevations_rad(path)[1]))
        };
    }

    fn __len__(&self) -> usize {
        self.paths.len()
    }

    /// For each path its bounces from source to receiver, a list of tuples: a wall by its index, a pole by -1 minus its
    /// index, an edge by 2^32 plus its index, the floor by 2^33 and the ceiling by one more. Bounces at floor and
    /// ceiling come last, in their own order.
    #[getter]
    fn walls<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyList>> {
        let sequences = (0..self.paths.len()).map(|path| PyTuple::new(py, coded(self.paths.bounces(path))));
        PyList::new(py, sequences.collect::<PyResult<Vec<_>>>()?)
    }

    /// The corners of a path in the plan, from source to receiver, without those at floor and ceiling.
    ///
    /// Args:
    ///     path: its index, from 0.
    ///
    /// Returns:
    ///     Array of shape (n, 2), in metres; n is ``order + 2`` in a flat scene.
    ///
    /// Raises:
    ///     EerufError: an invalid path.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> wall = sim.Scene([[5, 2, -5, 2]], physics="plain")
    ///     >>> wall.paths((0, 0), (3, 0), max_order=1).points(1).tolist()
    ///     [[0.0, 0.0], [1.5, 2.0], [3.0, 0.0]]
    fn points<'py>(&self, path: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let py = path.py();
        let Some(last) = self.paths.len().checked_sub(1) else {
            return Err(wrong("path", shown(path), "no index where there are no paths"));
        };
        let path = whole("path", path, 0..=last as u64)? as usize;
        let receiver = self.paths.receiver.get(path).and_then(|&receiver| self.ends.receivers.get(receiver as usize));
        let receiver = receiver.copied().unwrap_or(self.ends.source);
        let scene = self.contents.scene();
        let corners = scene.bounce_points(self.ends.source, receiver, self.paths.bounces(path)).unwrap_or_default();
        let flat: Vec<f64> = corners.iter().flat_map(|corner| [corner.x, corner.y]).collect();
        PyArray1::from_vec(py, flat).reshape([corners.len(), 2])
    }

    /// Unpickling finds the paths again, which is exact and mostly faster than storing all of them.
    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let (py, this) = (slf.py(), slf.get());
        let in_room = this.contents.scene().room().is_some();
        let place = |at: &Point, height_m: f64| if in_room { vec![at.x, at.y, height_m] } else { vec![at.x, at.y] };
        let Ends { source, source_m, receivers, receivers_m } = &this.ends;
        let each: Vec<_> = receivers.iter().zip(receivers_m).map(|(at, &height_m)| place(at, height_m)).collect();
        let arguments = (place(source, *source_m), each, this.limits.max_order, this.limits.max_length_m);
        Ok((this.scene.bind(py).getattr("paths")?, arguments.into_pyobject(py)?))
    }

    fn __repr__(&self) -> String {
        format!(
            "<Paths: {} from ({}, {}) to {} receivers>",
            self.paths.len(),
            self.ends.source.x,
            self.ends.source.y,
            self.ends.receivers.len()
        )
    }
}
