//! Decoding of messages with ranges: CDR of ROS 2, and the format of ROS 1.
//!
//! `Range` has had a `variance` since ROS 2 Iron. The file's schema says whether a message has one; without a schema
//! the message's length does.

use std::rc::Rc;

use crate::bytes::{Bytes, Order};
use crate::names;
use crate::options::{Options, RangeUnit};
use crate::reading::LogReading;
use crate::schema::{Header, Schema};

/// Encoding of a topic's messages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// ROS 2.
    Cdr,
    Ros1,
}

/// The kind of messages.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Range {
        /// True if the schema has a variance; `None` without a schema.
        variance: Option<bool>,
    },
    /// `LaserScan` with at most this many beams.
    LaserScan(usize),
    /// Numbers at a path of the schema.
    Numbers(Rc<Numbers>),
    /// `PointCloud`: each point is a sensor, at its distance from the frame's origin.
    Points(Rc<Schema>),
    /// `PointCloud2`, read like `PointCloud`.
    Points2,
}

/// Ranges at a path of messages.
#[derive(Debug, PartialEq, Eq)]
pub(crate) struct Numbers {
    schema: Schema,
    path: Vec<String>,
    /// The unit, given by the user, the field's name, or the first values.
    pub(crate) unit: Option<RangeUnit>,
    /// True for one number instead of an array.
    pub(crate) is_single: bool,
}

/// Largest number of beams of a ring of sonars; lidars have more.
pub(crate) const MAX_BEAMS: usize = 64;
/// Largest number of beams if the user names the topic.
const MOST_BEAMS: usize = 4096;

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
        if let Some(field) = options.fields.iter().find(|field| field.topic == topic) {
            let text = schema.ok_or_else(|| format!("{type_name} without a schema; --field needs one"))?;
            let parsed = Schema::parse(text).ok_or_else(|| format!("{type_name}, whose schema cannot be read"))?;
            let paths = parsed.number_paths();
            let same = |path: &&String| path.replace("[]", "") == field.path.replace("[]", "");
            let Some(path) = paths.iter().find(same).cloned() else {
                return Err(format!("no field `{}` of {type_name}; expected one of: {}", field.path, paths.join(", ")));
            };
            return Ok(Self::numbers(parsed, &path, Some(field.unit)));
        }
        let is_asked = options.topics.iter().any(|asked| asked == topic);
        let takes_all = options.topics.is_empty() && options.fields.is_empty();
        if !is_asked && !takes_all {
            return Err(format!("{type_name}, which --topic and --field do not name"));
        }
        let plain = type_name.replace("/msg/", "/");
        match plain.as_str() {
            "sensor_msgs/Range" => return Ok(Self::Range { variance: schema.and_then(has_variance) }),
            "sensor_msgs/LaserScan" => {
                return Ok(Self::LaserScan(if is_asked || is_sonar(topic) { MOST_BEAMS } else { MAX_BEAMS }));
            }
            "sensor_msgs/PointCloud" | "sensor_msgs/PointCloud2" if !is_asked => {
                return Err(format!(
                    "{type_name}: points, no ranges; --topic {topic} reads each point as a sensor, at its distance \
                     from the frame's origin"
                ));
            }
            "sensor_msgs/PointCloud2" => return Ok(Self::Points2),
            _ => {}
        }
        let parsed = schema.and_then(Schema::parse);
        if plain == "sensor_msgs/PointCloud" {
            let parsed = parsed.ok_or_else(|| format!("{type_name} without a schema"))?;
            return Ok(Self::Points(Rc::new(parsed)));
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
                Ok(Self::numbers(parsed.clone(), path, None))
            }
            _ if paths.is_empty() || type_name.starts_with("tf2_msgs") => Err(refused()),
            Some(path) => Err(format!("{}; --field {topic} {path} m reads numbers of it", refused())),
            None if is_asked => {
                Err(format!("{type_name} has no field of ranges; --field names one of: {}", paths.join(", ")))
            }
            None => Err(refused()),
        }
    }

    fn numbers(schema: Schema, path: &str, unit: Option<RangeUnit>) -> Self {
        let parts = path.split('.').map(|name| name.trim_end_matches("[]").to_owned()).collect();
        let name = || path.rsplit('.').next().unwrap_or_default().trim_end_matches("[]");
        let unit = unit.or_else(|| names::range_unit(name()).map(|unit| unit.0));
        Self::Numbers(Rc::new(Numbers { schema, path: parts, unit, is_single: !path.contains("[]") }))
    }

    /// Returns true if sensors are told apart by their places in a message.
    pub(crate) fn has_places(&self) -> bool {
        match self {
            Self::Range { .. } => false,
            Self::Numbers(numbers) => !numbers.is_single,
            _ => true,
        }
    }

    /// Decodes a message into readings, whose `sensor` is the beam; returns its frame.
    pub(crate) fn decode(
        &self,
        encoding: Encoding,
        message: &[u8],
        recorded_ns: u64,
        readings: &mut Vec<LogReading>,
    ) -> Result<Vec<u8>, Undecoded> {
        let mut fields = match encoding {
            Encoding::Cdr => Fields::cdr(message),
            Encoding::Ros1 => Some(Fields { bytes: Bytes::new(message, Order::Little), cdr: None }),
        }
        .ok_or(Undecoded::Length)?;
        let decoded = match self {
            Self::Range { variance } => fields.range(*variance, recorded_ns, readings).map(<[u8]>::to_vec),
            Self::LaserScan(most) => fields.laser_scan(*most, recorded_ns, readings)?.map(<[u8]>::to_vec),
            Self::Numbers(numbers) => {
                let found = numbers.schema.numbers(&numbers.path, fields.bytes, fields.cdr);
                found.and_then(|(header, values)| push_all(&header, values, recorded_ns, readings))
            }
            Self::Points(schema) => {
                let axis = |axis: &str| {
                    let path = ["points".to_owned(), axis.to_owned()];
                    schema.numbers(&path, fields.bytes, fields.cdr)
                };
                (|| {
                    let ((header, x), (_, y), (_, z)) = (axis("x")?, axis("y")?, axis("z")?);
                    let far = x.iter().zip(&y).zip(&z).map(|((x, y), z)| x.hypot(*y).hypot(*z)).collect();
                    push_all(&header, far, recorded_ns, readings)
                })()
            }
            Self::Points2 => fields.points2(recorded_ns, readings),
        };
        decoded.ok_or(Undecoded::Length)
    }
}

