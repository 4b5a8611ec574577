//! `sim.Scene`: walls and poles, and the robots among them if there are any.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use eeruf_design::robot_ring;
use eeruf_files::Kind;
use eeruf_sim::{
    Air, DEFAULT_HEIGHT_M, Faces, Limits, Pole, Wall, World, WorldParts, world::DEFAULT_ORDER, world_file,
};
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{self, instance, matrix, number_or, points_in_space, shown, whole, whole_or, wrong},
    contents::{Contents, Objects},
    drawing,
    errors::{EerufError, Raise, warn, warn_of},
    faults,
    fields::{Reduced, attributes, reduce_by_name},
    paths::{Ends, Paths},
    requirements::Asked,
    robot::Robot,
    surroundings::{self, Material, Noise},
};

/// Walls, poles and robots from above, in metres. Immutable; scenes pickle.
///
/// A wall reflects on its left side, seen from its first end to its second, and its back absorbs: a room is a loop
/// walked counter-clockwise, a pillar one walked clockwise.
///
/// Args:
///     walls: array of shape (n, 4): x, y of one end and x, y of the other.
///     open: indices of openings, from which nothing comes back.
///     two_sided: indices of walls that reflect on both sides.
///     poles: array of shape (m, 3): x, y and radius.
///     materials: the material of the walls, one for all or one each: ``"smooth"``, ``"painted"``, ``"soft"``,
///         ``"perfect"`` or a :class:`Material`; smooth by default.
///     pole_materials: the material of the poles, likewise.
///     temperature_c: the air temperature in degrees Celsius, -100 to 100; the speed of sound depends on it.
///     humidity_percent: the humidity of the air, 0 to 100.
///     pressure_kpa: the pressure of the air.
///     robots: the robots that :func:`simulate` drives.
///     noise: True for a little jitter and fading, False for none, or a :class:`Noise`.
///     seed: the seed of the noise, 0 to 2^64 - 1.
///     max_order: how many bounces :func:`simulate` follows; 6 by default.
///     physics: ``"plain"``, ``"default"``, or a dict of differences from a ``preset``: ``shadows``, ``edges``,
///         ``narrow_panels``, ``range_walk``, ``interference`` (each True or False), ``fading_time_s``; see
///         ``docs/explanation/physics.md``.
///     height: ``"flat"``, all sound in one plane; ``"room"``, between a floor and a ceiling at 2.6 m; or a dict of
///         differences from that room: ``ceiling_m``, and ``floor`` and ``ceiling`` as in ``materials``.
///     faults: faults to simulate, dicts with the keys of ``[[fault]]`` in scene files, such as
///         ``{"kind": "cut", "sensors": [2], "from_s": 3.0}``; docs/how-to/simulate.md lists them all.
///
/// Raises:
///     EerufError: an array of the wrong shape, an index without a wall, an argument of the wrong type or out of range;
///         walls that cross, have no length or are not finite, or a robot at an occupied place.
///
/// Example:
///     >>> from eeruf import sim
///     >>> scene = sim.Scene([[0.85, 0, 0.85, 1.39], [0.85, 1.39, -0.85, 1.39], [-0.85, 1.39, -0.85, 0]])
///     >>> scene
///     <Scene: 3 walls, 0 poles, 0 robots>
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Scene {
    contents: Arc<Contents>,
    robots: Vec<Robot>,
    noise: eeruf_sim::Noise,
    physics: eeruf_sim::Physics,
    faults: Vec<eeruf_sim::Fault>,
    /// Seed of all random numbers.
    #[pyo3(get)]
    seed: u64,
    /// Number of bounces that :func:`simulate` follows.
    #[pyo3(get)]
    max_order: u32,
}

impl Scene {
    pub(crate) fn scene(&self) -> &eeruf_sim::Scene {
        self.contents.scene()
    }

    pub(crate) fn world(&self) -> PyResult<&Arc<World>> {
        self.contents.world().ok_or_else(|| EerufError::new_err("a scene of 0 robots; expected 1 or more to simulate"))
    }

