//! Decoding of messages with ranges: CDR of ROS 2, and the format of ROS 1.
//!
//! `Range` has had a `variance` since ROS 2 Iron. The file's schema says whether a message has one; without a schema
//! the message's length does.

use super::ros2;
use super::schema::{Decoder, Encoding, Schema};
use crate::names;
use crate::options::{Options, RangeUnit};
use crate::reading::LogReading;

/// The kind of messages, and the decoders for them, of which the first that fits applies.
#[derive(Debug)]
pub(crate) struct Kind {
    pub(crate) of: Of,
    decoders: Vec<Decoder>,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Of {
    Range,
    /// `LaserScan` with at most this many beams.
    LaserScan(usize),
    /// Numbers at a path of the schema, in the unit given by the user or the field's name.
    Numbers {
        unit: Option<RangeUnit>,
        /// True for one number instead of an array.
        is_single: bool,
    },
    /// `PointCloud`: each point is a sensor, at its distance from the frame's origin.
    Points,
}

/// Largest number of beams of a ring of sonars; lidars have more.
pub(crate) const MAX_BEAMS: usize = 64;
/// Largest number of beams if the user names the topic.
const MOST_BEAMS: usize = 4096;

/// Fields of `Range`, and of `LaserScan`, in the order in which they are decoded.
const RANGE: [&str; 6] = ["range", "min_range", "max_range", "radiation_type", "field_of_view", "variance"];
const LASER_SCAN: [&str; 5] = ["ranges", "range_min", "range_max", "angle_increment", "time_increment"];
const POINTS: [&str; 3] = ["points.x", "points.y", "points.z"];

/// Reason why a message could not be decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Undecoded {
    /// The message ends too early, or too late.
    Length,
    /// A `LaserScan` has as many beams as a lidar.
    Beams,
}

/// Returns true if a name means measuring by ultrasound.
fn is_sonar(name: &str) -> bool {
    let name = name.to_lowercase();
    ["sonar", "ultraso", "hcsr04", "hc_sr04", "srf0", "maxbotix"].iter().any(|word| name.contains(word))
}

impl Kind {
    /// The kind of messages, from the name of their type (`sensor_msgs/Range` or `sensor_msgs/msg/Range`), their schema
    /// and the user's options; or the reason why they hold no readings, with the option that reads them, if there is
    /// one.
    pub(crate) fn of(topic: &str, type_name: &str, schema: Option<&str>, options: &Options) -> Result<Self, String> {
        let parsed = schema.and_then(Schema::parse);
        if let Some(field) = options.fields.iter().find(|field| field.topic == topic) {
            let parsed =
                parsed.ok_or_else(|| format!("{type_name} without a schema that can be read; --field needs one"))?;
            let paths = parsed.number_paths();
            let same = |path: &&String| path.replace("[]", "") == field.path.replace("[]", "");
            let Some(path) = paths.iter().find(same) else {
                return Err(format!("no field `{}` of {type_name}; expected one of: {}", field.path, paths.join(", ")));
            };
            return Self::numbers(&parsed, path, Some(field.unit));
        }
        let is_asked = options.topics.iter().any(|asked| asked == topic);
        let takes_all = options.topics.is_empty() && options.fields.is_empty();
        if !is_asked && !takes_all {
            return Err(format!("{type_name}, which --topic and --field do not name"));
        }
        let own = |paths: &[&str]| parsed.as_ref()?.decoder(paths).map(|decoder| vec![decoder]);
        match type_name.replace("/msg/", "/").as_str() {
            "sensor_msgs/Range" => {
                let decoders = own(&RANGE).or_else(|| own(&RANGE[..5]));
                return Ok(Self { of: Of::Range, decoders: decoders.unwrap_or_else(ranges) });
            }
            "sensor_msgs/LaserScan" => {
                let most = if is_asked || is_sonar(topic) { MOST_BEAMS } else { MAX_BEAMS };
                let decoders =
                    own(&LASER_SCAN).unwrap_or_else(|| known(&ros2::definition("sensor_msgs/LaserScan"), &LASER_SCAN));
                return Ok(Self { of: Of::LaserScan(most), decoders });
            }
            "sensor_msgs/PointCloud" if is_asked => {
                let decoders = own(&POINTS).ok_or_else(|| format!("{type_name} without a schema"))?;
                return Ok(Self { of: Of::Points, decoders });
            }
            "sensor_msgs/PointCloud" => {
                return Err(format!(
                    "{type_name}: points, no ranges; --topic {topic} reads each point as a sensor, at its distance \
                     from the frame's origin"
                ));
            }
            _ => {}
        }
        let refused = || format!("{type_name}; expected sensor_msgs Range or LaserScan");
        let parsed = parsed.ok_or_else(refused)?;
        let paths = parsed.number_paths();
        let is_candidate = |path: &&String| {
            let last = path.rsplit('.').next().unwrap_or_default().trim_end_matches("[]").to_lowercase();
            let of = |words: &[&str]| words.iter().any(|word| last.starts_with(word));
            let is_limit = ["min", "max", "count", "type"].iter().any(|word| last.contains(word));
            !is_limit
                && (of(&["range", "distance", "sonar", "ultraso", "echo"])
                    || ["data", "values"].contains(&last.as_str()))
        };
        // An array before a single number; `data` last.
        let best =
            paths.iter().filter(is_candidate).max_by_key(|path| (path.contains("[]"), !path.starts_with("data")));
        match best {
            Some(path) if is_asked || is_sonar(topic) || is_sonar(type_name) || is_sonar(path) => {
                Self::numbers(&parsed, path, None)
            }
            _ if paths.is_empty() || type_name.starts_with("tf2_msgs") => Err(refused()),
            Some(path) => Err(format!("{}; --field {topic} {path} m reads numbers of it", refused())),
            None if is_asked => {
                Err(format!("{type_name} has no field of ranges; --field names one of: {}", paths.join(", ")))
            }
            None => Err(refused()),
        }
    }

