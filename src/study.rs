//! `eeruf study`: every firing method in one scene, side by side on the same seed, and who was fooled by whom.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use comfy_table::{CellAlignment, Table, presets};
use eeruf_sim::{
    BestSchedule, Method, Options, Readings, SimulationError, Summary, World, shortest_schedule_for, simulate_while,
    sweep,
};
use serde::{Serialize, Serializer};

use crate::Answer;
use crate::fooled::{self, Fooled, FooledJson};
use crate::illustrate;
use crate::input::{InputError, ScheduleFile, to_json};
use crate::watch::Watch;

/// Simulate every firing method in a scene, on the same seed: which readings were wrong, and who was fooled by whom.
///
/// The methods: simultaneous, sequential, far_groups, dither, conventional (constant lags, every echo believed), comparison
/// (constant lags, consecutive readings compared), median, eeruf_immediate, eeruf (the paper's table scaled to the period, or
/// the robot's own schedule), eeruf_best (the shortest schedule with the same guarantees), adaptive, multi_echo.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The scene
    #[arg(value_name = "SCENE.toml")]
    file: PathBuf,
    /// For how many of the first robot's periods; 2000 to begin with, 250 if anything moves
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000_000))]
    periods: Option<u32>,
    /// Draw SVG pictures into this folder: scene, timing, readings and methods
    #[arg(long, value_name = "DIR")]
    svg: Option<PathBuf>,
    /// Draw the same pictures as PNG
    #[arg(long, value_name = "DIR")]
    png: Option<PathBuf>,
    /// Print one JSON object
    #[arg(long)]
    json: bool,
    /// Simulate only these methods
    #[arg(long = "method", value_name = "NAME", num_args = 1.., value_delimiter = ',')]
    methods: Vec<Method>,
    /// Another seed than the scene's
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
}

const PERIODS: u32 = 2000;
/// Paths have to be found anew for every firing then.
const PERIODS_IF_MOVING: u32 = 250;
/// How many nodes the search for `eeruf_best` may cost.
const BUDGET: u64 = 20_000;
/// By how much a reading may be off before it counts as wrong.
pub(crate) const TOLERANCE_US: f64 = eeruf_sim::DEFAULT_TOLERANCE_US;

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let world = read_world(&args.file)?;
    let study = study(args, &world)?;
    for (folder, ending) in [(&args.svg, "svg"), (&args.png, "png")] {
        if let Some(folder) = folder {
            illustrate::pictures(folder, ending, &world, &study)?;
        }
    }
    if args.json {
        println!("{}", to_json(&StudyJson::new(args, &world, &study)));
    } else {
        print!("{}", describe(args, &world, &study));
    }
    Ok(Answer::Yes)
}

/// Reads a scene with its robots.
pub(crate) fn read_world(file: &Path) -> Result<World, InputError> {
    World::from_toml(file).map_err(|error| {
        // A scene names the file that is to blame, which may be that of a schedule.
        InputError::new(&error.file, error.line.map(|line| line as u64), &error.message)
    })
}

/// All methods on one world.
pub(crate) struct Study {
    pub(crate) runs: Vec<Readings>,
    /// Methods that cannot be simulated here, and why.
    left_out: Vec<(Method, String)>,
    best: Option<BestSchedule>,
    periods: u32,
    seed: u64,
}

impl Study {
    pub(crate) fn of(&self, method: Method) -> Option<&Readings> {
        self.runs.iter().find(|readings| readings.method == method)
    }
}

