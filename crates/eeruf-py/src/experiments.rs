//! The paper's experiments, and Set III. Their tables are JSON, with the names of `eeruf lab experiment --json`; the
//! functions for users are in `python/eeruf/experiments.py`.

use eeruf_core::Micros;
use eeruf_design::RoomsAsked;
use eeruf_sim::{
    LabMate, Physics, Robot, WorldParts,
    experiments::{
        Difference, FIRST,
        rooms::{RoomGroup, RoomKind, RoomPlan},
        set_one::{self as first_set, Alcove, READINGS, SetOneOptions},
        set_three::{self as third_set, SetThreeOptions},
        set_two::{
            self as second_set, Course, Ending, OdometryNoise, POLE_RADIUS_M, Pilots, Run, SECOND_AHEAD, SECOND_BEHIND,
            SetTwoOptions, SpeedStep,
        },
    },
    world::DEFAULT_ORDER,
};
use numpy::{PyArray1, PyArray2, prelude::*};
use pyo3::{
    prelude::*,
    types::{PyDict, PyList, PyString},
};
use serde::{Serialize, de::DeserializeOwned};

use crate::{
    arguments::{choice, flag, items, micros, number, points, shown, whole, whole_or, wrong},
    errors::{EerufError, Raise},
    methods::{best, methods as methods_of},
    own::Made,
    robot::ring_file,
    scene::Scene,
    surroundings,
    watch::{Background, in_background},
};

/// Largest number of seeds, as in the program.
const SEEDS_MOST: u64 = 100_000;
/// Default `T_delta` of a robot without odometry, as in the program.
const WITHOUT_ODOMETRY: Micros = Micros::new(500);

fn json(table: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(table).map_err(|error| EerufError::new_err(error.to_string()))
}

/// Set I over many geometries: the table, and the runs of each method.
#[pyfunction]
#[pyo3(name = "_set_one", signature = (seeds, first, readings, methods, progress, physics=None))]
pub(crate) fn set_one(
    py: Python<'_>,
    seeds: &Bound<'_, PyAny>,
    first: Option<&Bound<'_, PyAny>>,
    readings: Option<&Bound<'_, PyAny>>,
    methods: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
    physics: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, String)> {
    let physics = surroundings::physics(physics)?;
    let seeds = whole("seeds", seeds, 1..=SEEDS_MOST)?;
    let first = whole_or("first", first, FIRST, 0..=u64::from(u32::MAX))?;
    let readings = whole_or("readings", readings, READINGS, 1..=u32::MAX)?;
    let (methods, made) = methods_of(methods, SetOneOptions::default().methods)?;
    in_background(py, progress, move |background| {
        let best = best(&methods, &Alcove::random(0).robot(), background)?;
        let keep_going = |done| background.go_on(Some(done), || format!("{seeds} alcoves"));
        let asked = SetOneOptions { seeds, first, readings, methods, physics, best, ..SetOneOptions::default() };
        let table = first_set::set_one(&asked, &keep_going).map_err(|error| made.raise(error))?;
        Ok((json(&table)?, json(&table.runs)?))
    })
}

/// Set III over many placings: the table, and the runs of each method.
#[pyfunction]
#[pyo3(name = "_set_three", signature = (seeds, first, periods, methods, progress, physics, height))]
#[expect(clippy::too_many_arguments, reason = "keyword arguments")]
pub(crate) fn set_three(
    py: Python<'_>,
    seeds: &Bound<'_, PyAny>,
    first: Option<&Bound<'_, PyAny>>,
    periods: Option<&Bound<'_, PyAny>>,
    methods: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
    physics: Option<&Bound<'_, PyAny>>,
    height: Option<&Bound<'_, PyAny>>,
) -> PyResult<(String, String)> {
    let default = SetThreeOptions::default();
    let (methods, made) = methods_of(methods, default.methods.clone())?;
    let asked = SetThreeOptions {
        seeds: whole("seeds", seeds, 1..=SEEDS_MOST)?,
        first: whole_or("first", first, FIRST, 0..=u64::from(u32::MAX))?,
        periods: whole_or("periods", periods, default.periods, 10..=100_000)?,
        methods,
        physics: surroundings::physics(physics)?,
        room: surroundings::height(height)?,
        ..default
    };
    in_background(py, progress, move |background| {
        let keep_going = |done| background.go_on(Some(done), || format!("{} placings", asked.seeds));
        let table = third_set::set_three(&asked, &keep_going).map_err(|error| made.raise(error))?;
        Ok((json(&table)?, json(&table.runs)?))
    })
}

