//! `sim.Robot`: a robot with its ring.

use std::f64::consts::TAU;

use eeruf_core::{Micros, SensorLimits};
use eeruf_design::RingSpec;
use eeruf_sim::{Beam, Clock, GainProfile, Motion, Point, Sketch, Transducer, world::cover_motion};
use pyo3::{
    prelude::*,
    types::{PyDict, PyString},
};

use crate::{
    arguments::{
        choice, flag, in_radians, instance, items, micros, number, number_or, shown, times, whole, whole_or, wrong,
    },
    body::{outline, shown_body},
    errors::EerufError,
    faults::{shown_table, table_of},
    fields::{Reduced, attributes, call, reduce_by_name},
    module::{modules, shown_module},
    needs::Needs,
    pose::{from_pose, motion, pose_of, to_pose},
    requirements::{self, Asked},
    schedule::Schedule,
};

/// A robot with a ring of sensors, on an arc centred straight ahead or at places of your own.
///
/// Args:
///     pose: (x, y, heading) in metres and radians, counter-clockwise from the x axis.
///     sensors: how many on an arc, 1 to 64; or the place of each on the robot, as (x, y, heading). None if the ring
///         file has them.
///     spacing_rad: the angle from one sensor to the next on the arc, in radians.
///     radius_m: the radius of the arc, in metres.
///     module: its sensors' module: a name such as ``"hc-sr04"``, a dict of differences from one, such as
///         ``{"like": "hc-sr04", "sees_to_m": 2.5}``, or a list with one for each sensor; docs/reference/modules.md
///         lists them all.
///     gain: how the receiver's gain grows while it listens: ``"constant"``, ``"square_root"``, ``"linear"``,
///         ``"stepped"`` or ``"polaroid_6500"``, the steps of that module's control circuit.
///     beam: the pattern near 90 degrees off a sensor's axis: ``"cut_at_90"``, an endless baffle with nothing behind,
///         or ``"continuous"``, a baffle that ends; None for the module's own, ``"cut_at_90"`` of the
///         Polaroid 6500 and ``"continuous"`` of the HC-SR04.
///     coupling_db: the level of the sound that the mounting carries straight from sensor to sensor, relative to two
///         that face each other at the same distance, -200 to 0; None to use the patterns.
///     height_m: the sensors' height above the floor in metres, one for all or one each; for scenes that are not flat.
///     body: its outline, which reflects and shades the sound of others: the radius of a disc, (length, width) of a
///         box, or 3 to 8 corners (x, y) of a convex polygon, counter-clockwise, all in metres; None for no body.
///     period_us: ``T_p`` of the methods that bring no schedule of their own; the schedule's if there is one.
///     t_delta_us: ``T_delta``: consecutive readings that differ by no more are near-identical; one for all, or a list
///         of one for each sensor, for the robot's own schedule.
///     window_us: ``T_wind``: how long a sensor listens; one for all, or a list.
///     together: sets of sensors that the robot's own schedule fires at once, such as ``[[8, 9], [10, 11]]``.
///     blanking_us: how long a sensor is deaf after it has fired, one for all or a list; by default the
///         module's own.
///     min_refire_us: with immediate refiring, how long a sensor rests between its echo and its next firing.
///     audible_us: how long sound stays audible, for methods that fire one sensor at a time; by default from ``module``
///         if that is given, or else the listening time.
///     path_change_us: P: the largest change of a foreign sound's path from one reading to the next, where
///         a table fires the ring, at most 65,534 us; None for ``t_delta_us``.
///     ring: a :class:`~eeruf.Needs`, or the path of a ring file, that gives modules, windows, ``T_delta``, sensors
///         that fire together, neighbours, ``path_change_us`` and ``audible_us``, unless these are given here.
///     firing: a dict with the keys of ``[firing]`` in scene files, such as ``{"turn_us": 33_000}``, for the methods
///         that fire like sketches and modules.
///     start_us: when the ring begins to fire, by its own clock.
///     schedule: the schedule of the EERUF methods; None for the paper's table, scaled to the period.
///     neighbours: how many adjacent sensors must not fire close together, 1 to 64.
///     consecutive: how many readings in a row must agree, 2 to 8.
///     odometry: whether the robot tells its ring the changes of readings to expect from its own motion.
///     velocity_m_s: a constant velocity, (x, y) in the scene's frame, in m/s.
///     turn_rad_s: a constant rate of turn, in rad/s.
///     waypoints_m: points (x, y) that it drives through in straight lines, instead of a velocity.
///     speed_m_s: how fast it does so, in m/s.
///     clock_offset_us: what its clock shows at the start.
///     clock_drift_ppm: rate error of its clock, positive if fast, in millionths.
///
/// Raises:
///     EerufError: an argument of the wrong type or out of range, or two kinds of motion at once.
///
/// Example:
///     >>> from eeruf import sim
///     >>> sim.Robot((0.0, 0.0, 1.57), sensors=8, spacing_rad=0.26, radius_m=0.3).period_us
///     60000
///     >>> sim.Robot((0, 0, 0), sensors=[(0.1, 0.1, 0.5), (0.1, -0.1, -0.5)], module="hc-sr04").sensors
///     2
#[pyclass(frozen, eq, module = "eeruf.sim")]
#[derive(Clone, PartialEq)]
pub(crate) struct Robot {
    pub(crate) robot: eeruf_sim::Robot,
    /// (x, y, heading) in metres and radians.
    #[pyo3(get)]
    pose: (f64, f64, f64),
    /// The place of each sensor on the robot: (x, y, heading) in metres and radians.
    #[pyo3(get)]
    sensor_poses: Vec<(f64, f64, f64)>,
    /// The angle from one sensor to the next, in radians; None for sensors at places of their own.
    #[pyo3(get)]
    spacing_rad: Option<f64>,
    /// The radius of the arc, in metres; None for sensors at places of their own.
    #[pyo3(get)]
    radius_m: Option<f64>,
}

