//! `eeruf replay`: what the filter makes of recorded readings.

use std::path::{Path, PathBuf};

use eeruf_core::{EchoFilter, FilterError, Instant, Micros, RateFilter, ReadingKind, SensorError, Verdict};
use eeruf_logs::{Echo, McapWriter, Options, RangeUnit, Reading, Report, Sensor, Table, TimeUnit, read_log};

use super::answer::Answer;
use super::arguments::picture;
use super::hopping::Hopping;
use super::replay_hopping::replay_hopping;
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::implausible::warn_of_option;
use crate::files::kind::expect_log;
use crate::report::draw;
use crate::report::json::to_json;
use crate::report::replay::{Column, Counted, Counts, Replay, table};

/// Run the filter over a log of real readings: which would it have accepted?
///
/// With --hopping, the tracker of a hopping ring over the ring's own log of firings, as `eeruf study --method
/// eeruf_hopping --log` writes it.
///
/// The log is an MCAP file, a ROS 2 bag (its folder), a ROS 1 bag or a CSV file. Of bags, sensor_msgs/Range and
/// LaserScan (up to 64 beams) are read from all topics; a sensor is a topic and a frame, times are those of the
/// headers. Of a damaged log all is read that can be, what cannot is said, and the exit code is 2.
///
/// CSV has a header. A column is a sensor if the first value in it is a number: the range in metres. Other columns are
/// ignored, unless --time, --range and --sensor say which are which. Each row is one firing of every sensor; with
/// --sensor, of the sensor that it names. An empty value, or one of no-echo-m or more, is no echo.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log
    #[arg(value_name = "LOG")]
    file: PathBuf,
    /// T_delta: consecutive readings that differ by no more are near-identical; with --hopping by default that of the
    /// settings
    #[arg(long, value_name = "N", required_unless_present = "hopping")]
    t_delta_us: Option<u32>,
    /// The log is that of a hopping ring's firings: run the tracker over it, with these settings
    #[arg(long, value_name = "SETTING")]
    #[arg(conflicts_with_all = ["no_echo_m", "consecutive", "max_speed", "time", "time_unit"])]
    #[arg(conflicts_with_all = ["range", "range_unit", "sensor", "svg"])]
    hopping: Option<Hopping>,
    /// In m/s, to turn ranges back into echo times
    #[arg(long, default_value_t = 343.2, value_name = "C", value_parser = positive)]
    speed_of_sound: f64,
    /// CSV: the range in metres from which on a value means that there was no echo
    #[arg(long, default_value_t = 5.0, value_name = "M", value_parser = positive)]
    no_echo_m: f64,
    /// How many readings running must agree
    #[arg(long, default_value_t = 2, value_name = "N", value_parser = clap::value_parser!(u8).range(2..=8))]
    consecutive: u8,
    /// Without odometry, for a robot that drives at up to V m/s: instead of two readings that agree, three must lie on
    /// a line, within t_delta, so that echoes may change at any constant rate; the log must have times
    #[arg(long, value_name = "V", value_parser = speed, conflicts_with = "consecutive")]
    max_speed: Option<f64>,
    /// CSV: the column with the time
    #[arg(long, value_name = "COLUMN")]
    time: Option<String>,
    /// CSV: the unit of the time
    #[arg(long, value_name = "UNIT", default_value = "s")]
    time_unit: TimeName,
    /// CSV: a column with ranges; may be given several times
    #[arg(long, value_name = "COLUMN")]
    range: Vec<String>,
    /// CSV: the unit of the ranges; us are microseconds from firing to echo
    #[arg(long, value_name = "UNIT", default_value = "m")]
    range_unit: RangeName,
    /// CSV: the column that says whose reading a row is; needs one --range
    #[arg(long, value_name = "COLUMN")]
    sensor: Option<String>,
    /// Write the log's ranges as MCAP, and beside each topic `TOPIC/accepted`: the accepted ranges, +Inf where nothing
    /// is in range, -Inf for too close (REP 117), and no message for what was rejected; with --hopping also
    /// `TOPIC/confirmed`, without what is tentative
    #[arg(long, value_name = "FILE.mcap")]
    out: Option<PathBuf>,
    /// Draw what happened to each sensor over time, as SVG or, if the name ends in .png, as PNG
    #[arg(long, value_name = "FILE", value_parser = picture())]
    svg: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum TimeName {
    S,
    Ms,
    Us,
    Ns,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum RangeName {
    M,
    Cm,
    Mm,
    In,
    Us,
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if value > 0.0 && f64::is_finite(value) => Ok(value),
        _ => Err("expected a number above zero".to_owned()),
    }
}

