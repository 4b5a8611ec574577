//! The lab: measurements that the documents quote.
//!
//! `cargo lab` lists them. None of it is published or needed to use eeruf.

mod clock;
mod constant_depth;
#[path = "../../crates/eeruf-sim/tests/common/corpus.rs"]
mod corpus;
mod diagnose_places;
mod echo_times;
mod flow_tables;
mod measure;
mod narrow_panels;
mod rust_side;
mod shortest_periods;
mod uneven_rings;

use std::error::Error;
use std::io::Write as _;
use std::process::ExitCode;

/// Success, or the reason why nothing is printed.
type Answer = Result<(), Box<dyn Error>>;

/// A command: its name, arguments and output.
type Command = (&'static str, &'static str, &'static str, fn(&[String]) -> Answer);

const COMMANDS: [Command; 10] = [
    ("constant-depth", "", "angles at which a wall is heard, by distance and gain", constant_depth::main),
    (
        "diagnose-places",
        "[FIRST [PLACES [METHOD [PERIODS [PHYSICS]]]]]",
        "senders that diagnose names",
        diagnose_places::main,
    ),
    ("echo-times", "SCENE.toml [SENSORS]", "ways of sound in a scene, for simulated boards", echo_times::main),
    (
        "flow-tables",
        "courses | robots | rooms [--ring FILE] [--first N] [--count N] [--csv FILE]",
        "flow beside one by one, with and without a median",
        flow_tables::main,
    ),
    (
        "measure",
        "[RING.toml ..] [--first N] [--places N] [--csv FILE] [--blocks N]",
        "ways of firing by what a robot needs",
        measure::main,
    ),
    ("narrow-panels", "", "panels narrower than a Fresnel zone", narrow_panels::main),
    ("periods", "", "table of shortest periods", shortest_periods::table),
    ("rust-side", "paths | times", "what Python is held against", rust_side::main),
    (
        "shortest-periods",
        "[TICKS [SEPARATION [SENSORS [NEIGHBOURS [LAYOUTS [BUDGET [WINDOWS]]]]]]]",
        "shortest periods and their cost",
        shortest_periods::main,
    ),
    ("uneven-rings", "[RINGS [SECONDS [FIRST]]]", "random rings for a race with peers", uneven_rings::main),
];

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let asked = words.split_first().and_then(|(name, arguments)| {
        COMMANDS.iter().find(|(known, ..)| known == name).map(|command| (command, arguments))
    });
    let Some(((name, usage, _, run), arguments)) = asked else {
        if let Some(name) = words.first() {
            eprintln!("{name}: no command of the lab; `cargo lab` lists them");
            return ExitCode::from(2);
        }
        // The reader of the list may close the pipe before its end.
        let list = COMMANDS.map(|(name, usage, about, _)| format!("{name} {usage}\n    {about}\n")).concat();
        _ = std::io::stdout().write_all(list.as_bytes());
        return ExitCode::SUCCESS;
    };
    if let Err(error) = run(arguments) {
        eprintln!("{name}: {error}; usage: cargo lab {name} {usage}");
        return ExitCode::FAILURE;
    }
    ExitCode::SUCCESS
}
