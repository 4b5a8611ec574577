//! `sim.Scene`: walls and poles, and the robots among them if there are any.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eeruf_sim::{Air, Faces, Limits, Noise, Point, Pole, Stop, Tracer, Wall, World};
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{self, instance, matrix, number, points, shown, whole, whole_or, wrong},
    contents::Contents,
    errors::{Raise, SceneError},
    paths::Paths,
    robot::Robot,
    watch::in_background,
};

/// Up to so many walls and receivers, and so many bounces, paths are found sooner than a thread would start, and before
/// anybody could press Ctrl-C.
const FEW: usize = 32;
const LOW_ORDER: u32 = 6;

/// How a scene was made: what it takes to make it again.
enum Source {
    Toml { file: PathBuf, text: String },
    Code(Py<PyDict>),
}

/// Walls, poles and robots from above, in metres. Immutable; scenes pickle.
///
/// A wall reflects on its left side, seen from its first end to its second, and its back swallows: a room is a loop
/// walked counter-clockwise, a pillar one walked clockwise.
///
/// Args:
///     walls: array of shape (n, 4): x, y of one end and x, y of the other.
///     open: indices of openings, from which nothing comes back.
///     two_sided: indices of walls that reflect on both sides.
///     poles: array of shape (m, 3): x, y and radius.
///     temperature_c: of the air, in degrees Celsius, -100 to 100; the speed of sound depends on it.
///     robots: the robots that :func:`simulate` drives.
///     noise: whether :func:`simulate` has jitter, fading and bursts from outside.
///     seed: of the noise, 0 to 2^64 - 1.
///     max_order: how many bounces :func:`simulate` follows; 6 unless it is given.
///
/// Raises:
///     ArgumentError: an array of the wrong shape, an index of no wall, something of the wrong type or out of range.
///     SceneError: walls that cross, have no length or are not finite, or a robot where none can stand.
///
/// Example:
///     >>> from eeruf import sim
///     >>> scene = sim.Scene([[0.85, 0, 0.85, 1.39], [0.85, 1.39, -0.85, 1.39], [-0.85, 1.39, -0.85, 0]])
///     >>> scene
///     <Scene: 3 walls, 0 poles, 0 robots>
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Scene {
    contents: Arc<Contents>,
    source: Source,
}

impl Scene {
    fn scene(&self) -> &eeruf_sim::Scene {
        self.contents.scene()
    }

    pub(crate) fn world(&self) -> PyResult<&Arc<World>> {
        self.contents.world().ok_or_else(|| SceneError::new_err("a scene of 0 robots; expected 1 or more to simulate"))
    }

    fn from_source(file: PathBuf, text: String) -> PyResult<Self> {
        let world = World::from_text(&file, &text).map_err(Raise::raise)?;
        // Whoever unpickles it may not have the files beside it.
        let text = with_schedules(&file, &text).unwrap_or(text);
        Ok(Self { contents: Arc::new(Contents::World(Arc::new(world))), source: Source::Toml { file, text } })
    }
}

/// The text of a scene with the schedules in it that it names; `None` if it names none.
fn with_schedules(file: &Path, text: &str) -> Option<String> {
    let mut scene: toml::Table = text.parse().ok()?;
    let mut named = false;
    for robot in scene.get_mut("robot")?.as_array_mut()? {
        let schedule = robot.get_mut("schedule");
        if let Some((value, name)) =
            schedule.and_then(|value| value.as_str().map(str::to_owned).map(|name| (value, name)))
        {
            let beside = file.parent().unwrap_or(Path::new("")).join(name);
            *value = toml::Value::Table(std::fs::read_to_string(beside).ok()?.parse().ok()?);
            named = true;
        }
    }
    named.then(|| scene.to_string())
}

/// A scene from the text of a file, as a pickle holds it.
#[pyfunction]
#[pyo3(name = "_scene_from_text", signature = (file, text))]
pub(crate) fn scene_from_text(file: PathBuf, text: String) -> PyResult<Scene> {
    Scene::from_source(file, text)
}