    /// Checks the parts against each other.
    pub(crate) fn of(parts: WorldParts, robots: Vec<Robot>) -> PyResult<Self> {
        let WorldParts { scene, noise, physics, max_order, seed, faults, .. } = parts;
        let contents = if robots.is_empty() {
            if !faults.is_empty() {
                return Err(EerufError::new_err(format!("{} faults; expected none without robots", faults.len())));
            }
            Objects::Walls(Box::new(scene))
        } else {
            let inner = robots.iter().map(|robot| robot.robot.clone()).collect();
            let world = World::new(scene, inner, noise)
                .and_then(|world| world.with_physics(physics))
                .and_then(|world| world.with_max_order(max_order))
                .and_then(|world| world.with_faults(faults.clone()));
            let world = world.map_err(Raise::raise)?.with_seed(seed);
            for (robot, doubt) in world.doubts() {
                Python::attach(|py| warn(py, format_args!("robot {robot}: {doubt}")))?;
            }
            Objects::World(Arc::new(world))
        };
        Ok(Self { contents: Arc::new(contents.into()), robots, noise, physics, faults, seed, max_order })
    }

    fn from_text(name: &Path, text: &str) -> PyResult<Self> {
        let parts = WorldParts::from_text_with(name, text, robot_ring).map_err(Raise::raise)?;
        Python::attach(|py| warn_of(py, name, text))?;
        let robots: Vec<_> = parts.robots.iter().map(Robot::of).collect();
        if !robots.is_empty() {
            // Builds the world for its errors, which name the wrong line.
            World::from_text_with(name, text, robot_ring).map_err(Raise::raise)?;
        }
        Self::of(parts, robots)
    }
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

/// The keyword arguments that make a scene again.
#[rustfmt::skip]
const ARGUMENTS: [&str; 16] = [
    "walls", "open", "two_sided", "poles", "materials", "pole_materials", "temperature_c", "humidity_percent",
    "pressure_kpa", "robots", "noise", "seed", "max_order", "physics", "height", "faults",
];

#[pymethods]
impl Scene {
    #[new]
    #[pyo3(signature = (walls, open=None, two_sided=None, poles=None, **options))]
    #[pyo3(text_signature = "(walls, open=None, two_sided=None, poles=None, *, materials=None, pole_materials=None, \
            temperature_c=20.0, humidity_percent=50.0, pressure_kpa=101.325, robots=(), noise=True, seed=1, \
            max_order=6, physics=\"default\", height=\"flat\", faults=())")]
    fn new<'py>(
        walls: &Bound<'py, PyAny>,
        open: Option<&Bound<'_, PyAny>>,
        two_sided: Option<&Bound<'_, PyAny>>,
        poles: Option<&Bound<'_, PyAny>>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let options = Asked::of(walls.py(), "Scene", [], options, &[&ARGUMENTS[4..]])?;
        let given = |name: &str| options.get(name);
        let rows = matrix("walls", walls, 4)?;
        let mut built_walls: Vec<_> =
            rows.as_array().rows().into_iter().map(|row| Wall::new(row[0], row[1], row[2], row[3])).collect();
        for (name, which, faces) in [("open", open, Faces::Open), ("two_sided", two_sided, Faces::Both)] {
            for index in indices(name, which, built_walls.len())? {
                built_walls[index].faces = faces;
            }
        }
        let surfaces = surroundings::materials("materials", given("materials")?.as_ref(), built_walls.len())?;
        for (wall, material) in built_walls.iter_mut().zip(surfaces) {
            wall.material = material;
        }
        let mut built_poles = vec![];
        if let Some(poles) = poles {
            let rows = matrix("poles", poles, 3)?;
            built_poles.extend(rows.as_array().rows().into_iter().map(|row| Pole::new(row[0], row[1], row[2])));
        }
        let surfaces = surroundings::materials("pole_materials", given("pole_materials")?.as_ref(), built_poles.len())?;
        for (pole, material) in built_poles.iter_mut().zip(surfaces) {
            pole.material = material;
        }
        let number_of = |name, default, range| number_or(name, given(name)?.as_ref(), default, range);
        let default = Air::default();
        let air = Air {
            temperature_c: number_of("temperature_c", 20.0, -100.0..=100.0)?,
            humidity_percent: number_of("humidity_percent", default.humidity_percent, 0.0..=100.0)?,
            pressure_kpa: number_of("pressure_kpa", default.pressure_kpa, 0.0..=1e4)?,
        };
        let expected = "a sequence of eeruf.sim.Robot";
        let each = given("robots")?.map_or(Ok(vec![]), |robots| arguments::items("robots", &robots, expected))?;
        let one =
            |robot: &Bound<'_, PyAny>| instance::<Robot>("robots", robot, expected).map(|robot| robot.get().clone());
        let robots = each.iter().map(one).collect::<PyResult<Vec<_>>>()?;
        let noise = surroundings::noise(given("noise")?.as_ref())?;
        let seed = whole_or("seed", given("seed")?.as_ref(), 1, 0..=u64::MAX)?;
        let max_order = whole_or("max_order", given("max_order")?.as_ref(), DEFAULT_ORDER, 0..=u32::MAX)?;
        let physics = surroundings::physics(given("physics")?.as_ref())?;
        let room = surroundings::height(given("height")?.as_ref())?;
        let build = || eeruf_sim::Scene::new(built_walls, built_poles, air).and_then(|scene| scene.with_room(room));
        let scene = walls.py().detach(build).map_err(Raise::raise)?;
        let faults = faults::faults(given("faults")?.as_ref())?;
        Self::of(WorldParts { scene, robots: vec![], noise, physics, max_order, seed, faults }, robots)
    }

    /// Read a scene file, such as those in the folder ``scenes``.
    ///
    /// Args:
    ///     path: the path of the file; a schedule that it names is looked up beside it.
    ///
    /// Raises:
    ///     EerufError: not a path; no such file; or an invalid scene, with the name, the value and what is
    ///         expected.
    ///
    /// Example:
    ///     >>> import eeruf, pathlib, tempfile
    ///     >>> file = pathlib.Path(tempfile.mkdtemp(), "alcove.toml")
    ///     >>> _ = file.write_text(eeruf.example("scenes/alcove.toml"))
    ///     >>> len(eeruf.sim.Scene.read_toml(file).walls)
    ///     3
    #[staticmethod]
    fn read_toml(path: &Bound<'_, PyAny>) -> PyResult<Self> {
        let path: PathBuf = path.extract().map_err(|_| wrong("path", shown(path), "the path of a scene in TOML"))?;
        let text = Kind::Scene.read(&path).map_err(Raise::raise)?;
        Self::from_text(&path, &text)
    }

    /// Read an occupancy grid, as the ROS ``map_server`` saves it: walls along the outlines of the occupied cells.
    ///
    /// A cell is occupied if its probability is above the file's ``occupied_thresh``; an unknown one is not. Add robots
    /// with :meth:`replace`.
    ///
    /// Args:
    ///     path: of the YAML file, which names a PGM picture beside it.
    ///     tolerance_m: how far walls may be from the edges of the occupied cells, in metres, 0 to 1000; by default one
    ///         and a half cells, which straightens the stairs that a slanted wall becomes in cells.
    ///
    /// Raises:
    ///     EerufError: not a path, or an invalid tolerance; no such file; or an invalid map, with the name, the
    ///         value and what is expected.
    ///
    /// Example:
    ///     >>> from pathlib import Path
    ///     >>> from tempfile import TemporaryDirectory
    ///     >>> from eeruf import sim
    ///     >>> with TemporaryDirectory() as folder:
    ///     ...     _ = (Path(folder) / "room.pgm").write_text("P2 4 3 1  0 0 0 0  0 1 1 0  0 0 0 0")
    ///     ...     text = "image: room.pgm\nresolution: 0.5\norigin: [0, 0, 0]"
    ///     ...     _ = (Path(folder) / "room.yaml").write_text(text)
    ///     ...     sim.Scene.read_map(Path(folder) / "room.yaml", tolerance_m=0)
    ///     <Scene: 8 walls, 0 poles, 0 robots>
    #[staticmethod]
    #[pyo3(signature = (path, *, tolerance_m=None))]
    fn read_map(path: &Bound<'_, PyAny>, tolerance_m: Option<&Bound<'_, PyAny>>) -> PyResult<Self> {
        Self::of(crate::maps::read_map(path, tolerance_m)?, vec![])
    }

    /// Read a scene from the text of a scene file, as :meth:`to_toml` writes it.
    ///
    /// Args:
    ///     text: the contents of a file; a schedule that it names is looked up in the current folder.
    ///
    /// Raises:
    ///     EerufError: not a string; or an invalid scene, with the name, the value and what is expected.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> sim.Scene.from_toml("[[pole]]\nat_m = [1, 2]\nradius_m = 0.05").poles.tolist()
    ///     [[1.0, 2.0, 0.05]]
    #[staticmethod]
    #[pyo3(name = "from_toml", signature = (text))]
    fn of_toml(text: &Bound<'_, PyAny>) -> PyResult<Self> {
        let text = arguments::text("text", text, "a scene in TOML; read_toml takes a path")?;
        Self::from_text(Path::new("text"), &text)
    }

    /// Write this scene as a scene file, which gives the same readings in Python and in the program.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[sim.Robot((0, 0, 1.57), 8, 0.26, 0.3)])
    ///     >>> sim.Scene.from_toml(scene.to_toml()).to_toml() == scene.to_toml()
    ///     True
    fn to_toml(&self) -> String {
        let robots: Vec<_> = self.robots.iter().map(|robot| robot.robot.clone()).collect();
        world_file(self.scene(), &robots, &self.noise, &self.physics, self.max_order, self.seed, &self.faults)
    }

    /// Return the scene with these arguments changed.
    ///
    /// Args:
    ///     changes: arguments of ``Scene``, by name. New walls or poles have the default materials, unless those are
    ///         given too, and no openings.
    ///
    /// Raises:
    ///     EerufError: as for ``Scene``.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> scene = sim.Scene([[5, 2, -5, 2]], seed=3).replace(temperature_c=0.0)
    ///     >>> scene.temperature_c, scene.seed
    ///     (0.0, 3)
    #[pyo3(signature = (**changes))]
    fn replace<'py>(slf: &Bound<'py, Self>, changes: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        let arguments = attributes(slf, &ARGUMENTS)?;
        if let Some(changes) = changes {
            for (part, depending) in
                [("walls", &["open", "two_sided", "materials"][..]), ("poles", &["pole_materials"])]
            {
                if changes.contains(part)? {
                    for name in depending {
                        arguments.del_item(name)?;
                    }
                }
            }
            arguments.update(changes.as_mapping())?;
        }
        slf.get_type().call((), Some(&arguments))
    }

    /// Faults: dicts with the keys of ``[[fault]]`` in scene files.
    #[getter]
    fn faults<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        faults::shown_faults(py, &self.faults)
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

    /// The robots, a tuple of ``Robot``.
    #[getter]
    fn robots<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        PyTuple::new(py, self.robots.iter().cloned())
    }

    /// The material of each wall, a list of ``Material``.
    #[getter]
    fn materials(&self) -> Vec<Material> {
        self.scene().walls().iter().map(|wall| Material::of(wall.material)).collect()
    }

    /// The material of each pole, a list of ``Material``.
    #[getter]
    fn pole_materials(&self) -> Vec<Material> {
        self.scene().poles().iter().map(|pole| Material::of(pole.material)).collect()
    }

    /// The noise, a ``Noise``.
    #[getter]
    fn noise(&self) -> Noise {
        Noise(self.noise)
    }

    /// The simulated effects: a preset's name, or a dict.
    #[getter]
    fn physics<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        surroundings::shown_physics(py, &self.physics)
    }

    /// Floor and ceiling: ``"flat"`` for none, ``"room"`` for the default, or a dict.
    #[getter]
    fn height<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        surroundings::shown_height(py, self.scene().room())
    }

    /// The humidity of the air, in percent.
    #[getter]
    fn humidity_percent(&self) -> f64 {
        self.scene().air().humidity_percent
    }

    /// The pressure of the air, in kilopascals.
    #[getter]
    fn pressure_kpa(&self) -> f64 {
        self.scene().air().pressure_kpa
    }

    /// The temperature of the air, in degrees Celsius.
    #[getter]
    fn temperature_c(&self) -> f64 {
        self.scene().air().temperature_c
    }

    /// Every path from a source to some receivers, exactly, without the interpreter lock. Ctrl-C ends it.
    ///
    /// The paths are those that :func:`simulate` uses: with the scene's ``physics`` no path runs through a thick pole,
    /// edges diffract, and narrow walls reflect less. With ``physics="plain"`` they are only the specular ones.
    /// Amplitudes are for the first robot's transducers, or for a Polaroid 6500 if there is no robot.
    ///
    /// Args:
    ///     source: (x, y) in metres, or (x, y, height) in a scene that is not flat; 0.3 m high by default.
    ///     receivers: array of shape (n, 2) or (n, 3), or one point, likewise.
    ///     max_order: the most bounces, 0 to 1000, including those at poles, floor and ceiling. At most 4 are at floor
    ///         and ceiling.
    ///     max_length_m: the longest path, in metres, above 0; None for any length.
    ///     progress: True for a bar (tqdm if it is installed), or a callable that takes None and a text now and then.
    ///
    /// Returns:
    ///     The paths as arrays, sorted by receiver and then by length.
    ///
    /// Raises:
    ///     EerufError: an argument of the wrong type, shape or range; a point that is not finite, far from all walls or
    ///         inside something solid, too high an order, or too many paths to keep.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> wall = sim.Scene([[5, 2, -5, 2]], physics="plain")
    ///     >>> paths = wall.paths(source=(0, 0), receivers=[(3, 0)], max_order=1)
    ///     >>> paths.order.tolist(), paths.length_m.tolist()
    ///     ([0, 1], [3.0, 5.0])
    #[pyo3(signature = (source, receivers, max_order, max_length_m=None, *, progress=None))]
    fn paths(
        slf: &Bound<'_, Self>,
        source: &Bound<'_, PyAny>,
        receivers: &Bound<'_, PyAny>,
        max_order: &Bound<'_, PyAny>,
        max_length_m: Option<&Bound<'_, PyAny>>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Paths> {
        let (at, source_m) = points_in_space("source", source)?;
        let [from] = at[..] else { return Err(wrong("source", shown(source), "one point (x, y) in metres")) };
        let (receivers, receivers_m) = points_in_space("receivers", receivers)?;
        if slf.get().scene().room().is_none() && (source_m.is_some() || receivers_m.is_some()) {
            let name = if source_m.is_some() { "source" } else { "receivers" };
            return Err(wrong(name, "(x, y, height)", "(x, y), since the scene is flat; give it height=\"room\""));
        }
        let source_m = source_m.and_then(|heights_m| heights_m.first().copied()).unwrap_or(DEFAULT_HEIGHT_M);
        let receivers_m = receivers_m.unwrap_or_else(|| vec![DEFAULT_HEIGHT_M; receivers.len()]);
        let ends = Ends { source: from, source_m, receivers, receivers_m };
        let max_order = whole("max_order", max_order, 0..=u32::MAX)?;
        let max_length_m = number_or("max_length_m", max_length_m, f64::INFINITY, 0.0..=f64::INFINITY)?;
        let (contents, limits) = (Arc::clone(&slf.get().contents), Limits { max_order, max_length_m });
        Paths::find(slf.as_any(), contents, slf.get().physics, ends, limits, progress)
    }

    fn __repr__(&self) -> String {
        let (walls, poles) = (self.scene().walls().len(), self.scene().poles().len());
        format!("<Scene: {walls} walls, {poles} poles, {} robots>", self.robots.len())
    }

    /// The scene from above, as a notebook shows it.
    fn _repr_svg_(&self) -> String {
        drawing::svg(self.scene(), self.robots.iter().map(|robot| &robot.robot))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce_by_name(slf, attributes(slf, &ARGUMENTS)?)
    }
}

impl Scene {
    fn with_faces(&self, faces: Faces) -> Vec<usize> {
        let walls = self.scene().walls().iter().enumerate();
        walls.filter(|(_, wall)| wall.faces == faces).map(|(index, _)| index).collect()
    }
}
