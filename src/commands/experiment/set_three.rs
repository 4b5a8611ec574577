//! `eeruf experiment set-three`: robots of one make near each other, over many placings.

use eeruf_sim::experiments::set_three::{SetThreeOptions, Way, set_three};

use super::common::{Common, bad, watched};
use crate::console::{print_line, tell};
use crate::files::error::InputError;
use crate::report::draw;
use crate::report::experiment::set_three::describe;
use crate::report::json::to_json;

/// Set III: two to six robots with the same ring stand, meet or follow each other in a corridor or a hall, each with a
/// clock of its own.
///
/// A ring has twelve sensors all round, with the paper's period of 100 ms. Every placing is simulated by each method
/// for 40 periods. Figures are given as medians over the placings, with 95 % intervals.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    common: Common,
    /// Simulate only these methods, separated by commas; `driving` is eeruf_hopping by its settings for robots that
    /// drive. By default simultaneous, sequential, sequential_votes, dither, eeruf, eeruf_hopping, driving and flow
    #[arg(long = "method", value_name = "NAME,..", value_delimiter = ',')]
    ways: Vec<Way>,
    /// For how many periods each placing is simulated
    #[arg(long, value_name = "N", default_value_t = SetThreeOptions::default().periods)]
    #[arg(value_parser = clap::value_parser!(u32).range(10..=100_000))]
    periods: u32,
}

const SEEDS: u64 = 200;

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let options = SetThreeOptions {
        seeds: args.common.seeds.unwrap_or(SEEDS),
        first: args.common.first,
        periods: args.periods,
        ways: if args.ways.is_empty() { Way::USUAL.to_vec() } else { args.ways.clone() },
        physics: args.common.physics,
        room: args.common.room(),
        gain: args.common.gain,
    };
    let watched = watched(format!("{} placings by {} methods", options.seeds, options.ways.len()));
    let found = set_three(&options, &watched).map_err(|error| bad("set-three")(&error))?;
    drop(watched);
    args.common.draw("set-three", || draw::robots_of_one_make(&found))?;
    if args.common.json {
        print_line(to_json(&found))?;
    } else {
        tell(describe(&found))?;
    }
    Ok(())
}