/// Adds numbers as readings, in the order of their places.
fn push_all(header: &Header, values: Vec<f64>, recorded_ns: u64, readings: &mut Vec<LogReading>) -> Option<Vec<u8>> {
    if values.len() > MOST_BEAMS {
        return None;
    }
    let at_ns = Some(if header.stamp_ns == 0 { recorded_ns } else { header.stamp_ns });
    readings.extend(values.into_iter().enumerate().map(|(sensor, range_m)| LogReading {
        sensor,
        at_ns,
        radiation: 0,
        field_of_view_rad: 0.0,
        min_range_m: 0.0,
        max_range_m: 0.0,
        range_m,
        variance: None,
    }));
    Some(header.frame.clone().into_bytes())
}

/// Returns true if a schema has a variance; `None` if it has no range, so that it is not a schema of `Range`.
fn has_variance(schema: &str) -> Option<bool> {
    // The definitions of other messages follow after a line of `=`.
    let own = schema.lines().take_while(|line| !line.starts_with("===="));
    let names = own.map(|line| line.split('#').next().unwrap_or_default());
    let names: Vec<_> = names.filter_map(|line| line.split_whitespace().nth(1)).collect();
    let has = |name: &str| names.iter().any(|field| field.trim_end_matches(';') == name);
    has("range").then(|| has("variance"))
}

/// The bytes after CDR's header of four bytes, whose second byte gives the byte order, and the largest alignment.
pub(crate) fn cdr_bytes(message: &[u8]) -> Option<(Bytes<'_>, usize)> {
    let (header, body) = message.split_at_checked(4)?;
    let order = match (header[0], header[1]) {
        // Plain CDR, of the first and of the second version, for types that do not change.
        (0, 0 | 6) => Order::Big,
        (0, 1 | 7) => Order::Little,
        _ => return None,
    };
    Some((Bytes::new(body, order), if header[1] < 6 { 8 } else { 4 }))
}

/// The fields of a message, one after the other.
struct Fields<'a> {
    bytes: Bytes<'a>,
    /// True for CDR, which aligns numbers to at most this size and ends texts with a zero; ROS 1 does neither, and its
    /// headers have a number.
    cdr: Option<usize>,
}

impl<'a> Fields<'a> {
    fn cdr(message: &'a [u8]) -> Option<Self> {
        let (bytes, most) = cdr_bytes(message)?;
        Some(Self { bytes, cdr: Some(most) })
    }

    fn align(&mut self) -> Option<()> {
        if self.cdr.is_some() { self.bytes.align(4) } else { Some(()) }
    }

    fn u32(&mut self) -> Option<u32> {
        self.align()?;
        self.bytes.u32()
    }

    fn f32(&mut self) -> Option<f32> {
        self.align()?;
        self.bytes.f32()
    }