/// Figures of methods by name, and of groups.
#[derive(Serialize)]
struct Merged<F: Serialize, G: Serialize> {
    methods: Vec<(String, F)>,
    groups: G,
}

/// The figures of runs from several calls for Set I, II or III; the JSON has pairs of a name and its runs.
#[pyfunction]
#[pyo3(name = "_figures", signature = (set, runs))]
pub(crate) fn figures(py: Python<'_>, set: u8, runs: &Bound<'_, PyString>) -> PyResult<String> {
    let runs = runs.to_cow()?;
    fn of<R: DeserializeOwned, F: Serialize, G: Serialize>(
        runs: &str,
        figures: fn(&[R]) -> F,
        groups: impl FnOnce(&[&str], &[Vec<R>]) -> G,
    ) -> PyResult<String> {
        let refused = |error: serde_json::Error| EerufError::new_err(format!("runs: {error}; expected unchanged ones"));
        let (names, runs): (Vec<String>, Vec<Vec<R>>) =
            serde_json::from_str::<Vec<(String, Vec<R>)>>(runs).map_err(refused)?.into_iter().unzip();
        let groups = groups(&names.iter().map(String::as_str).collect::<Vec<_>>(), &runs);
        json(&Merged { methods: names.into_iter().zip(runs.iter().map(|runs| figures(runs))).collect(), groups })
    }
    py.detach(|| match set {
        1 => of(&runs, first_set::Figures::of, |_, _| ()),
        2 => of(&runs, second_set::Figures::of, |_, _| ()),
        _ => of(&runs, third_set::Figures::of, third_set::group),
    })
}

/// Difference of a figure between two methods, from its differences in each scene.
#[pyfunction]
#[pyo3(name = "_difference", signature = (differences))]
pub(crate) fn difference(py: Python<'_>, differences: Vec<f64>) -> PyResult<Option<String>> {
    py.detach(|| Difference::of(differences).map(|found| json(&found)).transpose())
}

/// The number of the first scene of an experiment, and the physics.
fn numbered(number: &Bound<'_, PyAny>, physics: &Bound<'_, PyAny>) -> PyResult<(u64, Physics)> {
    Ok((whole("first", number, 0..=u64::from(u32::MAX) + SEEDS_MOST)?, surroundings::physics(Some(physics))?))
}

/// The scene of an alcove of Set I.
#[pyfunction]
#[pyo3(name = "_alcove", signature = (number, physics))]
pub(crate) fn alcove(number: &Bound<'_, PyAny>, physics: &Bound<'_, PyAny>) -> PyResult<Scene> {
    let (seed, physics) = numbered(number, physics)?;
    let alcove = Alcove::random(seed);
    scene_of(alcove.scene().map_err(Raise::raise)?, vec![alcove.robot()], DEFAULT_ORDER, seed, physics)
}

/// The scene of a course of Set II, with the robot at the start.
#[pyfunction]
#[pyo3(name = "_course", signature = (number, physics))]
pub(crate) fn course(number: &Bound<'_, PyAny>, physics: &Bound<'_, PyAny>) -> PyResult<Scene> {
    let (seed, physics) = numbered(number, physics)?;
    let course = Course::random(seed);
    let order = course.world(course.robot(), None).map_err(Raise::raise)?.max_order();
    let robot = SetTwoOptions::default().robot(course.robot());
    scene_of(course.scene().map_err(Raise::raise)?, vec![robot], order, seed, physics)
}

