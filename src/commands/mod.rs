//! One file for each verb: its arguments, and their execution.
//!
//! Commands read with `files`, call the libraries, and pass the results to `report`; both know nothing of commands.

/// The end of a command's help: an example, and the exit codes.
macro_rules! help {
    ($example:literal, $codes:literal) => {
        concat!("Example:\n  eeruf ", $example, "\n\nExit codes: ", $codes, "; 74 the output cannot be written")
    };
}

pub(crate) mod arguments;
mod atlas;
mod certificate;
mod completions;
mod dataset;
mod design;
mod diagnose;
mod examples;
mod experiment;
mod licenses;
mod log_args;
mod logs;
#[cfg(feature = "man")]
mod man;
mod merge;
mod methods;
mod paths;
mod program;
mod reality;
mod replay;
mod rooms;
mod scene;
mod search;
mod study;
mod survey;
mod verify;

use clap::{ColorChoice, CommandFactory as _, Parser, Subcommand};
use serde::Serialize;

use crate::console::{OutputError, Settings, print_line, tell};
use crate::files::error::InputError;
use crate::report::json::to_json;

/// The end of the help of `study`, whose long help has more.
pub(crate) const STUDY: &str = help!("study scenes/alcove.toml --method sequential,eeruf", "0 simulated; 2 bad input");

/// The end of the program's help.
const CODES: &str = "Exit codes: 0 fine; 1 the answer is no; 2 bad input; 3 not decided; 74 the output cannot be \
                     written; 130 stopped by Ctrl-C";

/// Builds the command line. The authors' own commands are under `lab`, and also, hidden, under their old names.
pub(crate) fn program() -> clap::Command {
    let is_old = |name: &str| LabVerb::has_subcommand(name);
    Cli::command().mut_subcommands(|below| if is_old(below.get_name()) { below.hide(true) } else { below })
}

/// Fire all ultrasonic sensors of a robot several times faster than one by one, without believing each other's echoes.
///
/// Sensors are printed from 1, as in the paper, and counted from 0 in files and in --json.
#[derive(Parser)]
#[command(name = "eeruf", version = env!("EERUF_VERSION"), max_term_width = 100, after_help = CODES)]
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
    /// Treat warnings as errors: exit code 2
    #[arg(long, hide_short_help = true, global = true)]
    deny_warnings: bool,
    /// Print tables and lines as wide as they are; by default they fit the terminal, or COLUMNS if it is set
    #[arg(long, hide_short_help = true, global = true)]
    wide: bool,
    /// Quote the line that an error in a file is about, as on a terminal
    #[arg(long, hide_short_help = true, global = true)]
    explain: bool,
    /// Colour errors and warnings; auto: on a terminal, unless NO_COLOR is set
    #[arg(long, hide_short_help = true, global = true, value_name = "WHEN", default_value = "auto")]
    color: ColorChoice,
}

impl OutputArgs {
    pub(crate) fn settings(&self) -> Settings {
        let colour = match self.color {
            ColorChoice::Auto => None,
            ColorChoice::Always => Some(true),
            ColorChoice::Never => Some(false),
        };
        Settings {
            quiet: self.quiet,
            deny_warnings: self.deny_warnings,
            wide: self.wide,
            colour,
            explain: self.explain,
        }
    }
}

/// Answer of a command, which decides the exit code.
pub(crate) enum Answer {
    /// Exit code 0.
    Yes,
    /// The schedule is not verified, or the needs are infeasible: exit code 1.
    No,
    /// Budget or time ended the search before an answer: exit code 3.
    NotDecided,
}

/// Prints a result as one JSON object, or as text for people.
fn show<T: Serialize>(
    as_json: bool,
    json: impl FnOnce() -> T,
    text: impl FnOnce() -> String,
) -> Result<(), OutputError> {
    if as_json { print_line(to_json(&json())) } else { tell(text()) }
}

