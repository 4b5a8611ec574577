//! The robots of a world file.

use eeruf_core::{MAX_SENSORS, Micros, SensorLimits};
use eeruf_files::FileError;
use eeruf_modules::Value;
use toml::Spanned;

use super::format::{EachFile, HeightsFile, MotionFile, RingKey, RobotFile, radians};
use super::ring_file::{ReadRing, cover_motion};
use super::sketch::{SketchFile, sketch};
use super::source::Source;
use crate::{
    acoustics::Transducer,
    geometry::{Point, Vector},
    world::{motion::Motion, robot::Robot},
};

/// Builds the robot with this index; without firing of its own it uses the file's common one.
pub(super) fn robot(
    source: &Source,
    index: usize,
    entry: &Spanned<RobotFile>,
    firing: Option<&SketchFile>,
    read_ring: ReadRing,
) -> Result<Robot, FileError> {
    let file = entry.get_ref();
    let fail =
        |field, message: String| source.error(Some(entry.span()), field, format!("robot {}{message}", index + 1));
    if file.patience.is_some() {
        let gone = ": patience; expected no such key: a filter that waited for an echo let crosstalk in one phase \
                    starve the wall. Delete the line";
        return Err(fail("patience", gone.to_owned()));
    }
    let pose = file.pose.pose();
    let (mut speed_m_s, mut audible) = (0.0, None);
    let mut robot = match (&file.ring, &file.sensors) {
        (Some(RingKey::Arc(ring)), None) => {
            // The number is checked here, before as many poses are made.
            if ring.sensors == 0 || ring.sensors > MAX_SENSORS {
                return Err(fail("ring", format!(" has {} sensors; expected 1 to {MAX_SENSORS}", ring.sensors)));
            }
            Robot::ring(pose, ring.sensors, ring.spacing_deg.to_radians(), ring.radius_m, Transducer::POLAROID_6500)
        }
        (Some(RingKey::File(name)), sensors) => {
            let beside = source.beside(name)?;
            let ring = read_ring(&beside.file, &beside.text)?;
            (speed_m_s, audible) = (ring.speed_m_s, ring.audible);
            let poses = sensors.as_ref().map(|sensors| sensors.iter().map(|sensor| sensor.pose()).collect());
            Robot::of_ring(&ring, pose, poses).map_err(|message| fail("ring", format!(": {name}: {message}")))?
        }
        (None, Some(sensors)) => {
            Robot::with_sensors(pose, sensors.iter().map(|sensor| sensor.pose()).collect(), Transducer::POLAROID_6500)
        }
        _ => return Err(fail("pose", ": expected either ring or sensors".to_owned())),
    };
    if let Some(modules) = &file.module {
        let modules = modules.list(robot.sensors.len()).map_err(|message| fail("module", format!(": {message}")))?;
        robot = robot.with_modules(modules);
        robot.audible = audible.unwrap_or(robot.audible);
    }
    let mut pattern = robot.module_of(0);
    for (key, word) in [("gain", &file.gain), ("beam", &file.beam)] {
        let Some(word) = word else { continue };
        let set = pattern.set(key, Value::Word(word)).map_err(|error| error.to_string());
        set.map_err(|message| fail(key, format!(": {message}")))?;
    }
    robot = robot.with_pattern(file.gain.as_ref().map(|_| pattern.gain), file.beam.as_ref().map(|_| pattern.beam));
    if let Some(motion) = &file.motion {
        robot.motion = match motion {
            MotionFile {
                waypoints_m: Some(points),
                speed_m_s: Some(speed),
                velocity_m_s: None,
                turn_deg_s: None,
                turn_rad_s: None,
            } => {
                Motion::Waypoints { points: points.iter().map(|&[x, y]| Point::new(x, y)).collect(), speed_m_s: *speed }
            }
            MotionFile { waypoints_m: None, speed_m_s: None, velocity_m_s, turn_deg_s, turn_rad_s } => {
                let [x, y] = velocity_m_s.unwrap_or_default();
                Motion::Constant { velocity: Vector::new(x, y), turn_rad_s: radians(*turn_deg_s, *turn_rad_s) }
            }
            _ => {
                let expected = ": motion needs either waypoints_m and speed_m_s, or velocity_m_s, turn_deg_s or both";
                return Err(fail("motion", expected.to_owned()));
            }
        };
    }
    if let Some(body) = &file.body {
        robot.body = Some(body.body().map_err(|message| fail("body", format!(": body: {message}")))?);
    }
    robot.coupling_db = file.coupling_db;
    robot = match &file.height_m {
        None => robot,
        Some(HeightsFile::All(height_m)) => {
            let heights_m = vec![*height_m; robot.sensors.len()];
            robot.with_heights(heights_m)
        }
        Some(HeightsFile::Of(list)) => robot.with_heights(list.clone()),
    };
    robot.clock = file.clock.unwrap_or_default();
    robot.others = file.others.unwrap_or_default();
    if let Some(schedule) = &file.schedule {
        let schedule = source.schedule(schedule)?;
        (robot.schedule, robot.period) = (Some(schedule), schedule.period());
    }
    let set = |field: &mut Micros, value: Option<Micros>| *field = value.unwrap_or(*field);
    set(&mut robot.start, file.start_us);
    set(&mut robot.period, file.period_us);
    let sensors = robot.sensors.len();
    let each = |own: Vec<Micros>, value: &Option<EachFile>| match value {
        None => own,
        Some(EachFile::All(time)) => vec![*time; sensors],
        Some(EachFile::Of(list)) => list.clone(),
    };
    if file.t_delta_us.is_none() && !file.odometry {
        cover_motion(&mut robot, speed_m_s);
    }
    let own = |of: fn(&SensorLimits) -> Micros, all: Micros| match &robot.limits[..] {
        [] => vec![all; sensors],
        limits => limits.iter().map(of).collect(),
    };
    let t_delta = each(own(|limits| limits.t_delta, robot.t_delta), &file.t_delta_us);
    let window = each(own(|limits| limits.window, robot.window), &file.window_us);
    for (what, list) in [("t_delta_us", &t_delta), ("window_us", &window)] {
        if list.len() != sensors {
            let message =
                format!(": {} values; expected one for all, or one for each of {sensors} sensors", list.len());
            return Err(fail(what, message));
        }
    }
    let largest = |times: &[Micros]| times.iter().copied().max().unwrap_or_default();
    (robot.t_delta, robot.window) = (largest(&t_delta), largest(&window));
    let lists = [&file.t_delta_us, &file.window_us].iter().any(|value| matches!(value, Some(EachFile::Of(_))));
    if lists || !robot.limits.is_empty() {
        let limits = t_delta.into_iter().zip(window).map(|(t_delta, window)| SensorLimits { t_delta, window });
        robot.limits = limits.collect();
    }
    if !file.together.is_empty() {
        robot.together.clear();
    }
    for group in &file.together {
        if group.len() < 2 || group.iter().any(|&sensor| sensor >= sensors) {
            let message = format!(": {group:?}; expected two or more different sensors from 0 to {}", sensors - 1);
            return Err(fail("together", message));
        }
        robot.together.push(group.iter().fold(0, |set, sensor| set | 1 << sensor));
    }
    if file.blanking_us.is_some() {
        let blanking = each(vec![], &file.blanking_us);
        if blanking.len() != sensors {
            let message =
                format!(": {} values; expected one for all, or one for each of {sensors} sensors", blanking.len());
            return Err(fail("blanking_us", message));
        }
        robot = robot.with_blankings(blanking);
    }
    set(&mut robot.min_refire, file.min_refire_us);
    set(&mut robot.audible, file.audible_us);
    robot.path_change = file.path_change_us.or(robot.path_change);
    if let Some(firing) = file.firing.as_ref().or(firing) {
        robot.firing = sketch(source, firing)?;
    }
    robot.neighbours = file.neighbours.unwrap_or(robot.neighbours);
    robot.consecutive = file.consecutive.unwrap_or(robot.consecutive);
    robot.odometry = file.odometry;
    Ok(robot)
}
