//! Worlds in TOML files: walls, poles, air, robots, noise and seed. Whatever is wrong with one is said in one line: file,
//! line, field, value, what is expected.

use core::fmt;
use core::ops::Range;
use std::path::{Path, PathBuf};

use eeruf_core::{MAX_SENSORS, Micros};
use serde::Deserialize;
use toml::Spanned;

use crate::{
    air::Air,
    clock::Clock,
    error::SceneError,
    material::Material,
    method::AnySchedule,
    motion::Motion,
    noise::Noise,
    plane::{Point, Pose, Vector},
    pole::Pole,
    robot::Robot,
    scene::Scene,
    schedule_file::ScheduleFile,
    transducer::{GainProfile, Transducer},
    wall::{Faces, Wall},
    world::{DEFAULT_ORDER, World, WorldError},
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WorldFile {
    #[serde(default = "default_seed")]
    seed: u64,
    #[serde(default = "default_order")]
    max_order: u32,
    air: Option<Spanned<AirFile>>,
    noise: Option<Spanned<NoiseFile>>,
    #[serde(default, rename = "wall")]
    walls: Vec<Spanned<WallFile>>,
    #[serde(default, rename = "pole")]
    poles: Vec<Spanned<PoleFile>>,
    #[serde(default, rename = "robot")]
    robots: Vec<Spanned<RobotFile>>,
}

fn default_seed() -> u64 {
    1
}

fn default_order() -> u32 {
    DEFAULT_ORDER
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct AirFile {
    temperature_c: Option<f64>,
    humidity_percent: Option<f64>,
    pressure_kpa: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct NoiseFile {
    fading_db_rms: Option<f64>,
    jitter_us_rms: Option<f64>,
    bursts_per_s: Option<f64>,
    burst_db: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct WallFile {
    points_m: Vec<[f64; 2]>,
    #[serde(default)]
    closed: bool,
    #[serde(default)]
    faces: FacesFile,
    material: Option<MaterialFile>,
    reflection: Option<f64>,
    roughness_m: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PoleFile {
    at_m: [f64; 2],
    radius_m: f64,
    material: Option<MaterialFile>,
    reflection: Option<f64>,
    roughness_m: Option<f64>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum FacesFile {
    #[default]
    Left,
    Both,
    Open,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
enum MaterialFile {
    Smooth,
    Painted,
    Soft,
    Perfect,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RobotFile {
    pose: PoseFile,
    ring: Option<RingFile>,
    sensors: Option<Vec<PoseFile>>,
    #[serde(default)]
    transducer: TransducerFile,
    #[serde(default)]
    gain: GainFile,
    motion: Option<MotionFile>,
    clock: Option<ClockFile>,
    schedule: Option<Spanned<toml::Value>>,
    start_us: Option<u32>,
    period_us: Option<u32>,
    t_delta_us: Option<u32>,
    window_us: Option<u32>,
    blanking_us: Option<u32>,
    min_refire_us: Option<u32>,
    neighbours: Option<u8>,
    consecutive: Option<u8>,
    patience: Option<u8>,
    #[serde(default)]
    odometry: bool,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
struct PoseFile {
    x_m: f64,
    y_m: f64,
    #[serde(default)]
    heading_deg: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RingFile {
    sensors: usize,
    spacing_deg: f64,
    radius_m: f64,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum TransducerFile {
    #[default]
    #[serde(rename = "polaroid_6500")]
    Polaroid6500,
    HcSr04,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
enum GainFile {
    #[default]
    Constant,
    SquareRoot,
    Linear,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MotionFile {
    velocity_m_s: Option<[f64; 2]>,
    turn_deg_s: Option<f64>,
    waypoints_m: Option<Vec<[f64; 2]>>,
    speed_m_s: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ClockFile {
    #[serde(default)]
    offset_us: u32,
    #[serde(default)]
    drift_ppm: f64,
}

/// A file that is no world, in one line.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct WorldFileError {
    /// The file.
    pub file: PathBuf,
    /// The line, from 1, where one is to blame.
    pub line: Option<usize>,
    /// What is wrong and what is expected.
    pub message: String,
}

impl fmt::Display for WorldFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.file.display())?;
        if let Some(line) = self.line {
            write!(f, ", line {line}")?;
        }
        write!(f, ": {}", self.message)
    }
}

impl core::error::Error for WorldFileError {}

impl World {
    /// Reads a world from a TOML file. Schedules that it names are looked for beside it.
    ///
    /// # Errors
    /// The first thing found wrong.
    pub fn from_toml(file: &Path) -> Result<Self, WorldFileError> {
        Self::parse(&Source::read(file)?)
    }

    /// The same from a text; `file` stands in errors, and schedules are looked for beside it.
    ///
    /// # Errors
    /// As [`from_toml`](Self::from_toml).
    ///
    /// ```
    /// use eeruf_sim::World;
    /// let text = "
    ///     [[wall]]
    ///     points_m = [[2, -1], [2, 1]]
    ///     [[robot]]
    ///     pose = { x_m = 0, y_m = 0 }
    ///     ring = { sensors = 65, spacing_deg = 5, radius_m = 0.3 }
    /// ";
    /// let error = World::from_text("pillars.toml".as_ref(), text).unwrap_err();
    /// assert_eq!(error.to_string(), "pillars.toml, line 6: robot 1 has 65 sensors; expected 1 to 64");
    /// ```
    pub fn from_text(file: &Path, text: &str) -> Result<Self, WorldFileError> {
        Self::parse(&Source { file: file.to_owned(), text: text.to_owned() })
    }

    fn parse(source: &Source) -> Result<Self, WorldFileError> {
        let file: WorldFile = source.toml()?;
        let scene = scene(source, &file)?;
        let mut robots = Vec::new();
        for (index, entry) in file.robots.iter().enumerate() {
            robots.push(robot(source, index, entry)?);
        }
        let noise = file.noise.as_ref().map_or(Noise::default(), |noise| noise.get_ref().noise());
        let world = Self::new(scene, robots, noise).and_then(|world| world.with_max_order(file.max_order));
        world.map(|world| world.with_seed(file.seed)).map_err(|error| {
            let (place, field) = blame(&file, &error);
            source.error(place, field, error)
        })
    }
}

/// Which part of the file an error is about, and which field of it.
fn blame(file: &WorldFile, error: &WorldError) -> (Option<Range<usize>>, &'static str) {
    let robot = |robot: usize| file.robots.get(robot).map(Spanned::span);
    match *error {
        WorldError::Sensors { robot: index, .. } => (robot(index), "ring"),
        WorldError::Field { robot: index, field, .. } => (robot(index), field),
        WorldError::Schedule { robot: index, .. } => (robot(index), "schedule"),
        WorldError::Window { robot: index, .. } => (robot(index), "window_us"),
        WorldError::Contact { robot: index, .. } => (robot(index), "pose"),
        WorldError::Noise { field, .. } => (file.noise.as_ref().map(Spanned::span), field),
        WorldError::Order { .. } => (Some(0..usize::MAX), "max_order"),
        WorldError::Scene(_) | WorldError::Robots { .. } => (None, ""),
    }
}

fn scene(source: &Source, file: &WorldFile) -> Result<Scene, WorldFileError> {
    let mut walls = Vec::new();
    // The entry that each wall came from.
    let mut entries = Vec::new();
    for (index, entry) in file.walls.iter().enumerate() {
        let wall = entry.get_ref();
        if wall.points_m.len() < 2 {
            let message = format!("points_m has {} points; expected at least 2", wall.points_m.len());
            return Err(source.error(Some(entry.span()), "points_m", message));
        }
        let mut corners = wall.points_m.clone();
        if wall.closed {
            corners.push(corners[0]);
        }
        let material = material(Material::SMOOTH, wall.material, wall.reflection, wall.roughness_m);
        let faces = match wall.faces {
            FacesFile::Left => Faces::Left,
            FacesFile::Both => Faces::Both,
            FacesFile::Open => Faces::Open,
        };
        walls.extend(Wall::polyline(&corners).map(|wall| wall.with_faces(faces).with_material(material)));
        entries.resize(walls.len(), index);
    }
    let poles = file.poles.iter().map(|entry| {
        let pole = entry.get_ref();
        let material = material(Material::PERFECT, pole.material, pole.reflection, pole.roughness_m);
        Pole { material, ..Pole::new(pole.at_m[0], pole.at_m[1], pole.radius_m) }
    });
    let air = file.air.as_ref().map_or(Air::default(), |air| air.get_ref().air());
    Scene::new(walls, poles.collect(), air).map_err(|error| {
        let wall = |wall: usize| entries.get(wall).and_then(|&entry| file.walls.get(entry)).map(Spanned::span);
        let pole = |pole: usize| file.poles.get(pole).map(Spanned::span);
        let (place, field) = match error {
            SceneError::WallCoordinate { wall: index, .. }
            | SceneError::WallTooShort { wall: index, .. }
            | SceneError::WallsCross { walls: [_, index], .. }
            | SceneError::WallsOverlap { walls: [_, index] } => (wall(index), "points_m"),
            SceneError::WallMaterial { wall: index } => (wall(index), "reflection"),
            SceneError::Pole { pole: index, .. } | SceneError::SamePole { poles: [_, index] } => (pole(index), "at_m"),
            SceneError::PoleMaterial { pole: index } => (pole(index), "reflection"),
            SceneError::Air { quantity, .. } => (file.air.as_ref().map(Spanned::span), quantity),
            _ => (None, ""),
        };
        source.error(place, field, error)
    })
}

fn material(usual: Material, named: Option<MaterialFile>, reflection: Option<f64>, roughness: Option<f64>) -> Material {
    let base = match named {
        None => usual,
        Some(MaterialFile::Smooth) => Material::SMOOTH,
        Some(MaterialFile::Painted) => Material::PAINTED,
        Some(MaterialFile::Soft) => Material::SOFT,
        Some(MaterialFile::Perfect) => Material::PERFECT,
    };
    Material { reflection: reflection.unwrap_or(base.reflection), roughness_m: roughness.unwrap_or(base.roughness_m) }
}

impl AirFile {
    fn air(&self) -> Air {
        let usual = Air::default();
        Air {
            temperature_c: self.temperature_c.unwrap_or(usual.temperature_c),
            humidity_percent: self.humidity_percent.unwrap_or(usual.humidity_percent),
            pressure_kpa: self.pressure_kpa.unwrap_or(usual.pressure_kpa),
        }
    }
}

impl NoiseFile {
    fn noise(&self) -> Noise {
        let usual = Noise::default();
        Noise {
            fading_db_rms: self.fading_db_rms.unwrap_or(usual.fading_db_rms),
            jitter_us_rms: self.jitter_us_rms.unwrap_or(usual.jitter_us_rms),
            bursts_per_s: self.bursts_per_s.unwrap_or(usual.bursts_per_s),
            burst_db: self.burst_db.unwrap_or(usual.burst_db),
        }
    }
}

impl PoseFile {
    fn pose(self) -> Pose {
        Pose::new(Vector::new(self.x_m, self.y_m), self.heading_deg.to_radians())
    }
}

fn robot(source: &Source, index: usize, entry: &Spanned<RobotFile>) -> Result<Robot, WorldFileError> {
    let file = entry.get_ref();
    let fail =
        |field, message: String| source.error(Some(entry.span()), field, format!("robot {}{message}", index + 1));
    let gain = match file.gain {
        GainFile::Constant => GainProfile::Constant,
        GainFile::SquareRoot => GainProfile::SquareRoot,
        GainFile::Linear => GainProfile::Linear,
    };
    let preset = match file.transducer {
        TransducerFile::Polaroid6500 => Transducer::POLAROID_6500,
        TransducerFile::HcSr04 => Transducer::HC_SR04,
    };
    let transducer = Transducer { gain, ..preset };
    let pose = file.pose.pose();
    let mut robot = match (&file.ring, &file.sensors) {
        (Some(ring), None) => {
            // Checked here, before as many poses are made.
            if ring.sensors == 0 || ring.sensors > MAX_SENSORS {
                return Err(fail("ring", format!(" has {} sensors; expected 1 to {MAX_SENSORS}", ring.sensors)));
            }
            Robot::ring(pose, ring.sensors, ring.spacing_deg.to_radians(), ring.radius_m, transducer)
        }
        (None, Some(sensors)) => {
            Robot::with_sensors(pose, sensors.iter().map(|sensor| sensor.pose()).collect(), transducer)
        }
        _ => return Err(fail("pose", ": expected either ring or sensors".to_owned())),
    };
    if let Some(motion) = &file.motion {
        robot.motion = match motion {
            MotionFile { waypoints_m: Some(points), speed_m_s: Some(speed), velocity_m_s: None, turn_deg_s: None } => {
                Motion::Waypoints { points: points.iter().map(|&[x, y]| Point::new(x, y)).collect(), speed_m_s: *speed }
            }
            MotionFile { waypoints_m: None, speed_m_s: None, velocity_m_s, turn_deg_s } => {
                let [x, y] = velocity_m_s.unwrap_or_default();
                Motion::Constant { velocity: Vector::new(x, y), turn_rad_s: turn_deg_s.unwrap_or(0.0).to_radians() }
            }
            _ => {
                let expected = ": motion needs either waypoints_m and speed_m_s, or velocity_m_s, turn_deg_s or both";
                return Err(fail("motion", expected.to_owned()));
            }
        };
    }
    if let Some(clock) = &file.clock {
        robot.clock = Clock { offset_us: clock.offset_us, drift_ppm: clock.drift_ppm };
    }
    if let Some(schedule) = &file.schedule {
        robot.schedule = Some(self::schedule(source, schedule)?);
    }
    let set = |field: &mut Micros, value: Option<u32>| *field = value.map_or(*field, Micros::new);
    set(&mut robot.start, file.start_us);
    set(&mut robot.period, file.period_us);
    set(&mut robot.t_delta, file.t_delta_us);
    set(&mut robot.window, file.window_us);
    set(&mut robot.blanking, file.blanking_us);
    set(&mut robot.min_refire, file.min_refire_us);
    robot.neighbours = file.neighbours.unwrap_or(robot.neighbours);
    robot.consecutive = file.consecutive.unwrap_or(robot.consecutive);
    robot.patience = file.patience.unwrap_or(robot.patience);
    robot.odometry = file.odometry;
    Ok(robot)
}

/// A schedule in the file itself, or the name of a file beside it.
fn schedule(source: &Source, value: &Spanned<toml::Value>) -> Result<AnySchedule, WorldFileError> {
    let here = |message: String| source.error(Some(value.span()), "", format!("schedule: {message}"));
    if let toml::Value::String(name) = value.get_ref() {
        let beside = source.file.parent().unwrap_or(Path::new("")).join(name);
        let source = Source::read(&beside)?;
        let file: ScheduleFile = source.toml()?;
        return file.schedule().map_err(|message| source.error(None, "", message));
    }
    let file = ScheduleFile::deserialize(value.get_ref().clone()).map_err(|error| here(error.message().to_owned()))?;
    file.schedule().map_err(here)
}

/// A file and its text.
struct Source {
    file: PathBuf,
    text: String,
}

impl Source {
    fn read(file: &Path) -> Result<Self, WorldFileError> {
        match std::fs::read_to_string(file) {
            Ok(text) => Ok(Self { file: file.to_owned(), text }),
            Err(error) => Err(WorldFileError { file: file.to_owned(), line: None, message: error.to_string() }),
        }
    }

    fn toml<T: serde::de::DeserializeOwned>(&self) -> Result<T, WorldFileError> {
        toml::from_str(&self.text).map_err(|error| self.error(error.span(), "", error.message().replace('\n', "; ")))
    }

    /// An error at a field within a part of the text, or at the part's first line.
    fn error(&self, part: Option<Range<usize>>, field: &str, message: impl fmt::Display) -> WorldFileError {
        let line = part.map(|part| self.line(part, field));
        WorldFileError { file: self.file.clone(), line, message: message.to_string() }
    }

    /// The line on which a field is set, which begins with its name or holds it in braces; entries of arrays of tables span
    /// from their header on.
    fn line(&self, part: Range<usize>, field: &str) -> usize {
        let end = part.end.min(self.text.len());
        let start = part.start.min(end);
        let first = 1 + self.text.get(..start).map_or(0, |before| before.matches('\n').count());
        // The span of a table may end with its header; what follows it up to the next header belongs to it.
        let rest = self.text.get(start..).unwrap_or("");
        let own = rest.lines().enumerate().take_while(|(k, line)| *k == 0 || !line.trim_start().starts_with("[["));
        let sets = |line: &str| line.split(['{', ',']).any(|item| item.trim_start().starts_with(field));
        let mut found = own.filter(|(_, line)| !field.is_empty() && sets(line.split('#').next().unwrap_or("")));
        first + found.next().map_or(0, |(k, _)| k)
    }
}
