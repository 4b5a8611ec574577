//! `sensor_msgs/Range` and `sensor_msgs/LaserScan` as bytes: CDR, as ROS 2 has them, and the format of ROS 1.
//!
//! `Range` has had a `variance` since ROS 2 Iron. The schema in the file says whether a message has one; files without
//! a schema leave it to the message's length.

use crate::bytes::{Bytes, Order};
use crate::reading::Reading;

/// How the messages of a topic are encoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Encoding {
    /// ROS 2.
    Cdr,
    Ros1,
}

/// Which messages they are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Range {
        /// Whether the schema has a variance, if there is a schema.
        variance: Option<bool>,
    },
    LaserScan,
}

/// A ring of sonars has no more beams than this; lidars have.
pub(crate) const MAX_BEAMS: usize = 64;

/// Why a message could not be decoded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Undecoded {
    /// It ends too early, or too late.
    Length,
    /// A `LaserScan` of a lidar.
    Beams,
}

impl Kind {
    /// By the name of a type, as `sensor_msgs/Range` or `sensor_msgs/msg/Range`, and the text of its schema.
    pub(crate) fn of(type_name: &str, schema: Option<&str>) -> Option<Self> {
        match type_name.strip_prefix("sensor_msgs/")?.trim_start_matches("msg/") {
            "Range" => Some(Self::Range { variance: schema.and_then(has_variance) }),
            "LaserScan" => Some(Self::LaserScan),
            _ => None,
        }
    }

    /// Decodes a message into readings, whose `sensor` is the beam; the answer is its frame.
    pub(crate) fn decode<'a>(
        self,
        encoding: Encoding,
        message: &'a [u8],
        recorded_ns: u64,
        readings: &mut Vec<Reading>,
    ) -> Result<&'a [u8], Undecoded> {
        let mut fields = match encoding {
            Encoding::Cdr => Fields::cdr(message),
            Encoding::Ros1 => Some(Fields { bytes: Bytes::new(message, Order::Little), cdr: false }),
        }
        .ok_or(Undecoded::Length)?;
        let decoded = match self {
            Self::Range { variance } => fields.range(variance, recorded_ns, readings),
            Self::LaserScan => fields.laser_scan(recorded_ns, readings)?,
        };
        decoded.ok_or(Undecoded::Length)
    }
}

/// Whether a schema has a variance; `None` where it does not even have a range, so that it is no schema of `Range`.
fn has_variance(schema: &str) -> Option<bool> {
    // The definitions of other messages follow after a line of `=`.
    let own = schema.lines().take_while(|line| !line.starts_with("===="));
    let names = own.map(|line| line.split('#').next().unwrap_or_default());
    let names: Vec<_> = names.filter_map(|line| line.split_whitespace().nth(1)).collect();
    let has = |name: &str| names.iter().any(|field| field.trim_end_matches(';') == name);
    has("range").then(|| has("variance"))
}

/// The fields of a message, one after the other.
struct Fields<'a> {
    bytes: Bytes<'a>,
    /// CDR aligns numbers and ends texts by a zero; ROS 1 does neither, and its headers have a number.
    cdr: bool,
}

impl<'a> Fields<'a> {
    /// What follows CDR's own header of four bytes, of which the second says in which order bytes come.
    fn cdr(message: &'a [u8]) -> Option<Self> {
        let (header, body) = message.split_at_checked(4)?;
        let order = match (header[0], header[1]) {
            // Plain CDR, of the first and of the second version, for types that do not change.
            (0, 0 | 6) => Order::Big,
            (0, 1 | 7) => Order::Little,
            _ => return None,
        };
        Some(Self { bytes: Bytes::new(body, order), cdr: true })
    }

    fn align(&mut self) -> Option<()> {
        if self.cdr { self.bytes.align(4) } else { Some(()) }
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
        if !self.cdr {
            self.bytes.u32()?; // A running number.
        }
        let (seconds, nanoseconds) = (self.u32()?, self.u32()?);
        let stamp = u64::from(seconds) * 1_000_000_000 + u64::from(nanoseconds);
        self.align()?;
        let frame = self.bytes.counted()?;
        let frame = if self.cdr { frame.strip_suffix(&[0]).unwrap_or(frame) } else { frame };
        Some((if stamp == 0 { recorded_ns } else { stamp }, frame))
    }

    fn range(&mut self, variance: Option<bool>, recorded_ns: u64, readings: &mut Vec<Reading>) -> Option<&'a [u8]> {
        let (at_ns, frame) = self.header(recorded_ns)?;
        let radiation = self.bytes.u8()?;
        let field_of_view_rad = self.f32()?;
        let [min, max, range] = [self.f32()?, self.f32()?, self.f32()?];
        let variance = match (variance, self.bytes.left()) {
            (Some(false) | None, 0) => None,
            (Some(true) | None, 4) => Some(self.f32()?),
            _ => return None,
        };
        readings.push(Reading {
            sensor: 0,
            at_ns,
            radiation,
            field_of_view_rad,
            min_range_m: min.into(),
            max_range_m: max.into(),
            range_m: range.into(),
            variance,
        });
        Some(frame)
    }

    fn laser_scan(&mut self, recorded_ns: u64, readings: &mut Vec<Reading>) -> Result<Option<&'a [u8]>, Undecoded> {
        let Some((at_ns, frame)) = self.header(recorded_ns) else { return Ok(None) };
        let Some(numbers) = self.numbers::<7>() else { return Ok(None) };
        let [_, _, angle_increment, time_increment, _, min, max] = numbers;
        let Some(beams) = self.u32().map(|beams| beams as usize) else { return Ok(None) };
        // The ranges, and then the intensities after their number.
        if self.bytes.left() < beams.saturating_mul(4).saturating_add(4) {
            return Ok(None);
        }
        if beams > MAX_BEAMS {
            return Err(Undecoded::Beams);
        }
        for beam in 0..beams {
            let Some(range) = self.f32() else { return Ok(None) };
            let after_ns = f64::from(time_increment.max(0.0)) * beam as f64 * 1e9;
            readings.push(Reading {
                sensor: beam,
                at_ns: at_ns.saturating_add(after_ns as u64),
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

    fn numbers<const N: usize>(&mut self) -> Option<[f32; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f32()?;
        }
        Some(numbers)
    }
}