fn speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=60.0).contains(&value) => Ok(value),
        _ => Err("expected 0 to 60".to_owned()),
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    expect_log(&args.file)?;
    warn_of_option("--t-delta-us", "t_delta_us", args.t_delta_us.unwrap_or_default())?;
    if let Some(hopping) = args.hopping {
        let mut settings = hopping.settings().tracker;
        if let Some(t_delta) = args.t_delta_us.map(Micros::new) {
            // What depends on it gives way.
            settings.t_delta = t_delta;
            settings.near = settings.near.max(t_delta);
            settings.tentative_within = settings.tentative_within.min(t_delta);
        }
        return replay_hopping(&args.file, settings, args.speed_of_sound, args.out.as_deref(), args.json);
    }
    let mut replayed = Replayed::new(args)?;
    let report = read_log(&args.file, &options(args), |sensors, reading| replayed.reading(sensors, reading))?;
    if let Some(error) = replayed.failed.take() {
        return Err(error);
    }
    if let Some(out) = replayed.out.take() {
        out.finish()?;
    }
    print(args, &report, replayed.sensors)?;
    match &report.damage[..] {
        [] => Ok(Answer::Yes),
        [first] => Err(InputError::new(&first.file, None, at(first))),
        [first, rest @ ..] => {
            let message = format!("{}; and {} more places that cannot be read", at(first), rest.len());
            Err(InputError::new(&first.file, None, message))
        }
    }
}

fn at(damage: &eeruf_logs::Damage) -> String {
    damage.at.map_or_else(|| damage.message.clone(), |at| format!("at byte {at}: {}", damage.message))
}

fn options(args: &Args) -> Options {
    let table = Table {
        ranges: args.range.clone(),
        range_unit: match args.range_unit {
            RangeName::M => RangeUnit::M,
            RangeName::Cm => RangeUnit::Cm,
            RangeName::Mm => RangeUnit::Mm,
            RangeName::In => RangeUnit::In,
            RangeName::Us => RangeUnit::Us,
        },
        time: args.time.clone(),
        time_unit: match args.time_unit {
            TimeName::S => TimeUnit::S,
            TimeName::Ms => TimeUnit::Ms,
            TimeName::Us => TimeUnit::Us,
            TimeName::Ns => TimeUnit::Ns,
        },
        sensor: args.sensor.clone(),
    };
    Options { table, speed_of_sound: args.speed_of_sound, no_echo_m: args.no_echo_m }
}

fn print(args: &Args, report: &Report, sensors: Vec<Filtered>) -> Result<(), InputError> {
    let names = report.names();
    let counts: Vec<_> = names.iter().zip(&sensors).map(|(name, sensor)| Counts::of(name, &sensor.counted)).collect();
    let total = counts.iter().fold(Counts::default(), Counts::plus);
    if let Some(file) = &args.svg {
        let column = |(name, sensor): (&String, Filtered)| Column { name: name.clone(), kinds: sensor.kinds };
        let columns: Vec<_> = names.iter().zip(sensors).map(column).collect();
        draw::kinds_over_time(&columns, args.t_delta_us.unwrap_or_default()).save(file)?;
    }
    let skipped = report.skipped.iter().map(|topic| match topic.messages {
        0 => format!("{}: {}", topic.topic, topic.why),
        messages => format!("{}: {messages} messages with {}", topic.topic, topic.why),
    });
    if args.json {
        let damage = report.damage.iter().map(ToString::to_string).collect();
        let replay = Replay { total, sensors: counts, as_logged: None, damage, skipped: skipped.collect() };
        print_line(to_json(&replay))?;
    } else {
        let table = table(&args.file, args.t_delta_us.unwrap_or_default(), &counts, &total);
        let skipped: String = skipped.map(|skipped| format!("left out {skipped}\n")).collect();
        tell(format!("{table}\n{skipped}"))?;
    }
    Ok(())
}

/// The filters of all sensors, and what they have made of the log so far.
struct Replayed {
    sensors: Vec<Filtered>,
    fresh: Filter,
    speed_of_sound: f64,
    keep_kinds: bool,
    out: Option<McapWriter>,
    /// The first reading that could not be taken.
    failed: Option<InputError>,
    log: PathBuf,
}

/// The filter of one sensor.
#[derive(Clone)]
enum Filter {
    Plain(EchoFilter<1>),
    /// With a rate.
    Rate(RateFilter<1>),
}

impl Filter {
    fn new(args: &Args) -> Result<Self, FilterError> {
        let t_delta = Micros::new(args.t_delta_us.unwrap_or_default());
        Ok(match args.max_speed {
            None => Self::Plain(EchoFilter::new(t_delta, args.consecutive)?),
            // At 60 m/s still far from the largest number.
            Some(speed) => Self::Rate(RateFilter::new(t_delta, (2e6 * speed / args.speed_of_sound).round() as u32)?),
        })
    }

    fn forget(&mut self) -> Result<(), SensorError> {
        match self {
            Self::Plain(filter) => filter.forget(0),
            Self::Rate(filter) => filter.forget(0),
        }
    }

