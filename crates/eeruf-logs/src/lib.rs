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
//! `Range` has had a `variance` since ROS 2 Iron: the file's schema says whether it is there, or else the message's
//! length. A `LaserScan` counts as a ring of sonars if it has at most 64 beams, or if its topic is asked for; each beam
//! is a sensor. Sensors are counted from 0. Units, times and values for no echo are guessed if the log does not state
//! them; [`Report::guesses`] lists each guess with the option that overrides it.
//!
//! Damaged or cut parts are skipped and listed in [`Report::damage`]; the rest is read.
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

mod diagnose;
mod doctor;
#[cfg(feature = "files")]
mod files;
mod firings;
mod names;
mod options;
mod paths;
mod pattern;
mod reading;
mod replay;
mod sink;
mod statistics;
mod survey;
mod symptom;
mod text;
mod value;

use std::io::Read;
use std::path::Path;

use eeruf_files::FileError;
use sink::Sink;

pub use diagnose::{Diagnosis, Hearing, Named, Settings, Share, Timing, diagnose, diagnose_while, timing};
pub use doctor::{Doctor, Examination, LogVerdict, Suspect};
#[cfg(feature = "files")]
pub use files::{
    Counted, Judging, Marker, McapWriter, Placement, RangeJudge, Shape, Transform, read_from, read_log, read_stream,
};
pub use firings::{Firing, FiringLog};
pub use options::{FieldChoice, Options, RangeUnit, Table, TimeUnit};
pub use paths::{FoundPath, KeepGoing};
pub use pattern::{FiringPattern, Pattern};
pub use reading::{Echo, LogReading, Sensor};
pub use replay::{FlowSettings, Replayed, replay_flow};
pub use sink::{Guess, Report, Skipped};
pub use survey::{PathSettings, Surveyed, survey, survey_while};
pub use symptom::{Finding, Symptom};

/// Reads a text from beginning to end, and calls `each` as [`read_log`] does; `name` is used in errors. It needs no
/// feature, so that a page in a browser can read pasted text.
///
/// # Errors
/// A text without lines, or an option that does not fit it.
pub fn read_text(
    input: impl Read,
    name: &Path,
    options: &Options,
    mut each: impl FnMut(&Report, &LogReading),
) -> Result<Report, FileError> {
    let mut sink = Sink::new(options, &mut each);
    sink.form("text");
    text::read(input, name, &mut sink)?;
    Ok(sink.finish(name))
}

/// Doctest of the crate's README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