    fn numbers(schema: &Schema, path: &str, unit: Option<RangeUnit>) -> Result<Self, String> {
        let plain = path.replace("[]", "");
        let decoder = schema.decoder(&[&plain]).ok_or_else(|| format!("no numbers at {path}, as its schema has it"))?;
        let name = plain.rsplit('.').next().unwrap_or_default();
        let unit = unit.or_else(|| names::range_unit(name).map(|unit| unit.0));
        Ok(Self { of: Of::Numbers { unit, is_single: !path.contains("[]") }, decoders: vec![decoder] })
    }

    /// Returns true if sensors are told apart by their places in a message.
    pub(crate) const fn has_places(&self) -> bool {
        !matches!(self.of, Of::Range | Of::Numbers { is_single: true, .. })
    }

    /// Decodes a message into readings, whose `sensor` is the beam; returns its frame.
    pub(crate) fn decode<'a>(
        &self,
        encoding: Encoding,
        message: &'a [u8],
        recorded_ns: u64,
        readings: &mut Vec<LogReading>,
    ) -> Result<&'a [u8], Undecoded> {
        let most = if let Of::LaserScan(most) = self.of { most } else { MOST_BEAMS };
        let found = self.decoders.iter().find_map(|decoder| decoder.decode(encoding, message, most));
        let found = found.ok_or(Undecoded::Length)?;
        if found.is_too_long {
            return Err(Undecoded::Beams);
        }
        let at_ns = if found.stamp_ns == 0 { recorded_ns } else { found.stamp_ns };
        let reading = |(sensor, range_m)| LogReading::new(sensor, Some(at_ns), range_m, 0.0);
        match self.of {
            Of::Range => readings.push(LogReading {
                min_range_m: found.number(1),
                max_range_m: found.number(2),
                radiation: found.number(3) as u8,
                field_of_view_rad: found.number(4) as f32,
                variance: found.numbers(5).next().map(|variance| variance as f32),
                ..reading((0, found.number(0)))
            }),
            Of::LaserScan(_) => readings.extend(found.numbers(0).enumerate().map(|(beam, range_m)| LogReading {
                at_ns: Some(at_ns.saturating_add((found.number(4).max(0.0) * beam as f64 * 1e9) as u64)),
                min_range_m: found.number(1),
                max_range_m: found.number(2),
                field_of_view_rad: found.number(3).abs() as f32,
                ..reading((beam, range_m))
            })),
            Of::Numbers { .. } => readings.extend(found.numbers(0).enumerate().map(reading)),
            Of::Points => {
                let far = found.numbers(0).zip(found.numbers(1)).zip(found.numbers(2));
                readings.extend(far.map(|((x, y), z)| x.hypot(y).hypot(z)).enumerate().map(reading));
            }
        }
        if readings.len() > MOST_BEAMS { Err(Undecoded::Length) } else { Ok(found.frame) }
    }
}

/// The decoder by a definition of this crate.
fn known(definition: &str, paths: &[&str]) -> Vec<Decoder> {
    Schema::parse(definition).and_then(|schema| schema.decoder(paths)).into_iter().collect()
}

/// Decoders for a `Range` without a schema, with a variance and without.
fn ranges() -> Vec<Decoder> {
    let of_iron = ros2::definition(ros2::RANGE);
    let of_humble = of_iron.replace("float32 variance\n", "");
    [known(&of_iron, &RANGE), known(&of_humble, &RANGE[..5])].into_iter().flatten().collect()
}