/// The scene of a room, with the robot of a ring file in its place.
#[pyfunction]
#[pyo3(name = "_room", signature = (kind, number, ring, driving, physics, height))]
pub(crate) fn room(
    kind: &Bound<'_, PyAny>,
    number: &Bound<'_, PyAny>,
    ring: &Bound<'_, PyAny>,
    driving: &Bound<'_, PyAny>,
    physics: &Bound<'_, PyAny>,
    height: &Bound<'_, PyAny>,
) -> PyResult<Scene> {
    let kinds = RoomKind::ALL.map(|kind| (kind.as_str(), kind));
    let kind = choice("kind", Some(kind), &kinds)?;
    let (seed, physics) = numbered(number, physics)?;
    let height = surroundings::height(Some(height))?;
    let spec = ring_file(ring)?;
    let robot = spec.room_robot().map_err(EerufError::new_err)?.robot;
    let speed_m_s = if flag("driving", Some(driving), false)? { spec.room_speed_m_s() } else { 0.0 };
    let plan = RoomPlan::random(kind, seed, robot.radius_m());
    let world = plan.world(&Robot { odometry: true, ..robot }, speed_m_s).map_err(Raise::raise)?;
    let scene = plan.scene().and_then(|scene| scene.with_room(height)).map_err(Raise::raise)?;
    scene_of(scene, world.robots().to_vec(), DEFAULT_ORDER, seed, physics)
}

/// Rooms for judging a ring, as given in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct InRooms<'py> {
    rooms: Option<Bound<'py, PyAny>>,
    places: Bound<'py, PyAny>,
    first: Bound<'py, PyAny>,
    all_ways: Bound<'py, PyAny>,
}

/// Judges ways of firing a ring file's ring in rooms, as `eeruf study RING.toml --json` prints them.
#[pyfunction]
#[pyo3(name = "_recommend", signature = (ring, asked, progress))]
pub(crate) fn recommend(
    py: Python<'_>,
    ring: &Bound<'_, PyAny>,
    asked: InRooms<'_>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let spec = ring_file(ring)?;
    let InRooms { rooms, places, first, all_ways } = asked;
    let asked = RoomsAsked {
        own: rooms.as_ref().map(own_rooms).transpose()?.unwrap_or_default(),
        places: whole("places", &places, 1..=1000)?,
        first: whole("first", &first, 0..=1_000_000_000)?,
        all: flag("all_ways", Some(&all_ways), false)?,
    };
    in_background(py, progress, move |background| {
        let design = spec.shortest_to_study().map_err(|error| EerufError::new_err(error.to_string()))?;
        let keep_going = |done| background.go_on(Some(done), || "rooms".to_owned());
        let judged = spec.judge_in_rooms(design.as_ref(), &asked, &keep_going);
        json(&judged.map_err(EerufError::new_err)?)
    })
}

/// Scenes by name, as rooms for a ring in the place of their first robot.
fn own_rooms(rooms: &Bound<'_, PyAny>) -> PyResult<Vec<RoomGroup>> {
    let refused = || EerufError::new_err(format!("rooms = {}; expected scenes by name, a dict", shown(rooms)));
    let scenes = rooms.cast::<PyDict>().map_err(|_| refused())?;
    let room = |(number, (name, scene)): (u64, (Bound<'_, PyAny>, Bound<'_, PyAny>))| -> PyResult<RoomGroup> {
        let (name, scene): (String, PyRef<'_, Scene>) =
            (name.extract().map_err(|_| refused())?, scene.extract().map_err(|_| refused())?);
        RoomGroup::of_world(name, number, scene.world()?).ok_or_else(refused)
    };
    if scenes.is_empty() {
        return Err(refused());
    }
    (0..).zip(scenes.iter()).map(room).collect()
}

fn scene_of(
    scene: eeruf_sim::Scene,
    robots: Vec<Robot>,
    max_order: u32,
    seed: u64,
    physics: Physics,
) -> PyResult<Scene> {
    let shown = robots.iter().map(crate::robot::Robot::of).collect();
    let (noise, faults) = (eeruf_sim::Noise::default(), vec![]);
    Scene::of(WorldParts { scene, robots, noise, physics, max_order, seed, faults }, shown)
}

/// Arguments of Set II, as given in Python.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Asked<'py> {
    seeds: Bound<'py, PyAny>,
    first: Option<Bound<'py, PyAny>>,
    methods: Option<Bound<'py, PyAny>>,
    second_robot: Option<Bound<'py, PyAny>>,
    speed_m_s: Bound<'py, PyAny>,
    odometry: Bound<'py, PyAny>,
    t_delta_us: Option<Bound<'py, PyAny>>,
    physics: Option<Bound<'py, PyAny>>,
    pilot: Bound<'py, PyAny>,
    odometry_noise: Bound<'py, PyAny>,
    bodies: Bound<'py, PyAny>,
}