impl Robot {
    /// Converts a robot that a file describes.
    pub(crate) fn of(robot: &eeruf_sim::Robot) -> Self {
        Self {
            pose: from_pose(&robot.pose),
            sensor_poses: robot.sensors.iter().map(from_pose).collect(),
            spacing_rad: None,
            radius_m: None,
            robot: robot.clone(),
        }
    }

    /// The keyword arguments that recreate the robot.
    fn arguments<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyDict>> {
        let this = slf.get();
        let all = attributes(slf, &["pose"])?;
        let add = |names: &[&str]| all.update(attributes(slf, names)?.as_mapping());
        if this.spacing_rad.is_some() && this.radius_m.is_some() {
            add(&["sensors", "spacing_rad", "radius_m"])?;
        } else {
            all.set_item("sensors", &this.sensor_poses)?;
        }
        add(&["module"])?;
        if this.robot.modules.is_empty() {
            add(&["gain", "beam"])?;
        }
        add(&["coupling_db"])?;
        // A common height stays common when the sensors are replaced.
        match &this.robot.heights_m[..] {
            [] => {}
            [first, others @ ..] if others.iter().all(|height_m| height_m == first) => {
                all.set_item("height_m", first)?;
            }
            each => all.set_item("height_m", each)?,
        }
        add(&["body", "period_us", "t_delta_us", "window_us", "blanking_us", "together", "min_refire_us", "start_us"])?;
        add(&["audible_us", "path_change_us", "firing", "schedule", "neighbours", "consecutive", "odometry"])?;
        match &this.robot.motion {
            Motion::Still => {}
            Motion::Constant { .. } => add(&TURNS)?,
            Motion::Waypoints { .. } => add(&DRIVES)?,
        }
        add(&["clock_offset_us", "clock_drift_ppm"])?;
        Ok(all)
    }
}

impl Robot {
    /// A limit of each sensor, if they have their own.
    fn limits(&self, of: fn(&SensorLimits) -> Micros) -> Option<Vec<Micros>> {
        (!self.robot.limits.is_empty()).then(|| self.robot.limits.iter().map(of).collect())
    }
}

