//! Firing logs in MCAP: messages `eeruf_msgs/msg/Firing` of ROS 2.

use std::collections::BTreeSet;
use std::path::Path;

use super::bag;
use super::firing_text::{MAX_SENSORS, kind_of};
use super::form::Opened;
use super::mcap::Mcap;
use super::ros2::{FIRING, definition};
use super::schema::{Decoder, Encoding, Schema};
use crate::firings::{Firing, FiringLog};
use crate::options::Options;
use crate::sink::Sink;
use eeruf_files::FileError;

/// The fields of the message, in the order in which they are decoded.
const FIELDS: [&str; 9] = ["sensor", "fired_us", "period", "phase", "has_echo", "t_echo_us", "g", "clock", "reading"];

/// The firings of a file so far.
struct FiringMessages {
    decoder: Option<Decoder>,
    /// The topics that have messages.
    topics: BTreeSet<String>,
    clock: String,
    firings: Vec<Firing>,
    has_other: bool,
}

/// Reads the firings of a file, up to damage; `file` is used in errors.
pub(crate) fn read(input: &mut Opened<'_>, file: &Path) -> Result<FiringLog, FileError> {
    let copy = input.copied().map_err(|error| FileError::reading(file, &error))?;
    let (options, mut each) = (Options::default(), |_: &_, _: &_| {});
    let decoder = Schema::parse(&definition(FIRING)).and_then(|schema| schema.decoder(&FIELDS));
    let (topics, firings) = (BTreeSet::new(), vec![]);
    let mut found = FiringMessages { decoder, topics, clock: String::new(), firings, has_other: false };
    let mut message = |topic: &str, data: &[u8]| found.message(topic, data);
    let mut sink = Sink::new(&options, &mut each);
    sink.of_topics.firings = Some(&mut message);
    bag::read(Mcap::new(false), &mut copy.as_file(), file, &mut sink)?;
    let damage = sink.report.damage.first().map(|damage| damage.message().to_owned());
    found.log(damage, file)
}

impl FiringMessages {
    fn message(&mut self, topic: &str, data: &[u8]) {
        let decoded = self.decoder.as_ref().and_then(|decoder| decoder.decode(Encoding::Cdr, data, 1));
        let decoded = decoded.filter(|found| found.number(0) < f64::from(MAX_SENSORS));
        self.has_other |= decoded.is_none();
        let Some(found) = decoded else { return };
        if !self.topics.contains(topic) {
            self.topics.insert(topic.to_owned());
        }
        if self.clock.is_empty() {
            self.clock = found.text(7);
        }
        self.firings.push(Firing {
            sensor: found.number(0) as u8,
            fired_us: found.number(1) as i64,
            period: found.number(2) as u32,
            phase: found.number(3) as u8,
            t_echo_us: Some(found.number(5) as u32).filter(|_| found.number(4) != 0.0),
            reading: kind_of(&found.text(8)),
            g_us_ms: Some(found.number(6) as f32).filter(|g| *g >= 0.0),
        });
    }

    fn log(self, damage: Option<String>, file: &Path) -> Result<FiringLog, FileError> {
        if self.has_other {
            let expected = "expected sensor (0 to 63), fired_us, period, phase and t_echo_us";
            return Err(FileError::new(file, format!("a message of {FIRING} that is no firing; {expected}")));
        }
        if self.firings.is_empty() {
            let why = damage.map_or(String::new(), |damage| format!("; {damage}"));
            return Err(FileError::new(file, format!("0 firings; expected messages of the type {FIRING}{why}")));
        }
        if self.topics.len() > 1 {
            let topics = self.topics.into_iter().collect::<Vec<_>>().join(", ");
            return Err(FileError::new(file, format!("firings of several rings: {topics}; expected one topic")));
        }
        let clock = if self.clock.is_empty() { "unnamed" } else { &self.clock };
        Ok(FiringLog { damage, ..FiringLog::new(clock, self.firings) })
    }
}
