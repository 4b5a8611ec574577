//! `eeruf lab reality`: compares the simulator with a real ring's log.

use std::fs;
use std::path::{Path, PathBuf};

use eeruf_files::FileError;
use eeruf_logs::FiringLog;
use eeruf_sim::{Method, Options, simulate_while};
use serde::Serialize;

use super::{Answer, show};
use crate::files::error::InputError;
use crate::files::implausible::read_firings;
use crate::files::toml::read_world;
use crate::report::table::markdown;
use crate::report::watch::Watch;

/// Compare the simulator with a log of a real ring in a room that was measured by tape.
///
/// The log has a row for each firing, as c/arduino/examples/RealLog prints them; the scene has the measured walls and
/// the ring. The ring is simulated for the duration of the log, and fires in the same way. Prints for each sensor the
/// share of firings with an echo, the median distance, and the share of echoes more than 5 cm off it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log of firings
    #[arg(value_name = "LOG.csv")]
    log: PathBuf,
    /// The room, with the ring in it
    #[arg(value_name = "SCENE.toml")]
    scene: PathBuf,
    /// The way in which the ring fired
    #[arg(long, value_name = "NAME", default_value = "sequential")]
    method: Method,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

/// Distance from the median beyond which an echo is another object's: a choice, as in docs/log/arduino.md.
const OFF_MM: f64 = 50.0;
/// Largest difference in the share of firings with an echo for a sensor to agree with its log.
const LIKE: f64 = 0.1;
const MOST_PERIODS: f64 = 1e6;

/// Figures of one sensor.
#[derive(Clone, Copy, Serialize)]
struct Figures {
    firings: usize,
    /// Share of the firings with an echo.
    echoes: f64,
    /// The median of the distances; `None` without an echo.
    median_mm: Option<f64>,
    /// Share of the echoes that are more than 5 cm from the median.
    off: f64,
}

impl Figures {
    /// Computes the figures from each firing's distance, if it had an echo.
    fn of(firings: impl Iterator<Item = Option<f64>>) -> Self {
        let all: Vec<_> = firings.collect();
        let mut mm: Vec<f64> = all.iter().copied().flatten().collect();
        mm.sort_by(f64::total_cmp);
        let share = |part: usize, of: usize| part as f64 / of.max(1) as f64;
        let median_mm = mm.get(mm.len() / 2).copied();
        let off = median_mm.map_or(0, |median| mm.iter().filter(|mm| (*mm - median).abs() > OFF_MM).count());
        Self { firings: all.len(), echoes: share(mm.len(), all.len()), median_mm, off: share(off, mm.len()) }
    }

    fn is_like(&self, other: &Self) -> bool {
        let near = match (self.median_mm, other.median_mm) {
            (Some(one), Some(another)) => (one - another).abs() <= OFF_MM,
            (one, another) => one.is_none() == another.is_none(),
        };
        near && (self.echoes - other.echoes).abs() <= LIKE && (self.off - other.off).abs() <= LIKE
    }
}

/// A sensor on the bench and in the simulator.
#[derive(Serialize)]
struct Compared {
    sensor: usize,
    log: Figures,
    simulated: Figures,
    is_like: bool,
}

#[derive(Serialize)]
struct Reality {
    method: &'static str,
    seconds: f64,
    sensors: Vec<Compared>,
}

impl Reality {
    fn text(&self) -> String {
        let header = ["sensor", "firings", "simulated", "echoes %", "sim.", "median mm", "sim.", "5 cm off %", "sim."];
        let row = |Compared { sensor, log, simulated, .. }: &Compared| {
            let percent = |share: f64| format!("{:.1}", 100.0 * share);
            let median = |of: &Figures| of.median_mm.map_or("-".to_owned(), |mm| format!("{mm:.0}"));
            let counts = [sensor + 1, log.firings, simulated.firings].map(|count| count.to_string());
            let shares = [percent(log.echoes), percent(simulated.echoes), median(log), median(simulated)];
            let off = [percent(log.off), percent(simulated.off)];
            counts.into_iter().chain(shares).chain(off).collect::<Vec<_>>()
        };
        let (all, like) = (self.sensors.len(), self.sensors.iter().filter(|sensor| sensor.is_like).count());
        format!(
            "{like} of {all} sensors are as simulated ({}, {:.0} s): medians within 5 cm, shares within 10 \
             points\n{}\n",
            self.method,
            self.seconds,
            markdown(&header, self.sensors.iter().map(row))
        )
    }
}

