//! `eeruf-ros2`: a ROS 2 node for rings of ultrasonic sensors that needs no ROS installed.
//!
//! It listens to a board over a serial line, or to raw echo times or ranges on topics, publishes what counts as
//! `sensor_msgs/Range` and what is wrong as `diagnostic_msgs/DiagnosticArray`, sends `MAVLink`, and writes the log that
//! `eeruf diagnose` reads. See `docs/how-to/ros2.md`.

mod board_clock;
mod board_line;
mod cli;
mod diagnosis;
mod filter;
mod firing_log;
mod mavlink;
mod parameters;
mod range;
mod ros;
mod run;
mod view;

use std::process::ExitCode;

use clap::Parser;

use crate::cli::Cli;

fn main() -> ExitCode {
    let outcome = Cli::parse().parameters().and_then(|parameters| run::run(&parameters));
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("eeruf-ros2: {error}");
            ExitCode::FAILURE
        }
    }
}
