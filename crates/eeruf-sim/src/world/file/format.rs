//! The tables and keys of a world file for serde, and the expansion of their short forms.

use eeruf_core::Micros;
use eeruf_modules::ModulesFile;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};
use toml::Spanned;

use super::fault::FaultFile;
use super::sketch::SketchFile;
use crate::{
    acoustics::{Physics, UnknownPhysics},
    geometry::{Pose, Vector},
    scene::{Air, Body, Faces, Material, Outline, Room},
    world::{clock::Clock, noise::Noise, world::DEFAULT_ORDER},
};

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WorldFile {
    #[serde(default = "default_seed", deserialize_with = "seed", serialize_with = "write_seed")]
    pub(super) seed: u64,
    #[serde(default = "default_order")]
    pub(super) max_order: u32,
    pub(super) air: Option<Spanned<Air>>,
    pub(super) noise: Option<Spanned<Noise>>,
    pub(super) physics: Option<Spanned<PhysicsFile>>,
    pub(super) height: Option<Spanned<HeightFile>>,
    pub(super) firing: Option<SketchFile>,
    #[serde(default, rename = "wall", skip_serializing_if = "Vec::is_empty")]
    pub(super) walls: Vec<Spanned<WallFile>>,
    #[serde(default, rename = "pole", skip_serializing_if = "Vec::is_empty")]
    pub(super) poles: Vec<Spanned<PoleFile>>,
    #[serde(default, rename = "robot", skip_serializing_if = "Vec::is_empty")]
    pub(super) robots: Vec<Spanned<RobotFile>>,
    #[serde(default, rename = "fault", skip_serializing_if = "Vec::is_empty")]
    pub(super) faults: Vec<Spanned<FaultFile>>,
}