fn study(args: &Args, world: &World) -> Result<Study, InputError> {
    let asked: Vec<Method> = Method::ALL.into_iter().filter(|method| args.methods.contains(method)).collect();
    let methods = if asked.is_empty() { Method::ALL.to_vec() } else { asked };
    let bad = |error: &dyn std::fmt::Display| InputError::new(&args.file, None, error);
    let mut watch = Watch::new();
    let best = if methods.contains(&Method::EerufBest) {
        let robot = world.robots().first().ok_or_else(|| bad(&"no robot"))?;
        shortest_schedule_for(robot, BUDGET, |progress| {
            watch.go_on(|| format!("designing eeruf_best, {} nodes", progress.nodes))
        })
        .map_err(|error| bad(&error))?
    } else {
        None
    };
    let periods = args.periods.unwrap_or(if world.moves() { PERIODS_IF_MOVING } else { PERIODS });
    let seed = args.seed.unwrap_or(world.seed());
    let options =
        Options { seed: Some(seed), best: best.as_ref().map(|best| best.schedule), ..Options::periods(periods) };
    let shared = Mutex::new((watch, vec![0.0; methods.len()]));
    let jobs: Vec<_> = methods.iter().copied().enumerate().collect();
    let results = sweep(&jobs, |&(place, method)| {
        let readings = simulate_while(world, method, &options, |share| {
            let mut shared = shared.lock().unwrap_or_else(PoisonError::into_inner);
            let (watch, shares) = &mut *shared;
            shares[place] = share;
            let done = shares.iter().sum::<f64>() / shares.len() as f64;
            watch.go_on(|| format!("{periods} periods of {} methods, {:.0} % done", shares.len(), 100.0 * done))
        });
        (method, readings)
    });
    let (mut runs, mut left_out) = (vec![], vec![]);
    for (method, result) in results {
        match result {
            Ok(readings) => runs.push(readings),
            Err(SimulationError::Stopped) => return Err(bad(&"stopped by Ctrl-C")),
            // Asked for by name, or nothing to do with the method: then it is the answer to the question.
            Err(error) if !args.methods.is_empty() || matches!(error, SimulationError::Paths { .. }) => {
                return Err(bad(&error));
            }
            Err(error) => left_out.push((method, error.to_string())),
        }
    }
    Ok(Study { runs, left_out, best, periods, seed })
}

/// One robot's readings alone.
pub(crate) fn of_robot(readings: &Readings, robot: usize, sensors: usize) -> Readings {
    let own: Vec<usize> =
        (0..readings.len()).filter(|&reading| usize::from(readings.robot[reading]) == robot).collect();
    fn pick<T: Copy>(own: &[usize], of: &[T]) -> Vec<T> {
        own.iter().map(|&reading| of[reading]).collect()
    }
    let mut alone = readings.clone();
    alone.sensors = sensors;
    alone.robot = pick(&own, &readings.robot);
    alone.sensor = pick(&own, &readings.sensor);
    alone.period = pick(&own, &readings.period);
    alone.phase = pick(&own, &readings.phase);
    alone.fired_s = pick(&own, &readings.fired_s);
    alone.kind = pick(&own, &readings.kind);
    alone.t_echo_us = pick(&own, &readings.t_echo_us);
    alone.earliest_us = pick(&own, &readings.earliest_us);
    alone.reference_us = pick(&own, &readings.reference_us);
    alone.cause = pick(&own, &readings.cause);
    alone.path = pick(&own, &readings.path);
    alone.emitted_s = pick(&own, &readings.emitted_s);
    alone
}

/// What `--json` prints. Shares are fractions of 1; robots, sensors and walls from 0.
#[derive(Serialize)]
struct StudyJson<'a> {
    scene: String,
    seed: u64,
    periods: u32,
    #[serde(serialize_with = "in_order")]
    methods: Vec<(Method, MethodJson)>,
    #[serde(serialize_with = "in_order")]
    left_out: Vec<(Method, &'a str)>,
    #[serde(skip_serializing_if = "Option::is_none")]
    best: Option<BestJson>,
}

#[derive(Serialize)]
struct MethodJson {
    /// All robots together.
    #[serde(flatten)]
    summary: Summary,
    duration_s: f64,
    robots: Vec<Summary>,
    fooled: Vec<FooledJson>,
}

#[derive(Serialize)]
struct BestJson {
    schedule: ScheduleFile,
    proven: bool,
}

/// As an object whose keys keep the order in which methods are listed.
fn in_order<S: Serializer, T: Serialize>(entries: &[(Method, T)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().map(|(method, entry)| (method, entry)))
}

impl<'a> StudyJson<'a> {
    fn new(args: &Args, world: &World, study: &'a Study) -> Self {
        let methods = study.runs.iter().map(|readings| {
            let robots = world.robots().iter().enumerate();
            let entry = MethodJson {
                summary: readings.summary(),
                duration_s: readings.duration_s,
                robots: robots.map(|(k, robot)| of_robot(readings, k, robot.sensors.len()).summary()).collect(),
                fooled: fooled::to_json(readings, TOLERANCE_US),
            };
            (readings.method, entry)
        });
        Self {
            scene: args.file.display().to_string(),
            seed: study.seed,
            periods: study.periods,
            methods: methods.collect(),
            left_out: study.left_out.iter().map(|(method, why)| (*method, why.as_str())).collect(),
            best: study
                .best
                .as_ref()
                .map(|best| BestJson { schedule: ScheduleFile::from(&best.schedule), proven: best.proven }),
        }
    }
}

