//! Options of reading a log.

/// Options for reading a log. Whatever is not given is guessed, and listed in
/// [`Report::guesses`](crate::Report::guesses).
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// The columns of a text.
    pub table: Table,
    /// Speed of sound in m/s, for values that are echo times.
    pub speed_of_sound: f64,
    /// Range in metres from which on a value of a text means no echo.
    pub no_echo_m: f64,
    /// Values that mean no echo, in the log's unit, or words. If empty: zero, values below zero, and a ceiling that the
    /// log repeats.
    pub no_echo: Vec<String>,
    /// The topics of a bag to read, of any readable type. If empty, all that hold ranges.
    pub topics: Vec<String>,
    /// Fields of messages that hold ranges.
    pub fields: Vec<FieldChoice>,
    /// True to read also the topics that a filter wrote: `TOPIC/accepted` and `TOPIC/confirmed` beside `TOPIC`.
    pub judged: bool,
}

impl Default for Options {
    /// Options that guess everything, with 343.2 m/s, and no echo from 5 m on.
    fn default() -> Self {
        Self {
            table: Table::default(),
            speed_of_sound: 343.2,
            no_echo_m: 5.0,
            no_echo: Vec::new(),
            topics: Vec::new(),
            fields: Vec::new(),
            judged: false,
        }
    }
}

/// The parts of a log that options choose from.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Parts {
    Columns,
    #[cfg(feature = "files")]
    Topics,
    /// Frames of the serial line, which have neither columns nor topics.
    #[cfg(feature = "files")]
    Frames,
}

impl Options {
    /// A warning about options for parts that the log does not have.
    pub(crate) fn without_effect(&self, parts: Parts) -> Option<String> {
        let bags = || given(&[("--topic", !self.topics.is_empty()), ("--field", !self.fields.is_empty())]);
        let (idle, has) = match parts {
            Parts::Columns => (bags(), "columns and no topics; --range and --sensor choose columns"),
            #[cfg(feature = "files")]
            Parts::Topics => (self.of_columns(), "topics and no columns; --topic and --field choose topics"),
            #[cfg(feature = "files")]
            Parts::Frames => ([self.of_columns(), bags()].concat(), "frames of the serial line, which say all"),
        };
        let (verb, them) = if idle.len() == 1 { ("has", "it") } else { ("have", "them") };
        let idle = if idle.is_empty() { return None } else { idle.join(", ") };
        Some(format!("{idle} {verb} no effect; expected a log that {them} could choose from; this one has {has}"))
    }

    #[cfg(feature = "files")]
    fn of_columns(&self) -> Vec<&'static str> {
        let Self { table, no_echo, .. } = self;
        given(&[
            ("--columns", !table.columns.is_empty()),
            ("--range", !table.ranges.is_empty()),
            ("--range-unit", table.range_unit.is_some()),
            ("--time", table.time.is_some()),
            ("--time-unit", table.time_unit.is_some()),
            ("--sensor", table.sensor.is_some()),
            ("--no-echo", !no_echo.is_empty()),
        ])
    }
}

fn given(options: &[(&'static str, bool)]) -> Vec<&'static str> {
    options.iter().filter(|(_, is_given)| *is_given).map(|(option, _)| *option).collect()
}

/// A field of a topic's messages that holds ranges.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FieldChoice {
    /// The topic.
    pub topic: String,
    /// The path to the field, such as `distance_mm[]` or `sonars[].range`.
    pub path: String,
    /// The unit of the field's values.
    pub unit: RangeUnit,
}

/// The columns of a text, by their names.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// The names of the columns in their order, in place of a header; `-` leaves one out. If empty, the header's.
    pub columns: Vec<String>,
    /// The columns with ranges. If empty, those called so by a name or a unit, or else all purely numeric ones.
    pub ranges: Vec<String>,
    /// The unit of the ranges.
    pub range_unit: Option<RangeUnit>,
    /// The column with the time of each row.
    pub time: Option<String>,
    /// The unit of the time.
    pub time_unit: Option<TimeUnit>,
    /// The column that names a row's sensor; there is then one column with ranges.
    pub sensor: Option<String>,
}

/// The unit of ranges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum RangeUnit {
    /// Metres.
    #[default]
    M,
    /// Centimetres.
    Cm,
    /// Millimetres.
    Mm,
    /// Inches.
    In,
    /// Feet.
    Ft,
    /// Milliseconds of round trip from firing to echo.
    Ms,
    /// Microseconds of round trip from firing to echo.
    Us,
}

/// The unit of times.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TimeUnit {
    /// Seconds.
    #[default]
    S,
    /// Milliseconds.
    Ms,
    /// Microseconds.
    Us,
    /// Nanoseconds.
    Ns,
}

impl RangeUnit {
    /// Units by the names that options take.
    pub const NAMES: [(&str, Self); 7] = [
        ("m", Self::M),
        ("cm", Self::Cm),
        ("mm", Self::Mm),
        ("in", Self::In),
        ("ft", Self::Ft),
        ("ms", Self::Ms),
        ("us", Self::Us),
    ];

    /// The unit in metres.
    pub(crate) fn metres(self, speed_of_sound: f64) -> f64 {
        let (_, size, _) = self.said();
        if matches!(self, Self::Ms | Self::Us) { 0.5 * size * speed_of_sound } else { size }
    }

    pub(crate) const fn name(self) -> &'static str {
        self.said().0
    }

    /// The unit with this name in a log.
    pub(crate) fn of_word(word: &str) -> Option<Self> {
        let is_own = |(_, unit): &&(_, Self)| unit.said().2.split(' ').any(|own| own == word);
        Self::NAMES.iter().find(is_own).map(|(_, unit)| *unit)
    }

    /// The name of the unit, its size in metres or seconds, and its names in logs.
    const fn said(self) -> (&'static str, f64, &'static str) {
        match self {
            Self::M => ("metres", 1.0, "m meter meters metre metres"),
            Self::Cm => ("centimetres", 1e-2, "cm cms centimeter centimeters centimetre centimetres"),
            Self::Mm => ("millimetres", 1e-3, "mm millimeter millimeters millimetre millimetres"),
            Self::In => ("inches", 0.0254, "in inch inches \""),
            Self::Ft => ("feet", 0.3048, "ft foot feet"),
            // `ms` in a log is a time.
            Self::Ms => ("milliseconds", 1e-3, "-"),
            Self::Us => ("microseconds", 1e-6, "us \u{b5}s \u{3bc}s usec microseconds microsecond"),
        }
    }
}

impl TimeUnit {
    /// Units by the names that options take.
    pub const NAMES: [(&str, Self); 4] = [("s", Self::S), ("ms", Self::Ms), ("us", Self::Us), ("ns", Self::Ns)];

    /// The unit with this name in a log.
    pub(crate) fn of_word(word: &str) -> Option<Self> {
        let is_own = |(_, unit): &&(_, Self)| unit.said().2.split(' ').any(|own| own == word);
        Self::NAMES.iter().find(is_own).map(|(_, unit)| *unit)
    }

    /// The name of the unit, its nanoseconds, and its names in logs.
    pub(crate) const fn said(self) -> (&'static str, f64, &'static str) {
        match self {
            Self::S => ("seconds", 1e9, "s sec secs seconds"),
            Self::Ms => ("milliseconds", 1e6, "ms millis msec milliseconds"),
            Self::Us => ("microseconds", 1e3, "us micros usec microseconds \u{b5}s"),
            Self::Ns => ("nanoseconds", 1.0, "ns nanos nsec nsecs nanosec nanoseconds"),
        }
    }
}
