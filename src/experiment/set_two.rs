//! `eeruf experiment set-two`: a LabMate drives through a course of thin poles, over many courses.

use std::fs;

use eeruf_core::Micros;
use eeruf_sim::experiments::set_two::{
    Course, Figures, MULTI_ECHO_CONSECUTIVE, SECOND_AHEAD, SECOND_BEHIND, SetTwo, SetTwoOptions, SpeedStep, set_two,
    speed_sweep,
};
use eeruf_sim::{LabMate, Method, Point, Robot, best_schedule_for};
use serde::Serialize;

use super::{Common, bad, percent, table, watched};
use crate::draw;
use crate::input::{InputError, to_json};
use crate::watch::Watch;

/// Set II: a LabMate drives through a course of 8 mm poles, about 1.6 m apart, steered by what its eight sensors tell.
///
/// The ring fills a histogram grid (HIMM), the vector field histogram steers. Every method drives the same seeded courses.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    common: Common,
    /// Drive by these methods only; sequential, conventional, comparison, eeruf, eeruf_best, adaptive and multi_echo
    /// to begin with
    #[arg(long = "method", value_name = "NAME", num_args = 1.., value_delimiter = ',')]
    methods: Vec<Method>,
    /// Let another robot with 24 sensors fire 24 times in 80 ms in a corner of the lab: behind the start, or ahead, where all
    /// sensors face it
    #[arg(long, value_name = "WHERE", num_args = 0..=1, default_missing_value = "behind")]
    second_robot: Option<Corner>,
    /// The platform's highest speed in m/s
    #[arg(long, value_name = "M/S", default_value_t = 1.0, value_parser = speed)]
    speed: f64,
    /// Do not tell the ring by how much readings should change from the robot's own motion, and compare within 500 us instead
    #[arg(long)]
    no_odometry: bool,
    /// Drive all courses at several top speeds instead, and say which speed each method bears
    #[arg(long, conflicts_with = "speed")]
    sweep: bool,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum Corner {
    Behind,
    Ahead,
}

impl Corner {
    fn place(self) -> Point {
        match self {
            Self::Behind => SECOND_BEHIND,
            Self::Ahead => SECOND_AHEAD,
        }
    }
}

const SEEDS: u64 = 100;
/// How many nodes the search for `eeruf_best` may cost; it is proven shortest long before.
const BUDGET: u64 = 300_000;
/// Wide enough for a robot at 1 m/s: 2 v dt / c is at most 0.434 ms.
const PAPERS_T_DELTA: Micros = Micros::new(500);
/// The top speeds of a sweep, in m/s.
const SPEEDS: [f64; 7] = [0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0];
/// A method bears a speed at which this share of the courses is finished.
const BORNE: f64 = 0.95;

fn speed(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(speed) if (0.1..=5.0).contains(&speed) => Ok(speed),
        _ => Err("expected 0.1 to 5".to_owned()),
    }
}

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let bad = bad("set-two");
    let mut options = SetTwoOptions {
        seeds: args.common.seeds.unwrap_or(SEEDS),
        second_robot: args.second_robot.map(Corner::place),
        labmate: LabMate { speed_max_m_s: args.speed, ..LabMate::default() },
        odometry: !args.no_odometry,
        t_delta: if args.no_odometry { PAPERS_T_DELTA } else { SetTwoOptions::default().t_delta },
        ..SetTwoOptions::default()
    };
    let asked: Vec<Method> = Method::ALL.into_iter().filter(|method| args.methods.contains(method)).collect();
    if !asked.is_empty() {
        options.methods = asked;
    }
    if options.methods.contains(&Method::EerufBest) {
        let mut watch = Watch::new();
        let designing = |nodes: u64| format!("designing eeruf_best, {nodes} nodes");
        let robot = Robot { t_delta: options.t_delta, ..Course::random(0).robot() };
        let best = best_schedule_for(&robot, BUDGET, |progress| watch.go_on(|| designing(progress.nodes)));
        options.best = Some(best.map_err(|error| bad(&error))?);
    }
    let watched = watched(format!("{} courses by {} methods", options.seeds, options.methods.len()));
    if args.sweep {
        let steps = speed_sweep(&options, &SPEEDS, &watched).map_err(|error| bad(&error))?;
        drop(watched);
        let sweep = Sweep::of(&options, steps);
        print!("{}", if args.common.json { to_json(&sweep) + "\n" } else { sweep.describe() });
        return Ok(());
    }
    let found = set_two(&options, &watched).map_err(|error| bad(&error))?;
    drop(watched);
    for (folder, ending) in [(&args.common.svg, "svg"), (&args.common.png, "png")] {
        if let Some(folder) = folder {
            fs::create_dir_all(folder).map_err(|error| InputError::new(folder, None, error))?;
            let name = match args.second_robot {
                None => "set-two",
                Some(Corner::Behind) => "set-two-second-behind",
                Some(Corner::Ahead) => "set-two-second-ahead",
            };
            draw::courses(&found).save(&folder.join(name).with_extension(ending))?;
        }
    }
    if args.common.json {
        println!("{}", to_json(&found));
    } else {
        print!("{}", describe(&found));
    }
    Ok(())
}