fn describe(args: &Args, world: &World, study: &Study) -> String {
    let scene = world.scene();
    let mut text = format!(
        "{}: {} walls, {} poles, sound followed for up to {} bounces; seed {}\n",
        args.file.display(),
        scene.walls().len(),
        scene.poles().len(),
        world.max_order(),
        study.seed
    );
    for (index, robot) in world.robots().iter().enumerate() {
        let sensors = robot.sensors.len();
        let runs: Vec<Readings> = study.runs.iter().map(|readings| of_robot(readings, index, sensors)).collect();
        let seconds = runs.first().map_or(0.0, |readings| readings.duration_s);
        _ = writeln!(
            text,
            "\nRobot {}: {sensors} sensors, period {}, listening for {}, t_delta {}; {seconds:.0} s simulated",
            index + 1,
            robot.period,
            robot.window,
            robot.t_delta,
        );
        _ = writeln!(text, "{}", table(&runs));
        let fooled = Fooled::of(&runs, index, TOLERANCE_US);
        text += &fooled.describe();
        text += &verdict(&runs, sensors);
    }
    if let Some(BestSchedule { schedule, proven }) = &study.best {
        let proof =
            if *proven { "proven: no schedule with the same guarantees is shorter" } else { "not proven shortest" };
        _ = writeln!(text, "\neeruf_best fires with a period of {} ({proof}).", schedule.period());
    }
    for (method, why) in &study.left_out {
        _ = writeln!(text, "{method} is left out: {why}.");
    }
    text
}

fn percent(share: f64) -> String {
    let digits = if share > 0.0 && share < 0.000_95 {
        3
    } else if share < 0.095 {
        2
    } else {
        1
    };
    format!("{:.digits$}", 100.0 * share)
}

fn table(runs: &[Readings]) -> Table {
    let mut table = Table::new();
    table.load_style(presets::ASCII_MARKDOWN);
    table.set_header([
        "method",
        "wrong, % of all",
        "% of accepted",
        "rejected %",
        "good lost %",
        "age ms, median",
        "99 %",
        "accepted/s",
        "starved",
    ]);
    for readings in runs {
        let summary = readings.summary();
        let or_none = |share: Option<f64>| share.map_or_else(|| "-".to_owned(), percent);
        table.add_row([
            summary.method.to_string(),
            percent(summary.wrong_of_all),
            or_none(summary.wrong_of_accepted),
            percent(summary.rejected),
            or_none(summary.good_lost),
            format!("{:.0}", summary.age_ms.median),
            format!("{:.0}", summary.age_ms.p99),
            format!("{:.1}", summary.readings_per_s),
            if summary.starved == 0 { "-".to_owned() } else { summary.starved.to_string() },
        ]);
    }
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}

/// What the table says, in words: why alternate, and what it costs.
fn verdict(runs: &[Readings], sensors: usize) -> String {
    let of = |method| runs.iter().find(|readings| readings.method == method).map(Readings::summary);
    let wrong = |summary: &Summary| percent(summary.wrong_of_accepted.unwrap_or(0.0));
    let mut text = String::new();
    let (Some(usual), Some(eeruf)) = (of(Method::Conventional), of(Method::Eeruf)) else {
        return text;
    };
    _ = writeln!(text, "\nFiring with constant lags, {} % of what is believed is wrong.", wrong(&usual));
    if let Some(control) = of(Method::Comparison) {
        _ = writeln!(
            text,
            "Comparing each reading with the one before leaves {} %: crosstalk repeats as well as a true echo does.",
            wrong(&control)
        );
    }
    _ = writeln!(
        text,
        "EERUF lets each sensor's wait alternate, so that crosstalk moves from reading to reading: {} % is left.",
        wrong(&eeruf)
    );
    _ = write!(text, "It costs {} % of the good readings", percent(eeruf.good_lost.unwrap_or(0.0)));
    if eeruf.starved > 0 {
        _ = write!(
            text,
            ", and {} of {sensors} sensors never had one accepted: foreign sound always came first there",
            eeruf.starved
        );
        if of(Method::MultiEcho).is_some_and(|several| several.starved < eeruf.starved) {
            _ = write!(text, ".\nSensors that report several echoes get round that (multi_echo)");
        }
    }
    _ = writeln!(text, ".");
    if let Some(slow) = of(Method::Sequential)
        && slow.readings_per_s > 0.0
    {
        _ = writeln!(
            text,
            "One by one, {:.1} readings are accepted a second; with EERUF {:.1}.",
            slow.readings_per_s, eeruf.readings_per_s
        );
    }
    text
}
