//! `sim.Simulation`, which goes on step by step, and `sim.simulate_blocks`.

use std::{
    path::PathBuf,
    sync::{Mutex, MutexGuard, PoisonError},
};

use eeruf::Recording;
use eeruf_sim::{Body, Point, SimulationError, simulation::expected_readings};
use pyo3::{
    prelude::*,
    types::{PyDict, PyTuple},
};

use crate::{
    arguments::{flag, number, number_or, shown, whole, whole_or, wrong},
    errors::Raise,
    fields::to_dict,
    logs, memory,
    pose::{point_of, pose_of},
    readings::Readings,
    simulate::Asked,
    watch::{Watch, in_background},
};

/// How many periods a block has unless another number is asked for.
const BLOCK_PERIODS: u32 = 10_000;

/// A robot of a ``Simulation``, now.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((1, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot])).robots[0].pose
///     (1.0, 0.0, 0.0)
#[pyclass(frozen, eq, get_all, module = "eeruf.sim")]
#[derive(Clone, PartialEq)]
pub(crate) struct RobotState {
    /// (x, y, heading) in metres and radians.
    pose: (f64, f64, f64),
    /// Velocity along x and y, in m/s.
    velocity_m_s: (f64, f64),
    /// Rate of turn, counter-clockwise, in rad/s.
    turn_rad_s: f64,
    /// Whether the disc that holds its sensors touches a wall or a pole.
    touches: bool,
}

#[pymethods]
impl RobotState {
    #[new]
    #[pyo3(signature = (pose, velocity_m_s=None, turn_rad_s=None, touches=None))]
    #[pyo3(text_signature = "(pose, velocity_m_s=(0.0, 0.0), turn_rad_s=0.0, touches=False)")]
    fn new(
        pose: &Bound<'_, PyAny>,
        velocity_m_s: Option<&Bound<'_, PyAny>>,
        turn_rad_s: Option<&Bound<'_, PyAny>>,
        touches: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let velocity = velocity_m_s.map(|velocity| point_of("velocity_m_s", velocity)).transpose()?;
        Ok(Self {
            pose: pose_of("pose", pose)?,
            velocity_m_s: velocity.map_or((0.0, 0.0), |velocity: Point| (velocity.x, velocity.y)),
            turn_rad_s: number_or("turn_rad_s", turn_rad_s, 0.0, f64::MIN..=f64::MAX)?,
            touches: flag("touches", touches, false)?,
        })
    }

    /// Its fields by their names: a dict of plain values.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((1, 0, 0), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot])).robots[0].to_dict()["pose"]
    ///     [1.0, 0.0, 0.0]
    fn to_dict<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        to_dict(slf, &["pose", "velocity_m_s", "turn_rad_s", "touches"])
    }

    fn __repr__(&self) -> String {
        let Self { pose, velocity_m_s, turn_rad_s, touches } = self;
        let touches = if *touches { "True" } else { "False" };
        format!(
            "RobotState(pose={pose:?}, velocity_m_s={velocity_m_s:?}, turn_rad_s={turn_rad_s:?}, touches={touches})"
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        let Self { pose, velocity_m_s, turn_rad_s, touches } = *slf.get();
        let fields = (pose, velocity_m_s, turn_rad_s, touches).into_pyobject(slf.py())?;
        Ok((slf.get_type().into_any(), fields))
    }
}

/// A world that goes on step by step: for your own controller, filter, or display.
///
/// Its steps together give the readings of :func:`simulate`, bit for bit, and need no more memory than one of them.
///
/// Args:
///     scene: with one robot or more.
///     method: one of ``METHODS``.
///     seed: of the noise, 0 to 2^64 - 1; the scene's by default.
///     mcap: a file that each step is written into, for Foxglove, Rerun and ROS 2: ranges, what is accepted, poses, the
///         scene, each reading's path and each firing. :meth:`close` ends it, and so does ``with``.
///
/// Raises:
///     ArgumentError: no such method, or something of the wrong type or out of range.
///     SceneError: the scene has no robot.
///     SimulationError: a ring cannot fire by the method as it should listen.
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
    under_way: Mutex<UnderWay>,
    asked: Asked,
}

