//! `sim.Simulation`, which runs step by step.

use std::{
    path::PathBuf,
    sync::{Arc, Mutex, MutexGuard, PoisonError},
    thread::{self, ThreadId},
};

use eeruf_sim::{Body, Moment, Own, SimulationError, Stop};
use pyo3::{
    PyTraverseError, PyVisit,
    prelude::*,
    types::{PyString, PyTuple},
};

use crate::{
    arguments::{instance, number, shown, whole, wrong},
    errors::{EerufError, Raise},
    fields::record,
    logs,
    own::{self, Calls},
    pose::{PoseOf, pose_of, to_pose},
    program::Recording,
    readings::Readings,
    scene::Scene,
    schedule::Schedule,
    simulate::Asked,
    watch::{Watch, in_background},
};

/// A world that is simulated step by step, for your own controller, filter, or display.
///
/// All steps together give the readings of :func:`simulate`, bit for bit, in little more memory than one step's. A copy
/// continues from the same state. A pickle repeats all calls since the beginning (about 30 bytes each), and so does a
/// copy if a :class:`Method` makes its firings or filters.
///
/// Args:
///     scene: a scene with one robot or more.
///     method: one of ``METHODS``, or a :class:`Method`.
///     seed: the seed of the noise, 0 to 2^64 - 1; the scene's by default.
///     firing: a callable that plans the first robot's firings in place of the method. It takes the number of a period,
///         from 0, and returns its length in microseconds and its firings, ``(length_us, [(t_fire_us, sensor), ..])``,
///         optionally with the phase, 0 to 7, as a third element. For other robots, a dict of callables by robot. No
///         sensor may fire while it listens.
///     filter: a callable that judges the first robot's readings in place of the method. It takes a
///         :class:`FiredReading` and returns ``(kind, t_echo_us)``, or a result of :meth:`EchoFilter.push`. For other
///         robots, a dict of callables by robot.
///     mcap: a file to record each step in, for Foxglove, Rerun and ROS 2: ranges, accepted readings, poses, the scene,
///         each reading's path and each firing. :meth:`close` or the end of a ``with`` block ends it.
///
/// The step that called these callables raises their exceptions, and an EerufError about invalid return values. They
/// run within a step, so they cannot query or steer the simulation.
///
/// Raises:
///     EerufError: no such method, or an argument of the wrong type or out of range; the scene has no robot; a ring's
///         listening times do not fit the method, or a period cannot be fired.
///     LogError: the file cannot be written.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
///     >>> world.set_velocity(0, v_m_s=0.3, w_rad_s=0.0)
///     >>> while not world.robots[0].touches:
///     ...     readings = world.step(0.06)
///     >>> round(world.robots[0].pose[1], 1)
///     1.7
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Simulation {
    robots: usize,
    under_way: Mutex<UnderWay>,
    /// The thread that is stepping, so that a callable within it does not wait for itself.
    stepping: Mutex<Option<ThreadId>>,
    asked: Mutex<Asked>,
    calls: Mutex<Arc<Calls>>,
    /// The arguments that recreate the object, and the calls since then.
    made_of: Option<(Py<Scene>, Py<PyAny>)>,
    history: Mutex<History>,
}

/// The calls so far, in order.
#[derive(Default)]
struct History {
    /// Calls before the last copy was made; copies share them.
    before: Vec<Arc<Vec<Done>>>,
    since: Vec<Done>,
}

impl History {
    /// Shares the history with a copy, whatever its length.
    fn share(&mut self) -> Self {
        if !self.since.is_empty() {
            self.before.push(Arc::new(core::mem::take(&mut self.since)));
        }
        Self { before: self.before.clone(), since: vec![] }
    }
}

/// Calls of a simulation, recorded so that a pickle can repeat them.
enum Done {
    Step(f64),
    ToReading(f64),
    Velocity(usize, f64, f64),
    Pose(usize, PoseOf),
    Schedule(usize, Py<Schedule>),
    Scene(Py<Scene>),
}

