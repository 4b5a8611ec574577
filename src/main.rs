//! The program `eeruf`: design, verify and study firing schedules, and see what the filter makes of recorded readings.
//!
//! One module for each verb; `input` reads files and reports what is wrong with them in one line.

// Doc comments of arguments are what --help prints in a terminal, where backticks only disturb.
#![allow(clippy::doc_markdown)]

mod design;
mod draw;
mod experiment;
mod fooled;
mod illustrate;
mod input;
mod paths;
mod replay;
mod ring_file;
mod search;
mod study;
mod timing;
mod verify;
mod watch;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Fire all ultrasonic sensors of a robot five to ten times faster than one by one, without believing each other's
/// echoes.
///
/// Sensors are printed from 1, as in the paper, and counted from 0 in files and in --json.
#[derive(Parser)]
#[command(version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    Design(design::Args),
    Verify(verify::Args),
    Search(search::Args),
    Study(study::Args),
    Paths(paths::Args),
    Replay(replay::Args),
    Experiment(experiment::Args),
}

/// What a verb's answer is, and with it the exit code.
enum Answer {
    /// Exit code 0.
    Yes,
    /// Not verified, or infeasible: exit code 1.
    No,
}

fn main() -> ExitCode {
    let answer = match Cli::parse().verb {
        Verb::Design(args) => design::run(&args),
        Verb::Verify(args) => verify::run(&args),
        Verb::Search(args) => search::run(&args),
        Verb::Study(args) => study::run(&args),
        Verb::Paths(args) => paths::run(&args),
        Verb::Replay(args) => replay::run(&args),
        Verb::Experiment(args) => experiment::run(&args),
    };
    match answer {
        Ok(Answer::Yes) => ExitCode::SUCCESS,
        Ok(Answer::No) => ExitCode::from(1),
        Err(error) => {
            eprintln!("eeruf: {error}");
            ExitCode::from(2)
        }
    }
}