    fn push(&mut self, at_ns: u64, t_echo: Option<Micros>) -> Result<Verdict, SensorError> {
        match self {
            Self::Plain(filter) => filter.push(0, t_echo),
            // Of a clock that wraps.
            Self::Rate(filter) => filter.push(0, Instant::from_micros((at_ns / 1000) as u32), t_echo),
        }
    }
}

/// One sensor.
struct Filtered {
    filter: Filter,
    counted: Counted,
    /// Only if a picture is wanted.
    kinds: Vec<ReadingKind>,
    /// The latest time, in nanoseconds.
    latest_ns: u64,
}

impl Replayed {
    fn new(args: &Args) -> Result<Self, InputError> {
        let bad = |error: FilterError| InputError::new(&args.file, None, error);
        Ok(Self {
            sensors: Vec::new(),
            fresh: Filter::new(args).map_err(bad)?,
            speed_of_sound: args.speed_of_sound,
            keep_kinds: args.svg.is_some(),
            out: args.out.as_deref().map(McapWriter::create).transpose()?,
            failed: None,
            log: args.file.clone(),
        })
    }

    fn reading(&mut self, sensors: &[Sensor], reading: &Reading) {
        if self.failed.is_none() {
            self.failed = self.filter(sensors, reading).err();
        }
    }

    fn filter(&mut self, sensors: &[Sensor], reading: &Reading) -> Result<(), InputError> {
        while self.sensors.len() <= reading.sensor {
            let (filter, counted) = (self.fresh.clone(), Counted::default());
            self.sensors.push(Filtered { filter, counted, kinds: Vec::new(), latest_ns: 0 });
        }
        let of = &mut self.sensors[reading.sensor];
        let kind = of.kind(reading, self.speed_of_sound, &self.log)?;
        of.note_time(reading.at_ns);
        if let Some(kind) = kind {
            of.counted.tally.count(kind);
            if self.keep_kinds {
                of.kinds.push(kind);
            }
        }
        match &mut self.out {
            Some(out) => write(out, &sensors[reading.sensor], reading, kind, &self.log),
            None => Ok(()),
        }
    }
}

impl Filtered {
    /// What the filter makes of a reading; `None` of one that is no number.
    fn kind(&mut self, reading: &Reading, speed_of_sound: f64, log: &Path) -> Result<Option<ReadingKind>, InputError> {
        // Each filter has one sensor, so that it knows it.
        if reading.at_ns == 0 && matches!(self.filter, Filter::Rate(_)) {
            let message = "a reading without a time; --max-speed needs --time COLUMN for CSV";
            return Err(InputError::new(log, None, message));
        }
        let pushed = |verdict: Result<Verdict, _>| verdict.map(|verdict| Some(verdict.kind));
        match reading.echo() {
            Echo::Invalid => {
                self.counted.invalid += 1;
                Ok(None)
            }
            Echo::TooClose => self.filter.forget().map(|()| Some(ReadingKind::TooEarly)),
            Echo::Nothing => pushed(self.filter.push(reading.at_ns, None)),
            Echo::At(range_m) => {
                let t_echo_us = (2e6 * range_m / speed_of_sound).round();
                if t_echo_us >= f64::from(u32::MAX) {
                    let message = format!("a range of {range_m} m; expected one that sound covers within an hour");
                    return Err(InputError::new(log, None, message));
                }
                pushed(self.filter.push(reading.at_ns, Some(Micros::new(t_echo_us as u32))))
            }
        }
        .map_err(|error| InputError::new(log, None, error))
    }

    fn note_time(&mut self, at_ns: u64) {
        let (from, to) = self.counted.between_ns.unwrap_or((at_ns, at_ns));
        self.counted.between_ns = Some((from.min(at_ns), to.max(at_ns)));
        self.counted.backwards += u64::from(at_ns < self.latest_ns);
        self.latest_ns = at_ns;
    }
}

/// The reading as it was, and beside it what the filter accepts.
fn write(
    out: &mut McapWriter,
    sensor: &Sensor,
    reading: &Reading,
    kind: Option<ReadingKind>,
    log: &Path,
) -> Result<(), InputError> {
    if reading.at_ns == 0 {
        return Err(InputError::new(log, None, "a reading without a time; --out needs --time COLUMN for CSV"));
    }
    let topic = sensor.beam.map_or_else(|| sensor.topic.clone(), |beam| format!("{}/beam_{beam}", sensor.topic));
    out.range(&topic, &sensor.frame, reading)?;
    let range_m = match kind {
        Some(ReadingKind::Accepted) => reading.range_m,
        Some(ReadingKind::Clear) => f64::INFINITY,
        Some(ReadingKind::TooEarly) => f64::NEG_INFINITY,
        _ => return Ok(()),
    };
    Ok(out.range(&format!("{topic}/accepted"), &sensor.frame, &Reading { range_m, ..*reading })?)
}
