//! `eeruf lab atlas`: the file of rings whose shortest period is known.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, OpenOptions};
use std::io::{ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use eeruf_design::atlas::{ATLAS, Ring, Row, all_rings, is_in_shard, rows};
use eeruf_design::atlas_making::{again, header, make};
use eeruf_files::FileError;

use super::Answer;
use super::arguments::picture;
use super::experiment::Shard;
use crate::console::print;
use crate::files::error::InputError;
use crate::report::draw;
use crate::report::watch::Watch;

/// Make the atlas of shortest periods that `design` answers from: rings of 2 to 32 sensors, each with its schedule.
///
/// Rows are appended to FILE one by one, so that the command can be stopped at any time and continues later. Several
/// processes on one machine may write to the same file at once, each with its share: --shard 1/3, 2/3, 3/3. When
/// the last ring is done, the file is sorted. Exit code 0 if every ring of the share is done, 1 if it was stopped
/// before, 2 for bad input.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The file; without it, the atlas in this program is drawn or printed
    #[arg(value_name = "FILE")]
    file: Option<PathBuf>,
    /// Draw period over number of sensors, as SVG or, if the name ends in .png, as PNG
    #[arg(long, value_name = "FILE", value_parser = picture("atlas"))]
    svg: Option<PathBuf>,
    /// Search the open rings of FILE again, with this number of nodes each, fewer for more than 16 sensors, and write
    /// new certificates; by default, none is searched
    #[arg(long, value_name = "NODES", requires = "file", conflicts_with = "shard")]
    again: Option<u64>,
    /// Search only part I of N of the rings
    #[arg(long, value_name = "I/N", default_value = "1/1")]
    shard: Shard,
    /// Only rings of up to this many sensors
    #[arg(long, value_name = "K", default_value_t = 32, value_parser = clap::value_parser!(u8).range(2..=32))]
    most_sensors: u8,
}

pub(crate) fn run(args: &Args) -> Result<Answer, InputError> {
    let answer = match (&args.file, args.again) {
        (Some(file), Some(nodes)) => search_again(file, nodes, args.most_sensors)?,
        (Some(file), None) => search(args, file)?,
        (None, _) => Answer::Yes,
    };
    let text = match &args.file {
        Some(file) => read(file).map_err(|error| FileError::reading(file, &error))?,
        None => ATLAS.to_owned(),
    };
    match (&args.file, &args.svg) {
        (_, Some(svg)) => draw::atlas(&rows(&text).collect::<Vec<_>>()).save(svg)?,
        (None, None) => print(&text)?,
        (Some(_), None) => {}
    }
    Ok(answer)
}

/// Searches the rings of the share that are not in the file yet.
fn search(args: &Args, path: &Path) -> Result<Answer, InputError> {
    let bad = |error: std::io::Error| FileError::writing(path, &error);
    let found = read(path).map_err(|error| FileError::reading(path, &error))?;
    if found.contains('\n') && !found.starts_with(header()) && rows(&found).next().is_none() {
        return Err(InputError::new(
            path,
            "no row of an atlas; expected a file that `eeruf lab atlas` wrote, or a new name",
        ));
    }
    let rings: Vec<Ring> = all_rings().into_iter().filter(|ring| ring.sensors <= args.most_sensors).collect();
    end_last_line(path).map_err(bad)?;
    let done: BTreeSet<Ring> = rows(&read(path).map_err(bad)?).map(|row| row.ring).collect();
    let watch = Watch::new();
    let (share, of) = (args.shard.part as usize - 1, args.shard.of as usize);
    let numbered = rings.iter().enumerate().filter(|&(number, _)| is_in_shard(number, share, of));
    let left: Vec<&Ring> = numbered.map(|(_, ring)| ring).filter(|ring| !done.contains(ring)).collect();
    for (number, ring) in left.iter().enumerate() {
        if !watch.go_on(|| format!("{number} of {} rings, now {ring}", left.len())) {
            return Ok(Answer::No);
        }
        let row = make(ring).map_err(|what| InputError::new(path, format!("{ring}: {what}")))?;
        // One call for the whole line, so that lines of several processes do not mix.
        let mut file = OpenOptions::new().append(true).create(true).open(path).map_err(bad)?;
        file.write_all(format!("{row}\n").as_bytes()).map_err(bad)?;
    }
    sort_if_complete(path, &rings).map_err(bad)?;
    Ok(Answer::Yes)
}

/// Searches the open rings of a file again, and certifies all of its rows; the file is whole at any time.
fn search_again(path: &Path, nodes: u64, most_sensors: u8) -> Result<Answer, InputError> {
    let bad = |error: std::io::Error| FileError::writing(path, &error);
    let mut all: Vec<Row> = rows(&read(path).map_err(|error| FileError::reading(path, &error))?).collect();
    let (watch, mut answer) = (Watch::new(), Answer::Yes);
    let count = all.len();
    for (number, row) in all.iter_mut().enumerate().filter(|(_, row)| row.ring.sensors <= most_sensors) {
        if !watch.go_on(|| format!("{number} of {count} rings, now {}", row.ring)) {
            answer = Answer::No;
            break;
        }
        *row = again(row, nodes).map_err(|what| InputError::new(path, format!("{}: {what}", row.ring)))?;
    }
    let text = header().to_owned() + &all.iter().map(|row| format!("{row}\n")).collect::<String>();
    replace(path, &text).map_err(bad)?;
    Ok(answer)
}

fn read(file: &Path) -> std::io::Result<String> {
    match fs::read_to_string(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(String::new()),
        read => read,
    }
}

/// Ends a line that a process left unfinished, so that it is not taken for the beginning of the next.
fn end_last_line(path: &Path) -> std::io::Result<()> {
    let mut file = match OpenOptions::new().read(true).append(true).open(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
        file => file?,
    };
    if file.metadata()?.len() == 0 {
        return Ok(());
    }
    file.seek(SeekFrom::End(-1))?;
    let mut last = [0];
    file.read_exact(&mut last)?;
    if last == *b"\n" { Ok(()) } else { file.write_all(b"\n") }
}

/// Rewrites the file in its order, if no ring is missing.
fn sort_if_complete(file: &Path, rings: &[Ring]) -> std::io::Result<()> {
    let sorted: BTreeMap<Ring, Row> = rows(&read(file)?).map(|row| (row.ring, row)).collect();
    if !rings.iter().all(|ring| sorted.contains_key(ring)) {
        return Ok(());
    }
    let mut text = header().to_owned();
    text.extend(sorted.values().map(|row| format!("{row}\n")));
    replace(file, &text)
}

/// Writes the file under another name first, so that it is always whole.
fn replace(file: &Path, text: &str) -> std::io::Result<()> {
    let beside = file.with_extension(format!("{}.tmp", std::process::id()));
    fs::write(&beside, text)?;
    fs::rename(&beside, file)
}
