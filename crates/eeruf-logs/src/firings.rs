//! Logs of firings: for each, the sensor, the time and the echo. `study --log` and firmware write them;
//! [`diagnose`](crate::diagnose()) and surveys read them.
//!
//! ```text
//! # clock: simulation
//! sensor,fired_us,period,phase,t_echo_us,reading
//! 0,15000,0,0,5872,rejected
//! 4,15000,0,0,,no_echo
//! ```
//!
//! A table with these columns in any order and any separator; others are ignored, and lines that are damaged are left
//! out and named. Times are in microseconds of one clock, which the first line may name; one of 32 bits may wrap.
//! `t_echo_us` is the raw echo time, from firing to the first edge, empty without echo. `reading` is the ring's verdict
//! (`rejected`, `accepted`, `ambiguous`, ..) and may be missing. Sensors, periods and phases count from 0. `g` may say
//! how fast readings changed with the robot's motion, in microseconds for each millisecond: 2 (v + w 0.5 m) over the
//! speed of sound. Rows may be out of order by at most 2^31 us. If `sends` is 0, the sensor only listened from then on,
//! as some can.
//!
//! The same in MCAP is a message `eeruf_msgs/msg/Firing` of ROS 2 for each row, which
//! [`McapWriter::firing`](crate::McapWriter::firing) writes.

use std::fmt;
use std::io::Write;

use eeruf_core::ReadingKind;
use eeruf_files::{FIRING_COLUMNS, firing_row};

/// One firing of one sensor.
#[derive(Clone, Debug, PartialEq)]
pub struct Firing {
    /// The sensor, from 0.
    pub sensor: u8,
    /// Time of the firing, in microseconds of the log's clock.
    pub fired_us: i64,
    /// The period, from 0.
    pub period: u32,
    /// The phase, from 0.
    pub phase: u8,
    /// Time from the firing to the first echo, in microseconds; `None` without an echo.
    pub t_echo_us: Option<u32>,
    /// The ring's verdict on the reading, if the log says it.
    pub reading: Option<ReadingKind>,
    /// The rate at which readings change with the robot's motion, in microseconds for each millisecond, if known.
    pub g_us_ms: Option<f32>,
}

/// A log of firings, in order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FiringLog {
    /// The clock of the times.
    pub clock: String,
    /// The firings, in order of time.
    pub firings: Vec<Firing>,
    /// Readings of sensors that listened without firing: `fired_us` is the start of listening.
    pub listened: Vec<Firing>,
    /// The part of the file that could not be read, if any.
    pub damage: Option<String>,
}

impl FiringLog {
    /// Returns true if the log shows that the robot drives: at least a fifth of the readings with a `g` have about 3
    /// cm/s or more.
    pub(crate) fn drives(&self) -> bool {
        const MOVES_US_MS: f32 = 0.17;
        const DRIVES: f64 = 0.2;
        let said = self.firings.iter().filter_map(|firing| firing.g_us_ms);
        let (all, moves) = said.fold((0, 0), |(all, moves), g| (all + 1, moves + u32::from(g >= MOVES_US_MS)));
        f64::from(moves) > DRIVES * f64::from(all)
    }
}

impl Firing {
    /// Returns the time when the sensor fired, in nanoseconds; at least 1000, as a message's stamp of zero means that
    /// there is none.
    pub fn at_ns(&self) -> u64 {
        1000 * self.fired_us.max(1).cast_unsigned()
    }

    /// The ring's verdict on the reading, as logs spell it.
    pub(crate) fn spelled(&self) -> &'static str {
        self.reading.map_or("", ReadingKind::as_str)
    }
}

impl fmt::Display for Firing {
    /// Returns the row: a cell for each of the [`FIRING_COLUMNS`].
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let row = firing_row(self.sensor, self.fired_us, self.period, self.phase, self.t_echo_us, self.spelled());
        f.write_str(&row)
    }
}

impl FiringLog {
    /// A log with these firings, sorted by time.
    pub fn new(clock: &str, mut firings: Vec<Firing>) -> Self {
        firings.sort_by_key(|firing| firing.fired_us);
        Self { clock: clock.to_owned(), firings, ..Self::default() }
    }

    /// Warnings about legal but implausible times, such as milliseconds for microseconds.
    pub fn doubts(&self) -> Vec<String> {
        /// Shortest plausible times: earlier sound is ringing of the transducer, and sensors of a ring fire less often.
        const LEAST_US: i64 = 200;
        let echo = self.firings.iter().filter_map(|firing| firing.t_echo_us).max().map(i64::from);
        let span = self.firings.last().zip(self.firings.first()).map(|(last, first)| last.fired_us - first.fired_us);
        let between = span.map(|span| span / (self.firings.len() as i64 - 1).max(1));
        [("t_echo_us", "at most", echo), ("fired_us", "mean steps of", between)]
            .into_iter()
            .filter_map(|(key, of, us)| Some((key, of, us.filter(|us| (1..LEAST_US).contains(us))?)))
            .map(|(key, of, us)| {
                let why = "likely milliseconds: times are microseconds";
                format!("column {key}: {of} {us}; expected {LEAST_US} or more; {why}")
            })
            .collect()
    }

    /// Writes the log in the form that [`FiringLog::read`] reads.
    ///
    /// # Errors
    /// The log cannot be written.
    pub fn write(&self, mut output: impl Write) -> std::io::Result<()> {
        let sends = if self.listened.is_empty() { "" } else { ",sends" };
        let moves = self.firings.iter().any(|firing| firing.g_us_ms.is_some());
        let motion = if moves { ",g" } else { "" };
        writeln!(output, "# clock: {}", self.clock)?;
        writeln!(output, "{FIRING_COLUMNS}{motion}{sends}")?;
        for (rows, sends) in [(&self.firings, ",1"), (&self.listened, ",0")] {
            let sends = if self.listened.is_empty() { "" } else { sends };
            for firing in rows {
                write!(output, "{firing}")?;
                match firing.g_us_ms {
                    Some(g) => write!(output, ",{g}")?,
                    None if moves => write!(output, ",")?,
                    None => {}
                }
                writeln!(output, "{sends}")?;
            }
        }
        Ok(())
    }

    /// Number of sensors of the ring, judging by the log: one more than the highest number.
    pub fn sensors(&self) -> usize {
        let rows = self.firings.iter().chain(&self.listened);
        rows.map(|firing| usize::from(firing.sensor) + 1).max().unwrap_or(0)
    }
}