impl Done {
    /// The name of the called method, and its arguments.
    fn call<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        match self {
            Self::Step(seconds) => ("step", seconds).into_pyobject(py),
            Self::ToReading(seconds) => ("step_to_reading", seconds).into_pyobject(py),
            Self::Velocity(robot, v_m_s, w_rad_s) => ("set_velocity", robot, v_m_s, w_rad_s).into_pyobject(py),
            Self::Pose(robot, pose) => ("set_pose", robot, *pose).into_pyobject(py),
            Self::Schedule(robot, schedule) => ("change_schedule", robot, schedule).into_pyobject(py),
            Self::Scene(scene) => ("change_scene", scene).into_pyobject(py),
        }
    }
}

pub(crate) struct UnderWay {
    pub(crate) simulation: eeruf_sim::Simulation,
    recording: Option<Recording>,
}

/// A simulation at its beginning.
fn begun(asked: &Asked, own: Own, ends: bool, stop: &Stop) -> Result<eeruf_sim::Simulation, SimulationError> {
    let Asked { world, chosen, options } = asked;
    let (world, method) = (Arc::clone(world), chosen.entry.method());
    if ends {
        eeruf_sim::Simulation::ending(world, method, options, own, stop.clone())
    } else {
        eeruf_sim::Simulation::with_own(world, method, options, own, stop.clone())
    }
}

impl Simulation {
    /// A simulation with the caller's own firings and filters, with an optional end.
    pub(crate) fn new_from(
        py: Python<'_>,
        asked: Asked,
        (own, calls): (Own, Arc<Calls>),
        ends: bool,
        mcap: Option<PathBuf>,
    ) -> PyResult<Self> {
        in_background(py, None, move |background| {
            let asked = asked.with_best(background)?;
            let simulation = begun(&asked, own, ends, background.stop());
            let simulation = simulation.map_err(|error| calls.raised().unwrap_or_else(|| error.raise()))?;
            let recording = mcap.map(|file| Recording::create(&file, &simulation)).transpose().map_err(logs::raise)?;
            let under_way = Mutex::new(UnderWay { simulation, recording });
            Ok(Self {
                robots: asked.world.robots().len(),
                under_way,
                stepping: Mutex::default(),
                asked: Mutex::new(asked),
                calls: Mutex::new(calls),
                made_of: None,
                history: Mutex::default(),
            })
        })
    }

