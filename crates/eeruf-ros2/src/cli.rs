//! The command line: where the parameters are, and what stands above them.

use std::path::PathBuf;

use clap::Parser;

use crate::parameters::{Parameters, Source};

/// A ROS 2 node for rings of ultrasonic sensors that needs no ROS installed
#[derive(Parser)]
#[command(version, max_term_width = 100)]
pub(crate) struct Cli {
    /// Parameters, as YAML that `ros2 param dump` writes; all have defaults
    #[arg(long, value_name = "FILE")]
    params_file: Option<PathBuf>,
    /// The node's name, by which its parameters are found
    #[arg(long, default_value = "eeruf")]
    name: String,
    /// Listen to a board on this serial line, whatever the parameters say
    #[arg(long, value_name = "DEVICE")]
    port: Option<String>,
    /// Write a log that `eeruf diagnose` reads
    #[arg(long, value_name = "FILE.csv")]
    log: Option<PathBuf>,
    #[arg(long, value_name = "WHERE", help = "Send MAVLink to `udp:HOST:PORT`")]
    mavlink: Option<String>,
    #[arg(long, help = "Speak no ROS: only the log and MAVLink, from a serial line")]
    no_ros: bool,
}

impl Cli {
    /// The parameters of the file, and what the command line puts above them.
    pub(crate) fn parameters(self) -> Result<Parameters, String> {
        let mut parameters = match &self.params_file {
            None => Parameters::default(),
            Some(file) => {
                let text = std::fs::read_to_string(file).map_err(|error| format!("{}: {error}", file.display()))?;
                Parameters::from_yaml(&text, &self.name).map_err(|error| format!("{}: {error}", file.display()))?
            }
        };
        parameters.name = self.name;
        if let Some(port) = self.port {
            parameters.port = port;
            parameters.source = Source::Serial;
        }
        if let Some(log) = self.log {
            parameters.log = log;
        }
        if let Some(mavlink) = self.mavlink {
            parameters.mavlink = mavlink;
        }
        parameters.ros = !self.no_ros;
        parameters.check()?;
        Ok(parameters)
    }
}