fn beside(second_robot_m: Option<[f64; 2]>) -> String {
    second_robot_m
        .map_or_else(String::new, |[x, y]| format!(", a second robot at ({x} m, {y} m) firing 24 times in 80 ms"))
}

fn describe(found: &SetTwo) -> String {
    let header = [
        "method",
        "finished",
        "contacts",
        "timed out",
        "mean m/s",
        "top m/s",
        "nearest m",
        "rejected %",
        "wrong %",
        "phantom echoes",
        "phantom cells",
        "poles missed %",
        "accepted/s",
    ];
    let mut text = format!(
        "Set II: {} courses at up to {} m/s{}. Phantoms and the nearest pole are means over the courses;\n\
         multi_echo compares {MULTI_ECHO_CONSECUTIVE} readings, the other filters 2.\n\n",
        found.seeds,
        found.speed_m_s,
        beside(found.second_robot_m)
    );
    text += &table(&header, found.methods.iter().map(|(method, figures)| row(*method, figures)));
    text
}

fn row(method: Method, figures: &Figures) -> Vec<String> {
    vec![
        method.to_string(),
        format!("{} of {}", figures.finished, figures.courses),
        figures.contacts.to_string(),
        figures.timed_out.to_string(),
        format!("{:.2}", figures.mean_speed_m_s),
        format!("{:.2}", figures.top_speed_m_s),
        format!("{:.2}", figures.nearest_m),
        percent(figures.rejected),
        percent(figures.wrong_of_all),
        format!("{:.1}", figures.phantom_echoes),
        format!("{:.1}", figures.phantom_cells),
        percent(figures.poles_missed),
        format!("{:.1}", figures.readings_per_s),
    ]
}

/// What a sweep tells.
#[derive(Serialize)]
struct Sweep {
    seeds: u64,
    second_robot_m: Option<[f64; 2]>,
    steps: Vec<SpeedStep>,
    /// The highest speed at which nearly all courses are finished.
    #[serde(serialize_with = "by_name")]
    borne_m_s: Vec<(Method, Option<f64>)>,
}

fn by_name<S: serde::Serializer>(borne: &[(Method, Option<f64>)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(borne.iter().map(|(method, speed)| (method, speed)))
}

impl Sweep {
    fn of(options: &SetTwoOptions, steps: Vec<SpeedStep>) -> Self {
        let borne = |place: usize| {
            let mut borne = steps.iter().filter(|step| step.finished[place].1 >= BORNE);
            borne.next_back().map(|step| step.speed_m_s)
        };
        let borne_m_s = options.methods.iter().enumerate().map(|(place, method)| (*method, borne(place))).collect();
        let second_robot_m = options.second_robot.map(|at| [at.x, at.y]);
        Self { seeds: options.seeds, second_robot_m, steps, borne_m_s }
    }

    fn describe(&self) -> String {
        let mut header = vec!["method".to_owned()];
        header.extend(self.steps.iter().map(|step| format!("{} m/s", step.speed_m_s)));
        header.push("borne m/s".to_owned());
        let rows =
            self.borne_m_s.iter().enumerate().map(|(place, (method, borne))| {
                let mut row = vec![method.to_string()];
                row.extend(self.steps.iter().map(|step| {
                    format!("{:.0} ({:.2})", 100.0 * step.finished[place].1, step.mean_speed_m_s[place].1)
                }));
                row.push(borne.map_or_else(|| "-".to_owned(), |speed| speed.to_string()));
                row
            });
        let mut text = format!(
            "Set II: {} courses at several top speeds{}: finished %, and (mean speed in m/s). Borne is\n\
             the highest speed at which {:.0} % of the courses are finished; multi_echo compares {MULTI_ECHO_CONSECUTIVE} readings, the other filters 2.\n\n",
            self.seeds,
            beside(self.second_robot_m),
            100.0 * BORNE
        );
        text += &table(&header.iter().map(String::as_str).collect::<Vec<_>>(), rows);
        text
    }
}
