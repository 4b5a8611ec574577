//! `eeruf experiment set-one`: eight sensors before three walls at right angles, over many alcoves.

use eeruf_core::{HoppingSettings, Micros};
use eeruf_sim::Method;
use eeruf_sim::Robot;
use eeruf_sim::best_schedule_for;
use eeruf_sim::experiments::set_one::{Alcove, SENSORS, SetOneOptions, set_one};

use super::common::{BUDGET, Common, bad, designing, watched};
use crate::commands::methods::chosen;
use crate::files::error::InputError;
use crate::report::draw;
use crate::report::experiment::set_one::describe;
use crate::report::json::to_json;
use crate::report::watch::Watch;

/// Set I: eight sensors before three perpendicular walls, each reading compared with what the sensor reads alone.
///
/// Every alcove is simulated by each method for as long as 8000 readings of the conventional one take. Figures are
/// given as 10 % / median / 90 % of the alcoves.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    common: Common,
    /// Simulate only these methods
    #[arg(long = "method", value_name = "NAME", num_args = 1.., value_delimiter = ',')]
    methods: Vec<Method>,
    /// How many sensors the ring has
    #[arg(long, value_name = "N", default_value_t = SENSORS as u8)]
    #[arg(value_parser = clap::value_parser!(u8).range(1..=24))]
    sensors: u8,
    /// The period in microseconds
    #[arg(long, value_name = "US", default_value_t = 60_000)]
    #[arg(value_parser = clap::value_parser!(u32).range(45_000..=1_000_000))]
    period_us: u32,
    /// How eeruf_hopping fires and believes
    #[arg(long, value_name = "SETTING", default_value = "balanced")]
    hopping: Hopping,
}

/// The named settings of time hopping.
#[derive(Clone, Copy, clap::ValueEnum)]
enum Hopping {
    /// For most robots
    Balanced,
    /// For robots that must stop early
    Quick,
    /// For maps: confirmed echoes alone
    Maps,
}

impl Hopping {
    fn settings(self) -> HoppingSettings {
        match self {
            Self::Balanced => HoppingSettings::BALANCED,
            Self::Quick => HoppingSettings::QUICK,
            Self::Maps => HoppingSettings::MAPS,
        }
    }
}

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let bad = bad("set-one");
    let mut options = SetOneOptions {
        first: args.common.first,
        physics: args.common.physics,
        methods: chosen(&args.methods),
        hopping: args.hopping.settings(),
        sensors: args.sensors.into(),
        period: Micros::new(args.period_us),
        ..SetOneOptions::default()
    };
    options.seeds = args.common.seeds.unwrap_or(options.seeds);
    let mut watch = Watch::new();
    let robot = Robot { period: options.period, ..Alcove::random(0).robot_of(options.sensors) };
    let best = best_schedule_for(&robot, BUDGET, |progress| watch.go_on(|| designing(progress)))
        .map_err(|error| bad(&error))?;
    options.best = Some(best);
    drop(watch);
    let watched = watched(format!("{} alcoves by {} methods", options.seeds, options.methods.len()));
    let found = set_one(&options, &watched).map_err(|error| bad(&error))?;
    drop(watched);
    args.common.draw("set-one", || draw::set_one(&found))?;
    if args.common.json {
        println!("{}", to_json(&found));
    } else {
        print!("{}", describe(&found, &best));
    }
    Ok(())
}
