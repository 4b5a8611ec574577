//! `eeruf experiment set-one`: eight sensors before three walls at right angles, over many alcoves.

use eeruf_sim::Method;
use eeruf_sim::best_schedule_for;
use eeruf_sim::experiments::set_one::{Alcove, READINGS, set_one};

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
}

const SEEDS: u64 = 200;

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let bad = bad("set-one");
    let methods = chosen(&args.methods);
    let seeds = args.common.seeds.unwrap_or(SEEDS);
    let mut watch = Watch::new();
    let best = best_schedule_for(&Alcove::random(0).robot(), BUDGET, |progress| watch.go_on(|| designing(progress)))
        .map_err(|error| bad(&error))?;
    drop(watch);
    let watched = watched(format!("{seeds} alcoves by {} methods", methods.len()));
    let found = set_one(seeds, READINGS, &methods, Some(&best), &watched).map_err(|error| bad(&error))?;
    drop(watched);
    args.common.draw("set-one", || draw::set_one(&found))?;
    if args.common.json {
        println!("{}", to_json(&found));
    } else {
        print!("{}", describe(&found, &best));
    }
    Ok(())
}
