//! Ranges of ultrasonic sensors from the logs that robots keep, one reading after the other, in memory that does not
//! grow with the file.
//!
//! | log | what is read |
//! |---|---|
//! | MCAP | `sensor_msgs/Range` and `LaserScan`, arrays of numbers by schema, in `cdr` and `ros1`; zstd, lz4 |
//! | ROS 2 bag (a folder) | the same, from its MCAP or `SQLite` files; messages packed by zstd too |
//! | ROS 1 bag | the same, format 2.0; chunks of bz2, lz4 or neither |
//! | text | tables with any separator, with or without header; pairs of name and value; JSON |
//! | flight logs: `.BIN`, `.tlog`, `.ulg` | distances that a sensor measures by sound, with their quality |
//! | frames of `eeruf-serial`, as they came | each firing |
//! | any of these packed | as a whole, by gzip, bzip2 or zstd |
//!
//! `Range` has had a `variance` since ROS 2 Iron: the schema in the file says whether it is there, else the message's
//! length. A `LaserScan` counts as a ring of sonars if it has at most 64 beams, or if its topic is asked for; each beam
//! is a sensor. Sensors are counted from 0. Units, times and values for no echo are guessed where the log does not say
//! them; [`Report::guesses`] lists each guess with the option that overrides it.
//!
//! What is damaged or cut off is skipped, and said in [`Report::damage`]; all the rest is read.
//!
//! ```
//! use eeruf_logs::{Echo, Options, read_log};
//! let file = std::env::temp_dir().join("eeruf-logs-example.csv");
//! std::fs::write(&file, "t,left,right\n0.00,1.20,\n0.06,1.21,2.50\n")?;
//! let mut options = Options::default();
//! options.no_echo_m = 4.0;
//! let mut echoes = Vec::new();
//! let report = read_log(&file, &options, |_, reading| echoes.push((reading.sensor, reading.echo())))?;
//! assert_eq!(report.names(), ["left", "right"]);
//! assert_eq!(echoes[1..], [(1, Echo::Nothing), (0, Echo::At(1.21)), (1, Echo::At(2.5))]);
//! # std::fs::remove_file(&file)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bytes;
mod cdr;
mod chunks;
mod diagnose;
mod doctor;
mod firing_files;
mod firing_messages;
mod firing_text;
mod firings;
mod flight;
mod form;
mod judging;
mod mcap;
mod message;
mod names;
mod options;
mod pattern;
mod reading;
mod replay;
mod ros1;
mod ros2;
mod rosbag2;
mod schema;
mod serial;
mod sink;
mod survey;
mod symptom;
mod text;
mod unzstd;
mod value;
mod write;

use std::fs::File;
use std::io::{self, BufReader, Read, Seek};
use std::path::Path;

use eeruf_files::FileError;
use form::{Form, Packing, UntilError};
use sink::Sink;

pub use diagnose::{
    AlignError, Alignment, Diagnosis, FoundPath, Hearing, KeepGoing, Named, Settings, Share, Timing, TimingError,
    align, diagnose, diagnose_while, timing,
};
pub use doctor::{Doctor, Examination, Suspect, Verdict};
pub use firings::{Firing, FiringLog};
pub use judging::{Counted, Judging, RangeJudge};
pub use options::{FieldChoice, Options, RangeUnit, Table, TimeUnit};
pub use pattern::{FiringPattern, Pattern};
pub use reading::{Echo, Reading, Sensor};
pub use replay::{FlowSettings, Replayed, replay_flow};
pub use ros2::{Marker, Placement, Shape, Transform};
pub use sink::{Guess, Report, Skipped};
pub use survey::{PathSettings, Surveyed, survey, survey_while};
pub use symptom::{Finding, Symptom};
pub use write::McapWriter;

/// Reads a log from beginning to end, and calls `each` with the report so far, which has the sensors, and each reading,
/// in the order in which they were recorded. The form shows in the first bytes, also of a file that is packed as a
/// whole, else in the ending of its name; of text, in its lines. [`Report::guesses`] lists what was guessed.
///
/// A log without sensors is no error: [`Report::sensors`] is empty then, and [`Report::skipped`] says what was found.
///
/// # Errors
/// A file that cannot be opened, a folder without bag files, a form that is known and not read, or an option that does
/// not fit the log. Of a log that is damaged, what can be read is.
pub fn read_log(file: &Path, options: &Options, mut each: impl FnMut(&Report, &Reading)) -> Result<Report, FileError> {
    if file.as_os_str() == "-" {
        return read_stream(io::stdin().lock(), file, options, each);
    }
    if !file.is_dir() && std::fs::metadata(file).is_ok_and(|of| !of.is_file()) {
        // A pipe is read once.
        let opened = File::open(file).map_err(|error| FileError::reading(file, &error))?;
        return read_stream(opened, file, options, each);
    }
    let mut sink = Sink::new(options, &mut each);
    if file.is_dir() {
        sink.form("a ROS 2 bag");
        sink.has(options::Parts::Topics);
        rosbag2::read(file, &mut sink)?;
        return Ok(sink.finish(file));
    }
    let form = Form::of_file(file)?;
    sink.form(form.name());
    if form == Form::Sqlite {
        sink.has(options::Parts::Topics);
        rosbag2::read_sqlite(file, file, false, &mut sink)?;
    } else {
        let mut opened = File::open(file).map_err(|error| FileError::reading(file, &error))?;
        read_anywhere(&mut opened, file, form, options, &mut sink)?;
    }
    Ok(sink.finish(file))
}

