//! Writes a world file that reads back as the same world.

use eeruf_core::{Micros, SensorLimits};
use eeruf_files::ScheduleFile;
use eeruf_modules::{Module, ModulesFile, find};
use toml::{Spanned, Table, Value};

use super::format::{
    BodyFile, EachFile, HeightFile, HeightPreset, HeightsFile, MotionFile, PhysicsFile, PoleFile, PoseFile, RobotFile,
    WallFile, WorldFile,
};
use super::sketch::SketchFile;
use crate::{
    acoustics::{Physics, Transducer},
    geometry::Pose,
    scene::{Body, Faces, Pole, Room, Scene, Wall},
    world::{fault::Fault, motion::Motion, noise::Noise, robot::Robot, sketch::Sketch},
};

/// Writes the world file of a scene with these robots, noise, physics, order, seed and faults. Reading it again gives
/// an equal world, bit for bit, with the schedules in it. Only the last bit of a heading may change, and only the first
/// time; see [`heading_rad`].
pub fn world_file(
    scene: &Scene,
    robots: &[Robot],
    noise: &Noise,
    physics: &Physics,
    max_order: u32,
    seed: u64,
    faults: &[Fault],
) -> String {
    let height = match scene.room() {
        None => HeightFile::Preset(HeightPreset::Flat),
        Some(room) if *room == Room::DEFAULT => HeightFile::Preset(HeightPreset::Room),
        Some(room) => HeightFile::Written(*room),
    };
    let file = WorldFile {
        seed,
        max_order,
        air: Some(nowhere(scene.air())),
        noise: Some(nowhere(*noise)),
        physics: Some(nowhere(PhysicsFile::Written(*physics))),
        height: Some(nowhere(height)),
        firing: None,
        walls: scene.walls().iter().map(|wall| nowhere(WallFile::from(wall))).collect(),
        poles: scene.poles().iter().map(|pole| nowhere(PoleFile::from(pole))).collect(),
        robots: robots.iter().map(|robot| nowhere(RobotFile::from(robot))).collect(),
        faults: vec![],
    };
    // The file consists of numbers, words and tables, which TOML supports. A table sorts its keys.
    let mut file = Table::try_from(file).unwrap_or_default();
    if !faults.is_empty() {
        file.insert("fault".to_owned(), faults.iter().map(Fault::to_table).collect::<Vec<_>>().into());
    }
    file.to_string()
}

/// Wraps values that come from no text.
fn nowhere<T>(of: T) -> Spanned<T> {
    Spanned::new(0..0, of)
}

impl From<&Wall> for WallFile {
    fn from(wall: &Wall) -> Self {
        Self {
            points_m: vec![[wall.from.x, wall.from.y], [wall.to.x, wall.to.y]],
            closed: None,
            faces: Some(wall.faces).filter(|faces| *faces != Faces::Left),
            material: None,
            reflection: Some(wall.material.reflection),
            roughness_m: Some(wall.material.roughness_m),
        }
    }
}

impl From<&Pole> for PoleFile {
    fn from(pole: &Pole) -> Self {
        Self {
            at_m: [pole.centre.x, pole.centre.y],
            radius_m: pole.radius_m,
            material: None,
            reflection: Some(pole.material.reflection),
            roughness_m: Some(pole.material.roughness_m),
        }
    }
}

impl From<&Pose> for PoseFile {
    fn from(pose: &Pose) -> Self {
        let heading_rad = Some(heading_rad(pose));
        Self { x_m: pose.translation.x, y_m: pose.translation.y, heading_deg: None, heading_rad }
    }
}

/// Returns an angle whose pose equals this one bit for bit, if one is nearby: a pose stores sine and cosine, of which
/// there are more than angles. Otherwise the angle's pose differs in the last bits, and gives the angle again.
pub fn heading_rad(pose: &Pose) -> f64 {
    let angle = pose.rotation.angle();
    exact_angle(pose).or_else(|| exact_angle(&Pose::rotation(angle))).unwrap_or(angle)
}

