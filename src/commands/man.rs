//! `eeruf man`: the pages for `man`, one for the program and one for each verb.

use std::fs;
use std::path::PathBuf;

use clap::CommandFactory as _;

use super::Cli;
use super::answer::Answer;
use crate::files::error::InputError;

/// Write the manual's pages, one for the program and one for each verb.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder that they are written into, as ~/.local/share/man/man1
    #[arg(value_name = "DIR")]
    folder: PathBuf,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    fs::create_dir_all(&args.folder)
        .and_then(|()| clap_mangen::generate_to(Cli::command(), &args.folder))
        .map_err(|error| InputError::new(&args.folder, None, error))?;
    Ok(Answer::Yes)
}