struct UnderWay {
    simulation: eeruf_sim::Simulation,
    recording: Option<Recording>,
}

/// A step cannot be taken, or not written.
enum StepError {
    Simulation(SimulationError),
    Log(eeruf_logs::LogError),
}

impl Raise for StepError {
    fn raise(self) -> PyErr {
        match self {
            Self::Simulation(error) => error.raise(),
            Self::Log(error) => logs::raise(error),
        }
    }
}

impl Simulation {
    fn new_from(py: Python<'_>, asked: Asked, ending: bool, mcap: Option<PathBuf>) -> PyResult<Self> {
        in_background(py, None, move |background| {
            let asked = asked.with_best(background)?;
            let Asked { ref world, method, ref options } = asked;
            let start = if ending { eeruf_sim::Simulation::ending } else { eeruf_sim::Simulation::new };
            let simulation = start(world.clone(), method, options, background.stop().clone()).map_err(Raise::raise)?;
            let recording = mcap.map(|file| Recording::create(&file, &simulation)).transpose().map_err(logs::raise)?;
            Ok(Self { under_way: Mutex::new(UnderWay { simulation, recording }), asked })
        })
    }

    /// Without the interpreter lock: whoever holds the simulation may wait for that.
    fn lock(&self) -> MutexGuard<'_, UnderWay> {
        self.under_way.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Lets time pass while Ctrl-C and progress are looked after.
    fn go_on(
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
        let readings = py.detach(|| {
            let mut keep_going = |share| watch.go_on(Some(share), || format!("simulating {}", self.asked.method));
            let UnderWay { simulation, recording } = &mut *self.lock();
            let readings = step(simulation, &mut keep_going).map_err(StepError::Simulation)?;
            if let Some(recording) = recording {
                recording.add(simulation, &readings).map_err(StepError::Log)?;
            }
            Ok::<_, StepError>(readings)
        });
        watch.outcome(readings.map(Readings::new).map_err(Raise::raise))
    }
}

