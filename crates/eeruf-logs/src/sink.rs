//! Receives messages from readers of files, assigns readings to sensors, counts them, and notes damage.

use std::fmt;
use std::path::Path;

use crate::options::{Options, Parts};
use crate::pattern::{FiringPattern, Stamps};
use crate::reading::{Echo, LogReading, Sensor};
use eeruf_files::FileError;

/// Contents of a log, with its damage.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// The form of the file.
    pub form: String,
    /// The sensors, in the order of their first readings.
    pub sensors: Vec<Sensor>,
    /// Number of messages with readings (for a CSV file, rows).
    pub messages: u64,
    /// The known damage.
    pub damage: Vec<FileError>,
    /// Topics without readings, with their types and number of messages.
    pub skipped: Vec<Skipped>,
    /// Guesses about properties that the log does not state.
    pub guesses: Vec<Guess>,
    /// Warnings about values that seem to be wrong.
    pub warnings: Vec<String>,
    /// Firing pattern of the sensors, from the times of the readings.
    pub firing: FiringPattern,
}

/// A guess about a log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Guess {
    /// The subject of the guess.
    pub what: String,
    /// The guessed value, and the basis of the guess.
    pub value: String,
    /// The options that override the guess.
    pub option: String,
}

/// A topic with messages that hold no readings.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Skipped {
    /// The topic.
    pub topic: String,
    /// Reason why the topic's messages were left out.
    pub why: String,
    /// Number of omitted messages, if they were counted.
    pub messages: u64,
}

impl Skipped {
    pub(crate) fn new(topic: impl Into<String>, why: impl Into<String>) -> Self {
        Self { topic: topic.into(), why: why.into(), messages: 0 }
    }
}

impl Report {
    /// The name of each sensor: its topic, with the frame where several sensors share a topic.
    pub fn names(&self) -> Vec<String> {
        let of_topic = |topic: &str| self.sensors.iter().filter(|sensor| sensor.topic == topic).count();
        self.sensors.iter().map(|sensor| sensor.name(of_topic(&sensor.topic) == 1)).collect()
    }
}

/// Largest number of listed damages; further ones are only counted.
const LISTED: usize = 100;

/// A receiver of messages, each with its topic.
#[cfg(feature = "files")]
pub(crate) type Messages<'a> = &'a mut dyn FnMut(&str, &[u8]);

/// Knowledge of the topics of a log.
#[cfg(feature = "files")]
#[derive(Default)]
pub(crate) struct Topics<'a> {
    /// Number of messages of any type, readable or not.
    pub(crate) found: u64,
    pub(crate) buffer: Vec<LogReading>,
    /// The receiver of a ring's firings, if they are asked for.
    pub(crate) firings: Option<Messages<'a>>,
    /// Topics with readings.
    pub(crate) names: std::collections::HashSet<String>,
    /// Topics about which a warning was given.
    pub(crate) warned: std::collections::HashSet<String>,
}

/// A receiver of messages that passes on their readings.
pub(crate) struct Sink<'a> {
    pub(crate) report: Report,
    pub(crate) each: &'a mut dyn FnMut(&Report, &LogReading),
    more_damage: u64,
    pub(crate) options: &'a Options,
    #[cfg(feature = "files")]
    pub(crate) of_topics: Topics<'a>,
    pub(crate) stamps: Stamps,
    /// True if all readings of a row or message share its time.
    pub(crate) one_time_a_row: bool,
    /// True if readings have times of their own.
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

    /// Notes the form of the log.
    pub(crate) fn form(&mut self, form: &str) {
        form.clone_into(&mut self.report.form);
    }

    /// Warns about options for parts that the log does not have.
    pub(crate) fn has(&mut self, parts: Parts) {
        self.report.warnings.extend(self.options.without_effect(parts));
    }

    /// Adds a reading that is not part of a message.
    pub(crate) fn reading(&mut self, reading: &LogReading) {
        self.stamps.push(reading.sensor, reading.at_ns, finite(reading));
        (self.each)(&self.report, reading);
    }

    /// Notes a damaged line of a text.
    pub(crate) fn damaged_line(&mut self, file: &Path, line: u64, message: impl fmt::Display) {
        self.note(FileError::new(file, message).at_line(Some(line)));
    }

    /// Notes a damaged part of a file.
    #[cfg(feature = "files")]
    pub(crate) fn damage(&mut self, file: &Path, at: Option<u64>, message: impl fmt::Display) {
        self.note(FileError::new(file, message).at_byte(at));
    }

    /// Lists damage, or only counts it if the list is full.
    pub(crate) fn note(&mut self, damage: FileError) {
        if self.report.damage.len() < LISTED {
            self.report.damage.push(damage);
        } else {
            self.more_damage += 1;
        }
    }

    pub(crate) fn finish(mut self, file: &Path) -> Report {
        if self.more_damage > 0 {
            let message = format!("places that cannot be read, beyond these: {}", self.more_damage);
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