/// Reads a seed: a number, or a text from 2^63 on, where TOML's whole numbers end.
fn seed<'de, D: Deserializer<'de>>(deserializer: D) -> Result<u64, D::Error> {
    #[derive(Deserialize, Serialize)]
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

/// Writes a seed: a text from 2^63 on, where TOML's whole numbers end.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "as serde calls it")]
fn write_seed<S: Serializer>(seed: &u64, serializer: S) -> Result<S::Ok, S::Error> {
    match i64::try_from(*seed) {
        Ok(seed) => serializer.serialize_i64(seed),
        Err(_) => serializer.collect_str(seed),
    }
}

fn default_seed() -> u64 {
    1
}

fn default_order() -> u32 {
    DEFAULT_ORDER
}

/// A preset's name, or a table with the differences from one.
#[derive(Deserialize, Serialize)]
#[serde(untagged, expecting = "expected \"plain\", \"default\" or a table")]
pub(super) enum PhysicsFile {
    Preset(String),
    Table(PhysicsTable),
    #[serde(skip_deserializing)]
    Written(Physics),
}

#[derive(Deserialize, Serialize)]
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
            Self::Written(physics) => Ok(*physics),
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

/// A preset's name, or a table with the differences from a room.
#[derive(Deserialize, Serialize)]
#[serde(untagged, expecting = "expected \"flat\", \"room\" or a table with ceiling_m, floor and ceiling")]
pub(super) enum HeightFile {
    Preset(HeightPreset),
    Table(HeightTable),
    #[serde(skip_deserializing)]
    Written(Room),
}

#[derive(Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum HeightPreset {
    Flat,
    Room,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct HeightTable {
    ceiling_m: Option<f64>,
    floor: Option<SurfaceFile>,
    ceiling: Option<SurfaceFile>,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct SurfaceFile {
    material: Option<MaterialFile>,
    reflection: Option<f64>,
    roughness_m: Option<f64>,
}

impl HeightFile {
    /// Returns floor and ceiling; `None` for a flat scene.
    pub(super) fn room(&self) -> Option<Room> {
        let surface = |default: Material, file: &Option<SurfaceFile>| {
            file.as_ref().map_or(default, |file| material(default, file.material, file.reflection, file.roughness_m))
        };
        match self {
            Self::Preset(HeightPreset::Flat) => None,
            Self::Preset(HeightPreset::Room) => Some(Room::DEFAULT),
            Self::Written(room) => Some(*room),
            Self::Table(table) => Some(Room {
                ceiling_m: table.ceiling_m.unwrap_or(Room::DEFAULT.ceiling_m),
                floor: surface(Room::DEFAULT.floor, &table.floor),
                ceiling: surface(Room::DEFAULT.ceiling, &table.ceiling),
            }),
        }
    }
}

/// One of three outlines.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct BodyFile {
    pub(super) radius_m: Option<f64>,
    pub(super) box_m: Option<[f64; 2]>,
    pub(super) corners_m: Option<Vec<[f64; 2]>>,
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

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct WallFile {
    pub(super) points_m: Vec<[f64; 2]>,
    pub(super) closed: Option<bool>,
    pub(super) faces: Option<Faces>,
    pub(super) material: Option<MaterialFile>,
    pub(super) reflection: Option<f64>,
    pub(super) roughness_m: Option<f64>,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct PoleFile {
    pub(super) at_m: [f64; 2],
    pub(super) radius_m: f64,
    pub(super) material: Option<MaterialFile>,
    pub(super) reflection: Option<f64>,
    pub(super) roughness_m: Option<f64>,
}

#[derive(Clone, Copy, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub(super) enum MaterialFile {
    Smooth,
    Painted,
    Soft,
    Perfect,
}

/// A time for all sensors, or one for each.
#[derive(Deserialize, Serialize)]
#[serde(untagged, expecting = "expected a whole number from 0 to 4294967295, or a list of one for each sensor")]
pub(super) enum EachFile {
    All(Micros),
    Of(Vec<Micros>),
}

/// A height for all sensors, or one for each.
#[derive(Deserialize, Serialize)]
#[serde(untagged, expecting = "expected a height in metres, or a list of one for each sensor")]
pub(super) enum HeightsFile {
    All(f64),
    Of(Vec<f64>),
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RobotFile {
    pub(super) pose: PoseFile,
    #[serde(default, deserialize_with = "ring", skip_serializing)]
    pub(super) ring: Option<RingKey>,
    pub(super) sensors: Option<Vec<PoseFile>>,
    /// The module, named `transducer` in older files.
    #[serde(alias = "transducer")]
    pub(super) module: Option<ModulesFile>,
    pub(super) gain: Option<String>,
    pub(super) beam: Option<String>,
    pub(super) coupling_db: Option<f64>,
    pub(super) height_m: Option<HeightsFile>,
    pub(super) body: Option<BodyFile>,
    pub(super) motion: Option<MotionFile>,
    pub(super) clock: Option<Clock>,
    pub(super) others: Option<bool>,
    pub(super) schedule: Option<Spanned<toml::Value>>,
    pub(super) start_us: Option<Micros>,
    pub(super) period_us: Option<Micros>,
    pub(super) t_delta_us: Option<EachFile>,
    pub(super) window_us: Option<EachFile>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub(super) together: Vec<Vec<usize>>,
    pub(super) blanking_us: Option<EachFile>,
    pub(super) min_refire_us: Option<Micros>,
    pub(super) audible_us: Option<Micros>,
    pub(super) path_change_us: Option<Micros>,
    pub(super) firing: Option<SketchFile>,
    pub(super) neighbours: Option<u8>,
    pub(super) consecutive: Option<u8>,
    /// A key of older files, which is refused with its name.
    #[serde(skip_serializing)]
    pub(super) patience: Option<serde::de::IgnoredAny>,
    #[serde(default)]
    pub(super) odometry: bool,
}

#[derive(Clone, Copy, Deserialize, Serialize)]
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

/// Reads a ring key. The function is written by hand, so that an invalid table gives the error of its own type.
fn ring<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<RingKey>, D::Error> {
    let key = match toml::Value::deserialize(deserializer)? {
        toml::Value::String(name) => RingKey::File(name),
        table => RingKey::Arc(RingFile::deserialize(table).map_err(|error| D::Error::custom(error.message()))?),
    };
    Ok(Some(key))
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct RingFile {
    pub(super) sensors: usize,
    pub(super) spacing_deg: f64,
    pub(super) radius_m: f64,
}

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub(super) struct MotionFile {
    pub(super) velocity_m_s: Option<[f64; 2]>,
    pub(super) turn_deg_s: Option<f64>,
    pub(super) turn_rad_s: Option<f64>,
    pub(super) waypoints_m: Option<Vec<[f64; 2]>>,
    pub(super) speed_m_s: Option<f64>,
}

impl PoseFile {
    pub(super) fn pose(self) -> Pose {
        let heading_rad = radians(self.heading_deg, self.heading_rad);
        Pose::new(Vector::new(self.x_m, self.y_m), heading_rad)
    }
}

/// Returns an angle in radians, given in radians or degrees; 0 if neither is given.
pub(super) fn radians(deg: Option<f64>, rad: Option<f64>) -> f64 {
    rad.or_else(|| deg.map(f64::to_radians)).unwrap_or(0.0)
}

/// Returns a material by its name, with its own values if given.
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
