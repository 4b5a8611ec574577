//! Where readers of files hand in messages: finds out which sensor each reading is of, counts, and notes what is lost.

use std::fmt;
use std::path::Path;

use crate::options::{Options, Parts};
use crate::pattern::{FiringPattern, Stamps};
use crate::reading::{Echo, LogReading, Sensor};
use eeruf_files::FileError;

/// Contents of a log, and what of it could not be read.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// The form of the file.
    pub form: String,
    /// The sensors, in the order in which they were first met.
    pub sensors: Vec<Sensor>,
    /// Number of messages with readings there that were (rows, of a CSV file).
    pub messages: u64,
    /// Damage, as far as it is known.
    pub damage: Vec<FileError>,
    /// Topics without readings, with their types, and how many topics had none at all.
    pub skipped: Vec<Skipped>,
    /// Guesses about what the log does not say.
    pub guesses: Vec<Guess>,
    /// Values that were read and seem to be wrong.
    pub warnings: Vec<String>,
    /// Firing pattern of the sensors, by the times of the readings.
    pub firing: FiringPattern,
}

/// A guess about a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guess {
    /// The subject of the guess.
    pub what: String,
    /// The guess, and what it is made by.
    pub value: String,
    /// The options that override it.
    pub option: String,
}

/// A topic whose messages, or some of them, hold no readings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    /// The topic.
    pub topic: String,
    /// Reason why its messages were left out.
    pub why: String,
    /// Number of messages that were left out, where they were counted.
    pub messages: u64,
}

impl Report {
    /// The name of each sensor: its topic, with the frame where several sensors share a topic.
    pub fn names(&self) -> Vec<String> {
        let of_topic = |topic: &str| self.sensors.iter().filter(|sensor| sensor.topic == topic).count();
        self.sensors.iter().map(|sensor| sensor.name(of_topic(&sensor.topic) == 1)).collect()
    }
}

/// Damage beyond this is counted, not listed.
const LISTED: usize = 100;

/// Knowledge of the topics of a log.
#[cfg(feature = "files")]
#[derive(Default)]
pub(crate) struct Topics {
    /// Number of messages that were found, of whatever type and whether or not they could be read.
    pub(crate) found: u64,
    pub(crate) buffer: Vec<LogReading>,
    /// Topics with readings.
    pub(crate) names: std::collections::HashSet<String>,
    /// Topics of which one warning is enough.
    pub(crate) warned: std::collections::HashSet<String>,
}

/// Takes messages, and hands on readings.
pub(crate) struct Sink<'a> {
    pub(crate) report: Report,
    pub(crate) each: &'a mut dyn FnMut(&Report, &LogReading),
    more_damage: u64,
    pub(crate) options: &'a Options,
    #[cfg(feature = "files")]
    pub(crate) of_topics: Topics,
    pub(crate) stamps: Stamps,
    /// All readings of a row, or of a message, have its time.
    pub(crate) one_time_a_row: bool,
    /// Readings have times of their own.
    pub(crate) has_own_times: bool,
}

impl<'a> Sink<'a> {
    pub(crate) fn new(options: &'a Options, each: &'a mut dyn FnMut(&Report, &LogReading)) -> Self {
        Self {
            report: Report::default(),
            each,
            more_damage: 0,
            options,
            #[cfg(feature = "files")]
            of_topics: Topics::default(),
            stamps: Stamps::default(),
            one_time_a_row: false,
            has_own_times: false,
        }
    }

    /// The form of the log.
    pub(crate) fn form(&mut self, form: &str) {
        form.clone_into(&mut self.report.form);
    }

    /// Warns of options that choose from parts which the log does not have.
    pub(crate) fn has(&mut self, parts: Parts) {
        self.report.warnings.extend(self.options.without_effect(parts));
    }

    /// A reading that came in no message.
    pub(crate) fn reading(&mut self, reading: &LogReading) {
        self.stamps.push(reading.sensor, reading.at_ns, finite(reading));
        (self.each)(&self.report, reading);
    }

    /// A line of a text cannot be read.
    pub(crate) fn damaged_line(&mut self, file: &Path, line: u64, message: impl fmt::Display) {
        self.note(FileError::new(file, message).at_line(Some(line)));
    }

    /// A part of a file cannot be read.
    #[cfg(feature = "files")]
    pub(crate) fn damage(&mut self, file: &Path, at: Option<u64>, message: impl fmt::Display) {
        self.note(FileError::new(file, message).at_byte(at));
    }

    /// Lists damage, as far as there is room for it.
    pub(crate) fn note(&mut self, damage: FileError) {
        if self.report.damage.len() < LISTED {
            self.report.damage.push(damage);
        } else {
            self.more_damage += 1;
        }
    }

    pub(crate) fn finish(mut self, file: &Path) -> Report {
        if self.more_damage > 0 {
            let message = format!("{} more places that cannot be read", self.more_damage);
            self.report.damage.push(FileError::new(file, message));
        }
        self.report.firing = self.stamps.pattern(self.report.sensors.len(), self.one_time_a_row && !self.has_own_times);
        self.report
    }
}

pub(crate) fn finite(reading: &LogReading) -> Option<f64> {
    match reading.echo() {
        Echo::At(range_m) => Some(range_m),
        _ => None,
    }
}
