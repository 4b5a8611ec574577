//! The command line: the parameters, and the options that override them.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Parser;
use eeruf_sim::World;

use crate::gpio::GpioRing;
use crate::parameters::{Parameters, Source};
use crate::placing::Placing;
use crate::ros_args::{Given, RosArgs};
use crate::simulated;

/// A ROS 2 node for rings of ultrasonic sensors that needs no ROS installed
#[derive(Parser)]
#[command(version, max_term_width = 100)]
#[command(after_help = "After --ros-args: -r __ns:=/robot_1 -r FROM:=TO -p NAME:=VALUE --params-file FILE")]
struct Cli {
    /// Parameters, as YAML that `ros2 param dump` writes; all have defaults
    #[arg(long, value_name = "FILE")]
    params_file: Option<String>,
    /// Print all parameters with their defaults, as a file
    #[arg(long)]
    print_params: bool,
    /// The node's name, by which its parameters are found
    #[arg(long)]
    name: Option<String>,
    /// Listen to a board on this serial line, whatever the parameters say
    #[arg(long, value_name = "DEVICE")]
    port: Option<String>,
    /// Take number and places of the sensors from a ring file
    #[arg(long, value_name = "RING.toml")]
    ring: Option<PathBuf>,
    /// Fire the modules of this ring file on this machine's own pins; parameters say which
    #[arg(long, value_name = "RING.toml", conflicts_with_all = ["port", "ring", "simulate"])]
    gpio: Option<PathBuf>,
    /// Simulate the first robot of a scene, without hardware
    #[arg(long, value_name = "SCENE.toml", conflicts_with = "port")]
    simulate: Option<PathBuf>,
    /// Write a log that `eeruf diagnose` reads
    #[arg(long, value_name = "FILE.csv")]
    log: Option<PathBuf>,
    #[arg(long, value_name = "WHERE", help = "Send MAVLink to `udp:HOST:PORT`")]
    mavlink: Option<String>,
    #[arg(long, help = "Speak no ROS: only the log and MAVLink, from a serial line")]
    no_ros: bool,
}

/// The task that the command line sets.
pub(crate) enum Task {
    Print(String),
    Run(Box<Setup>),
}

/// Arguments for starting the node.
pub(crate) struct Setup {
    pub(crate) parameters: Parameters,
    /// Places of the sensors, if a ring file gives them.
    pub(crate) placing: Placing,
    /// The scene, if there is no hardware.
    pub(crate) world: Option<Arc<World>>,
    /// The ring on this machine's own pins.
    pub(crate) gpio: Option<GpioRing>,
    /// Arguments of ROS; `None` without ROS.
    pub(crate) ros: Option<RosArgs>,
}

/// Parses the command line and reads the files that it names. Exits if clap answers by itself.
pub(crate) fn task() -> Result<Task, String> {
    let mut arguments: Vec<String> = Vec::new();
    for argument in std::env::args_os() {
        let text = argument.into_string();
        arguments.push(text.map_err(|raw| format!("{}: expected UTF-8", Path::new(&raw).display()))?);
    }
    let mut ros = RosArgs::take_from(&mut arguments)?;
    let cli = Cli::parse_from(arguments);
    if cli.print_params {
        return Ok(Task::Print(Parameters::file()));
    }
    ros.node = cli.name.unwrap_or(ros.node);
    let mut parameters = Parameters::default();
    for given in cli.params_file.map(Given::File).iter().chain(&ros.given) {
        match given {
            Given::File(file) => {
                let text = std::fs::read_to_string(file).map_err(|error| format!("{file}: {error}"))?;
                parameters.read_yaml(&text, &ros.full_name()).map_err(|error| format!("{file}: {error}"))?;
            }
            Given::One(name, value) => parameters.read_one(name, value)?,
        }
    }
    if let Some(port) = cli.port {
        parameters.port = port;
        parameters.source = Source::Serial;
    }
    parameters.ring = cli.ring.unwrap_or(parameters.ring);
    parameters.log = cli.log.unwrap_or(parameters.log);
    parameters.mavlink = cli.mavlink.unwrap_or(parameters.mavlink);
    if let Some(ring) = cli.gpio {
        parameters.ring = ring;
        parameters.source = Source::Gpio;
    }
    if let Some(scene) = cli.simulate {
        parameters.scene = scene;
        parameters.source = Source::Simulation;
    }
    let mut placing = Placing::read(&mut parameters)?;
    let world = (parameters.source == Source::Simulation).then(|| simulated::world(&parameters.scene)).transpose()?;
    if let Some(world) = &world {
        placing = simulated::placing(world, parameters.height_m);
        placing.direct(&mut parameters);
        parameters.temperature_c = world.scene().air().temperature_c as f32;
    }
    parameters.check()?;
    let gpio = (parameters.source == Source::Gpio)
        .then(|| GpioRing::design(&parameters.ring, &parameters.method))
        .transpose()?;
    Ok(Task::Run(Box::new(Setup { parameters, placing, world, gpio, ros: (!cli.no_ros).then_some(ros) })))
}