/// One height for all sensors, or one for each, in metres.
fn heights(value: &Bound<'_, PyAny>, sensors: usize) -> PyResult<Vec<f64>> {
    if value.extract::<f64>().is_ok() {
        return Ok(vec![number("height_m", value, 0.0..=1e3)?; sensors]);
    }
    let each = items("height_m", value, "a height in metres, or one for each sensor")?;
    if each.len() != sensors {
        return Err(wrong("number of height_m", each.len(), format_args!("{sensors}, one for each sensor")));
    }
    each.iter().map(|height_m| number("height_m", height_m, 0.0..=1e3)).collect()
}

/// The settings of firing by sketches and modules.
pub(crate) fn sketch(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Sketch> {
    let refused = |_| wrong(name, shown(value), "a dict with keys of [firing], such as {\"turn_us\": 33_000}");
    let table = table_of(name, value.cast::<PyDict>().map_err(refused)?)?;
    Sketch::from_table(&table).map_err(|message| EerufError::new_err(format!("{name}: {message}")))
}

/// The ring of a `Needs` or a ring file.
pub(crate) fn ring_file(value: &Bound<'_, PyAny>) -> PyResult<RingSpec> {
    let needs = Needs::given(value)?.ok_or_else(|| wrong("ring", shown(value), "a Needs, or the path of a ring file"));
    Ok(needs?.ring().clone())
}

fn refused_ring(message: &str) -> PyErr {
    EerufError::new_err(format!("ring: {message}"))
}

/// A time for each of this many sensors, and true if they were given one by one.
fn each_micros(name: &str, value: &Bound<'_, PyAny>, sensors: usize) -> PyResult<(Vec<Micros>, bool)> {
    if value.is_instance_of::<PyString>() || value.try_iter().is_err() {
        return Ok((vec![micros(name, value)?; sensors], false));
    }
    let each = times(name, value)?;
    if each.len() != sensors {
        return Err(wrong(&format!("number of {name}"), each.len(), format_args!("{sensors}, one for each sensor")));
    }
    Ok((each, true))
}

/// One time, or a list of one for each sensor.
fn shown_micros<'py>(py: Python<'py>, one: Micros, each: Option<Vec<Micros>>) -> PyResult<Bound<'py, PyAny>> {
    match each {
        None => Ok(one.as_micros().into_pyobject(py)?.into_any()),
        Some(each) => each.into_iter().map(Micros::as_micros).collect::<Vec<_>>().into_pyobject(py),
    }
}

/// The arguments of the two kinds of motion.
const TURNS: [&str; 2] = ["velocity_m_s", "turn_rad_s"];
const DRIVES: [&str; 2] = ["waypoints_m", "speed_m_s"];
/// The other keyword arguments.
#[rustfmt::skip]
const OPTIONS: [&str; 22] = [
    "gain", "period_us", "t_delta_us", "window_us", "blanking_us", "min_refire_us", "start_us", "schedule",
    "neighbours", "consecutive", "odometry", "clock_offset_us", "clock_drift_ppm", "body", "beam", "coupling_db",
    "height_m", "together", "audible_us", "path_change_us", "firing", "ring",
];

