//! `sim.Batch`: many simulations that advance together, on all cores.

use std::sync::Arc;

use eeruf_sim::{Body, Own, PathsError, Robot, Simulation, SimulationError, Stop, Threads};
use numpy::PyReadonlyArray1;
use pyo3::{PyTraverseError, PyVisit, exceptions::PyRuntimeError, prelude::*};
use rayon::prelude::*;

use crate::{
    arguments::{items, matrix, native, number, refused_by_numpy, shown, whole, whole_or, wrong},
    batch_state::{BatchState, Known},
    errors::{EerufError, Raise},
    exclusive::Exclusive,
    pose::{PoseOf, heading, to_pose},
    simulate::Asked,
    watch::{Background, in_background},
};

/// Many simulations that advance together on all cores, without the interpreter lock: arrays in, arrays out. For
/// reinforcement learning and sweeps; only the first robot of each world is steered and observed.
///
/// A world's steps give the readings of :class:`Simulation`, bit for bit, on any number of threads. If a sensor or a
/// body moves into something solid, its world stops at the beginning of that step and ``touches`` until :meth:`reset`.
///
/// Args:
///     scenes: one or more, each with a robot; all first robots have the same number of sensors.
///     method: one of ``METHODS``, or a :class:`Method` without callables, which would hold the interpreter lock.
///     seeds: the seed of each world's noise, 0 to 2^64 - 1; by default its scene's.
///     threads: the number of threads, 1 to 1024; by default one per core.
///
/// Raises:
///     EerufError: no scenes, no such method, or an argument of the wrong type or out of range; a scene has no robot; a
///         ring's listening times do not fit the method, or the method has callables.
///
/// Example:
///     >>> from eeruf import sim
///     >>> robot = sim.Robot((0, 0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3)
///     >>> batch = sim.Batch([sim.Scene([[5, y, -5, y]], robots=[robot]) for y in (1.5, 2.0, 2.5)])
///     >>> state = batch.step(0.6, v_m_s=[0.0, 0.5, 1.0], w_rad_s=0.0)
///     >>> state.t_echo_us.shape, [round(float(y), 1) for y in state.pose[:, 1]]
///     ((3, 8), [0.0, 0.3, 0.6])
#[pyclass(frozen, module = "eeruf.sim")]
pub(crate) struct Batch {
    size: usize,
    sensors: usize,
    /// The method, for scenes that are added later.
    method: Option<Py<PyAny>>,
    worlds: Arc<Exclusive<Vec<Member>>>,
    threads: Arc<Threads>,
}

/// A world of a batch.
struct Member {
    asked: Asked,
    simulation: Simulation,
    /// The latest state of each sensor of the first robot.
    known: Vec<Known>,
    /// True once a sensor went into something solid.
    has_crashed: bool,
}

/// The number of sensors that a batch steers and observes.
fn sensors_of(asked: &Asked) -> usize {
    asked.world.robots().first().map_or(0, |robot| robot.sensors.len())
}

impl Member {
    fn new(asked: Asked) -> Result<Self, SimulationError> {
        let (method, options) = (asked.chosen.entry.method(), &asked.options);
        let simulation = Simulation::with_own(Arc::clone(&asked.world), method, options, Own::new(), Stop::default())?;
        let known = vec![Known::NOTHING; sensors_of(&asked)];
        Ok(Self { asked, simulation, known, has_crashed: false })
    }

