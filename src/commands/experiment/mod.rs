//! `eeruf experiment`: Section 4 of the paper as two commands, with its own figures beside those found here.

mod common;
mod set_one;
mod set_two;

use super::answer::Answer;
use crate::files::error::InputError;

/// Repeat an experiment of the paper over many seeded geometries or courses, by every method.
#[derive(clap::Args)]
pub(crate) struct Args {
    #[command(subcommand)]
    set: Set,
}

#[derive(clap::Subcommand)]
enum Set {
    SetOne(set_one::Args),
    SetTwo(set_two::Args),
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    match &args.set {
        Set::SetOne(args) => set_one::run(args)?,
        Set::SetTwo(args) => set_two::run(args)?,
    }
    Ok(Answer::Yes)
}