fn indices(name: &str, value: Option<&Bound<'_, PyAny>>, walls: usize) -> PyResult<Vec<usize>> {
    let Some(value) = value else { return Ok(vec![]) };
    let items = arguments::items(name, value, "a sequence of indices of walls")?;
    match (walls as u64).checked_sub(1) {
        None if items.is_empty() => Ok(vec![]),
        None => Err(wrong(name, shown(value), "no indices where there are no walls")),
        Some(last) => items.iter().map(|item| whole(name, item, 0..=last).map(|index| index as usize)).collect(),
    }
}

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (
        walls, open=None, two_sided=None, poles=None, *, temperature_c=None, robots=None, noise=None, seed=None,
        max_order=None
    ))]
    #[pyo3(text_signature = "(walls, open=None, two_sided=None, poles=None, *, temperature_c=20.0, robots=(), \
            noise=True, seed=1, max_order=6)")]
    #[expect(clippy::too_many_arguments, reason = "keyword arguments")]
    fn new(
        py: Python<'_>,
        walls: &Bound<'_, PyAny>,
        open: Option<&Bound<'_, PyAny>>,
        two_sided: Option<&Bound<'_, PyAny>>,
        poles: Option<&Bound<'_, PyAny>>,
        temperature_c: Option<&Bound<'_, PyAny>>,
        robots: Option<&Bound<'_, PyAny>>,
        noise: Option<&Bound<'_, PyAny>>,
        seed: Option<&Bound<'_, PyAny>>,
        max_order: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let made_of = PyDict::new(py);
        let rows = matrix("walls", walls, 4)?;
        made_of.set_item("walls", PyArray2::from_array(py, &rows.as_array()))?;
        let mut built_walls: Vec<_> =
            rows.as_array().rows().into_iter().map(|row| Wall::new(row[0], row[1], row[2], row[3])).collect();
        for (name, which, faces) in [("open", open, Faces::Open), ("two_sided", two_sided, Faces::Both)] {
            let indices = indices(name, which, built_walls.len())?;
            made_of.set_item(name, &indices)?;
            for index in indices {
                built_walls[index].faces = faces;
            }
        }
        let mut built_poles = vec![];
        if let Some(poles) = poles {
            let rows = matrix("poles", poles, 3)?;
            made_of.set_item("poles", PyArray2::from_array(py, &rows.as_array()))?;
            built_poles.extend(rows.as_array().rows().into_iter().map(|row| Pole::new(row[0], row[1], row[2])));
        }
        let celsius = temperature_c.map_or(Ok(20.0), |celsius| number("temperature_c", celsius, -100.0..=100.0))?;
        let expected = "a sequence of eeruf.sim.Robot";
        let given = robots.map_or(Ok(vec![]), |robots| arguments::items("robots", robots, expected))?;
        let one =
            |robot: &Bound<'_, PyAny>| instance::<Robot>("robots", robot, expected).map(|robot| robot.get().clone());
        let robots = given.iter().map(one).collect::<PyResult<Vec<_>>>()?;
        let noise = arguments::flag("noise", noise, true)?;
        let seed = whole_or("seed", seed, 1, 0..=u64::MAX)?;
        let order = max_order.map(|order| whole("max_order", order, 0..=u32::MAX)).transpose()?;
        made_of.set_item("temperature_c", celsius)?;
        made_of.set_item("robots", PyTuple::new(py, robots.iter().cloned())?)?;
        made_of.set_item("noise", noise)?;
        made_of.set_item("seed", seed)?;
        made_of.set_item("max_order", order)?;
        let scene =
            py.detach(|| eeruf_sim::Scene::new(built_walls, built_poles, Air::at(celsius))).map_err(Raise::raise)?;
        let source = Source::Code(made_of.unbind());
        if robots.is_empty() {
            return Ok(Self { contents: Arc::new(Contents::Walls(Box::new(scene))), source });
        }
        let noise = if noise { Noise::default() } else { Noise::NONE };
        let robots = robots.into_iter().map(|robot| robot.robot).collect();
        let mut world = World::new(scene, robots, noise).map_err(Raise::raise)?.with_seed(seed);
        if let Some(order) = order {
            world = world.with_max_order(order).map_err(Raise::raise)?;
        }
        Ok(Self { contents: Arc::new(Contents::World(Arc::new(world))), source })
    }

    /// Read a scene file, such as those in the folder ``scenes``.
    ///
    /// Args:
    ///     path: of the file; a schedule that it names is looked for beside it.
    ///
    /// Raises:
    ///     ArgumentError: not a path.
    ///     SceneError: no such file, or it says something that makes no scene: by name, value and what is expected.
    #[staticmethod]
    #[pyo3(signature = (path))]
    fn from_toml(path: &Bound<'_, PyAny>) -> PyResult<Self> {
        let path: PathBuf = path.extract().map_err(|_| wrong("path", shown(path), "the path of a scene in TOML"))?;
        let text = std::fs::read_to_string(&path)
            .map_err(|error| SceneError::new_err(format!("{}: {error}", path.display())))?;
        Self::from_source(path, text)
    }

    /// The walls: array of shape (n, 4), as given.
    #[getter]
    fn walls<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let walls = self.scene().walls();
        let flat = walls.iter().flat_map(|wall| [wall.from.x, wall.from.y, wall.to.x, wall.to.y]).collect();
        PyArray1::from_vec(py, flat).reshape([walls.len(), 4])
    }

    /// The indices of the openings, from which nothing comes back.
    #[getter]
    fn open(&self) -> Vec<usize> {
        self.with_faces(Faces::Open)
    }

    /// The indices of the walls that reflect on both sides.
    #[getter]
    fn two_sided(&self) -> Vec<usize> {
        self.with_faces(Faces::Both)
    }

    /// The poles: array of shape (m, 3) of x, y and radius in metres.
    #[getter]
    fn poles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let poles = self.scene().poles();
        let flat = poles.iter().flat_map(|pole| [pole.centre.x, pole.centre.y, pole.radius_m]).collect();
        PyArray1::from_vec(py, flat).reshape([poles.len(), 3])
    }

    /// How many robots there are.
    #[getter]
    fn robots(&self) -> usize {
        self.contents.world().map_or(0, |world| world.robots().len())
    }

    /// The temperature of the air, in degrees Celsius.
    #[getter]
    fn temperature_c(&self) -> f64 {
        self.scene().air().temperature_c
    }

    /// Every specular path from a source to some receivers, exactly, without the interpreter lock. Ctrl-C ends it.
    ///
    /// Args:
    ///     source: (x, y) in metres.
    ///     receivers: array of shape (n, 2), or one point, in metres.
    ///     max_order: the most bounces, 0 to 1000; those at poles count.
    ///     max_length_m: the longest path, in metres, above 0; None for any length.
    ///     progress: True for a bar (tqdm if it is installed), or a callable that takes None and a text now and then.
    ///
    /// Returns:
    ///     The paths as arrays, sorted by receiver and then by length.
    ///
    /// Raises:
    ///     ArgumentError: something of the wrong type, shape or range.
    ///     PathsError: a point that is not finite or far from all walls, too high an order, or too many paths to keep.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> wall = sim.Scene([[5, 2, -5, 2]])
    ///     >>> paths = wall.paths(source=(0, 0), receivers=[(3, 0)], max_order=1)
    ///     >>> paths.order.tolist(), paths.length_m.tolist()
    ///     ([0, 1], [3.0, 5.0])
    #[pyo3(signature = (source, receivers, max_order, max_length_m=None, *, progress=None))]
    #[pyo3(text_signature = "($self, source, receivers, max_order, max_length_m=None, *, progress=None)")]
    fn paths(
        slf: &Bound<'_, Self>,
        source: &Bound<'_, PyAny>,
        receivers: &Bound<'_, PyAny>,
        max_order: &Bound<'_, PyAny>,
        max_length_m: Option<&Bound<'_, PyAny>>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Paths> {
        let at = points("source", source)?;
        let [from] = at[..] else { return Err(wrong("source", shown(source), "one point (x, y) in metres")) };
        let receivers = points("receivers", receivers)?;
        let max_order = whole("max_order", max_order, 0..=u32::MAX)?;
        let max_length_m =
            max_length_m.map_or(Ok(f64::INFINITY), |most| number("max_length_m", most, 0.0..=f64::INFINITY))?;
        let (py, scene) = (slf.py(), slf.clone().unbind());
        let standing = slf.get().scene();
        let few = standing.walls().len() + standing.poles().len() <= FEW && receivers.len() <= FEW;
        let find = move |receivers: Vec<Point>, stop: Stop| {
            let contents = Arc::clone(&scene.get().contents);
            let (limits, mut paths) = (Limits { max_order, max_length_m }, eeruf_sim::Paths::default());
            let mut tracer = Tracer::new();
            tracer.stop = stop;
            tracer.trace(contents.scene(), from, &receivers, limits, &mut paths).map_err(Raise::raise)?;
            Ok(Paths::new(paths, from, receivers, contents, scene.into_any(), limits))
        };
        if few && max_order <= LOW_ORDER && progress.is_none() {
            return py.detach(|| find(receivers, Stop::default()));
        }
        in_background(py, progress, move |background| {
            background.go_on(None, || format!("paths up to order {max_order}"));
            find(receivers, background.stop().clone())
        })
    }

    fn __repr__(&self) -> String {
        let (walls, poles) = (self.scene().walls().len(), self.scene().poles().len());
        let origin = match &self.source {
            Source::Toml { file, .. } => format!(" from {}", Path::display(file)),
            Source::Code(_) => String::new(),
        };
        format!("<Scene{origin}: {walls} walls, {poles} poles, {} robots>", self.robots())
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let py = slf.py();
        let rebuild = py.import("eeruf._rebuild")?.getattr("scene")?;
        let arguments = match &slf.get().source {
            Source::Toml { file, text } => (file, text).into_pyobject(py)?,
            Source::Code(made_of) => (made_of,).into_pyobject(py)?,
        };
        Ok((rebuild, arguments))
    }
}

impl Scene {
    fn with_faces(&self, faces: Faces) -> Vec<usize> {
        let walls = self.scene().walls().iter().enumerate();
        walls.filter(|(_, wall)| wall.faces == faces).map(|(index, _)| index).collect()
    }
}