fn speed(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    number(name, value, 0.1..=5.0)
}

impl Asked<'_> {
    fn options(self) -> PyResult<(SetTwoOptions, Made)> {
        let default = SetTwoOptions::default();
        let (methods, made) = methods_of(self.methods.as_ref(), default.methods)?;
        let odometry = flag("odometry", Some(&self.odometry), true)?;
        let t_delta = self.t_delta_us.map(|value| micros("t_delta_us", &value)).transpose()?;
        let noisy = flag("odometry_noise", Some(&self.odometry_noise), true)?;
        let named = Pilots::NAMED.map(|pilots| (pilots.as_str(), pilots));
        let options = SetTwoOptions {
            pilots: choice("pilot", Some(&self.pilot), &named)?,
            odometry_noise: if noisy { OdometryNoise::default() } else { OdometryNoise::NONE },
            seeds: whole("seeds", &self.seeds, 1..=SEEDS_MOST)?,
            first: whole_or("first", self.first.as_ref(), FIRST, 0..=u64::from(u32::MAX))?,
            methods,
            second_robot: self.second_robot.as_ref().map(corner).transpose()?,
            labmate: LabMate { speed_max_m_s: speed("speed_m_s", &self.speed_m_s)?, ..default.labmate },
            odometry,
            bodies: flag("bodies", Some(&self.bodies), false)?,
            physics: surroundings::physics(self.physics.as_ref())?,
            t_delta: t_delta.unwrap_or(if odometry { default.t_delta } else { WITHOUT_ODOMETRY }),
            ..SetTwoOptions::default()
        };
        Ok((options, made))
    }
}

fn corner(value: &Bound<'_, PyAny>) -> PyResult<eeruf_sim::Point> {
    let refused = || wrong("second_robot", shown(value), "\"behind\", \"ahead\" or a point (x, y) in metres");
    match value.extract::<String>().as_deref() {
        Ok("behind") => Ok(SECOND_BEHIND),
        Ok("ahead") => Ok(SECOND_AHEAD),
        Ok(_) => Err(refused()),
        Err(_) => match points("second_robot", value).as_deref() {
            Ok([at]) => Ok(*at),
            _ => Err(refused()),
        },
    }
}

fn with_best(options: SetTwoOptions, background: &Background) -> PyResult<SetTwoOptions> {
    let robot = Robot { t_delta: options.t_delta, ..Course::random(0).robot() };
    Ok(SetTwoOptions { best: best(&options.methods, &robot, background)?, ..options })
}

/// Set II over many courses: the table, and for each method the fields of each run.
#[pyfunction]
#[pyo3(name = "_set_two", signature = (asked, progress))]
pub(crate) fn set_two<'py>(
    py: Python<'py>,
    asked: Asked<'py>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(String, Bound<'py, PyDict>)> {
    let (options, made) = asked.options()?;
    let found = in_background(py, progress, move |background| {
        let options = with_best(options, background)?;
        let keep_going = |done| background.go_on(Some(done), || format!("{} courses", options.seeds));
        second_set::set_two(&options, &keep_going).map_err(|error| made.raise(error))
    })?;
    let runs = PyDict::new(py);
    for ((method, _), of_method) in found.methods.iter().zip(&found.runs) {
        let fields = of_method.iter().map(|run| fields(py, run)).collect::<PyResult<Vec<_>>>()?;
        runs.set_item(method, PyList::new(py, fields)?)?;
    }
    Ok((json(&found)?, runs))
}