    fn asked(&self) -> Asked {
        self.asked.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    fn note(&self, done: Done) {
        self.history.lock().unwrap_or_else(PoisonError::into_inner).since.push(done);
    }

    fn calls(&self) -> Arc<Calls> {
        Arc::clone(&self.calls.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Locks the simulation without holding the interpreter lock, for which its current holder may be waiting.
    pub(crate) fn lock(&self) -> PyResult<MutexGuard<'_, UnderWay>> {
        if *self.stepping.lock().unwrap_or_else(PoisonError::into_inner) == Some(thread::current().id()) {
            let why = "a simulation under way; expected its firing and its filter to leave it alone";
            return Err(EerufError::new_err(why));
        }
        Ok(self.under_way.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Records the stepping thread.
    fn set_stepping(&self, who: Option<ThreadId>) {
        *self.stepping.lock().unwrap_or_else(PoisonError::into_inner) = who;
    }

    fn robot(&self, name: &str, robot: &Bound<'_, PyAny>) -> PyResult<usize> {
        Ok(whole(name, robot, 0..=self.robots as u32 - 1)? as usize)
    }

    /// Steps while checking for Ctrl-C and reporting progress.
    pub(crate) fn go_on(
        &self,
        py: Python<'_>,
        progress: Option<&Bound<'_, PyAny>>,
        step: impl Send
        + FnOnce(
            &mut eeruf_sim::Simulation,
            &mut dyn FnMut(f64) -> bool,
        ) -> Result<eeruf_sim::Readings, SimulationError>,
    ) -> PyResult<Readings> {
        let mut watch = Watch::new(progress)?;
        let (calls, entry) = (self.calls(), self.asked().chosen.entry);
        let readings = py.detach(|| {
            let mut keep_going = |share| watch.go_on(Some(share), || format!("simulating {entry}"));
            let UnderWay { simulation, recording } = &mut *self.lock()?;
            self.set_stepping(Some(thread::current().id()));
            let readings = step(simulation, &mut keep_going);
            self.set_stepping(None);
            let readings = readings.map_err(|error| calls.raised().unwrap_or_else(|| error.raise()))?;
            if let Some(recording) = recording {
                recording.add(simulation, &readings).map_err(logs::raise)?;
            }
            Ok(readings)
        });
        watch.outcome(readings.map(Readings::new))
    }
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scene, method=None, *, seed=None, firing=None, filter=None, mcap=None))]
    #[pyo3(text_signature = "(scene, method=\"eeruf\", *, seed=None, firing=None, filter=None, mcap=None)")]
    fn new(
        scene: &Bound<'_, PyAny>,
        method: Option<&Bound<'_, PyAny>>,
        seed: Option<&Bound<'_, PyAny>>,
        firing: Option<&Bound<'_, PyAny>>,
        filter: Option<&Bound<'_, PyAny>>,
        mcap: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let asked = Asked::new(scene, method, None, seed)?;
        let own = own::own(scene.py(), firing, filter, asked.chosen.makers.as_deref(), asked.world.robots())?;
        let file = |path: &Bound<'_, PyAny>| {
            path.extract::<PathBuf>().map_err(|_| wrong("mcap", shown(path), "the path of a file to write, or None"))
        };
        let mcap = mcap.map(file).transpose()?;
        let made = Self::new_from(scene.py(), asked, own, false, mcap)?;
        let method = method.map_or_else(|| PyString::new(scene.py(), "eeruf").into_any(), Clone::clone);
        let scene = instance::<Scene>("scene", scene, "an eeruf.sim.Scene")?.clone();
        Ok(Self { made_of: Some((scene.unbind(), method.unbind())), ..made })
    }

