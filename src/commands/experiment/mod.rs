//! `eeruf lab experiment`: Section 4 of the paper as two commands, with the paper's figures beside those found here,
//! and several robots of the same make as a third.

mod common;
mod set_one;
mod set_three;
mod set_two;
mod shard;

use std::path::Path;

pub(super) use shard::{Part, Shard};

use super::Answer;
use crate::files::error::InputError;

/// Repeat an experiment over many seeded geometries, courses or placings, by every method.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    set: Set,
}

#[derive(clap::Subcommand)]
enum Set {
    #[command(name = "set-one", after_help = help!(
        "lab experiment set-one --seeds 20 --method sequential,eeruf",
        "0 repeated; 2 bad input"
    ))]
    One(set_one::Args),
    #[command(name = "set-two", after_help = help!(
        "lab experiment set-two --seeds 5 --method conventional,eeruf",
        "0 repeated; 2 bad input"
    ))]
    Two(set_two::Args),
    #[command(name = "set-three", after_help = help!(
        "lab experiment set-three --seeds 5 --method sequential,flow",
        "0 repeated; 2 bad input"
    ))]
    Three(set_three::Args),
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    match &args.set {
        Set::One(args) => set_one::run(args)?,
        Set::Two(args) => set_two::run(args)?,
        Set::Three(args) => set_three::run(args)?,
    }
    Ok(Answer::Yes)
}

/// Prints the undivided experiment from the runs of all parts.
pub(super) fn merged(args: &Args, file: &Path, runs: &shard::Runs) -> Result<(), InputError> {
    match &args.set {
        Set::One(args) => set_one::merged(args, file, runs),
        Set::Two(args) => set_two::merged(args, file, runs),
        Set::Three(args) => set_three::merged(args, file, runs),
    }
}
