//! One file for each verb: its arguments, and what it does with them.
//!
//! Commands read with `files`, ask the libraries, and hand what they found to `report`; neither knows of them.

mod answer;
pub(crate) mod arguments;
mod atlas;
mod certificate;
mod completions;
mod dataset;
mod design;
mod diagnose;
mod examples;
mod experiment;
mod hopping;
mod licenses;
mod log_args;
mod logs;
mod man;
mod merge;
mod methods;
mod paths;
mod replay;
mod replay_hopping;
mod rooms;
mod scene;
mod search;
mod study;
mod survey;
mod verify;

pub(crate) use answer::Answer;
use clap::{ColorChoice, Parser, Subcommand};

use crate::console::Settings;
use crate::files::error::InputError;

/// The commands by what they are for.
const GROUPS: &str = "\
Commands by what they are for:
  Schedules   design, verify, search, atlas
  Simulation  study, paths, scene, experiment, merge, dataset
  Real rings  survey, logs, replay, diagnose
  Setting up  examples, completions, man, licenses

Exit codes: 0 fine; 1 the answer is no; 2 bad input; 3 not decided; 74 the output cannot be written.";

/// Fire all ultrasonic sensors of a robot several times faster than one by one, without believing each other's echoes.
///
/// Sensors are printed from 1, as in the paper, and counted from 0 in files and in --json.
#[derive(Parser)]
#[command(name = "eeruf", version = env!("EERUF_VERSION"), max_term_width = 100, after_help = GROUPS)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) verb: Verb,
    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

/// The options of output, the same for every command.
#[derive(clap::Args)]
#[command(next_help_heading = "Output")]
pub(crate) struct OutputArgs {
    /// Print no warnings
    #[arg(long, short, global = true)]
    quiet: bool,
    /// Take a warning for an error: exit code 2
    #[arg(long, global = true)]
    deny_warnings: bool,
    /// Print tables and lines as wide as they are; by default they fit the terminal, or COLUMNS if it is set
    #[arg(long, global = true)]
    wide: bool,
    /// Colour errors and warnings; auto does on a terminal, unless NO_COLOR is set
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    color: ColorChoice,
}

impl OutputArgs {
    pub(crate) fn settings(&self) -> Settings {
        let colour = match self.color {
            ColorChoice::Auto => None,
            ColorChoice::Always => Some(true),
            ColorChoice::Never => Some(false),
        };
        Settings { quiet: self.quiet, deny_warnings: self.deny_warnings, wide: self.wide, colour }
    }
}

/// The end of a command's help: an example, and the exit codes.
macro_rules! help {
    ($example:literal, $codes:literal) => {
        concat!("Example:\n  eeruf ", $example, "\n\nExit codes: ", $codes, "; 74 the output cannot be written")
    };
}

#[derive(Subcommand)]
pub(crate) enum Verb {
    #[command(after_help = help!(
        "design rings/paper-12.toml --emit rust",
        "0 a schedule; 1 none meets the needs; 2 bad input; 3 not decided (--period)"
    ))]
    Design(design::Args),
    #[command(after_help = help!(
        "verify rings/table-i-d.toml --t-delta-us 999",
        "0 verified; 1 not verified; 2 bad input"
    ))]
    Verify(verify::Args),
    #[command(after_help = help!(
        "search rings/table-i-waits.toml --best interval",
        "0 a table; 1 none; 2 bad input; 3 not decided"
    ))]
    Search(search::Args),
    #[command(after_help = help!("study scenes/alcove.toml --method sequential,eeruf", "0 simulated; 2 bad input"))]
    Study(study::Args),
    #[command(after_help = help!("paths scenes/alcove.toml --order 2", "0 listed; 2 bad input"))]
    Paths(paths::Args),
    #[command(after_help = help!("scene map.yaml > scene.toml", "0 printed; 2 bad input"))]
    Scene(scene::Args),
    #[command(after_help = help!("logs log.csv", "0 sensors found; 1 none; 2 bad input or a damaged log"))]
    Logs(logs::Args),
    #[command(after_help = help!(
        "replay log.csv --t-delta-us 500",
        "0 replayed; 1 no sensors; 2 bad input or a damaged log"
    ))]
    Replay(replay::Args),
    #[command(after_help = help!(
        "diagnose firings.csv --schedule schedule.toml",
        "0 nothing is broken; 1 something is; 2 bad input or a damaged log"
    ))]
    Diagnose(diagnose::Args),
    #[command(after_help = help!("survey survey.csv --ring ring.toml", "0 surveyed; 2 bad input or a damaged log"))]
    Survey(survey::Args),
    #[command(after_help = help!(
        "experiment set-one --seeds 20 --method sequential,eeruf",
        "0 repeated; 2 bad input"
    ))]
    Experiment(experiment::Args),
    #[command(after_help = help!("merge part-1.json part-2.json", "0 merged; 2 bad input, or a part is missing"))]
    Merge(merge::Args),
    #[command(after_help = help!("dataset out --alcoves 2 --courses 1", "0 written; 2 bad input"))]
    Dataset(dataset::Args),
    #[command(after_help = help!(
        "atlas --svg atlas.svg",
        "0 every ring of the share is done; 1 ended before; 2 bad input"
    ))]
    Atlas(atlas::Args),
    #[command(after_help = help!("examples .", "0 written; 2 bad input"))]
    Examples(examples::Args),
    #[command(after_help = help!("completions bash > eeruf.bash", "0 printed; 2 bad input"))]
    Completions(completions::Args),
    #[command(after_help = help!("man ~/.local/share/man/man1", "0 written; 2 bad input"))]
    Man(man::Args),
    #[command(after_help = help!("licenses", "0 printed"))]
    Licenses(licenses::Args),
}

impl Verb {
    pub(crate) fn run(&self) -> Result<Answer, InputError> {
        match self {
            Self::Design(args) => design::run(args),
            Self::Verify(args) => verify::run(args),
            Self::Search(args) => search::run(args),
            Self::Study(args) => study::run(args),
            Self::Paths(args) => paths::run(args),
            Self::Scene(args) => scene::run(args),
            Self::Logs(args) => logs::run(args),
            Self::Replay(args) => replay::run(args),
            Self::Diagnose(args) => diagnose::run(args),
            Self::Survey(args) => survey::run(args),
            Self::Experiment(args) => experiment::run(args),
            Self::Merge(args) => merge::run(args),
            Self::Dataset(args) => dataset::run(args),
            Self::Atlas(args) => atlas::run(args),
            Self::Examples(args) => examples::run(args),
            Self::Completions(args) => completions::run(args),
            Self::Man(args) => man::run(args),
            Self::Licenses(args) => licenses::run(args),
        }
    }
}