#[pymethods]
impl Simulation {
    #[new]
    #[pyo3(signature = (scene, method=None, *, seed=None, mcap=None))]
    #[pyo3(text_signature = "(scene, method=\"eeruf\", *, seed=None, mcap=None)")]
    fn new(
        scene: &Bound<'_, PyAny>,
        method: Option<&Bound<'_, PyAny>>,
        seed: Option<&Bound<'_, PyAny>>,
        mcap: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let file = |path: &Bound<'_, PyAny>| {
            path.extract::<PathBuf>().map_err(|_| wrong("mcap", shown(path), "the path of a file to write, or None"))
        };
        let mcap = mcap.map(file).transpose()?;
        Self::new_from(scene.py(), Asked::new(scene, method, None, seed)?, false, mcap)
    }

    /// End the MCAP file, if one is being written; the simulation may go on.
    ///
    /// Raises:
    ///     LogError: what was left could not be written.
    ///
    /// Example:
    ///     >>> from eeruf import read_firings, sim
    ///     >>> import pathlib, tempfile
    ///     >>> file = pathlib.Path(tempfile.mkdtemp(), "wall.mcap")
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> with sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]), mcap=file) as world:
    ///     ...     readings = world.step(0.6)
    ///     >>> len(read_firings(file)) == len(readings)
    ///     True
    fn close(&self, py: Python<'_>) -> PyResult<()> {
        py.detach(|| self.lock().recording.take().map_or(Ok(()), Recording::finish)).map_err(logs::raise)
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

    /// Let time pass, without the interpreter lock. Ctrl-C ends it.
    ///
    /// Args:
    ///     seconds: how long, 0 to 10^9.
    ///
    /// Returns:
    ///     What was read meanwhile: the readings whose windows have closed.
    ///
    /// Raises:
    ///     ArgumentError: no such time.
    ///     SimulationError: a robot has moved out of the scene's reach.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> len(world.step(0.6)) > 70, round(world.time_s, 6)
    ///     (True, 0.6)
    #[pyo3(signature = (seconds))]
    fn step(&self, seconds: &Bound<'_, PyAny>) -> PyResult<Readings> {
        let py = seconds.py();
        let seconds = number("seconds", seconds, 0.0..=1e9)?;
        self.go_on(py, None, |simulation, keep_going| simulation.step(seconds, keep_going))
    }

    /// Let time pass until the next reading comes, without the interpreter lock. Ctrl-C ends it.
    ///
    /// Args:
    ///     seconds: how long at most, 0 to 10^9.
    ///
    /// Returns:
    ///     What was read then: one reading, several of the same moment, or none if that time passed before.
    ///
    /// Raises:
    ///     ArgumentError: no such time.
    ///     SimulationError: a robot has moved out of the scene's reach.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> len(world.step_to_reading(0.6)) >= 1, world.time_s < 0.6
    ///     (True, True)
    #[pyo3(signature = (seconds))]
    fn step_to_reading(&self, seconds: &Bound<'_, PyAny>) -> PyResult<Readings> {
        let py = seconds.py();
        let seconds = number("seconds", seconds, 0.0..=1e9)?;
        self.go_on(py, None, |simulation, keep_going| simulation.step_to_reading(seconds, keep_going))
    }

    /// From now on a robot goes ahead and turns at these speeds, whatever its motion was.
    ///
    /// Args:
    ///     robot: which one, from 0.
    ///     v_m_s: the speed ahead in m/s, -50 to 50.
    ///     w_rad_s: the rate of turn in rad/s, counter-clockwise, -50 to 50.
    ///
    /// Raises:
    ///     ArgumentError: no such robot or speed.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
    ///     >>> world = sim.Simulation(sim.Scene([[5, 2, -5, 2]], robots=[robot]))
    ///     >>> world.set_velocity(0, v_m_s=0.5, w_rad_s=0.0)
    ///     >>> _ = world.step(1.0)
    ///     >>> round(world.robots[0].pose[1], 3)
    ///     0.5
    #[pyo3(signature = (robot, v_m_s, w_rad_s))]
    fn set_velocity(
        &self,
        robot: &Bound<'_, PyAny>,
        v_m_s: &Bound<'_, PyAny>,
        w_rad_s: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let py = robot.py();
        let last = self.asked.world.robots().len() as u32 - 1;
        let robot = whole("robot", robot, 0..=last)? as usize;
        let (v_m_s, w_rad_s) = (number("v_m_s", v_m_s, -50.0..=50.0)?, number("w_rad_s", w_rad_s, -50.0..=50.0)?);
        py.detach(|| self.lock().simulation.set_velocity(robot, v_m_s, w_rad_s)).map_err(Raise::raise)
    }

    /// The robots now: a list of ``RobotState``.
    #[getter]
    fn robots(&self, py: Python<'_>) -> PyResult<Vec<RobotState>> {
        let world = &self.asked.world;
        let state = |(index, robot): (usize, &eeruf_sim::Robot)| {
            let moment = self.lock().simulation.moment(index)?;
            let at = moment.pose.translation;
            Ok(RobotState {
                pose: (at.x, at.y, moment.pose.rotation.angle()),
                velocity_m_s: (moment.velocity.x, moment.velocity.y),
                turn_rad_s: moment.turn_rad_s,
                touches: world.scene().contact(&Body::Disc(robot.radius_m().max(1e-6)), &moment.pose).is_some(),
            })
        };
        let states: Result<_, SimulationError> = py.detach(|| world.robots().iter().enumerate().map(state).collect());
        states.map_err(Raise::raise)
    }

    /// The time that has passed, in seconds.
    #[getter]
    fn time_s(&self, py: Python<'_>) -> f64 {
        py.detach(|| self.lock().simulation.time_s())
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        let robots = self.asked.world.robots().len();
        format!("<Simulation: {robots} robots, {}, after {:.3} s>", self.asked.method, self.time_s(py))
    }
}

