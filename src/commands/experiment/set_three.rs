//! `eeruf lab experiment set-three`: robots of the same make near each other, over many placings.

use std::path::Path;

use eeruf_sim::Entry;
use eeruf_sim::experiments::set_three::{SetThree, SetThreeOptions, set_three};

use super::common::{Common, Watched};
use super::shard::{Runs, runs_of};
use crate::commands::show;
use crate::files::error::InputError;
use crate::report::draw;
use crate::report::experiment::set_three::describe;

/// Set III: two to six robots with the same ring stand, meet or follow each other in a corridor or a hall, each with a
/// clock of its own.
///
/// A ring has twelve sensors all round, with the paper's period of 100 ms. Every placing is simulated by each method
/// for 40 periods. Figures are given as medians over the placings, with 95 % intervals. Fired like today's rings
/// (`--method in_turn,arrays,groups,sync_line,free_running,table`), they have two arrays of six, four groups of three,
/// and modules that rest for 65 ms.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(flatten)]
    common: Common,
    /// Simulate only these methods, separated by commas; by default simultaneous, sequential, sequential_votes, dither,
    /// eeruf and flow
    #[arg(id = "method", long, value_name = "NAME,..", value_delimiter = ',')]
    methods: Vec<Entry>,
    /// Number of periods for which each placing is simulated
    #[arg(long, value_name = "N", default_value_t = SetThreeOptions::default().periods)]
    #[arg(value_parser = clap::value_parser!(u32).range(10..=100_000))]
    periods: u32,
}

const SEEDS: u64 = 200;

pub(crate) fn run(args: &Args) -> Result<(), InputError> {
    let options = options(args);
    let block = |first, seeds, watched: Watched<'_>| {
        Ok(set_three(&SetThreeOptions { first, seeds, ..options.clone() }, watched)?.runs)
    };
    let seeds = (options.first, options.seeds);
    let ran = args.common.in_blocks(("set-three", "placings"), &options.methods, seeds, block)?;
    let Some((seeds, runs)) = ran else { return Ok(()) };
    print(args, &SetThree::of(&SetThreeOptions { seeds, ..options }, runs))
}

/// Prints the undivided result from the runs of all parts.
pub(super) fn merged(args: &Args, file: &Path, runs: &Runs) -> Result<(), InputError> {
    let options = options(args);
    let runs = runs_of(&options.methods, options.seeds, file, runs)?;
    print(args, &SetThree::of(&options, runs))
}

fn options(args: &Args) -> SetThreeOptions {
    let mut options = SetThreeOptions {
        seeds: args.common.seeds.unwrap_or(SEEDS),
        first: args.common.first,
        periods: args.periods,
        physics: args.common.physics,
        room: args.common.room(),
        gain: args.common.gain,
        ..SetThreeOptions::default()
    };
    if !args.methods.is_empty() {
        options.methods.clone_from(&args.methods);
    }
    options
}

fn print(args: &Args, found: &SetThree) -> Result<(), InputError> {
    args.common.draw("set-three", || draw::robots_of_one_make(found))?;
    Ok(show(args.common.json, || found, || describe(found))?)
}
