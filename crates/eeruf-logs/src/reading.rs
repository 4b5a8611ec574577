//! Contents of a log: readings and their sensors.

/// A sensor of a log: a topic and a frame, and for a `LaserScan` one of its beams.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Sensor {
    /// The topic, or the name of a CSV file's column.
    pub topic: String,
    /// `frame_id` of the messages' headers; empty where they have none.
    pub frame: String,
    /// The beam of a `LaserScan`, from 0.
    pub beam: Option<u16>,
}

impl Sensor {
    /// The topic, with frame and beam if it has several sensors.
    pub fn name(&self, alone_on_its_topic: bool) -> String {
        match (self.beam, alone_on_its_topic || self.frame.is_empty()) {
            (Some(beam), _) => format!("{}[{beam}]", self.topic),
            (None, true) => self.topic.clone(),
            (None, false) => format!("{} {}", self.topic, self.frame),
        }
    }
}

/// One reading of one sensor, in the units of `sensor_msgs/Range`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LogReading {
    /// The sensor, as an index into [`Report::sensors`](crate::Report::sensors).
    pub sensor: usize,
    /// The time in nanoseconds: the header's stamp, or the recording time of the message if the stamp is zero.
    pub at_ns: Option<u64>,
    /// `radiation_type`: 0 is ultrasound, 1 infrared.
    pub radiation: u8,
    /// `field_of_view`, in radians.
    pub field_of_view_rad: f32,
    /// Shortest range that the sensor can measure, in metres.
    pub min_range_m: f64,
    /// Range in metres from which a value means no echo.
    pub max_range_m: f64,
    /// The range in metres as recorded, with infinities as in REP 117.
    pub range_m: f64,
    /// `variance`, in square metres, if the message has one.
    pub variance: Option<f32>,
}

/// The meaning of a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Echo {
    /// An echo from this range, in metres.
    At(f64),
    /// Nothing in range: `+Inf`, or the maximum range and more.
    Nothing,
    /// An object too close to measure: `-Inf`, or less than the minimum range.
    TooClose,
    /// Not a number: the driver reported an error.
    Invalid,
}

impl LogReading {
    /// A reading by ultrasound, from a log that says no more; it means no echo from `max_range_m` on, if that is not 0.
    pub(crate) const fn new(sensor: usize, at_ns: Option<u64>, range_m: f64, max_range_m: f64) -> Self {
        Self {
            sensor,
            at_ns,
            radiation: 0,
            field_of_view_rad: 0.0,
            min_range_m: 0.0,
            max_range_m,
            range_m,
            variance: None,
        }
    }

    /// The meaning of the range by REP 117.
    pub fn echo(&self) -> Echo {
        let Self { range_m, min_range_m, max_range_m, .. } = *self;
        if range_m.is_nan() {
            Echo::Invalid
        } else if range_m == f64::INFINITY || (max_range_m > 0.0 && range_m >= max_range_m) {
            Echo::Nothing
        } else if range_m < min_range_m || range_m < 0.0 {
            Echo::TooClose
        } else {
            Echo::At(range_m)
        }
    }
}