    fn step(&mut self, seconds: f64, motion: Option<[f64; 2]>, background: &Background) -> Result<(), SimulationError> {
        for known in &mut self.known {
            (known.readings, known.accepted) = (0, 0);
        }
        if self.has_crashed {
            return Ok(());
        }
        if let Some([v_m_s, w_rad_s]) = motion {
            self.simulation.set_velocity(0, v_m_s, w_rad_s)?;
        }
        let readings = match self.simulation.step(seconds, |_| !background.stop().is_stopped()) {
            Err(SimulationError::Paths { error: PathsError::Inside { .. } | PathsError::Body { .. }, .. }) => {
                self.has_crashed = true;
                return Ok(());
            }
            readings => readings?,
        };
        for reading in (0..readings.len()).filter(|&reading| readings.robot[reading] == 0) {
            let known = &mut self.known[usize::from(readings.sensor[reading])];
            known.readings += 1;
            if readings.is_accepted(reading) {
                known.accepted += 1;
                known.t_echo_us = readings.t_echo_us[reading];
                known.fired_s = readings.fired_s[reading];
                known.is_clear = readings.t_echo_us[reading].is_nan();
                known.is_wrong = readings.is_wrong(reading, eeruf_sim::DEFAULT_TOLERANCE_US);
            }
        }
        Ok(())
    }

    /// A copy in the same state.
    fn copy(&self) -> Option<Self> {
        let (asked, simulation, known) =
            (self.asked.clone(), self.simulation.copy(Stop::default())?, self.known.clone());
        Some(Self { asked, simulation, known, has_crashed: self.has_crashed })
    }

    /// Pose as (x, y, heading), and true if the disc that holds the sensors touches something.
    fn robot(&self) -> Result<([f64; 3], bool), SimulationError> {
        let (pose, world) = (self.simulation.moment(0)?.pose, &self.asked.world);
        let radius_m = world.robots().first().map_or(0.0, Robot::radius_m);
        let touches = self.has_crashed || world.scene().contact(&Body::Disc(radius_m.max(1e-6)), &pose).is_some();
        Ok(([pose.translation.x, pose.translation.y, pose.rotation.angle()], touches))
    }
}

/// Puts the index of a world before its error.
fn of_world(index: usize) -> impl Fn(SimulationError) -> PyErr {
    move |error| {
        Python::attach(|py| match error.raise() {
            why if why.is_instance_of::<EerufError>(py) => {
                EerufError::new_err(format!("world {index}: {}", why.value(py)))
            }
            why => why,
        })
    }
}

impl Batch {
    /// Observes the state of all worlds.
    fn look(worlds: &[Member]) -> PyResult<BatchState> {
        let mut state = BatchState::with_room(worlds.len(), worlds.first().map_or(0, |world| world.known.len()));
        for (index, world) in worlds.iter().enumerate() {
            let (pose, touches) = world.robot().map_err(of_world(index))?;
            state.push(world.simulation.time_s(), pose, touches, &world.known);
        }
        Ok(state)
    }

    /// One value for each world, from a number or an array.
    fn for_each(&self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
        let expected = format!("a number, or one for each of the {} worlds, from -50 to 50", self.size);
        let refused = || wrong(name, shown(value), &expected);
        let array = native(value, Some("float64")).map_err(|error| refused_by_numpy(error, value.py(), refused))?;
        let numpy = value.py().import("numpy")?;
        let array = numpy.call_method1("broadcast_to", (array, (self.size,))).map_err(|_| refused())?;
        let array = native(&array, None)?;
        let values = array.extract::<PyReadonlyArray1<'_, f64>>().map_err(|_| refused())?.as_array().to_vec();
        if values.iter().all(|value| (-50.0..=50.0).contains(value)) { Ok(values) } else { Err(refused()) }
    }

    /// Indices of worlds given by a mask or by numbers; all if none are given.
    fn chosen(&self, worlds: Option<&Bound<'_, PyAny>>) -> PyResult<Vec<usize>> {
        let Some(worlds) = worlds else { return Ok((0..self.size).collect()) };
        let expected = format!("a mask of {} truth values, or numbers of worlds, each once", self.size);
        let refused = || wrong("worlds", shown(worlds), &expected);
        let numpy = worlds.py().import("numpy")?;
        let array = numpy.call_method1("asarray", (worlds,)).map_err(|_| refused())?;
        if array.getattr("dtype")?.getattr("kind")?.extract::<String>()? == "b" {
            let mask = array.call_method0("tolist")?.extract::<Vec<bool>>().map_err(|_| refused())?;
            if mask.len() != self.size {
                return Err(refused());
            }
            return Ok((0..self.size).filter(|&index| mask[index]).collect());
        }
        let indices = array.call_method0("tolist")?.extract::<Vec<usize>>().map_err(|_| refused())?;
        let mut sorted = indices.clone();
        sorted.sort_unstable();
        sorted.dedup();
        let fine = sorted.len() == indices.len() && sorted.last().is_none_or(|&last| last < self.size);
        if fine { Ok(indices) } else { Err(refused()) }
    }
}