/// Returns the firings of a log; if the log names ways of firing, those of this method.
fn firings(file: &Path, method: Method) -> Result<FiringLog, InputError> {
    let text = fs::read_to_string(file).map_err(|error| FileError::reading(file, &error))?;
    let mut lines = text.lines().map(|line| line.trim().split(',').collect::<Vec<_>>());
    let header = lines.find(|cells| cells.contains(&"fired_us")).unwrap_or_default();
    let Some(way) = header.iter().position(|name| *name == "way") else { return read_firings(file) };
    let of_way = lines.filter(|cells| cells.get(way).is_some_and(|said| *said == method.as_str()));
    let kept: Vec<_> = std::iter::once(header.clone()).chain(of_way).map(|cells| cells.join(",")).collect();
    if kept.len() < 2 {
        return Err(InputError::new(file, format!("no firing by {method}; expected some, or another --method")));
    }
    Ok(FiringLog::read_from((kept.join("\n") + "\n").as_bytes(), file)?)
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let (log, world) = (firings(&args.log, args.method)?, read_world(&args.scene)?);
    let robot =
        world.robots().first().ok_or_else(|| InputError::new(&args.scene, "no [[robot]]; expected the ring"))?;
    let sensors = robot.sensors.len();
    if let Some(firing) = log.firings.iter().find(|firing| usize::from(firing.sensor) >= sensors) {
        let (last, found) = (sensors - 1, firing.sensor);
        return Err(InputError::new(
            &args.log,
            format!("sensor {found}; expected 0 to {last}, those of the scene's ring"),
        ));
    }
    let times = log.firings.iter().map(|firing| firing.fired_us);
    let (first, last) = (times.clone().min().unwrap_or(0), times.max().unwrap_or(0));
    let seconds = (last - first) as f64 / 1e6;
    let periods = (seconds * 1e6 / f64::from(robot.period.as_micros().max(1))).ceil();
    if !(1.0..=MOST_PERIODS).contains(&periods) {
        let expected = format!("a time in which the ring fires, up to {MOST_PERIODS:.0} periods");
        return Err(InputError::new(&args.log, format!("firings within {seconds:.1} s; expected {expected}")));
    }
    let watch = Watch::new();
    let go_on = |done: f64| watch.go_on(|| format!("{:.0} % simulated", 100.0 * done));
    let simulated = simulate_while(&world, args.method, &Options::periods(periods as u32), go_on);
    let simulated = simulated.map_err(|error| InputError::new(&args.scene, error))?;
    let mm_per_us = world.scene().air().speed_of_sound() / 2e3;
    let compared = |sensor: usize| {
        let of_log = log.firings.iter().filter(|firing| usize::from(firing.sensor) == sensor);
        let log = Figures::of(of_log.map(|firing| firing.t_echo_us.map(|us| f64::from(us) * mm_per_us)));
        let first_robot = (0..simulated.len()).filter(|&k| simulated.robot[k] == 0);
        let of_sensor = first_robot.filter(|&k| usize::from(simulated.sensor[k]) == sensor);
        let echo = |k: usize| Some(simulated.earliest_us[k] * mm_per_us).filter(|mm| mm.is_finite());
        let simulated = Figures::of(of_sensor.map(echo));
        Compared { sensor, log, simulated, is_like: log.is_like(&simulated) }
    };
    let reality = Reality { method: args.method.as_str(), seconds, sensors: (0..sensors).map(compared).collect() };
    show(args.json, || &reality, || reality.text())?;
    Ok(Answer::Yes)
}