/// Returns an angle whose sine and cosine are exactly those of this pose.
fn exact_angle(pose: &Pose) -> Option<f64> {
    let angle = pose.rotation.angle();
    // The original angle may have been up to a turn more or less.
    for turned in [0.0, core::f64::consts::TAU, -core::f64::consts::TAU] {
        let (mut above, mut below) = (angle + turned, angle + turned);
        for _ in 0..8 {
            for candidate in [above, below] {
                if Pose::rotation(candidate).rotation == pose.rotation {
                    return Some(candidate);
                }
            }
            (above, below) = (above.next_up(), below.next_down());
        }
    }
    None
}

impl From<&Body> for BodyFile {
    fn from(body: &Body) -> Self {
        let none = Self { radius_m: None, box_m: None, corners_m: None };
        match body {
            Body::Disc(radius_m) => Self { radius_m: Some(*radius_m), ..none },
            Body::Box(length_m, width_m) => Self { box_m: Some([*length_m, *width_m]), ..none },
            Body::Polygon(polygon) => {
                let corners = polygon.corners().iter().map(|corner| [corner.x, corner.y]);
                Self { corners_m: Some(corners.collect()), ..none }
            }
        }
    }
}

impl MotionFile {
    /// Converts a motion to a file's form; `None` for a robot that stands still.
    fn of(motion: &Motion) -> Option<Self> {
        let none = Self { velocity_m_s: None, turn_deg_s: None, turn_rad_s: None, waypoints_m: None, speed_m_s: None };
        match motion {
            Motion::Still => None,
            Motion::Constant { velocity, turn_rad_s } => {
                Some(Self { velocity_m_s: Some([velocity.x, velocity.y]), turn_rad_s: Some(*turn_rad_s), ..none })
            }
            Motion::Waypoints { points, speed_m_s } => Some(Self {
                waypoints_m: Some(points.iter().map(|at| [at.x, at.y]).collect()),
                speed_m_s: Some(*speed_m_s),
                ..none
            }),
        }
    }
}

impl From<&Robot> for RobotFile {
    fn from(robot: &Robot) -> Self {
        let (module, gain, beam) = if robot.modules.is_empty() {
            let Transducer { gain, beam, .. } = robot.transducer;
            let module = robot.module_of(0);
            // A preset may differ in gain and beam, which have keys of their own.
            let preset = find(module.name).filter(|preset| Module { gain, beam, ..**preset } == module);
            let module = preset.copied().unwrap_or(module);
            (ModulesFile::All(module), Some(gain.name().to_owned()), Some(beam.name().to_owned()))
        } else {
            (ModulesFile::Of(robot.modules.clone()), None, None)
        };
        let each = |of: fn(&SensorLimits) -> Micros, all: Micros| match &robot.limits[..] {
            [] => EachFile::All(all),
            limits => EachFile::Of(limits.iter().map(of).collect()),
        };
        let blanking = match &robot.blankings[..] {
            [] => EachFile::All(robot.blanking),
            blankings => EachFile::Of(blankings.to_vec()),
        };
        let members = |set: &u64| (0..64).filter(|sensor| set >> sensor & 1 == 1).collect();
        let schedule = robot.schedule.as_ref().and_then(|own| Value::try_from(ScheduleFile::from(own)).ok());
        Self {
            pose: PoseFile::from(&robot.pose),
            ring: None,
            sensors: Some(robot.sensors.iter().map(PoseFile::from).collect()),
            module: Some(module),
            gain,
            beam,
            coupling_db: robot.coupling_db,
            height_m: (!robot.heights_m.is_empty()).then(|| HeightsFile::Of(robot.heights_m.clone())),
            body: robot.body.as_ref().map(BodyFile::from),
            motion: MotionFile::of(&robot.motion),
            clock: Some(robot.clock),
            others: robot.others.then_some(true),
            schedule: schedule.map(nowhere),
            start_us: Some(robot.start),
            period_us: Some(robot.period),
            t_delta_us: Some(each(|limits| limits.t_delta, robot.t_delta)),
            window_us: Some(each(|limits| limits.window, robot.window)),
            together: robot.together.iter().map(members).collect(),
            blanking_us: Some(blanking),
            min_refire_us: Some(robot.min_refire),
            audible_us: Some(robot.audible),
            path_change_us: robot.path_change,
            firing: (robot.firing != Sketch::default()).then(|| SketchFile::from(&robot.firing)),
            neighbours: Some(robot.neighbours),
            consecutive: Some(robot.consecutive),
            patience: None,
            odometry: robot.odometry,
        }
    }
}