#[derive(Subcommand)]
pub(crate) enum Verb {
    #[command(after_help = help!(
        "design rings/hc-sr04-8.toml --program arduino",
        "0 a schedule; 1 none meets the needs; 2 bad input; 3 not decided (--period)"
    ))]
    Design(design::Args),
    #[command(after_help = STUDY)]
    Study(study::Args),
    #[command(after_help = help!(
        "logs log.csv",
        "0 no crosstalk seen; 1 crosstalk; 2 not understood, or damaged; 3 the log cannot tell"
    ))]
    Logs(logs::Args),
    #[command(after_help = help!(
        "verify rings/table-i-d.toml --t-delta-us 999",
        "0 verified; 1 not verified; 2 bad input"
    ))]
    Verify(verify::Args),
    #[command(after_help = help!("examples .", "0 written; 2 bad input"))]
    Examples(examples::Args),
    #[command(after_help = help!("completions bash > eeruf.bash", "0 printed; 2 bad input"))]
    Completions(completions::Args),
    #[cfg(feature = "man")]
    #[command(after_help = help!("man ~/.local/share/man/man1", "0 written; 2 bad input"))]
    Man(man::Args),
    #[command(after_help = help!("licenses", "0 printed"))]
    Licenses(licenses::Args),
    /// Run the commands of eeruf's authors: experiments, the atlas, data sets, paths
    Lab {
        #[command(subcommand)]
        verb: LabVerb,
    },
    #[command(flatten)]
    Old(LabVerb),
    #[command(hide = true, after_help = help!(
        "replay log.csv --t-delta-us 500",
        "0 replayed; 2 no sensors, bad input or a damaged log"
    ))]
    Replay(replay::Args),
    #[command(hide = true, after_help = help!(
        "diagnose firings.csv --schedule schedule.toml",
        "0 no sensor is deaf; 1 one is; 2 bad input or a damaged log"
    ))]
    Diagnose(diagnose::Args),
    #[command(hide = true, after_help = help!("survey survey.csv --ring ring.toml", "0 surveyed; 2 bad input"))]
    Survey(survey::Args),
}

/// The commands of eeruf's authors.
#[derive(Subcommand)]
pub(crate) enum LabVerb {
    #[command(after_help = help!(
        "lab experiment set-one --seeds 20 --method sequential,eeruf",
        "0 repeated; 2 bad input"
    ))]
    Experiment(experiment::Args),
    #[command(after_help = help!("lab merge part-1.json part-2.json", "0 merged; 2 bad input, or a part is missing"))]
    Merge(merge::Args),
    #[command(after_help = help!("lab dataset out --alcoves 2 --courses 1", "0 written; 2 bad input"))]
    Dataset(dataset::Args),
    #[command(after_help = help!(
        "lab atlas --svg atlas.svg",
        "0 every ring of the share is done; 1 ended before; 2 bad input"
    ))]
    Atlas(atlas::Args),
    #[command(after_help = help!(
        "lab search rings/table-i-waits.toml --best interval",
        "0 a table; 1 none; 2 bad input; 3 not decided"
    ))]
    Search(search::Args),
    #[command(after_help = help!("lab paths scenes/alcove.toml --order 2", "0 listed; 2 bad input"))]
    Paths(paths::Args),
    #[command(after_help = help!("lab scene map.yaml > scene.toml", "0 printed; 2 bad input"))]
    Scene(scene::Args),
    #[command(after_help = help!("lab reality log.csv room.toml --method flow", "0 compared; 2 bad input"))]
    Reality(reality::Args),
}

