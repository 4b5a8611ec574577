//! Ranges of ultrasonic sensors from the logs that robots keep, one reading after the other, in memory that does not
//! grow with the file.
//!
//! | log | what is read |
//! |---|---|
//! | MCAP | `sensor_msgs/Range` and `LaserScan`, arrays of numbers by schema, in `cdr` and `ros1`; zstd, lz4 |
//! | ROS 2 bag (a folder) | the same, from its MCAP or `SQLite` files; messages packed by zstd too |
//! | ROS 1 bag | the same, format 2.0; chunks of bz2, lz4 or neither |
//! | text | tables with any separator, with or without header; pairs of name and value; JSON |
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
//! let report = read_log(&file, &options, |_sensors, reading| echoes.push((reading.sensor, reading.echo())))?;
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
mod form;
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
mod text;
mod unzstd;
mod value;
mod weighed;
mod write;

use std::fs::File;
use std::io::{BufReader, Read};
use std::path::Path;

use eeruf_files::FileError;

pub use diagnose::{
    AlignError, Alignment, Diagnosis, Fault, FoundPath, Hearing, Named, Settings, Share, Timing, TimingError, align,
    diagnose, timing,
};
pub use doctor::{Doctor, Examination, Verdict};
pub use firings::{Firing, FiringLog};
pub use options::{FieldChoice, Options, RangeUnit, Table, TimeUnit};
pub use pattern::{FiringPattern, Pattern};
pub use reading::{Echo, Reading, Sensor};
pub use replay::{ReplayError, replay};
pub use ros2::{Marker, Placement, Shape, Transform};
pub use sink::{Guess, Report, Skipped};
pub use survey::{PathSettings, Surveyed, survey};
pub use weighed::Weighed;
pub use write::McapWriter;

/// Reads a log from beginning to end, and calls `each` with the sensors so far and each reading, in the order in which
/// they were recorded. The form shows in the first bytes, also of a file that is packed as a whole, else in the ending
/// of its name; of text, in its lines. [`Report::guesses`] lists what was guessed.
///
/// A log without sensors is no error: [`Report::sensors`] is empty then, and [`Report::skipped`] says what was found.
///
/// # Errors
/// A file that cannot be opened, a folder without bag files, a form that is known and not read, or an option that does
/// not fit the log. Of a log that is damaged, what can be read is.
pub fn read_log(
    file: &Path,
    options: &Options,
    mut each: impl FnMut(&[Sensor], &Reading),
) -> Result<Report, FileError> {
    let mut sink = sink::Sink::new(options, &mut each);
    if file.is_dir() {
        "a ROS 2 bag".clone_into(&mut sink.report.form);
        sink.has(options::Parts::Topics);
        rosbag2::read(file, &mut sink)?;
        return Ok(sink.finish(file));
    }
    let form = form::Form::of_file(file)?;
    form.name().clone_into(&mut sink.report.form);
    read_form(file, file, form, options, &mut sink)?;
    Ok(sink.finish(file))
}

/// Reads a file of this form; `name` stands in errors.
fn read_form(
    file: &Path,
    name: &Path,
    form: form::Form,
    options: &Options,
    sink: &mut sink::Sink<'_>,
) -> Result<(), FileError> {
    let failed = |error: std::io::Error| FileError::reading(name, &error);
    if matches!(form, form::Form::Mcap | form::Form::Ros1 | form::Form::Sqlite) {
        sink.has(options::Parts::Topics);
    }
    match form {
        form::Form::Mcap => mcap::read(file, false, sink),
        form::Form::Ros1 => ros1::read(file, sink),
        form::Form::Sqlite => rosbag2::read_sqlite(file, false, sink),
        form::Form::Text => text::read(File::open(file).map_err(failed)?, name, options, sink),
        form::Form::Serial => serial::read(File::open(file).map_err(failed)?, name, options, sink),
        form::Form::Foreign(foreign) => Err(foreign.refuse(name)),
        form::Form::Packed(packing) => {
            let opened = BufReader::new(File::open(file).map_err(failed)?);
            read_unpacked(packing.unpack(opened).map_err(failed)?, name, packing, options, sink)
        }
    }
}

/// Reads what comes out of a packed file: text at once, a bag by way of a temporary file.
fn read_unpacked(
    mut input: impl Read,
    name: &Path,
    packing: form::Packing,
    options: &Options,
    sink: &mut sink::Sink<'_>,
) -> Result<(), FileError> {
    let failed = |error: std::io::Error| FileError::reading(name, &error);
    let (mut first, mut error) = (Vec::new(), None);
    form::UntilError::new(&mut input, &mut error).take(512).read_to_end(&mut first).map_err(failed)?;
    let stem = name.file_stem().map_or(name, Path::new);
    let form = form::Form::of(&first, stem);
    let input = first.as_slice().chain(input);
    match form {
        form::Form::Text if error.is_none() => {
            text::read(form::UntilError::new(input, &mut error), name, options, sink)?;
        }
        form::Form::Serial => {
            form.name().clone_into(&mut sink.report.form);
            serial::read(form::UntilError::new(input, &mut error), name, options, sink)?;
        }
        form::Form::Packed(_) => return Err(FileError::new(name, "packed twice; expected once: unpack it first")),
        form::Form::Text => {}
        form::Form::Foreign(foreign) => return Err(foreign.refuse(name)),
        form::Form::Mcap | form::Form::Ros1 | form::Form::Sqlite => {
            let (unpacked, failed_at) = form::to_file(input, "bag").map_err(failed)?;
            error = error.or(failed_at);
            form.name().clone_into(&mut sink.report.form);
            read_form(unpacked.path(), name, form, options, sink)?;
        }
    }
    sink.report.form = format!("{}, packed by {}", sink.report.form, packing.name());
    if let Some(error) = error {
        sink.damage(name, None, format!("it cannot be unpacked to its end: {error}; what comes before was read"));
    }
    Ok(())
}

/// Reads a log of text, as [`read_log`] does, from any reader; `file` stands in errors.
///
/// # Errors
/// As [`read_log`] for text.
pub fn read_text(
    input: impl Read,
    file: &Path,
    options: &Options,
    mut each: impl FnMut(&[Sensor], &Reading),
) -> Result<Report, FileError> {
    let mut sink = sink::Sink::new(options, &mut each);
    text::read(input, file, options, &mut sink)?;
    Ok(sink.finish(file))
}

/// The listing of the crate's README compiles and holds.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
