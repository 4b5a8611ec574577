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
use std::process::ExitCode;

use clap::Parser;

/// Success, or the reason why nothing is printed.
type Answer = Result<(), Box<dyn Error>>;

/// Measurements that the documents quote
#[derive(Parser)]
#[command(bin_name = "cargo lab")]
enum Command {
    /// Angles at which a wall is heard, by distance and gain
    ConstantDepth,
    /// Senders that diagnose names
    #[command(override_usage = "cargo lab diagnose-places [FIRST [PLACES [METHOD [PERIODS [PHYSICS]]]]]")]
    DiagnosePlaces { words: Vec<String> },
    /// Ways of sound in a scene, for simulated boards
    #[command(override_usage = "cargo lab echo-times SCENE.toml [SENSORS]")]
    EchoTimes { words: Vec<String> },
    /// Flow beside one by one, with and without a median
    FlowTables(flow_tables::Asked),
    /// Ways of firing by what a robot needs
    Measure(measure::Asked),
    /// Panels narrower than a Fresnel zone
    NarrowPanels,
    /// Table of shortest periods
    Periods,
    /// Paths and times that Python is held against
    #[command(override_usage = "cargo lab rust-side paths|times")]
    RustSide { words: Vec<String> },
    /// Shortest periods and their cost
    #[command(override_usage = "cargo lab shortest-periods [TICKS [SEPARATION [SENSORS [NEIGHBOURS [LAYOUTS [BUDGET \
                                [WINDOWS]]]]]]]")]
    ShortestPeriods { words: Vec<String> },
    /// Random rings for a race with peers
    #[command(override_usage = "cargo lab uneven-rings [RINGS [SECONDS [FIRST]]]")]
    UnevenRings { words: Vec<String> },
}

fn main() -> ExitCode {
    let answer = match Command::parse() {
        Command::ConstantDepth => constant_depth::main(),
        Command::DiagnosePlaces { words } => diagnose_places::main(&words),
        Command::EchoTimes { words } => echo_times::main(&words),
        Command::FlowTables(asked) => flow_tables::main(&asked),
        Command::Measure(asked) => measure::main(&asked),
        Command::NarrowPanels => narrow_panels::main(),
        Command::Periods => shortest_periods::table(),
        Command::RustSide { words } => rust_side::main(&words),
        Command::ShortestPeriods { words } => shortest_periods::main(&words),
        Command::UnevenRings { words } => uneven_rings::main(&words),
    };
    let Err(error) = answer else { return ExitCode::SUCCESS };
    eprintln!("{error}; see `cargo lab --help`");
    ExitCode::FAILURE
}