/// Result of a sweep, under the program's names.
#[derive(Serialize)]
struct Sweep {
    first: u64,
    pilot: &'static str,
    physics: Physics,
    bodies: bool,
    seeds: u64,
    second_robot_m: Option<[f64; 2]>,
    steps: Vec<SpeedStep>,
}

/// Set II at several top speeds.
#[pyfunction]
#[pyo3(name = "_speed_sweep", signature = (speeds_m_s, asked, progress))]
pub(crate) fn speed_sweep(
    py: Python<'_>,
    speeds_m_s: &Bound<'_, PyAny>,
    asked: Asked<'_>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<String> {
    let expected = "one speed or more, in m/s";
    let given = items("speeds_m_s", speeds_m_s, expected)?;
    let named = given.iter().enumerate().map(|(place, value)| speed(&format!("speeds_m_s[{place}]"), value));
    let speeds = named.collect::<PyResult<Vec<f64>>>()?;
    if speeds.is_empty() {
        return Err(wrong("speeds_m_s", "[]", expected));
    }
    let (options, made) = asked.options()?;
    in_background(py, progress, move |background| {
        let options = with_best(options, background)?;
        let keep_going =
            |done| background.go_on(Some(done), || format!("{} courses at {} speeds", options.seeds, speeds.len()));
        let steps = second_set::speed_sweep(&options, &speeds, &keep_going).map_err(|error| made.raise(error))?;
        let second_robot_m = options.second_robot.map(|at| [at.x, at.y]);
        let SetTwoOptions { first, seeds, pilots, physics, bodies, .. } = options;
        json(&Sweep { first, pilot: pilots.as_str(), physics, bodies, seeds, second_robot_m, steps })
    })
}

/// The fields of `eeruf.experiments.Run`.
fn fields<'py>(py: Python<'py>, run: &Run) -> PyResult<Bound<'py, PyDict>> {
    let fields = PyDict::new(py);
    fields.set_item("course", run.course)?;
    let ending = match run.ending {
        Ending::Finished => "finished",
        Ending::Contact => "contact",
        Ending::TimeOut => "time_out",
    };
    fields.set_item("ending", ending)?;
    fields.set_item("time_s", run.time_s)?;
    fields.set_item("way_m", run.way_m)?;
    fields.set_item("top_speed_m_s", run.top_speed_m_s)?;
    fields.set_item("nearest_m", run.nearest_m)?;
    fields.set_item("readings", run.readings)?;
    fields.set_item("rejected_readings", run.rejected)?;
    fields.set_item("wrong_readings", run.wrong)?;
    fields.set_item("phantom_echoes", run.phantom_echoes)?;
    fields.set_item("phantom_cells", run.phantom_cells)?;
    fields.set_item("poles_passed", run.poles_passed)?;
    fields.set_item("poles_unseen", run.poles_missed)?;
    let track = run.track.iter().map(|at| [at.time_s, at.x_m, at.y_m, at.heading_rad, at.speed_m_s]);
    fields.set_item("track", rows(py, track)?)?;
    fields.set_item("grid", rows(py, run.grid.iter().map(|cell| [cell.x_m, cell.y_m, f64::from(cell.value)]))?)?;
    let poles = Course::random(run.course).poles;
    fields.set_item("poles", rows(py, poles.iter().map(|pole| [pole.x, pole.y, POLE_RADIUS_M]))?)?;
    Ok(fields)
}

fn rows<'py, const N: usize>(
    py: Python<'py>,
    rows: impl Iterator<Item = [f64; N]>,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    let flat: Vec<f64> = rows.flatten().collect();
    let count = flat.len() / N;
    PyArray1::from_vec(py, flat).reshape([count, N])
}
