//! A judge of the ranges of a log, with counts and an output file.

use std::path::{Path, PathBuf};

use eeruf_core::judge::Verdict;
use eeruf_core::{EchoFilter, Micros, ReadingKind, RingError, SensorError, Tally};
use eeruf_files::FileError;

use super::write::McapWriter;
use crate::reading::{Echo, LogReading, Sensor};

/// A judge that compares consecutive readings of each sensor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RangeJudge {
    /// The largest difference of two readings that agree.
    pub t_delta: Micros,
    /// Number of readings that must agree, 2 to 8.
    pub consecutive: u8,
}

/// Counts of one sensor's judged readings.
#[derive(Clone, Copy, Debug, Default)]
pub struct Counted {
    /// Readings by their kinds.
    pub tally: Tally<u32>,
    /// Number of readings that are not numbers.
    pub invalid: u64,
    /// Times of the earliest and of the latest reading, in nanoseconds.
    pub between_ns: Option<(u64, u64)>,
    /// Number of readings whose time is before that of the previous reading.
    pub backwards: u64,
    /// Number of pauses after which a reading is not compared with earlier ones.
    pub gaps: u64,
}

/// A judge at work on a log.
///
/// ```
/// use eeruf_core::{Micros, ReadingKind::*};
/// use eeruf_logs::{Judging, Options, RangeJudge, read_stream};
/// let two = RangeJudge { t_delta: Micros::new(500), consecutive: 2 };
/// let (mut judging, mut kinds) = (Judging::new(two, 343.2, "log".as_ref())?, vec![]);
/// let text = "front m\n1.20\n1.21\n0.40\n";
/// read_stream(text.as_bytes(), "log".as_ref(), &Options::default(), |report, reading| {
///     kinds.push(judging.push(&report.sensors, reading));
/// })?;
/// assert_eq!(kinds, [Ok(Some(First)), Ok(Some(Accepted)), Ok(Some(Rejected))]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct Judging {
    sensors: Vec<Judged>,
    fresh: EchoFilter<1>,
    speed_of_sound: f64,
    out: Option<McapWriter>,
    log: PathBuf,
}

/// One sensor.
struct Judged {
    filter: EchoFilter<1>,
    counted: Counted,
    latest_ns: Option<u64>,
    /// A running mean of the interval between two readings.
    usual_ns: Option<f64>,
}

impl Judging {
    /// A judge without readings; the speed of sound, in m/s, converts ranges to times, and the log's name is used in
    /// errors.
    ///
    /// # Errors
    /// The judge cannot compare this number of readings.
    pub fn new(judge: RangeJudge, speed_of_sound: f64, log: &Path) -> Result<Self, RingError> {
        let fresh = EchoFilter::new(judge.t_delta, judge.consecutive)?;
        Ok(Self { sensors: Vec::new(), fresh, speed_of_sound, out: None, log: log.to_owned() })
    }

    /// Writes each reading to its topic too, and the accepted ones to `TOPIC/accepted`: the range, `+Inf` where
    /// nothing is in range, `-Inf` for too close.
    #[must_use]
    pub fn writing(self, out: McapWriter) -> Self {
        Self { out: Some(out), ..self }
    }

    /// Judges a reading of a log with these sensors so far; `None` for a reading that is not a number.
    ///
    /// # Errors
    /// A reading without a time, if the judge or the file needs one; a range of more than an hour of sound; a file that
    /// cannot be written.
    pub fn push(&mut self, sensors: &[Sensor], reading: &LogReading) -> Result<Option<ReadingKind>, FileError> {
        while self.sensors.len() <= reading.sensor {
            let (filter, counted) = (self.fresh.clone(), Counted::default());
            self.sensors.push(Judged { filter, counted, latest_ns: None, usual_ns: None });
        }
        let failed = |message: String| FileError::new(&self.log, message);
        let kind = self.sensors[reading.sensor].judge(reading, self.speed_of_sound).map_err(failed)?;
        if let (Some(out), Some(sensor)) = (&mut self.out, sensors.get(reading.sensor)) {
            if reading.at_ns.is_none() {
                return Err(failed(untimed("MCAP needs")));
            }
            write(out, sensor, reading, kind)?;
        }
        Ok(kind)
    }

