//! `eeruf replay`: what the filter makes of recorded readings.

use std::path::{Path, PathBuf};

use eeruf_core::{
    EchoFilter, Instant, Micros, ReadingKind, RingError, SensorError,
    judge::{RateFilter, Verdict},
};
use eeruf_files::Kind;
use eeruf_logs::{Echo, McapWriter, Reading, Report, Sensor, read_log};

use super::Answer;
use super::arguments::picture;
use super::log_args::{LogArgs, left_out, tell_damage, warn_of_log};
use super::methods::Hopping;
use super::replay_hopping::replay_hopping;
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::files::implausible::warn;
use crate::report::draw;
use crate::report::json::to_json;
use crate::report::replay::{Column, Counted, Counts, Firing, Replay, table};

/// Run the filter over a log of real readings: which would it have accepted?
///
/// With --hopping, the tracker of a hopping ring over the ring's own log of firings, as `eeruf study --method
/// eeruf_hopping --log` writes it.
///
/// The log is whatever `eeruf logs` reads: MCAP, ROS 1 and ROS 2 bags, tables, lines of pairs, JSON. Of a damaged log
/// all is read that can be, what cannot is said, and the exit code is 2. A gap in a sensor's times, and a clock that
/// steps back, start its comparison over. The last line says how the sensors fire, and what agreement proves for that.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log
    #[arg(value_name = "LOG")]
    file: PathBuf,
    /// T_delta in microseconds: consecutive readings that differ by no more are near-identical; with --hopping by
    /// default that of the settings
    #[arg(long, value_name = "US", required_unless_present = "hopping")]
    t_delta_us: Option<u32>,
    /// The log is that of a hopping ring's firings: run the tracker over it, with these settings; by default it
    /// is a log of ranges
    #[arg(long, value_name = "SETTING")]
    #[arg(conflicts_with_all = ["no_echo_m", "consecutive", "max_speed", "time", "time_unit", "no_echo", "columns"])]
    #[arg(conflicts_with_all = ["range", "range_unit", "sensor", "svg", "topic", "field"])]
    hopping: Option<Hopping>,
    /// Number of consecutive readings that must agree
    #[arg(long, default_value_t = 2, value_name = "N", value_parser = clap::value_parser!(u8).range(2..=8))]
    consecutive: u8,
    /// Without odometry, for a robot that drives at up to this speed in m/s: instead of two readings that agree, three
    /// must lie on a line, within t_delta, so that echoes may change at any constant rate; the log must have times. By
    /// default the robot stands or readings are compensated
    #[arg(long, value_name = "M/S", value_parser = speed, conflicts_with = "consecutive")]
    max_speed: Option<f64>,
    #[command(flatten)]
    log: LogArgs,
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

fn speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(value) if (0.0..=60.0).contains(&value) => Ok(value),
        _ => Err("expected 0 to 60".to_owned()),
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    Kind::expect_log(&args.file)?;
    if args.t_delta_us == Some(0) {
        let message = "0; expected 20 to 20000; no two echoes of one wall come at the same microsecond";
        warn(InputError::new("--t-delta-us", message))?;
    }
    if let Some(hopping) = args.hopping {
        let mut settings = hopping.settings().tracker;
        if let Some(t_delta) = args.t_delta_us.map(Micros::new) {
            // What depends on it gives way.
            settings.t_delta = t_delta;
            settings.near = settings.near.max(t_delta);
            settings.tentative_within = settings.tentative_within.min(t_delta);
        }
        return replay_hopping(&args.file, settings, args.log.speed_of_sound, args.out.as_deref(), args.json);
    }
    let mut replayed = Replayed::new(args)?;
    let report = read_log(&args.file, &args.log.options()?, |sensors, reading| replayed.reading(sensors, reading))?;
    if let Some(error) = replayed.failed.take() {
        return Err(error);
    }
    warn_of_log(&args.file, &report)?;
    if let Some(out) = replayed.out.take() {
        out.finish()?;
    }
    if !report.sensors.is_empty() || args.json {
        print(args, &report, replayed.sensors)?;
    }
    tell_damage(&args.file, &report)?;
    Ok(Answer::Yes)
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
    let t_delta_us = args.t_delta_us.unwrap_or_default();
    let proves = report.firing.proves(Some(t_delta_us));
    if args.json {
        let damage = report.damage.iter().map(ToString::to_string).collect();
        let (skipped, warnings) = (left_out(report), report.warnings.clone());
        let firing = Some(Firing { pattern: report.firing.pattern.as_str(), proves });
        let replay = Replay { total, sensors: counts, as_logged: None, damage, skipped, warnings, firing };
        print_line(to_json(&replay))?;
    } else {
        let table = table(&args.file, t_delta_us, &counts, &total);
        let skipped: String = left_out(report).iter().map(|skipped| format!("left out {skipped}\n")).collect();
        let guesses = guesses(report);
        tell(format!("{table}\n{guesses}{skipped}firing: {}: {proves}\n", report.firing.pattern.as_str()))?;
    }
    Ok(())
}

