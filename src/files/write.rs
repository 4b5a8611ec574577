//! Writing files and folders for the user; paths are checked before the work begins.

use std::fs;
use std::path::{Path, PathBuf};

use clap::ArgMatches;
use eeruf_files::FileError;

use super::error::InputError;
use crate::commands::arguments::is_picture;

/// The options that name input files, and those that name output files.
const READ: [&str; 2] = ["file", "simulate"];
const WRITTEN: [&str; 6] = ["out", "log", "mcap", "svg", "png", "certificate"];
const PICTURES: [&str; 2] = ["svg", "png"];

/// Refuses an output file that is also an input, that is a folder, or whose folder does not exist.
pub(crate) fn check_outputs(matches: &ArgMatches) -> Result<(), InputError> {
    let Some((verb, below)) = matches.subcommand() else { return Ok(()) };
    let named = |id: &str| below.try_get_many::<PathBuf>(id).ok().flatten().into_iter().flatten();
    let read: Vec<_> = READ.into_iter().flat_map(named).filter_map(|file| file.canonicalize().ok()).collect();
    for (id, file) in WRITTEN.into_iter().flat_map(|id| named(id).map(move |file| (id, file))) {
        let wrong = |why: &str| Err(InputError::new(format!("--{id}"), format!("{}; {why}", file.display())));
        if file.canonicalize().is_ok_and(|file| read.contains(&file)) {
            return wrong("expected another file than the one that is read");
        }
        // These commands make their folders.
        if verb == "dataset" || (verb == "design" && id == "out") {
            continue;
        }
        if let Some(folder) = PICTURES.contains(&id).then(|| below.get_raw(id)?.next()).flatten().map(Path::new)
            && !is_picture(folder)
        {
            make_folder(folder)?;
            continue;
        }
        if file.is_dir() {
            return wrong("expected a file, not a folder");
        }
        let folder = file.parent().filter(|folder| *folder != Path::new(""));
        if let Some(error) = folder.and_then(|folder| folder.metadata().err()) {
            return Err(FileError::writing(file, &error).into());
        }
    }
    check_outputs(below)
}

/// Writes an output file.
pub(crate) fn write(file: &Path, contents: impl AsRef<[u8]>) -> Result<(), InputError> {
    fs::write(file, contents).map_err(|error| FileError::writing(file, &error).into())
}

/// Makes an output folder and its parents.
pub(crate) fn make_folder(folder: &Path) -> Result<(), InputError> {
    fs::create_dir_all(folder).map_err(|error| FileError::writing(folder, &error).into())
}