    /// The counts of each sensor so far.
    pub fn counted(&self) -> Vec<Counted> {
        self.sensors.iter().map(|sensor| sensor.counted).collect()
    }

    /// Completes the output file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn finish(self) -> Result<(), FileError> {
        self.out.map_or(Ok(()), McapWriter::finish)
    }
}

impl Judged {
    fn judge(&mut self, reading: &LogReading, speed_of_sound: f64) -> Result<Option<ReadingKind>, String> {
        // Each filter has one sensor, 0, so this never happens.
        let failed = |error: SensorError| error.to_string();
        if reading.at_ns.is_some_and(|at_ns| self.breaks(at_ns)) {
            self.filter.forget(0).map_err(failed)?;
        }
        let pushed = |verdict: Result<Verdict, _>| verdict.map(|verdict| verdict.kind);
        let kind = match reading.echo() {
            Echo::Invalid => {
                self.counted.invalid += 1;
                return Ok(None);
            }
            Echo::TooClose => self.filter.forget(0).map(|()| ReadingKind::TooEarly),
            Echo::Nothing => pushed(self.filter.push(0, None)),
            Echo::At(range_m) => {
                let t_echo_us = (2e6 * range_m / speed_of_sound).round();
                if t_echo_us >= f64::from(u32::MAX) {
                    return Err(format!("a range of {range_m} m; expected one that sound covers within an hour"));
                }
                pushed(self.filter.push(0, Some(Micros::new(t_echo_us as u32))))
            }
        };
        let kind = kind.map_err(failed)?;
        self.counted.tally.count(kind);
        Ok(Some(kind))
    }

    /// Notes a time, and returns true if a reading then must not be compared with the previous one.
    fn breaks(&mut self, at_ns: u64) -> bool {
        /// Least length of a gap: in nanoseconds, and in usual intervals.
        const SHORTEST_GAP_NS: f64 = 1e9;
        const TIMES_USUAL: f64 = 5.0;
        /// Least length of a gap before a usual interval is known.
        const FIRST_GAP_NS: f64 = 1e10;
        let (from, to) = self.counted.between_ns.unwrap_or((at_ns, at_ns));
        self.counted.between_ns = Some((from.min(at_ns), to.max(at_ns)));
        let Some(before) = self.latest_ns.replace(at_ns) else { return false };
        if at_ns < before {
            self.counted.backwards += 1;
            return true;
        }
        let pause = (at_ns - before) as f64;
        if pause > self.usual_ns.map_or(FIRST_GAP_NS, |usual| SHORTEST_GAP_NS.max(TIMES_USUAL * usual)) {
            self.counted.gaps += 1;
            return true;
        }
        self.usual_ns = Some(self.usual_ns.map_or(pause, |usual| usual + (pause - usual) / 8.0));
        false
    }
}

fn untimed(thing_needs: &str) -> String {
    format!("a reading without a time; expected --time COLUMN for a table, as {thing_needs} times")
}

/// Writes the reading, and if it is accepted, writes it again on the topic of accepted readings.
fn write(
    out: &mut McapWriter,
    sensor: &Sensor,
    reading: &LogReading,
    kind: Option<ReadingKind>,
) -> Result<(), FileError> {
    let topic = sensor.beam.map_or_else(|| sensor.topic.clone(), |beam| format!("{}/beam_{beam}", sensor.topic));
    out.range(&topic, &sensor.frame, reading)?;
    let range_m = match kind {
        Some(ReadingKind::Accepted) => reading.range_m,
        Some(ReadingKind::Clear) => f64::INFINITY,
        Some(ReadingKind::TooEarly) => f64::NEG_INFINITY,
        _ => return Ok(()),
    };
    out.range(&format!("{topic}/accepted"), &sensor.frame, &LogReading { range_m, ..*reading })
}
