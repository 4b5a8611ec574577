//! The program `eeruf`: design, verify and study firing schedules, and see what the filter makes of recorded readings.
//!
//! `commands` has one file for each verb; `files` is what they read, `report` what they print and draw.

// Doc comments of arguments are what --help prints in a terminal, where backticks only disturb.
#![allow(clippy::doc_markdown)]

mod commands;
mod files;
mod report;

use std::process::ExitCode;

use clap::Parser;

use crate::commands::{Answer, Verb};

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

fn main() -> ExitCode {
    match Cli::parse().verb.run() {
        Ok(Answer::Yes) => ExitCode::SUCCESS,
        Ok(Answer::No) => ExitCode::from(1),
        Err(error) => {
            eprintln!("eeruf: {error}");
            ExitCode::from(2)
        }
    }
}