#[pymethods]
impl Robot {
    #[new]
    #[pyo3(signature = (pose, sensors=None, spacing_rad=None, radius_m=None, module=None, **options))]
    #[pyo3(text_signature = "(pose, sensors=None, spacing_rad=None, radius_m=None, module=\"polaroid-6500\", *, \
            gain=\"constant\", period_us=60000, t_delta_us=500, window_us=36000, blanking_us=None, \
            min_refire_us=36000, start_us=0, schedule=None, neighbours=4, consecutive=2, odometry=False, \
            velocity_m_s=None, turn_rad_s=None, waypoints_m=None, speed_m_s=None, clock_offset_us=0, \
            clock_drift_ppm=0.0, body=None, beam=None, coupling_db=None, height_m=0.3, together=(), \
            audible_us=None, path_change_us=None, firing=None, ring=None)")]
    fn new<'py>(
        pose: &Bound<'py, PyAny>,
        sensors: Option<&Bound<'_, PyAny>>,
        spacing_rad: Option<&Bound<'_, PyAny>>,
        radius_m: Option<&Bound<'_, PyAny>>,
        module: Option<&Bound<'_, PyAny>>,
        options: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Self> {
        let options = Asked::of(pose.py(), "Robot", [], options, &[&OPTIONS, &TURNS, &DRIVES])?;
        let given = |name: &str| options.get(name);
        let pose = pose_of("pose", pose)?;
        let spacing_rad = spacing_rad
            .map(|angle| in_radians("spacing_rad", number("spacing_rad", angle, -1e3..=1e3)?, TAU))
            .transpose()?;
        let radius_m = radius_m.map(|radius| number("radius_m", radius, 0.0..=1e3)).transpose()?;
        let no_arc = |why: &str| match [("spacing_rad", spacing_rad), ("radius_m", radius_m)] {
            [(name, Some(given)), _] | [_, (name, Some(given))] => {
                Err(wrong(name, given, format_args!("None, since {why}")))
            }
            _ => Ok(()),
        };
        let file = given("ring")?.as_ref().map(ring_file).transpose()?.map(|spec| spec.robot_ring());
        let rated_m_s = file.as_ref().map_or(0.0, |file| file.speed_m_s);
        let (mut robot, sensor_poses) = if let (None, Some(file)) = (sensors, &file) {
            no_arc("the ring file says where sensors stand")?;
            let robot =
                eeruf_sim::Robot::of_ring(file, to_pose(pose), None).map_err(|message| refused_ring(&message))?;
            let poses = robot.sensors.iter().map(from_pose).collect();
            (robot, poses)
        } else if sensors.is_none_or(|sensors| sensors.is_instance_of::<PyString>() || sensors.try_iter().is_err()) {
            let Some(sensors) = sensors else {
                return Err(wrong("sensors", "None", "a number, or (x, y, heading) of each sensor"));
            };
            let count = requirements::sensors(sensors)?;
            let (Some(spacing_rad), Some(radius_m)) = (spacing_rad, radius_m) else {
                let name = if spacing_rad.is_none() { "spacing_rad" } else { "radius_m" };
                return Err(wrong(name, "None", "a number, since the sensors stand on an arc"));
            };
            let robot = eeruf_sim::Robot::ring(to_pose(pose), count, spacing_rad, radius_m, Transducer::POLAROID_6500);
            let poses = robot.sensors.iter().map(from_pose).collect();
            (robot, poses)
        } else {
            no_arc("each sensor has a place of its own")?;
            let Some(sensors) = sensors else {
                return Err(wrong("sensors", "None", "(x, y, heading) of each sensor"));
            };
            let places = items("sensors", sensors, "a number, or (x, y, heading) of each sensor")?;
            let each = |(index, place)| pose_of(&format!("sensors[{index}]"), place);
            let poses = places.iter().enumerate().map(each).collect::<PyResult<Vec<_>>>()?;
            if poses.is_empty() || poses.len() > eeruf_core::MAX_SENSORS {
                return Err(wrong("number of sensors", poses.len(), "1 to 64"));
            }
            let on_robot = poses.iter().copied().map(to_pose).collect();
            (eeruf_sim::Robot::with_sensors(to_pose(pose), on_robot, Transducer::POLAROID_6500), poses)
        };
        if let (Some(file), Some(_)) = (&file, sensors) {
            robot = eeruf_sim::Robot::of_ring(file, to_pose(pose), Some(robot.sensors))
                .map_err(|message| refused_ring(&message))?;
        }
        let count = robot.sensors.len();
        if let Some(module) = module {
            robot = robot.with_modules(modules("module", module, count)?);
            robot.audible = file.as_ref().and_then(|file| file.audible).unwrap_or(robot.audible);
        }
        let gain = given("gain")?.map(|gain| choice("gain", Some(&gain), &GainProfile::NAMES)).transpose()?;
        let beam = given("beam")?.map(|beam| choice("beam", Some(&beam), &Beam::NAMES)).transpose()?;
        robot = robot.with_pattern(gain, beam);
        let set =
            |name, field: &mut Micros| given(name)?.map_or(Ok(()), |value| micros(name, &value).map(|us| *field = us));
        set("period_us", &mut robot.period)?;
        robot.odometry = flag("odometry", given("odometry")?.as_ref(), false)?;
        if let Some(schedule) = given("schedule")? {
            robot.schedule = Some(instance::<Schedule>("schedule", &schedule, "an eeruf.Schedule")?.get().0);
        }
        if given("t_delta_us")?.is_none() && !robot.odometry {
            cover_motion(&mut robot, rated_m_s);
        }
        let each = |name, of: fn(&SensorLimits) -> Micros, own: Micros| {
            let own = || match &robot.limits[..] {
                [] => vec![own; count],
                limits => limits.iter().map(of).collect(),
            };
            given(name)?.map_or_else(|| Ok((own(), false)), |value| each_micros(name, &value, count))
        };
        let (t_delta, own_t_delta) = each("t_delta_us", |limits| limits.t_delta, robot.t_delta)?;
        let (window, own_window) = each("window_us", |limits| limits.window, robot.window)?;
        let largest = |times: &[Micros]| times.iter().copied().max().unwrap_or_default();
        (robot.t_delta, robot.window) = (largest(&t_delta), largest(&window));
        if own_t_delta || own_window || !robot.limits.is_empty() {
            let limits = t_delta.into_iter().zip(window).map(|(t_delta, window)| SensorLimits { t_delta, window });
            robot.limits = limits.collect();
        }
        if let Some(blanking_us) = given("blanking_us")? {
            robot = robot.with_blankings(each_micros("blanking_us", &blanking_us, count)?.0);
        }
        let together = given("together")?;
        if together.is_some() {
            robot.together.clear();
        }
        for group in together.map_or(Ok(vec![]), |sets| items("together", &sets, "sets of two or more sensors"))? {
            let members = items("together", &group, "sets of two or more sensors")?;
            let last = u8::try_from(count - 1).unwrap_or(u8::MAX);
            let members = members.iter().map(|sensor| whole("together", sensor, 0..=last));
            let members = members.collect::<PyResult<Vec<u8>>>()?;
            if members.len() < 2 {
                return Err(wrong("together", shown(&group), "two or more sensors in each set"));
            }
            robot.together.push(members.iter().fold(0, |set, sensor| set | 1 << sensor));
        }
        set("min_refire_us", &mut robot.min_refire)?;
        set("start_us", &mut robot.start)?;
        set("audible_us", &mut robot.audible)?;
        if let Some(change) = given("path_change_us")? {
            robot.path_change = Some(micros("path_change_us", &change)?);
        }
        robot.firing = given("firing")?.map_or(Ok(Sketch::default()), |firing| sketch("firing", &firing))?;
        let neighbours = given("neighbours")?;
        if neighbours.is_some() || file.is_none() {
            robot.neighbours = requirements::neighbours(neighbours.as_ref())?;
        }
        robot.consecutive = whole_or("consecutive", given("consecutive")?.as_ref(), 2, 2..=8)?;
        let [turn, drive] = [TURNS, DRIVES].map(|names| names.map(given));
        let ([velocity_m_s, turn_rad_s], [waypoints_m, speed_m_s]) = (turn, drive);
        robot.motion =
            motion(velocity_m_s?.as_ref(), turn_rad_s?.as_ref(), waypoints_m?.as_ref(), speed_m_s?.as_ref())?;
        robot.clock = Clock {
            offset_us: whole_or("clock_offset_us", given("clock_offset_us")?.as_ref(), 0, 0..=u32::MAX)?,
            drift_ppm: number_or("clock_drift_ppm", given("clock_drift_ppm")?.as_ref(), 0.0, -1e3..=1e3)?,
        };
        robot.body = given("body")?.as_ref().map(outline).transpose()?;
        if let Some(height_m) = given("height_m")? {
            robot = robot.with_heights(heights(&height_m, count)?);
        }
        let level = given("coupling_db")?;
        robot.coupling_db = level.map(|level| number("coupling_db", &level, -200.0..=0.0)).transpose()?;
        if let (Some(schedule), None) = (robot.schedule, given("period_us")?) {
            robot.period = schedule.period();
        }
        Ok(Self { robot, pose, sensor_poses, spacing_rad, radius_m })
    }

    /// Return the robot with these arguments changed.
    ///
    /// Args:
    ///     changes: arguments of ``Robot``, by name.
    ///
    /// Raises:
    ///     EerufError: as for ``Robot``.
    ///
    /// Example:
    ///     >>> from eeruf import sim
    ///     >>> sim.Robot((0, 0, 0), 8, 0.26, 0.3).replace(t_delta_us=100).t_delta_us
    ///     100
    #[pyo3(signature = (**changes))]
    fn replace<'py>(slf: &Bound<'py, Self>, changes: Option<&Bound<'py, PyDict>>) -> PyResult<Bound<'py, PyAny>> {
        let arguments = Self::arguments(slf)?;
        let given = |name: &str| changes.is_some_and(|changes| changes.contains(name).unwrap_or(false));
        // A new way to place the sensors, to move or to blank replaces the other one.
        if given("sensors") && !given("spacing_rad") && changes_places(changes)? {
            arguments.del_item("spacing_rad").or_else(missing)?;
            arguments.del_item("radius_m").or_else(missing)?;
        }
        for (new, old) in [(TURNS, DRIVES), (DRIVES, TURNS)] {
            if new.into_iter().any(given) {
                old.into_iter().try_for_each(|name| arguments.del_item(name).or_else(missing))?;
            }
        }
        if given("module") {
            arguments.del_item("module")?;
            if !given("blanking_us") {
                arguments.del_item("blanking_us")?;
            }
            if !given("audible_us") {
                arguments.del_item("audible_us")?;
            }
        }
        if given("schedule") && !given("period_us") {
            arguments.del_item("period_us")?;
        }
        if let Some(changes) = changes {
            arguments.update(changes.as_mapping())?;
        }
        slf.get_type().call((), Some(&arguments))
    }

    /// Number of sensors.
    #[getter]
    fn sensors(&self) -> usize {
        self.robot.sensors.len()
    }

    /// The module of its sensors: a name, a dict of figures, or a list of these, one for each sensor.
    #[getter]
    fn module<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        if self.robot.modules.is_empty() {
            // Gain and beam have arguments of their own.
            let module = self.robot.module_of(0);
            let preset = eeruf_sim::modules::find(module.name).copied().unwrap_or(module);
            let eeruf_sim::modules::Module { gain, beam, .. } = preset;
            return shown_module(py, &eeruf_sim::modules::Module { gain, beam, ..module });
        }
        let each = self.robot.modules.iter().map(|module| shown_module(py, module));
        each.collect::<PyResult<Vec<_>>>()?.into_pyobject(py)
    }

    /// Sets of sensors that the robot's own schedule fires at once.
    #[getter]
    fn together(&self) -> Vec<Vec<usize>> {
        let members = |set: &u64| (0..self.sensors()).filter(|sensor| set >> sensor & 1 == 1).collect();
        self.robot.together.iter().map(members).collect()
    }

    /// Growth of the receiver's gain while it listens; if sensors differ, the first one's.
    #[getter]
    fn gain(&self) -> &'static str {
        self.robot.transducer.gain.name()
    }

    /// The pattern near 90 degrees off a sensor's axis.
    #[getter]
    fn beam(&self) -> &'static str {
        self.robot.transducer.beam.name()
    }

    /// The level of the sound that the mounting carries directly from sensor to sensor, in dB; None if the patterns
    /// decide.
    #[getter]
    fn coupling_db(&self) -> Option<f64> {
        self.robot.coupling_db
    }

    /// The height of its sensors above the floor in metres, one each.
    #[getter]
    fn height_m(&self) -> Vec<f64> {
        (0..self.robot.sensors.len()).map(|sensor| self.robot.height_m(sensor)).collect()
    }

    /// The outline: the radius of a disc, (length, width) of a box, or the corners of a polygon; None without one.
    #[getter]
    fn body<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        shown_body(py, self.robot.body.as_ref())
    }

    /// ``T_p`` of the methods that bring no schedule of their own, in microseconds.
    #[getter]
    fn period_us(&self) -> u32 {
        self.robot.period.as_micros()
    }

    /// ``T_delta``, in microseconds; a list with one for each sensor if they have their own.
    #[getter]
    fn t_delta_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown_micros(py, self.robot.t_delta, self.limits(|limits| limits.t_delta))
    }

    /// Listening time of a sensor, in microseconds; a list with one for each sensor if they have their own.
    #[getter]
    fn window_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        shown_micros(py, self.robot.window, self.limits(|limits| limits.window))
    }

    /// Deaf time of a sensor after it has fired, in microseconds; a list with one for each sensor if they differ.
    #[getter]
    fn blanking_us<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let each = Some(self.robot.blankings.clone()).filter(|each| !each.is_empty());
        shown_micros(py, self.robot.blanking, each)
    }

    /// Rest of a sensor between its echo and its next firing, in microseconds.
    #[getter]
    fn min_refire_us(&self) -> u32 {
        self.robot.min_refire.as_micros()
    }

    /// Time for which sound is heard after it was sent, in microseconds; 0 for the listening time.
    #[getter]
    fn audible_us(&self) -> u32 {
        self.robot.audible.as_micros()
    }

    /// Largest change of a foreign sound's path between two readings, in microseconds; None for ``t_delta_us``.
    #[getter]
    fn path_change_us(&self) -> Option<u32> {
        self.robot.path_change.map(Micros::as_micros)
    }

    /// Firing by sketches and modules: a dict of differences from the default.
    #[getter]
    fn firing<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        shown_table(py, &self.robot.firing.to_table())
    }

    /// Time when the ring begins to fire, in microseconds.
    #[getter]
    fn start_us(&self) -> u32 {
        self.robot.start.as_micros()
    }

    /// Schedule of the EERUF methods; None for the paper's table.
    #[getter]
    fn schedule(&self) -> Option<Schedule> {
        self.robot.schedule.map(Schedule)
    }

    /// Number of adjacent sensors that must not fire close together.
    #[getter]
    fn neighbours(&self) -> u8 {
        self.robot.neighbours
    }

    /// Number of readings in a row that must agree.
    #[getter]
    fn consecutive(&self) -> u8 {
        self.robot.consecutive
    }

    /// Returns true if the robot tells its ring the changes of readings to expect from its own motion.
    #[getter]
    fn odometry(&self) -> bool {
        self.robot.odometry
    }

    /// The constant velocity, (x, y) in m/s; None for a robot that stands still or drives through waypoints.
    #[getter]
    fn velocity_m_s(&self) -> Option<(f64, f64)> {
        match &self.robot.motion {
            Motion::Constant { velocity, .. } => Some((velocity.x, velocity.y)),
            _ => None,
        }
    }

    /// The constant rate of turn, in rad/s; None for a robot that stands still or drives through waypoints.
    #[getter]
    fn turn_rad_s(&self) -> Option<f64> {
        match &self.robot.motion {
            Motion::Constant { turn_rad_s, .. } => Some(*turn_rad_s),
            _ => None,
        }
    }

    /// The robot's waypoints, (x, y) in metres; None if there are none.
    #[getter]
    fn waypoints_m(&self) -> Option<Vec<(f64, f64)>> {
        match &self.robot.motion {
            Motion::Waypoints { points, .. } => Some(points.iter().map(|at: &Point| (at.x, at.y)).collect()),
            _ => None,
        }
    }

    /// Speed through the waypoints, in m/s; None without any.
    #[getter]
    fn speed_m_s(&self) -> Option<f64> {
        match &self.robot.motion {
            Motion::Waypoints { speed_m_s, .. } => Some(*speed_m_s),
            _ => None,
        }
    }

    /// The clock at the start, in microseconds.
    #[getter]
    fn clock_offset_us(&self) -> u32 {
        self.robot.clock.offset_us
    }

    /// Drift of the robot's clock (positive: too fast), in millionths.
    #[getter]
    fn clock_drift_ppm(&self) -> f64 {
        self.robot.clock.drift_ppm
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        call("Robot", &Self::arguments(slf)?)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduce_by_name(slf, Self::arguments(slf)?)
    }
}

/// Returns true if a change of `sensors` changes their places, not their number.
fn changes_places(changes: Option<&Bound<'_, PyDict>>) -> PyResult<bool> {
    let sensors = changes.map(|changes| changes.get_item("sensors")).transpose()?.flatten();
    Ok(sensors.is_some_and(|sensors| sensors.try_iter().is_ok()))
}

/// Ignores the error of a missing argument.
fn missing(error: PyErr) -> PyResult<()> {
    Python::attach(|py| if error.is_instance_of::<pyo3::exceptions::PyKeyError>(py) { Ok(()) } else { Err(error) })
}
