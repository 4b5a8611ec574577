//! What has to be said about a log besides where it is.

/// How to read a log. Only CSV needs anything.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    /// What the columns of a CSV file are.
    pub table: Table,
    /// In m/s, for values that are echo times.
    pub speed_of_sound: f64,
    /// From this range on, in metres, a value of a CSV file means that there was no echo.
    pub no_echo_m: f64,
}

impl Default for Options {
    /// Columns as their values have them, in metres; 343.2 m/s; no echo from 5 m on.
    fn default() -> Self {
        Self { table: Table::default(), speed_of_sound: 343.2, no_echo_m: 5.0 }
    }
}

/// What the columns of a CSV file are, by their names in its header.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Table {
    /// The columns with ranges. If empty, each column whose first value is a number, other than the time's.
    pub ranges: Vec<String>,
    /// The unit of the ranges.
    pub range_unit: RangeUnit,
    /// The column with the time of each row.
    pub time: Option<String>,
    /// The unit of the time.
    pub time_unit: TimeUnit,
    /// The column that says whose reading a row is; then there is one column with ranges.
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
    /// Microseconds from firing to echo, there and back.
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
    /// Metres in one of it.
    pub(crate) fn metres(self, speed_of_sound: f64) -> f64 {
        match self {
            Self::M => 1.0,
            Self::Cm => 1e-2,
            Self::Mm => 1e-3,
            Self::In => 0.0254,
            Self::Us => 0.5e-6 * speed_of_sound,
        }
    }

    pub(crate) const fn name(self) -> &'static str {
        match self {
            Self::M => "metres",
            Self::Cm => "centimetres",
            Self::Mm => "millimetres",
            Self::In => "inches",
            Self::Us => "microseconds",
        }
    }
}

impl TimeUnit {
    /// Nanoseconds in one of it.
    pub(crate) const fn nanoseconds(self) -> f64 {
        match self {
            Self::S => 1e9,
            Self::Ms => 1e6,
            Self::Us => 1e3,
            Self::Ns => 1.0,
        }
    }
}