    /// End the MCAP file, if one is being written; the simulation may go on.
    ///
    /// Raises:
    ///     LogError: the rest could not be written.
    ///
    /// Example:
    ///     >>> from eeruf import logs, sim
    ///     >>> import pathlib, tempfile
    ///     >>> file = pathlib.Path(tempfile.mkdtemp(), "wall.mcap")
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> with sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]), mcap=file) as world:
    ///     ...     readings = world.step(0.6)
    ///     >>> len(logs.read_firings(file)) == len(readings)
    ///     True
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.lock()?.recording.take().map_or(Ok(()), Recording::finish).map_err(logs::raise))
    }

    fn __enter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __exit__(
        &self,
        py: Python<'_>,
        _kind: &Bound<'_, PyAny>,
        _error: &Bound<'_, PyAny>,
        _traceback: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.close(py)
    }

    /// Advance the time, without the interpreter lock. Ctrl-C ends it.
    ///
    /// Args:
    ///     seconds: how long, 0 to 10^9.
    ///
    /// Returns:
    ///     The readings whose windows closed during the step.
    ///
    /// Raises:
    ///     EerufError: an invalid time; a robot has moved out of the scene's reach.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> len(world.step(0.6)) > 70, round(world.time_s, 6)
    ///     (True, 0.6)
    fn step(&self, seconds: &Bound<'_, PyAny>) -> PyResult<Readings> {
        let py = seconds.py();
        let seconds = number("seconds", seconds, 0.0..=1e9)?;
        let readings = self.go_on(py, None, |simulation, keep_going| simulation.step(seconds, keep_going))?;
        self.note(Done::Step(seconds));
        Ok(readings)
    }

    /// Advance the time to the next reading, without the interpreter lock. Ctrl-C ends it.
    ///
    /// Args:
    ///     seconds: how long at most, 0 to 10^9.
    ///
    /// Returns:
    ///     One reading, several of the same moment, or none if the time passed without any.
    ///
    /// Raises:
    ///     EerufError: an invalid time; a robot has moved out of the scene's reach.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> len(world.step_to_reading(0.6)) >= 1, world.time_s < 0.6
    ///     (True, True)
    fn step_to_reading(&self, seconds: &Bound<'_, PyAny>) -> PyResult<Readings> {
        let py = seconds.py();
        let seconds = number("seconds", seconds, 0.0..=1e9)?;
        let readings =
            self.go_on(py, None, |simulation, keep_going| simulation.step_to_reading(seconds, keep_going))?;
        self.note(Done::ToReading(seconds));
        Ok(readings)
    }

    /// Set a robot's forward speed and rate of turn from now on.
    ///
    /// Args:
    ///     robot: its index, from 0.
    ///     v_m_s: the speed ahead in m/s, -50 to 50.
    ///     w_rad_s: the rate of turn in rad/s, counter-clockwise, -50 to 50.
    ///
    /// Raises:
    ///     EerufError: an invalid robot or speed.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> world.set_velocity(0, v_m_s=0.5, w_rad_s=0.0)
    ///     >>> _ = world.step(1.0)
    ///     >>> round(world.robots[0].pose[1], 3)
    ///     0.5
    fn set_velocity(
        &self,
        robot: &Bound<'_, PyAny>,
        v_m_s: &Bound<'_, PyAny>,
        w_rad_s: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let py = robot.py();
        let robot = self.robot("robot", robot)?;
        let (v_m_s, w_rad_s) = (number("v_m_s", v_m_s, -50.0..=50.0)?, number("w_rad_s", w_rad_s, -50.0..=50.0)?);
        py.detach(|| self.lock()?.simulation.set_velocity(robot, v_m_s, w_rad_s).map_err(Raise::raise))?;
        self.note(Done::Velocity(robot, v_m_s, w_rad_s));
        Ok(())
    }

    /// Move a robot to another place at once. It keeps the speeds set last, or stands still.
    ///
    /// A ring with odometry takes the jump for motion. The new place may be occupied: see ``RobotState.touches``.
    ///
    /// Args:
    ///     robot: its index, from 0.
    ///     pose: (x, y, heading) in metres and radians, up to 10^5.
    ///
    /// Raises:
    ///     EerufError: an invalid robot or pose.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> world.set_pose(0, (0.5, 1.0, 1.57))
    ///     >>> world.robots[0].pose
    ///     (0.5, 1.0, 1.57)
    fn set_pose(&self, robot: &Bound<'_, PyAny>, pose: &Bound<'_, PyAny>) -> PyResult<()> {
        let py = robot.py();
        let (robot, pose) = (self.robot("robot", robot)?, pose_of("pose", pose)?);
        py.detach(|| self.lock()?.simulation.set_pose(robot, to_pose(pose)).map_err(Raise::raise))?;
        self.note(Done::Pose(robot, pose));
        Ok(())
    }

    /// Reset the simulation: time 0, and the poses, the scene and the schedules of the start.
    ///
    /// Parts made by ``make_filter`` and ``make_firing`` are remade; callables that were arguments are
    /// kept as they are. An MCAP file that is being written ends.
    ///
    /// Args:
    ///     seed: the seed of the noise from now on; unchanged by default.
    ///
    /// Raises:
    ///     EerufError: an invalid seed.
    ///     LogError: the rest of the file could not be written.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> first = str(world.step(0.6).t_echo_us)
    ///     >>> world.reset(seed=7)
    ///     >>> other = str(world.step(0.6).t_echo_us)
    ///     >>> world.reset(seed=1)
    ///     >>> world.time_s, other != first, str(world.step(0.6).t_echo_us) == first
    ///     (0.0, True, True)
    #[pyo3(signature = (seed=None))]
    fn reset(&self, py: Python<'_>, seed: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let mut asked = self.asked();
        if let Some(seed) = seed {
            asked.options.seed = Some(whole("seed", seed, 0..=u64::MAX)?);
        }
        let makers = asked.chosen.makers.clone();
        let (own, calls) = own::again(py, &self.calls(), makers.as_deref(), asked.world.robots())?;
        py.detach(|| {
            let mut under_way = self.lock()?;
            let simulation = begun(&asked, own, false, &Stop::default());
            under_way.simulation = simulation.map_err(|error| calls.raised().unwrap_or_else(|| error.raise()))?;
            let recording = under_way.recording.take();
            drop(under_way);
            *self.history.lock().unwrap_or_else(PoisonError::into_inner) = History::default();
            *self.asked.lock().unwrap_or_else(PoisonError::into_inner) = asked;
            *self.calls.lock().unwrap_or_else(PoisonError::into_inner) = calls;
            recording.map_or(Ok(()), Recording::finish).map_err(logs::raise)
        })
    }

    /// Change the schedule of a robot's ring at the end of its current period, late enough to keep the intervals of
    /// both. Readings before and after the change are not compared.
    ///
    /// Args:
    ///     robot: its index, from 0.
    ///     schedule: a ``Schedule`` of as many sensors.
    ///
    /// Raises:
    ///     EerufError: no such robot, or something other than a schedule; a method without such a schedule (immediate
    ///         refiring, dither, adaptive, a custom firing), a schedule for another number of sensors, or one in
    ///         which a sensor would fire again while it listens. The ring then continues as before.
    ///
    /// Example:
    ///     >>> import eeruf
    ///     >>> from eeruf import sim
    ///     >>> fast, slow = eeruf.tables.TABLE_I_D.scaled(3, 5), eeruf.tables.TABLE_I_D
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=12, spacing_rad=0.26, radius_m=0.3, schedule=fast)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> before = len(world.step(1.2))
    ///     >>> world.change_schedule(0, slow)
    ///     >>> len(world.step(1.2)) < 0.75 * before
    ///     True
    fn change_schedule(&self, robot: &Bound<'_, PyAny>, schedule: &Bound<'_, PyAny>) -> PyResult<()> {
        let py = robot.py();
        let robot = self.robot("robot", robot)?;
        let given = instance::<Schedule>("schedule", schedule, "an eeruf.Schedule")?;
        let schedule = given.get().0;
        py.detach(|| self.lock()?.simulation.change_schedule(robot, &schedule).map_err(Raise::raise))?;
        self.note(Done::Schedule(robot, given.clone().unbind()));
        Ok(())
    }

    /// Change walls, poles and air from now on, for obstacles that have moved. Sound in flight arrives as it would have
    /// before. Robots are not checked for touching the new scene.
    ///
    /// Args:
    ///     scene: the new scene; its robots, noise, seed, order and physics are ignored.
    ///
    /// Raises:
    ///     EerufError: not a scene; a sensor is within something solid or out of the scene's reach. Everything then
    ///         stays as it was. For a moving robot, the error comes when it fires.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> near, far = sim.Scene([[5, 2, -5, 2]], robots=[robot]), sim.Scene([[5, 2.5, -5, 2.5]])
    ///     >>> world = sim.Simulation(near)
    ///     >>> before = min(world.step(0.6).reference_us)
    ///     >>> world.change_scene(far)
    ///     >>> bool(min(world.step(0.6).reference_us[-8:]) > before + 2_000)
    ///     True
    fn change_scene(&self, scene: &Bound<'_, PyAny>) -> PyResult<()> {
        let py = scene.py();
        let given = instance::<Scene>("scene", scene, "an eeruf.sim.Scene")?;
        let scene = given.get();
        py.detach(|| {
            let now = scene.scene();
            let copied = eeruf_sim::Scene::new(now.walls().to_vec(), now.poles().to_vec(), now.air());
            let copied = copied.map_err(Raise::raise)?;
            self.lock()?.simulation.change_scene(copied).map_err(Raise::raise)
        })?;
        self.note(Done::Scene(given.clone().unbind()));
        Ok(())
    }

    /// The robots now: a list of ``RobotState``.
    #[getter]
    fn robots<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let world = &self.asked().world;
        let state = |(index, robot): (usize, &eeruf_sim::Robot)| {
            let moment = self.lock()?.simulation.moment(index).map_err(Raise::raise)?;
            let touches = world.scene().contact(&Body::Disc(robot.radius_m().max(1e-6)), &moment.pose).is_some();
            Ok((moment, touches))
        };
        let states = py.detach(|| world.robots().iter().enumerate().map(state).collect::<PyResult<Vec<_>>>())?;
        let of_python = |(moment, touches): (Moment, bool)| {
            let (at, velocity) = (moment.pose.translation, (moment.velocity.x, moment.velocity.y));
            let pose = (at.x, at.y, moment.pose.rotation.angle());
            record(py, "RobotState", (pose, velocity, moment.turn_rad_s, touches))
        };
        states.into_iter().map(of_python).collect()
    }

    /// The time that has passed, in seconds.
    #[getter]
    fn time_s(&self, py: Python<'_>) -> PyResult<f64> {
        py.detach(|| Ok(self.lock()?.simulation.time_s()))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let (robots, entry) = (self.robots, self.asked().chosen.entry);
        let time = self.time_s(py).map_or("in a step".to_owned(), |time_s| format!("after {time_s:.3} s"));
        format!("<Simulation: {robots} robots, {entry}, {time}>")
    }

    /// A copy has the same state; if a method makes parts of it, it repeats all calls, as a pickle does.
    fn __copy__<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        let (py, this) = (slf.py(), slf.get());
        let copied = py.detach(|| Ok::<_, PyErr>(this.lock()?.simulation.copy(Stop::default())))?;
        let Some(simulation) = copied else {
            let (rebuild, arguments) = this.__reduce__(py)?;
            return rebuild.call1(arguments);
        };
        let copy = Self {
            robots: this.robots,
            under_way: Mutex::new(UnderWay { simulation, recording: None }),
            stepping: Mutex::default(),
            asked: Mutex::new(this.asked()),
            calls: Mutex::new(this.calls()),
            made_of: this.made_of.as_ref().map(|(scene, method)| (scene.clone_ref(py), method.clone_ref(py))),
            history: Mutex::new(this.history.lock().unwrap_or_else(PoisonError::into_inner).share()),
        };
        Ok(Bound::new(py, copy)?.into_any())
    }

    fn __deepcopy__<'py>(slf: &Bound<'py, Self>, _memo: &Bound<'_, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        Self::__copy__(slf)
    }

    /// A pickle repeats all calls since the beginning, so that it continues in the same way.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Some((scene, method)) = self.made_of.as_ref().filter(|_| !self.calls().is_given()) else {
            let why = "a copy of a simulation with firing or filter; expected a sim.Method that makes them for each";
            return Err(EerufError::new_err(why));
        };
        let history = self.history.lock().unwrap_or_else(PoisonError::into_inner);
        let all = history.before.iter().flat_map(|before| before.iter()).chain(&history.since);
        let done = all.map(|done| done.call(py)).collect::<PyResult<Vec<_>>>()?;
        let rebuild = py.import("eeruf._rebuild")?.getattr("simulation")?;
        Ok((rebuild, (scene, method, self.asked().options.seed, done).into_pyobject(py)?))
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        // A locked list of calls is being changed, so it is in use.
        self.calls.try_lock().map_or(Ok(()), |calls| calls.traverse(&visit))?;
        self.made_of.as_ref().map_or(Ok(()), |(_, method)| visit.call(method))
    }

    fn __clear__(&self) {
        self.calls().clear();
    }
}
