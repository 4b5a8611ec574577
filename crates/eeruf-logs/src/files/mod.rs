//! Logs of every form, from files, streams and sources with random access.

mod bag;
mod bytes;
mod cdr;
mod firing_files;
pub(crate) mod firing_messages;
mod firing_text;
mod flight;
mod form;
mod judging;
mod mcap;
mod message;
mod ros1;
mod ros2;
mod rosbag2;
mod schema;
mod serial;
mod topics;
mod unzstd;
mod write;

use std::fs::File;
use std::io::{self, Read, Seek};
use std::path::Path;

use eeruf_files::FileError;

use crate::options::{Options, Parts};
use crate::reading::LogReading;
use crate::sink::{Report, Sink};
use crate::text;
use form::{Form, Opened};
pub use judging::{Counted, Judging, RangeJudge};
use mcap::Mcap;
use ros1::Ros1;
pub use ros2::{Marker, Placement, Shape, Transform};
pub use write::McapWriter;

/// Reads a log from beginning to end, and calls `each` with the report so far, which has the sensors, and each reading,
/// in the order in which they were recorded. The form is recognised by the first bytes, even of a file that is packed
/// as a whole, or by the ending of its name; that of text by its lines. [`Report::guesses`] lists what was guessed.
///
/// A log without sensors is no error: [`Report::sensors`] is then empty, and [`Report::skipped`] says what was found.
///
/// # Errors
/// A file that cannot be opened, a folder without bag files, a known form that cannot be read, or an option that does
/// not fit the log. The readable parts of a damaged log are read.
pub fn read_log(
    file: &Path,
    options: &Options,
    mut each: impl FnMut(&Report, &LogReading),
) -> Result<Report, FileError> {
    if file.as_os_str() == "-" {
        return read_stream(io::stdin().lock(), file, options, each);
    }
    let failed = |error: io::Error| FileError::reading(file, &error);
    let mut sink = Sink::new(options, &mut each);
    if file.is_dir() {
        sink.form("a ROS 2 bag");
        sink.has(Parts::Topics);
        rosbag2::read(file, &mut sink)?;
        return Ok(sink.finish(file));
    }
    let mut opened = File::open(file).map_err(failed)?;
    // A pipe is read once.
    if opened.metadata().is_ok_and(|of| !of.is_file()) {
        read_in_order(opened, file, &mut sink)?;
    } else if Form::of_file(file)? == Form::Sqlite {
        sink.form(Form::Sqlite.name());
        sink.has(Parts::Topics);
        rosbag2::read_sqlite(file, file, false, &mut sink)?;
    } else {
        read_anywhere(&mut opened, file, &mut sink)?;
    }
    Ok(sink.finish(file))
}

/// Reads a log that is not a local file, like [`read_log`]; `name` is used in errors, and its ending helps if the first
/// bytes do not show the form. An `SQLite` file is copied into a temporary one first.
///
/// # Errors
/// See [`read_log`].
pub fn read_from(
    mut input: impl Read + Seek,
    name: &Path,
    options: &Options,
    mut each: impl FnMut(&Report, &LogReading),
) -> Result<Report, FileError> {
    let mut sink = Sink::new(options, &mut each);
    read_anywhere(&mut input, name, &mut sink)?;
    Ok(sink.finish(name))
}

/// Reads a log from a stream such as a pipe, like [`read_log`]; `name` is used in errors. Text and frames of the serial
/// line are read as they arrive; a bag is copied into a temporary file first.
///
/// # Errors
/// See [`read_log`].
pub fn read_stream(
    input: impl Read,
    name: &Path,
    options: &Options,
    mut each: impl FnMut(&Report, &LogReading),
) -> Result<Report, FileError> {
    let mut sink = Sink::new(options, &mut each);
    read_in_order(input, name, &mut sink)?;
    Ok(sink.finish(name))
}

/// Reads a log from a source with random access; `name` is used in errors.
fn read_anywhere(input: &mut dyn bytes::Input, name: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let failed = |error: io::Error| FileError::reading(name, &error);
    let form = Form::of(&form::first_bytes(&mut *input).map_err(failed)?, name);
    input.rewind().map_err(failed)?;
    sink.form(form.name());
    match form {
        Form::Mcap | Form::Ros1 => read_bag(form, input, name, sink),
        _ => read_in_order(input, name, sink),
    }
}

fn read_bag(form: Form, input: &mut dyn bytes::Input, name: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    sink.has(Parts::Topics);
    match form {
        Form::Mcap => bag::read(Mcap::new(false), input, name, sink),
        _ => bag::read(Ros1, input, name, sink),
    }
}

/// Reads a log from its beginning to its end.
fn read_in_order(input: impl Read, name: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let mut opened = Opened::new(input, name).map_err(|error| FileError::reading(name, &error))?;
    sink.form(opened.form.name());
    match opened.form {
        // Nothing could be unpacked.
        Form::Text if opened.error.is_some() => {}
        Form::Text => text::read(&mut opened, name, sink)?,
        Form::Serial => serial::read(&mut opened, name, sink)?,
        Form::Flight(flight) => flight::read(flight, &mut opened, name, sink)?,
        Form::Foreign(foreign) => return Err(foreign.refuse(name)),
        Form::Packed(_) => return Err(FileError::new(name, "packed twice; expected once: unpack it first")),
        Form::Mcap | Form::Ros1 | Form::Sqlite => read_copy(&mut opened, name, sink)?,
    }
    if let Some(packing) = opened.packing {
        sink.form(&format!("{}, packed by {}", sink.report.form, packing.name()));
    }
    opened.tell(name, sink);
    Ok(())
}

/// Reads a bag by way of a temporary file.
fn read_copy(opened: &mut Opened<'_>, name: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let copy = opened.copied().map_err(|error| FileError::reading(name, &error))?;
    if opened.form == Form::Sqlite {
        sink.has(Parts::Topics);
        return rosbag2::read_sqlite(copy.path(), name, false, sink);
    }
    read_bag(opened.form, &mut copy.as_file(), name, sink)
}