/// One line of guesses; `eeruf logs` has them in full.
fn guesses(report: &Report) -> String {
    if report.guesses.is_empty() {
        return String::new();
    }
    let said: Vec<_> = report.guesses.iter().map(|guess| format!("{}: {}", guess.what, guess.value)).collect();
    format!("guessed {}\n", said.join("; "))
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
    fn new(args: &Args) -> Result<Self, RingError> {
        let t_delta = Micros::new(args.t_delta_us.unwrap_or_default());
        Ok(match args.max_speed {
            None => Self::Plain(EchoFilter::new(t_delta, args.consecutive)?),
            // At 60 m/s still far from the largest number.
            Some(speed) => {
                Self::Rate(RateFilter::new(t_delta, (2e6 * speed / args.log.speed_of_sound).round() as u32)?)
            }
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
    /// The latest times, in nanoseconds.
    clock: Clock,
}

/// The times of one sensor: finds gaps and steps back.
#[derive(Default)]
struct Clock {
    latest_ns: Option<u64>,
    /// A running mean of the time between two readings.
    usual_ns: Option<f64>,
}

impl Clock {
    /// Returns true if a reading at this time must not be compared with the one before.
    fn breaks(&mut self, at_ns: u64) -> bool {
        /// A longer pause than this is a gap, and one of as many usual ones.
        const SHORTEST_GAP_NS: f64 = 1e9;
        const TIMES_USUAL: f64 = 5.0;
        /// While nothing is usual.
        const FIRST_GAP_NS: f64 = 1e10;
        let Some(before) = self.latest_ns.replace(at_ns) else { return false };
        if at_ns < before {
            return true;
        }
        let pause = (at_ns - before) as f64;
        let longest = self.usual_ns.map_or(FIRST_GAP_NS, |usual| SHORTEST_GAP_NS.max(TIMES_USUAL * usual));
        if pause > longest {
            return true;
        }
        self.usual_ns = Some(self.usual_ns.map_or(pause, |usual| usual + (pause - usual) / 8.0));
        false
    }
}

impl Replayed {
    fn new(args: &Args) -> Result<Self, InputError> {
        let bad = |error: RingError| InputError::new(&args.file, error);
        Ok(Self {
            sensors: Vec::new(),
            fresh: Filter::new(args).map_err(bad)?,
            speed_of_sound: args.log.speed_of_sound,
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
            self.sensors.push(Filtered { filter, counted, kinds: Vec::new(), clock: Clock::default() });
        }
        let of = &mut self.sensors[reading.sensor];
        if let Some(at_ns) = reading.at_ns {
            let broken = of.note_time(at_ns);
            if broken {
                of.filter.forget().map_err(|error| InputError::new(&self.log, error))?;
            }
        }
        let kind = of.kind(reading, self.speed_of_sound, &self.log)?;
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
    /// The filter's verdict on a reading; `None` for a non-numeric one.
    fn kind(&mut self, reading: &Reading, speed_of_sound: f64, log: &Path) -> Result<Option<ReadingKind>, InputError> {
        // Each filter has one sensor, so that it knows it.
        if reading.at_ns.is_none() && matches!(self.filter, Filter::Rate(_)) {
            let message = "a reading without a time; expected --time COLUMN for a table, as --max-speed needs times";
            return Err(InputError::new(log, message));
        }
        let at_ns = reading.at_ns.unwrap_or(0);
        let pushed = |verdict: Result<Verdict, _>| verdict.map(|verdict| Some(verdict.kind));
        match reading.echo() {
            Echo::Invalid => {
                self.counted.invalid += 1;
                Ok(None)
            }
            Echo::TooClose => self.filter.forget().map(|()| Some(ReadingKind::TooEarly)),
            Echo::Nothing => pushed(self.filter.push(at_ns, None)),
            Echo::At(range_m) => {
                let t_echo_us = (2e6 * range_m / speed_of_sound).round();
                if t_echo_us >= f64::from(u32::MAX) {
                    let message = format!("a range of {range_m} m; expected one that sound covers within an hour");
                    return Err(InputError::new(log, message));
                }
                pushed(self.filter.push(at_ns, Some(Micros::new(t_echo_us as u32))))
            }
        }
        .map_err(|error| InputError::new(log, error))
    }

    /// Returns true if the time breaks the comparison with the reading before.
    fn note_time(&mut self, at_ns: u64) -> bool {
        let (from, to) = self.counted.between_ns.unwrap_or((at_ns, at_ns));
        self.counted.between_ns = Some((from.min(at_ns), to.max(at_ns)));
        let is_back = self.clock.latest_ns.is_some_and(|latest| at_ns < latest);
        let breaks = self.clock.breaks(at_ns);
        self.counted.backwards += u64::from(is_back);
        self.counted.gaps += u64::from(breaks && !is_back);
        breaks
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
    if reading.at_ns.is_none() {
        return Err(InputError::new(
            log,
            "a reading without a time; expected --time COLUMN for a table, as --out needs times",
        ));
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
