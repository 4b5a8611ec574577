//! Reads readings from text of every shape: tables, lines of pairs, JSON, with or without header, whole or damaged.
//!
//! A damaged line yields no reading: a line with a cell that is neither a number nor a word for no echo, with more or
//! fewer cells than the others, or a last line without a line break that is too short.

mod boot;
mod chosen;
mod column;
mod esphome;
mod groups;
mod guesses;
mod lines;
mod messages;
mod plan;
mod recognise;
mod repeats;
mod rows;
mod sample;
mod shape;
mod source;
mod validity;

use std::io::Read;
use std::path::Path;

use crate::options::Parts;
use crate::sink::{Sink, Skipped};
use eeruf_files::FileError;

pub(crate) use source::Source;
#[cfg(feature = "files")]
pub(crate) use {
    lines::Line,
    sample::is_comment,
    shape::{Separator, separated},
};

/// Number of lines, and of bytes, that are examined before the first reading.
const SAMPLE: (usize, usize) = (1000, 1 << 18);

/// Reads a text; `file` is used in errors.
pub(crate) fn read(input: impl Read, file: &Path, sink: &mut Sink<'_>) -> Result<(), FileError> {
    let options = sink.options;
    let failed = |error: std::io::Error| FileError::reading(file, &error);
    let mut source = Source::new(Box::new(input)).map_err(failed)?;
    let (mut sample, mut bytes) = (vec![], 0);
    while sample.len() < SAMPLE.0 && bytes < SAMPLE.1 {
        let Some(line) = source.next().map_err(failed)? else { break };
        bytes += line.text.len();
        sample.push(line);
    }
    if let Some(form) = source.of_records().filter(|_| sample.is_empty()) {
        form.clone_into(&mut sink.report.form);
        sink.report.skipped.push(Skipped::new(form, "no records with ranges"));
        return Ok(());
    }
    if sample.iter().all(|line| line.text.trim().is_empty()) && sample.len() < SAMPLE.0 {
        return Err(FileError::new(file, "the file is empty; expected lines with readings"));
    }
    let plan = recognise::recognise(file, &sample, (source.of_records(), source.is_of_objects()), options)?;
    sink.report.form.clone_from(&plan.form);
    sink.has(Parts::Columns);
    sink.report.guesses.extend(plan.guesses.iter().cloned());
    sink.report.warnings.extend(plan.implausible.clone());
    sink.report.skipped.extend(plan.skipped.iter().cloned());
    let mut rows = rows::Rows::new(file, plan, options, sink);
    for line in sample {
        rows.line(&line);
    }
    while let Some(line) = source.next().map_err(failed)? {
        rows.line(&line);
    }
    rows.end(source.left_out);
    // Columns of which no row had a reading are no sensors.
    if sink.report.messages == 0 {
        sink.report.sensors.clear();
    }
    Ok(())
}
