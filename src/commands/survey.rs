//! `eeruf survey`: finds from a measuring run which sensors hear each other.

use std::fs;
use std::path::{Path, PathBuf};

use eeruf_core::{Micros, survey::SurveyPlan};
use eeruf_files::Kind;
use eeruf_logs::{FiringLog, KeepGoing, PathSettings, Surveyed, survey_while};
use eeruf_sim::{Physics, World};

use super::arguments::picture;
use super::log_args::positive;
use super::{Answer, show};
use crate::console::tell;
use crate::files::error::InputError;
use crate::files::firings::csv;
use crate::files::implausible::read_firings;
use crate::files::survey::{TruePath, simulate, true_paths};
use crate::files::toml::read_world;
use crate::files::write::write;
use crate::report::survey::{FROM, RingTerms, Scenes, SurveyReport, describe, json, ring_file, who_hears_whom};
use crate::report::watch::{Watch, was_stopped};

/// Find from a measuring run which sensors hear each other, and write a ring file for `design`.
///
/// In the run each sensor fires alone, then each ordered pair with several delays between the two, after silence, as
/// eeruf_core::survey::Survey and the Arduino example Survey do. Sound whose time moves with the delay is the other
/// sensor's; a sensor's own echo does not move. The log is CSV with the columns sensor, fired_us, period (the slot),
/// phase and t_echo_us, or MCAP; a column `sends` that is 0 says that a sensor only listened.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The log
    #[arg(value_name = "LOG", required_unless_present = "simulate")]
    file: Option<PathBuf>,
    /// Survey the first robot of a scene, and compare the result with the true paths; for several scenes, print
    /// a line for each
    #[arg(long, value_name = "SCENE.toml", conflicts_with = "file", num_args = 1..)]
    simulate: Vec<PathBuf>,
    /// Write the simulated log
    #[arg(long, value_name = "LOG.csv", requires = "simulate")]
    out: Option<PathBuf>,
    /// Simulated: plain or default effects (see docs/explanation/physics.md); by default the scene's
    #[arg(long, value_name = "PRESET", requires = "simulate")]
    physics: Option<Physics>,
    /// Simulated: number of delays within a pair, from 0 on
    #[arg(long, value_name = "N", default_value_t = 20, requires = "simulate")]
    #[arg(value_parser = clap::value_parser!(u8).range(2..))]
    leads: u8,
    /// Simulated: the step from one delay to the next, in microseconds
    #[arg(long, value_name = "US", default_value_t = 750, requires = "simulate")]
    #[arg(value_parser = clap::value_parser!(u32).range(10..=100_000))]
    lead_step_us: u32,
    /// Largest difference between edges of one path, in microseconds: about four times the jitter
    #[arg(long, value_name = "US", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=5000))]
    tolerance_us: u32,
    /// Write a ring file for `design`, in which the pairs that hear each other are neighbours, each with an interval of
    /// its own
    #[arg(long, value_name = "RING.toml")]
    ring: Option<PathBuf>,
    /// Sensors that hear each other within this time, in microseconds, are neighbours; later sound is left to
    /// alternating waits
    #[arg(long, value_name = "US", default_value_t = 15_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(1000..=120_000))]
    until_us: u32,
    /// The ring file's t_delta_us, in microseconds
    #[arg(long, value_name = "US", default_value_t = 999, requires = "ring")]
    t_delta_us: u32,
    /// The ring file's window_us, in microseconds; by default the longest echo time of the log
    #[arg(long, value_name = "US", requires = "ring")]
    window_us: Option<u32>,
    /// Speed of sound in m/s, for the lengths of paths
    #[arg(long, default_value_t = 343.2, value_name = "M/S", value_parser = positive)]
    speed_of_sound: f64,
    /// Draw who hears whom, as SVG or, if the name ends in .png, as PNG
    #[arg(long, value_name = "FILE", value_parser = picture("pairs"))]
    svg: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
}