    /// The stamp in nanoseconds, and the frame.
    fn header(&mut self, recorded_ns: u64) -> Option<(u64, &'a [u8])> {
        if self.cdr.is_none() {
            self.bytes.u32()?; // A sequence number.
        }
        let (seconds, nanoseconds) = (self.u32()?, self.u32()?);
        let stamp = u64::from(seconds) * 1_000_000_000 + u64::from(nanoseconds);
        self.align()?;
        let frame = self.bytes.counted()?;
        let frame = if self.cdr.is_some() { frame.strip_suffix(&[0]).unwrap_or(frame) } else { frame };
        Some((if stamp == 0 { recorded_ns } else { stamp }, frame))
    }

    fn range(&mut self, variance: Option<bool>, recorded_ns: u64, readings: &mut Vec<LogReading>) -> Option<&'a [u8]> {
        let (at_ns, frame) = self.header(recorded_ns)?;
        let radiation = self.bytes.u8()?;
        let field_of_view_rad = self.f32()?;
        let [min, max, range] = [self.f32()?, self.f32()?, self.f32()?];
        let variance = match (variance, self.bytes.left()) {
            (Some(false) | None, 0) => None,
            (Some(true) | None, 4) => Some(self.f32()?),
            _ => return None,
        };
        readings.push(LogReading {
            sensor: 0,
            at_ns: Some(at_ns),
            radiation,
            field_of_view_rad,
            min_range_m: min.into(),
            max_range_m: max.into(),
            range_m: range.into(),
            variance,
        });
        Some(frame)
    }

    fn laser_scan(
        &mut self,
        most: usize,
        recorded_ns: u64,
        readings: &mut Vec<LogReading>,
    ) -> Result<Option<&'a [u8]>, Undecoded> {
        let Some((at_ns, frame)) = self.header(recorded_ns) else { return Ok(None) };
        let Some(numbers) = self.numbers::<7>() else { return Ok(None) };
        let [_, _, angle_increment, time_increment, _, min, max] = numbers;
        let Some(beams) = self.u32().map(|beams| beams as usize) else { return Ok(None) };
        // The ranges, and then the intensities after their number.
        if self.bytes.left() < beams.saturating_mul(4).saturating_add(4) {
            return Ok(None);
        }
        if beams > most {
            return Err(Undecoded::Beams);
        }
        for beam in 0..beams {
            let Some(range) = self.f32() else { return Ok(None) };
            let after_ns = f64::from(time_increment.max(0.0)) * beam as f64 * 1e9;
            readings.push(LogReading {
                sensor: beam,
                at_ns: Some(at_ns.saturating_add(after_ns as u64)),
                radiation: 0,
                field_of_view_rad: angle_increment.abs(),
                min_range_m: min.into(),
                max_range_m: max.into(),
                range_m: range.into(),
                variance: None,
            });
        }
        Ok(Some(frame))
    }

    /// Reads `PointCloud2` as the distances of its points from the origin.
    fn points2(&mut self, recorded_ns: u64, readings: &mut Vec<LogReading>) -> Option<Vec<u8>> {
        let (stamp_ns, frame) = self.header(recorded_ns)?;
        let (height, width, count) = (self.u32()? as usize, self.u32()? as usize, self.u32()?);
        let mut axes = [None; 3];
        for _ in 0..count {
            self.align()?;
            let name = self.bytes.text()?;
            let (offset, of) = (self.u32()? as usize, self.bytes.u8()?);
            self.u32()?; // Values of each point.
            if let Some(axis) = ["x", "y", "z"].iter().position(|axis| *axis == name.trim_end_matches('\0')) {
                axes[axis] = Some((offset, of));
            }
        }
        let order = if self.bytes.u8()? == 0 { Order::Little } else { Order::Big };
        let (step, _row) = (self.u32()? as usize, self.u32()?);
        self.align()?;
        let data = self.bytes.counted()?;
        let points = height.checked_mul(width)?;
        if points > MOST_BEAMS || data.len() < points.checked_mul(step)? {
            return None;
        }
        let at = |point: usize, axis: Option<(usize, u8)>| -> Option<f64> {
            let (offset, of) = axis?;
            let mut bytes = Bytes::new(data.get(point * step + offset..)?, order);
            match of {
                7 => bytes.f32().map(f64::from),
                8 => bytes.u64().map(f64::from_bits),
                _ => None,
            }
        };
        let far = |point| Some(at(point, axes[0])?.hypot(at(point, axes[1])?).hypot(at(point, axes[2]).unwrap_or(0.0)));
        let far = (0..points).map(far).collect::<Option<Vec<_>>>()?;
        let header = Header { stamp_ns, frame: String::from_utf8_lossy(frame).into_owned() };
        push_all(&header, far, recorded_ns, readings)
    }

    fn numbers<const N: usize>(&mut self) -> Option<[f32; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f32()?;
        }
        Some(numbers)
    }
}