/// Reads a log that is no file of this machine, as [`read_log`] does a file; `name` stands in errors, and its ending
/// helps where the first bytes do not show the form. An `SQLite` file is copied into a temporary one first.
///
/// # Errors
/// As [`read_log`].
pub fn read_from(
    mut input: impl Read + Seek,
    name: &Path,
    options: &Options,
    mut each: impl FnMut(&Report, &Reading),
) -> Result<Report, FileError> {
    let failed = |error: io::Error| FileError::reading(name, &error);
    let mut sink = Sink::new(options, &mut each);
    let form = Form::of(&form::first_bytes(&mut input).map_err(failed)?, name);
    input.rewind().map_err(failed)?;
    sink.form(form.name());
    read_anywhere(&mut input, name, form, options, &mut sink)?;
    Ok(sink.finish(name))
}

/// Reads a log that comes once and in order, as from a pipe, as [`read_log`] does a file; `name` stands in errors. Text
/// and frames of the serial line are read as they come; a bag is copied into a temporary file first.
///
/// # Errors
/// As [`read_log`].
pub fn read_stream(
    mut input: impl Read,
    name: &Path,
    options: &Options,
    mut each: impl FnMut(&Report, &Reading),
) -> Result<Report, FileError> {
    let mut sink = Sink::new(options, &mut each);
    let first = form::first_bytes(&mut input).map_err(|error| FileError::reading(name, &error))?;
    let form = Form::of(&first, name);
    sink.form(form.name());
    read_in_order(&mut first.as_slice().chain(input), name, form, options, &mut sink)?;
    Ok(sink.finish(name))
}

/// Reads a log of this form that can be read at any place; `name` stands in errors.
fn read_anywhere(
    input: &mut dyn bytes::Input,
    name: &Path,
    form: Form,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Result<(), FileError> {
    match form {
        Form::Mcap => {
            sink.has(options::Parts::Topics);
            mcap::read(input, name, false, sink)
        }
        Form::Ros1 => {
            sink.has(options::Parts::Topics);
            ros1::read(input, name, sink)
        }
        _ => read_in_order(input, name, form, options, sink),
    }
}

/// Reads a log of this form from its beginning to its end.
fn read_in_order(
    input: &mut dyn Read,
    name: &Path,
    form: Form,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Result<(), FileError> {
    match form {
        Form::Text => text::read(input, name, options, sink),
        Form::Serial => serial::read(input, name, options, sink),
        Form::Flight(flight) => flight::read(flight, input, name, sink),
        Form::Foreign(foreign) => Err(foreign.refuse(name)),
        Form::Packed(packing) => read_packed(input, name, packing, options, sink),
        Form::Mcap | Form::Ros1 | Form::Sqlite => match read_copy(input, name, form, options, sink)? {
            None => Ok(()),
            Some(error) => Err(FileError::reading(name, &error)),
        },
    }
}

/// Reads a bag by way of a temporary file; the error after which there was no more of it.
fn read_copy(
    input: &mut dyn Read,
    name: &Path,
    form: Form,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Result<Option<io::Error>, FileError> {
    let (copy, error) = form::to_file(input, "bag").map_err(|error| FileError::reading(name, &error))?;
    if form == Form::Sqlite {
        sink.has(options::Parts::Topics);
        rosbag2::read_sqlite(copy.path(), name, false, sink)?;
    } else {
        read_anywhere(&mut copy.as_file(), name, form, options, sink)?;
    }
    Ok(error)
}

/// Reads a file that is packed as a whole.
fn read_packed(
    input: &mut dyn Read,
    name: &Path,
    packing: Packing,
    options: &Options,
    sink: &mut Sink<'_>,
) -> Result<(), FileError> {
    let failed = |error: io::Error| FileError::reading(name, &error);
    let mut input = packing.unpack(BufReader::new(input)).map_err(failed)?;
    let mut error = None;
    let first = form::first_bytes(UntilError::new(&mut input, &mut error)).map_err(failed)?;
    let form = Form::of(&first, name.file_stem().map_or(name, Path::new));
    let mut input = first.as_slice().chain(input);
    match form {
        Form::Packed(_) => return Err(FileError::new(name, "packed twice; expected once: unpack it first")),
        // Nothing came out.
        Form::Text if error.is_some() => {}
        Form::Text => read_in_order(&mut UntilError::new(input, &mut error), name, form, options, sink)?,
        Form::Serial | Form::Flight(_) | Form::Foreign(_) => {
            sink.form(form.name());
            read_in_order(&mut UntilError::new(input, &mut error), name, form, options, sink)?;
        }
        Form::Mcap | Form::Ros1 | Form::Sqlite => {
            sink.form(form.name());
            error = error.or(read_copy(&mut input, name, form, options, sink)?);
        }
    }
    sink.form(&format!("{}, packed by {}", sink.report.form, packing.name()));
    if let Some(error) = error {
        sink.damage(name, None, format!("it cannot be unpacked to its end: {error}; what comes before was read"));
    }
    Ok(())
}

/// The listing of the crate's README compiles and holds.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