impl Args {
    /// Makes the arguments that `eeruf logs` passes on.
    pub(super) fn of(file: &Path, ring: Option<PathBuf>, json: bool) -> Self {
        Self {
            file: Some(file.to_owned()),
            simulate: vec![],
            out: None,
            physics: None,
            leads: 20,
            lead_step_us: 750,
            tolerance_us: 100,
            ring,
            until_us: 15_000,
            t_delta_us: 999,
            window_us: None,
            speed_of_sound: 343.2,
            svg: None,
            json,
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let file = args.file.as_ref().or(args.simulate.first()).map_or(Path::new(""), PathBuf::as_path);
    if args.simulate.len() > 1 {
        return several(args);
    }
    let at_work = Watch::unstoppable().asked(|| "a simulated survey".to_owned());
    let simulated = args.simulate.first().map(|scene| simulated(args, scene, &at_work)).transpose()?;
    drop(at_work);
    let (log, truth) = match simulated {
        Some((log, truth, physics)) => (log, Some((truth, physics))),
        None => {
            Kind::expect_log(file)?;
            (read_firings(file)?, None)
        }
    };
    let surveyed = watched(&log, &settings(args), Watch::new());
    let found = found(args, file, &log, &surveyed, truth.as_ref());
    // A survey stopped by Ctrl-C writes no ring file: pairs may be missing.
    if let Some(ring) = args.ring.as_ref().filter(|_| !was_stopped()) {
        let terms = RingTerms {
            t_delta_us: args.t_delta_us,
            window_us: args.window_us.unwrap_or(surveyed.window_us.next_multiple_of(1000)),
            tolerance_us: args.tolerance_us,
        };
        // A ring file that no survey wrote was probably meant to be read, as by `verify --ring`, and is kept.
        let is_foreign = fs::read_to_string(ring).is_ok_and(|text| !text.is_empty() && !text.starts_with(FROM));
        if is_foreign {
            let message = "a file that no survey wrote; expected a new name: `--ring` writes a ring file";
            return Err(InputError::new(ring, message));
        }
        write(ring, ring_file(&found, &terms))?;
    }
    if let Some(file) = &args.svg {
        who_hears_whom(&found).save(file)?;
    }
    show(args.json, || json(&found), || describe(&found))?;
    match &log.damage {
        Some(damage) => Err(InputError::new(file, damage)),
        None => Ok(Answer::Yes),
    }
}

/// Surveys a log, and shows progress meanwhile.
fn watched(log: &FiringLog, settings: &PathSettings, watch: Watch) -> Surveyed {
    survey_while(log, settings, &watch.asked(|| format!("{} firings", log.firings.len())))
}

fn settings(args: &Args) -> PathSettings {
    PathSettings { tolerance_us: args.tolerance_us, ..PathSettings::default() }
}

fn found<'a>(
    args: &Args,
    file: &'a Path,
    log: &'a FiringLog,
    surveyed: &'a Surveyed,
    truth: Option<&'a (Vec<TruePath>, String)>,
) -> SurveyReport<'a> {
    let truth = truth.map(|(paths, physics)| (&paths[..], physics.as_str()));
    SurveyReport { file, log, surveyed, until_us: args.until_us, speed_of_sound: args.speed_of_sound, truth }
}

/// Prints a line for each scene, and their sum.
fn several(args: &Args) -> Result<Answer, InputError> {
    let alone = [("--out", args.out.is_some()), ("--ring", args.ring.is_some()), ("--svg", args.svg.is_some())];
    if let Some((name, _)) = alone.into_iter().chain([("--json", args.json)]).find(|(_, given)| *given) {
        return Err(InputError::new(name, format!("{} scenes; expected one", args.simulate.len())));
    }
    let (mut lines, done, count) = (Scenes::default(), std::cell::Cell::new(0), args.simulate.len());
    let keep_going = Watch::unstoppable().asked(|| format!("{} of {count} scenes", done.get()));
    for scene in args.simulate.iter().take_while(|_| !was_stopped()) {
        let (log, truth, physics) = simulated(args, scene, &keep_going)?;
        let surveyed = survey_while(&log, &settings(args), &keep_going);
        done.set(done.get() + 1);
        lines.push(&found(args, scene, &log, &surveyed, Some(&(truth, physics))));
    }
    drop(keep_going);
    tell(lines.describe())?;
    Ok(Answer::Yes)
}

/// The log of a simulated survey, the true paths, and the name of the physics.
fn simulated(args: &Args, scene: &Path, go: KeepGoing<'_>) -> Result<(FiringLog, Vec<TruePath>, String), InputError> {
    let bad = |error: &dyn std::fmt::Display| InputError::new(scene, error);
    let mut world: World = read_world(scene)?;
    if let Some(physics) = args.physics {
        world = world.with_physics(physics).map_err(|error| bad(&error))?;
    }
    let Some(robot) = world.robots().first() else { return Err(bad(&"no robot")) };
    let plan = SurveyPlan::new(robot.sensors.len() as u8)
        .with_leads(args.leads, Micros::new(args.lead_step_us))
        .with_window(robot.window, Micros::from_millis(57));
    let log = simulate(&world, plan, go).map_err(|error| bad(&error))?;
    if let Some(out) = &args.out {
        write(out, csv(&log, out)?)?;
    }
    let truth = true_paths(&world).map_err(|error| bad(&error))?;
    let physics = world.physics().name().unwrap_or("the scene's own").to_owned();
    Ok((log, truth, physics))
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{FiringLog, PathSettings, Watch, watched};

    #[test]
    fn survey_of_a_log_asks_its_watch_whether_to_go_on() {
        let rows = "sensor,fired_us,period,phase,t_echo_us\n".to_owned();
        let rows = (0..40).fold(rows, |rows, slot| format!("{rows}0,{},{slot},0,3000\n", 100_000 * slot));
        let log = FiringLog::read_from(rows.as_bytes(), "survey.csv".as_ref()).expect("a log of firings");
        let settings = PathSettings::default();
        assert_eq!(watched(&log, &settings, Watch::new()).paths.len(), 1);
        assert!(watched(&log, &settings, Watch::ending_after(Duration::ZERO)).paths.is_empty());
    }
}
