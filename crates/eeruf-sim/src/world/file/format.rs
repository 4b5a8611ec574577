//! The tables and keys of a world file, as serde reads them, and what plain ones stand for.

use eeruf_modules::ModulesFile;
use serde::{Deserialize, Deserializer, de::Error};
use toml::Spanned;

use super::fault::FaultFile;
use super::sketch::SketchFile;
use crate::{
    acoustics::{Physics, UnknownPhysics},
    geometry::{Pose, Vector},
    scene::{Air, Body, Material, Outline, Room},
    world::{noise::Noise, world::DEFAULT_ORDER},
};

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WorldFile {
    #[serde(default = "default_seed", deserialize_with = "seed")]
    pub(super) seed: u64,
    #[serde(default = "default_order")]
    pub(super) max_order: u32,
    pub(super) air: Option<Spanned<AirFile>>,
    pub(super) noise: Option<Spanned<NoiseFile>>,
    pub(super) physics: Option<Spanned<PhysicsFile>>,
    pub(super) height: Option<Spanned<HeightFile>>,
    pub(super) firing: Option<SketchFile>,
    #[serde(default, rename = "wall")]
    pub(super) walls: Vec<Spanned<WallFile>>,
    #[serde(default, rename = "pole")]
    pub(super) poles: Vec<Spanned<PoleFile>>,
    #[serde(default, rename = "robot")]
    pub(super) robots: Vec<Spanned<RobotFile>>,
    #[serde(default, rename = "fault")]
    pub(super) faults: Vec<Spanned<FaultFile>>,
}

/// A number, or a text where it is above the 2^63 at which TOML's numbers end.
fn seed<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged, expecting = "expected a whole number from 0 to 18446744073709551615")]
    enum Seed {
        Number(u64),
        Text(String),
    }
    match Seed::deserialize(deserializer)? {
        Seed::Number(number) => Ok(number),
        Seed::Text(text) => text.parse().map_err(|_| D::Error::custom(format!("seed is {text:?}; expected a number"))),
    }
}

fn default_seed() -> u64 {
    1
}

