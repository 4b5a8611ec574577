//! Logs of every form, from files, streams and sources with random access.

use std::fs::File;
use std::io::{self, BufReader, Read, Seek};
use std::path::Path;

use eeruf_files::FileError;

use crate::form::{self, Form, Packing, UntilError};
use crate::options::{self, Options};
use crate::reading::LogReading;
use crate::sink::{Report, Sink};
use crate::{bytes, flight, mcap, ros1, rosbag2, serial, text};

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
    let failed = |error: io::Error| FileError::reading(name, &error);
    let mut sink = Sink::new(options, &mut each);
    let form = Form::of(&form::first_bytes(&mut input).map_err(failed)?, name);
    input.rewind().map_err(failed)?;
    sink.form(form.name());
    read_anywhere(&mut input, name, form, options, &mut sink)?;
    Ok(sink.finish(name))
}

/// Reads a log from a stream such as a pipe, like [`read_log`]; `name` is used in errors. Text and frames of the serial
/// line are read as they arrive; a bag is copied into a temporary file first.
///
/// # Errors
/// See [`read_log`].
pub fn read_stream(
    mut input: impl Read,
    name: &Path,
    options: &Options,
    mut each: impl FnMut(&Report, &LogReading),
) -> Result<Report, FileError> {
    let mut sink = Sink::new(options, &mut each);
    let first = form::first_bytes(&mut input).map_err(|error| FileError::reading(name, &error))?;
    let form = Form::of(&first, name);
    sink.form(form.name());
    read_in_order(&mut first.as_slice().chain(input), name, form, options, &mut sink)?;
    Ok(sink.finish(name))
}

/// Reads a log of this form from a source with random access; `name` is used in errors.
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

/// Reads a bag by way of a temporary file; returns the error that ended the bag, if any.
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
        // Nothing could be unpacked.
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