impl Verb {
    pub(crate) fn run(&self) -> Result<Answer, InputError> {
        match self {
            Self::Design(args) => design::run(args),
            Self::Study(args) => study::run(args),
            Self::Logs(args) => logs::run(args),
            Self::Verify(args) => verify::run(args),
            Self::Examples(args) => examples::run(args),
            Self::Completions(args) => completions::run(args),
            #[cfg(feature = "man")]
            Self::Man(args) => man::run(args),
            Self::Licenses(args) => licenses::run(args),
            Self::Replay(args) => replay::run(args),
            Self::Diagnose(args) => diagnose::run(args),
            Self::Survey(args) => survey::run(args),
            Self::Lab { verb } | Self::Old(verb) => match verb {
                LabVerb::Experiment(args) => experiment::run(args),
                LabVerb::Merge(args) => merge::run(args),
                LabVerb::Dataset(args) => dataset::run(args),
                LabVerb::Atlas(args) => atlas::run(args),
                LabVerb::Search(args) => search::run(args),
                LabVerb::Paths(args) => paths::run(args),
                LabVerb::Scene(args) => scene::run(args),
                LabVerb::Reality(args) => reality::run(args),
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use clap::builder::ValueRange;
    use clap::{Arg, Command, Subcommand as _};

    use super::{Cli, Parser as _, program};

    /// Placeholders of values that name a unit or a kind; the help must give the unit of any other number.
    const KINDS: [&str; 32] = [
        "RING.toml|SCENE.toml",
        "US",
        "S",
        "M",
        "M/S",
        "PERCENT",
        "NODES",
        "SEED",
        "I/N",
        "DIR",
        "DIR|FILE",
        "FILE",
        "FILE.mcap",
        "LOG",
        "LOG.csv",
        "RING.toml",
        "SCENE.toml",
        "SCENE.toml|MAP.yaml|DIR",
        "SCHEDULE.toml",
        "NAME",
        "NAME,..",
        "NAMES",
        "COLUMN",
        "VALUE",
        "TOPIC",
        "UNIT",
        "WHEN",
        "PRESET",
        "LAYOUT",
        "GAIN",
        "PILOT,..",
        "HEIGHT",
    ];

    /// Calls a function with every command that has no subcommands, and its path.
    fn each_leaf(command: &Command, path: &str, see: &mut dyn FnMut(&Command, &str)) {
        if command.get_subcommands().next().is_none() {
            see(command, path);
        }
        for below in command.get_subcommands().filter(|below| below.get_name() != "help") {
            each_leaf(below, &format!("{path} {}", below.get_name()), see);
        }
    }

    /// Lists the faults of an option's help.
    fn faults(command: &Command, arg: &Arg) -> Vec<&'static str> {
        let help = arg.get_long_help().or(arg.get_help()).map(ToString::to_string).unwrap_or_default();
        let kind = arg.get_value_names().map_or("", |names| names[0].as_str());
        let words = arg.get_possible_values();
        let is_number =
            ["N", "M", "K"].contains(&kind) && ["umber", "this many"].iter().any(|word| help.contains(word));
        let is_kind = !words.is_empty() || is_number || KINDS.contains(&kind);
        let is_us = arg.get_id().as_str().ends_with("_us") || arg.get_id() == "period";
        let is_file = ["FILE", "DIR", ".mcap", ".csv", ".toml"].iter().any(|of| kind.contains(of));
        let is_shown = !arg.get_default_values().is_empty() && !arg.is_hide_default_value_set();
        let is_list = arg.get_num_args().is_some_and(|range| range.max_values() == usize::MAX);
        let excludes = command.get_arg_conflicts_with(arg);
        [
            ("no unit or kind", is_kind),
            ("microseconds that it does not name", !is_us || (kind == "US" && help.contains("microseconds"))),
            ("no default", is_file || is_shown || help.contains("default") || arg.is_required_set()),
            ("a list that swallows files", !is_list || excludes.iter().any(|other| other.is_positional())),
        ]
        .into_iter()
        .filter_map(|(fault, held)| (!held).then_some(fault))
        .collect()
    }

    #[test]
    fn every_option_with_a_value_says_its_unit_and_default() {
        let (mut options, mut wrong) = (0, vec![]);
        let mut built = program();
        built.build();
        each_leaf(&built, "eeruf", &mut |command, path| {
            let takes = |arg: &&Arg| arg.get_num_args() != Some(ValueRange::EMPTY) && arg.get_long().is_some();
            for arg in command.get_arguments().filter(takes) {
                options += 1;
                wrong.extend(faults(command, arg).into_iter().map(|fault| format!("{path} {arg}: {fault}")));
            }
        });
        assert!(options > 120, "{options}");
        assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    }

    #[test]
    fn help_of_each_command_fits_one_screen() {
        let mut built = program();
        built.build();
        each_leaf(&built, "eeruf", &mut |command, path| {
            let help = command.clone().render_help().to_string();
            assert!(help.lines().count() <= 50, "{path}: {}", help.lines().count());
        });
        assert!(built.render_help().to_string().lines().count() <= 24);
    }

    #[test]
    fn every_command_has_an_example_that_parses_and_exit_codes() {
        each_leaf(&program(), "eeruf", &mut |command, path| {
            // Old names have the help of new ones.
            if super::LabVerb::has_subcommand(path.split(' ').nth(1).unwrap_or_default()) {
                return;
            }
            let help = command.get_after_help().map(ToString::to_string).unwrap_or_default();
            let (example, codes) = help.split_once("\n\nExit codes: 0 ").unwrap_or_else(|| panic!("{path}: {help}"));
            let example = example.strip_prefix("Example:\n  ").unwrap_or_else(|| panic!("{path}: {help}"));
            assert!(example.starts_with(path) && codes.contains("74"), "{path}: {help}");
            let words = example.split(" > ").next().unwrap_or_default().split(' ');
            assert!(Cli::try_parse_from(words).is_ok(), "{example}");
        });
    }
}
