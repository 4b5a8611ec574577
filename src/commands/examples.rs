//! `eeruf examples`: writes the example files.

use std::path::PathBuf;

use super::Answer;
use crate::console::print_line;
use crate::examples;
use crate::files::error::InputError;
use crate::files::write::{make_folder, write};

/// List the example scenes and rings, or write them into a folder.
///
/// The checker of certificates in Python is among them. The commands of the documents run in that folder.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Write scenes/, rings/ and checker/ into this folder; existing files are kept
    #[arg(value_name = "DIR")]
    folder: Option<PathBuf>,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    for (name, text) in examples::all() {
        let Some(folder) = &args.folder else {
            print_line(name)?;
            continue;
        };
        let file = folder.join(name);
        if file.exists() {
            print_line(format_args!("{} is there already", file.display()))?;
            continue;
        }
        if let Some(folder) = file.parent() {
            make_folder(folder)?;
        }
        write(&file, text)?;
        print_line(file.display())?;
    }
    Ok(Answer::Yes)
}