fn default_order() -> u32 {
    DEFAULT_ORDER
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct AirFile {
    pub(super) temperature_c: Option<f64>,
    pub(super) humidity_percent: Option<f64>,
    pub(super) pressure_kpa: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct NoiseFile {
    pub(super) fading_db_rms: Option<f64>,
    pub(super) jitter_us_rms: Option<f64>,
    pub(super) bursts_per_s: Option<f64>,
    pub(super) burst_db: Option<f64>,
}

/// A preset's name, or a table with what differs from one.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected \"plain\", \"default\" or a table")]
pub(super) enum PhysicsFile {
    Preset(String),
    Table(PhysicsTable),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PhysicsTable {
    preset: Option<String>,
    shadows: Option<bool>,
    edges: Option<bool>,
    narrow_panels: Option<bool>,
    range_walk: Option<bool>,
    interference: Option<bool>,
    fading_time_s: Option<f64>,
}

impl PhysicsFile {
    pub(super) fn physics(&self) -> Result<Physics, UnknownPhysics> {
        match self {
            Self::Preset(name) => name.parse(),
            Self::Table(table) => {
                let base = table.preset.as_ref().map_or(Ok(Physics::DEFAULT), |name| name.parse())?;
                Ok(Physics {
                    shadows: table.shadows.unwrap_or(base.shadows),
                    edges: table.edges.unwrap_or(base.edges),
                    narrow_panels: table.narrow_panels.unwrap_or(base.narrow_panels),
                    range_walk: table.range_walk.unwrap_or(base.range_walk),
                    interference: table.interference.unwrap_or(base.interference),
                    fading_time_s: table.fading_time_s.unwrap_or(base.fading_time_s),
                })
            }
        }
    }
}

/// A preset's name, or a table with what differs from that of a room.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected \"flat\", \"room\" or a table with ceiling_m, floor and ceiling")]
pub(super) enum HeightFile {
    Preset(HeightPreset),
    Table(HeightTable),
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum HeightPreset {
    Flat,
    Room,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HeightTable {
    ceiling_m: Option<f64>,
    floor: Option<SurfaceFile>,
    ceiling: Option<SurfaceFile>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SurfaceFile {
    material: Option<MaterialFile>,
    reflection: Option<f64>,
    roughness_m: Option<f64>,
}

impl HeightFile {
    /// Floor and ceiling; none for a flat scene.
    pub(super) fn room(&self) -> Option<Room> {
        let surface = |default: Material, file: &Option<SurfaceFile>| {
            file.as_ref().map_or(default, |file| material(default, file.material, file.reflection, file.roughness_m))
        };
        match self {
            Self::Preset(HeightPreset::Flat) => None,
            Self::Preset(HeightPreset::Room) => Some(Room::DEFAULT),
            Self::Table(table) => Some(Room {
                ceiling_m: table.ceiling_m.unwrap_or(Room::DEFAULT.ceiling_m),
                floor: surface(Room::DEFAULT.floor, &table.floor),
                ceiling: surface(Room::DEFAULT.ceiling, &table.ceiling),
            }),
        }
    }
}

/// One of three outlines.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyFile {
    radius_m: Option<f64>,
    box_m: Option<[f64; 2]>,
    corners_m: Option<Vec<[f64; 2]>>,
}

impl BodyFile {
    pub(super) fn body(&self) -> Result<Body, String> {
        match self {
            Self { radius_m: Some(radius_m), box_m: None, corners_m: None } => Ok(Body::Disc(*radius_m)),
            Self { radius_m: None, box_m: Some([length_m, width_m]), corners_m: None } => {
                Ok(Body::Box(*length_m, *width_m))
            }
            Self { radius_m: None, box_m: None, corners_m: Some(corners_m) } => {
                Outline::new(corners_m).map(Body::Polygon).map_err(|error| error.to_string())
            }
            _ => Err("expected one of radius_m, box_m and corners_m".to_owned()),
        }
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WallFile {
    pub(super) points_m: Vec<[f64; 2]>,
    #[serde(default)]
    pub(super) closed: bool,
    #[serde(default)]
    pub(super) faces: FacesFile,
    pub(super) material: Option<MaterialFile>,
    pub(super) reflection: Option<f64>,
    pub(super) roughness_m: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoleFile {
    pub(super) at_m: [f64; 2],
    pub(super) radius_m: f64,
    pub(super) material: Option<MaterialFile>,
    pub(super) reflection: Option<f64>,
    pub(super) roughness_m: Option<f64>,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum FacesFile {
    #[default]
    Left,
    Both,
    Open,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum MaterialFile {
    Smooth,
    Painted,
    Soft,
    Perfect,
}

/// A time for all sensors, or one for each.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a whole number from 0 to 4294967295, or a list of one for each sensor")]
pub(super) enum EachFile {
    All(u32),
    Of(Vec<u32>),
}

/// A height for all sensors, or one for each.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a height in metres, or a list of one for each sensor")]
pub(super) enum HeightsFile {
    All(f64),
    Of(Vec<f64>),
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RobotFile {
    pub(super) pose: PoseFile,
    #[serde(default, deserialize_with = "ring")]
    pub(super) ring: Option<RingKey>,
    pub(super) sensors: Option<Vec<PoseFile>>,
    /// `transducer` in older files.
    #[serde(alias = "transducer")]
    pub(super) module: Option<ModulesFile>,
    pub(super) gain: Option<String>,
    pub(super) beam: Option<String>,
    pub(super) coupling_db: Option<f64>,
    pub(super) height_m: Option<HeightsFile>,
    pub(super) body: Option<BodyFile>,
    pub(super) motion: Option<MotionFile>,
    pub(super) clock: Option<ClockFile>,
    #[serde(default)]
    pub(super) others: bool,
    pub(super) schedule: Option<Spanned<toml::Value>>,
    pub(super) start_us: Option<u32>,
    pub(super) period_us: Option<u32>,
    pub(super) t_delta_us: Option<EachFile>,
    pub(super) window_us: Option<EachFile>,
    #[serde(default)]
    pub(super) together: Vec<Vec<usize>>,
    pub(super) blanking_us: Option<EachFile>,
    pub(super) min_refire_us: Option<u32>,
    pub(super) audible_us: Option<u32>,
    pub(super) path_change_us: Option<u32>,
    pub(super) firing: Option<SketchFile>,
    pub(super) neighbours: Option<u8>,
    pub(super) consecutive: Option<u8>,
    /// A key of older files, refused by name.
    pub(super) patience: Option<serde::de::IgnoredAny>,
    #[serde(default)]
    pub(super) odometry: bool,
}

#[derive(Clone, Copy, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoseFile {
    pub(super) x_m: f64,
    pub(super) y_m: f64,
    pub(super) heading_deg: Option<f64>,
    pub(super) heading_rad: Option<f64>,
}

/// Sensors on an arc, or the name of a ring file.
pub(super) enum RingKey {
    Arc(RingFile),
    File(String),
}

/// By hand, so that the message of a wrong table is the table's.
fn ring<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<RingKey>, D::Error> {
    let key = match toml::Value::deserialize(deserializer)? {
        toml::Value::String(name) => RingKey::File(name),
        table => RingKey::Arc(RingFile::deserialize(table).map_err(|error| D::Error::custom(error.message()))?),
    };
    Ok(Some(key))
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RingFile {
    pub(super) sensors: usize,
    pub(super) spacing_deg: f64,
    pub(super) radius_m: f64,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotionFile {
    pub(super) velocity_m_s: Option<[f64; 2]>,
    pub(super) turn_deg_s: Option<f64>,
    pub(super) turn_rad_s: Option<f64>,
    pub(super) waypoints_m: Option<Vec<[f64; 2]>>,
    pub(super) speed_m_s: Option<f64>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct ClockFile {
    #[serde(default)]
    pub(super) offset_us: u32,
    #[serde(default)]
    pub(super) drift_ppm: f64,
}

impl AirFile {
    pub(super) fn air(&self) -> Air {
        let default = Air::default();
        Air {
            temperature_c: self.temperature_c.unwrap_or(default.temperature_c),
            humidity_percent: self.humidity_percent.unwrap_or(default.humidity_percent),
            pressure_kpa: self.pressure_kpa.unwrap_or(default.pressure_kpa),
        }
    }
}

impl NoiseFile {
    pub(super) fn noise(&self) -> Noise {
        let default = Noise::default();
        Noise {
            fading_db_rms: self.fading_db_rms.unwrap_or(default.fading_db_rms),
            jitter_us_rms: self.jitter_us_rms.unwrap_or(default.jitter_us_rms),
            bursts_per_s: self.bursts_per_s.unwrap_or(default.bursts_per_s),
            burst_db: self.burst_db.unwrap_or(default.burst_db),
        }
    }
}

impl PoseFile {
    pub(super) fn pose(self) -> Pose {
        let heading_rad = radians(self.heading_deg, self.heading_rad);
        Pose::new(Vector::new(self.x_m, self.y_m), heading_rad)
    }
}

/// An angle that may be given in degrees, in radians, as programs write it, or not at all.
pub(super) fn radians(deg: Option<f64>, rad: Option<f64>) -> f64 {
    rad.or_else(|| deg.map(f64::to_radians)).unwrap_or(0.0)
}

/// A material by its name, with what is set apart from it.
pub(super) fn material(
    default: Material,
    named: Option<MaterialFile>,
    reflection: Option<f64>,
    roughness: Option<f64>,
) -> Material {
    let base = match named {
        None => default,
        Some(MaterialFile::Smooth) => Material::SMOOTH,
        Some(MaterialFile::Painted) => Material::PAINTED,
        Some(MaterialFile::Soft) => Material::SOFT,
        Some(MaterialFile::Perfect) => Material::PERFECT,
    };
    Material { reflection: reflection.unwrap_or(base.reflection), roughness_m: roughness.unwrap_or(base.roughness_m) }
}