fn no_threads(error: impl std::error::Error) -> PyErr {
    PyRuntimeError::new_err(format!("no threads to step on: {error}"))
}

/// Seeds, one for each world.
fn seeds_of(seeds: Option<&Bound<'_, PyAny>>, worlds: usize) -> PyResult<Vec<Option<u64>>> {
    let Some(seeds) = seeds else { return Ok(vec![None; worlds]) };
    let expected = format!("a seed for each of {worlds} worlds");
    let given = items("seeds", seeds, &expected)?;
    if given.len() != worlds {
        return Err(wrong("len(seeds)", given.len(), worlds));
    }
    let seed = |(index, seed): (usize, &Bound<'_, PyAny>)| whole(&format!("seeds[{index}]"), seed, 0..=u64::MAX);
    given.iter().enumerate().map(|each| seed(each).map(Some)).collect()
}

#[pymethods]
impl Batch {
    #[new]
    #[pyo3(signature = (scenes, method=None, *, seeds=None, threads=None))]
    #[pyo3(text_signature = "(scenes, method=\"eeruf\", *, seeds=None, threads=None)")]
    fn new(
        scenes: &Bound<'_, PyAny>,
        method: Option<&Bound<'_, PyAny>>,
        seeds: Option<&Bound<'_, PyAny>>,
        threads: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<Self> {
        let py = scenes.py();
        let scenes = items("scenes", scenes, "several eeruf.sim.Scene")?;
        if scenes.is_empty() {
            return Err(wrong("scenes", "[]", "one eeruf.sim.Scene or more"));
        }
        let mut asked = Vec::with_capacity(scenes.len());
        for (scene, seed) in scenes.iter().zip(seeds_of(seeds, scenes.len())?) {
            let mut world = Asked::new(scene, method, None, None)?;
            world.options.seed = seed;
            asked.push(world);
        }
        if asked[0].chosen.makers.is_some() {
            let why = "a batch by a method with make_filter or make_firing; expected one without callables, which \
                       would hold the interpreter lock";
            return Err(EerufError::new_err(why));
        }
        let sensors = sensors_of(&asked[0]);
        if let Some(other) = asked.iter().position(|world| sensors_of(world) != sensors) {
            let name = format!("sensors of the first robot of scenes[{other}]");
            return Err(wrong(&name, sensors_of(&asked[other]), format_args!("{sensors}, as of scenes[0]")));
        }
        let threads = whole_or("threads", threads, 0, 1..=1024_u32)?;
        let threads = Threads::new(threads as usize);
        threads.pool().map_err(no_threads)?;
        let size = asked.len();
        let worlds = in_background(py, None, move |background| {
            let begin =
                |(index, asked): (usize, Asked)| Member::new(asked.with_best(background)?).map_err(of_world(index));
            asked.into_iter().enumerate().map(begin).collect::<PyResult<Vec<_>>>()
        })?;
        Ok(Self {
            size,
            sensors,
            method: method.map(|method| method.clone().unbind()),
            worlds: Arc::new(Exclusive::new("Batch", worlds)),
            threads: Arc::new(threads),
        })
    }

    fn __len__(&self) -> usize {
        self.size
    }

    /// Number of sensors of each world's first robot.
    #[getter]
    fn sensors(&self) -> usize {
        self.sensors
    }

    /// Advance all worlds, on all cores and without the interpreter lock. Ctrl-C ends it.
    ///
    /// Args:
    ///     seconds: how long, 0 to 10^9.
    ///     v_m_s: the first robots' speed ahead from now on, in m/s, -50 to 50: a number, or one for each world.
    ///         Without it they keep their speeds.
    ///     w_rad_s: their rate of turn, counter-clockwise, in rad/s; given together with ``v_m_s``.
    ///
    /// Returns:
    ///     The state of all worlds afterwards.
    ///
    /// Raises:
    ///     EerufError: an invalid time or speed; a robot has moved out of its scene's reach. Other worlds may have
    ///         advanced; :meth:`reset` this one.
    ///
    /// Example:
    ///     >>> from eeruf import experiments, sim
    ///     >>> batch = sim.Batch(experiments.courses(0, 4), "flow")
    ///     >>> state = batch.step(0.5, v_m_s=0.4, w_rad_s=[0.0, 0.1, 0.0, -0.1])
    ///     >>> bool((state.accepted.sum(axis=1) > 2).all())
    ///     True
    #[pyo3(signature = (seconds, v_m_s=None, w_rad_s=None))]
    fn step(
        &self,
        seconds: &Bound<'_, PyAny>,
        v_m_s: Option<&Bound<'_, PyAny>>,
        w_rad_s: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<BatchState> {
        let py = seconds.py();
        let seconds = number("seconds", seconds, 0.0..=1e9)?;
        let motions = match (v_m_s, w_rad_s) {
            (None, None) => None,
            (Some(v), Some(w)) => {
                let pairs = self.for_each("v_m_s", v)?.into_iter().zip(self.for_each("w_rad_s", w)?);
                Some(pairs.map(|(v, w)| [v, w]).collect::<Vec<_>>())
            }
            (None, Some(_)) => return Err(wrong("v_m_s", "None", "a speed beside w_rad_s")),
            (Some(_), None) => return Err(wrong("w_rad_s", "None", "a rate of turn beside v_m_s")),
        };
        let (worlds, threads) = (Arc::clone(&self.worlds), Arc::clone(&self.threads));
        in_background(py, None, move |background| {
            let mut guard = worlds.get()?;
            let worlds = &mut *guard;
            let go_on = |(index, world): (usize, &mut Member)| {
                let motion = motions.as_ref().map(|motions| motions[index]);
                world.step(seconds, motion, background).map_err(of_world(index))
            };
            threads.pool().map_err(no_threads)?.install(|| worlds.par_iter_mut().enumerate().try_for_each(go_on))?;
            Self::look(worlds)
        })
    }

    /// The state of all worlds now.
    ///
    /// Example:
    ///     >>> from eeruf import experiments, sim
    ///     >>> sim.Batch(experiments.courses(0, 2)).state.pose.tolist()
    ///     [[1.0, 3.0, 0.0], [1.0, 3.0, 0.0]]
    #[getter]
    fn state(&self, py: Python<'_>) -> PyResult<BatchState> {
        py.detach(|| Self::look(&self.worlds.get()?))
    }

    /// Reset some worlds: time 0, robots at their initial poses.
    ///
    /// Args:
    ///     worlds: a mask, or indices from 0; all by default.
    ///     seeds: new seeds of their noise, one for each; unchanged by default.
    ///     scenes: new scenes, one for each, whose first robots have the same number of sensors as before.
    ///     poses: initial poses of their first robots: an array of shape (n, 3), x, y, heading in metres and radians.
    ///
    /// Returns:
    ///     The state of all worlds afterwards.
    ///
    /// Raises:
    ///     EerufError: invalid worlds, or an argument without one entry for each; a ring's listening times do not
    ///         fit the method.
    ///
    /// Example:
    ///     >>> from eeruf import experiments, sim
    ///     >>> batch = sim.Batch(experiments.courses(0, 3))
    ///     >>> _ = batch.step(0.6, v_m_s=0.5, w_rad_s=0.0)
    ///     >>> state = batch.reset([False, True, False], scenes=experiments.courses(7, 1), seeds=[7])
    ///     >>> [round(float(time), 1) for time in state.time_s]
    ///     [0.6, 0.0, 0.6]
    #[pyo3(signature = (worlds=None, *, seeds=None, scenes=None, poses=None))]
    fn reset(
        &self,
        py: Python<'_>,
        worlds: Option<&Bound<'_, PyAny>>,
        seeds: Option<&Bound<'_, PyAny>>,
        scenes: Option<&Bound<'_, PyAny>>,
        poses: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<BatchState> {
        let chosen = self.chosen(worlds)?;
        let seeds = seeds_of(seeds, chosen.len())?;
        let scenes = scenes.map(|scenes| items("scenes", scenes, "several eeruf.sim.Scene")).transpose()?;
        if let Some(scenes) = scenes.as_ref().filter(|scenes| scenes.len() != chosen.len()) {
            return Err(wrong("len(scenes)", scenes.len(), chosen.len()));
        }
        let poses = poses.map(|poses| poses_of(poses, chosen.len())).transpose()?;
        let method = self.method.as_ref().map(|method| method.bind(py));
        let mut others = Vec::new();
        for (index, scene) in scenes.iter().flatten().enumerate() {
            let other = Asked::new(scene, method, None, None)?;
            if sensors_of(&other) != self.sensors {
                let name = format!("sensors of the first robot of scenes[{index}]");
                return Err(wrong(&name, sensors_of(&other), self.sensors));
            }
            others.push(other);
        }
        let worlds = Arc::clone(&self.worlds);
        in_background(py, None, move |background| {
            let mut worlds = worlds.get()?;
            let mut others = others.into_iter();
            for (place, &index) in chosen.iter().enumerate() {
                let seed = seeds[place].or(worlds[index].asked.options.seed);
                let mut asked = others
                    .next()
                    .map_or_else(|| Ok(worlds[index].asked.clone()), |other| other.with_best(background))?;
                asked.options.seed = seed;
                let mut member = Member::new(asked).map_err(of_world(index))?;
                if let Some(poses) = &poses {
                    member.simulation.set_pose(0, to_pose(poses[place])).map_err(of_world(index))?;
                }
                worlds[index] = member;
            }
            Self::look(&worlds)
        })
    }

    fn __repr__(&self) -> String {
        format!("<Batch: {} worlds of {} sensors>", self.size, self.sensors)
    }

    /// Copies the worlds in their current states; the copy steps on its own threads.
    fn __copy__(&self, py: Python<'_>) -> PyResult<Self> {
        let copied =
            py.detach(|| Ok::<_, PyErr>(self.worlds.get()?.iter().map(Member::copy).collect::<Option<_>>()))?;
        // No world of a batch has callables.
        let worlds = copied.ok_or_else(|| EerufError::new_err("a batch with callables cannot be copied"))?;
        Ok(Self {
            method: self.method.as_ref().map(|method| method.clone_ref(py)),
            worlds: Arc::new(Exclusive::new("Batch", worlds)),
            threads: Arc::new(self.threads.others()),
            ..*self
        })
    }

    fn __deepcopy__(&self, py: Python<'_>, _memo: &Bound<'_, PyAny>) -> PyResult<Self> {
        self.__copy__(py)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.method.as_ref().map_or(Ok(()), |method| visit.call(method))
    }
}

/// Poses, one for each world.
fn poses_of(poses: &Bound<'_, PyAny>, worlds: usize) -> PyResult<Vec<PoseOf>> {
    let poses = matrix("poses", poses, 3)?;
    let rows: Vec<_> = poses.as_array().rows().into_iter().map(|row| (row[0], row[1], row[2])).collect();
    if rows.len() != worlds {
        return Err(wrong("len(poses)", rows.len(), worlds));
    }
    for (index, pose) in rows.iter().enumerate() {
        if [pose.0, pose.1, pose.2].iter().any(|value| !(-1e5..=1e5).contains(value)) {
            let name = format!("poses[{index}]");
            return Err(wrong(&name, format_args!("{pose:?}"), "metres and radians from -100000 to 100000"));
        }
        heading(&format!("poses[{index}][2]"), pose.2)?;
    }
    Ok(rows)
}