/// The readings of a simulation block by block: an iterator that Ctrl-C interrupts.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
///     >>> blocks = list(sim.simulate_blocks(scene, periods=25, block_periods=10))
///     >>> len(blocks), sum(map(len, blocks))
///     (3, 200)
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct ReadingBlocks {
    simulation: Simulation,
    block_periods: u32,
    progress: Option<Py<PyAny>>,
}

#[pymethods]
impl ReadingBlocks {
    fn __iter__(slf: PyRef<'_, Self>) -> PyRef<'_, Self> {
        slf
    }

    fn __next__(&self, py: Python<'_>) -> PyResult<Option<Readings>> {
        if py.detach(|| self.simulation.lock().simulation.is_over()) {
            return Ok(None);
        }
        let periods = self.block_periods;
        let progress = self.progress.as_ref().map(|progress| progress.bind(py));
        self.simulation
            .go_on(py, progress, |simulation, keep_going| simulation.step_periods(periods, keep_going))
            .map(Some)
    }
}

/// As :func:`simulate`, but block by block: however long it is, it needs no more memory than a block.
///
/// Args:
///     scene: as for :func:`simulate`, and so all others.
///     method: as for :func:`simulate`.
///     periods: for how many periods of the first robot, 1 or more.
///     seed: as for :func:`simulate`.
///     block_periods: how many periods a block has at most.
///     progress: as for :func:`simulate`.
///
/// Returns:
///     An iterator of ``Readings``, which together are those of :func:`simulate`.
///
/// Raises:
///     ArgumentError: as for :func:`simulate`, and so all others.
///     SceneError: as for :func:`simulate`.
///     SimulationError: as for :func:`simulate`.
///     MemoryError: a block does not fit into memory.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> scene = sim.Scene([[5, 2, -5, 2]], robots=[robot])
///     >>> wrong = 0
///     >>> for readings in sim.simulate_blocks(scene, periods=2_000, block_periods=500):
///     ...     wrong += int((readings.is_accepted & readings.is_wrong()).sum())
///     >>> wrong < 40
///     True
#[pyfunction]
#[pyo3(signature = (scene, method=None, periods=None, seed=None, *, block_periods=None, progress=None))]
#[pyo3(text_signature = "(scene, method=\"eeruf\", periods=1000, seed=None, *, block_periods=10000, progress=None)")]
pub(crate) fn simulate_blocks(
    scene: &Bound<'_, PyAny>,
    method: Option<&Bound<'_, PyAny>>,
    periods: Option<&Bound<'_, PyAny>>,
    seed: Option<&Bound<'_, PyAny>>,
    block_periods: Option<&Bound<'_, PyAny>>,
    progress: Option<&Bound<'_, PyAny>>,
) -> PyResult<ReadingBlocks> {
    let asked = Asked::new(scene, method, periods, seed)?;
    let block_periods = whole_or("block_periods", block_periods, BLOCK_PERIODS, 1..=u32::MAX)?;
    let readings = expected_readings(&asked.world, block_periods.min(asked.options.periods));
    let bytes = eeruf_sim::Readings::bytes_for(readings);
    memory::check(&format!("{readings} readings"), bytes, "so fewer block_periods")?;
    // What is wrong with it is said now, not with the first block.
    Watch::new(progress)?;
    let simulation = Simulation::new_from(scene.py(), asked, true, None)?;
    Ok(ReadingBlocks { simulation, block_periods, progress: progress.map(|progress| progress.clone().unbind()) })
}
