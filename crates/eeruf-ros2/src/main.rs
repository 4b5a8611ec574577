//! `eeruf-ros2`: a ROS 2 node for rings of ultrasonic sensors that needs no ROS installed.
//!
//! It listens to a board over a serial line, fires modules on its own pins, or runs a simulation. It publishes readings
//! as `sensor_msgs/Range`, the state of all sensors as `sensor_msgs/PointCloud2` and `LaserScan`, and faults as
//! `diagnostic_msgs/DiagnosticArray`, sends `MAVLink`, and writes the log that `eeruf diagnose` reads. See
//! `docs/how-to/ros2.md`.

mod board_clock;
mod board_line;
mod cli;
mod diagnosis;
mod fan;
mod firing_log;
mod gpio;
mod mavlink;
#[cfg(test)]
mod nav2_tests;
mod parameters;
mod placing;
mod range;
mod ros;
mod ros_args;
mod run;
mod simulated;
mod view;

use std::process::ExitCode;

use crate::cli::{Task, task};

fn main() -> ExitCode {
    let outcome = task().and_then(|task| match task {
        Task::Print(text) => {
            print!("{text}");
            Ok(())
        }
        Task::Run(setup) => run::run(*setup),
    });
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("eeruf-ros2: {error}");
            ExitCode::FAILURE
        }
    }
}
