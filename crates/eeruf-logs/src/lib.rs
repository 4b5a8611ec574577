//! Ranges of ultrasonic sensors from the logs that robots keep, one reading after the other, in memory that does not
//! grow with the file.
//!
//! | log | what is read |
//! |---|---|
//! | MCAP | `sensor_msgs/Range` and `LaserScan` in `cdr` and `ros1`; chunks of zstd, lz4 or neither |
//! | ROS 2 bag (a folder) | the same, from its MCAP or `SQLite` files; messages packed by zstd too |
//! | ROS 1 bag | the same, format 2.0; chunks of bz2, lz4 or neither |
//! | CSV | a column for each sensor, or one that says whose reading a row is |
//!
//! `Range` has had a `variance` since ROS 2 Iron: the schema in the file says whether it is there, else the message's
//! length. A `LaserScan` counts as a ring of sonars if it has at most 64 beams; each beam is a sensor. Sensors are
//! counted from 0.
//!
//! What is damaged or cut off is skipped, and said in [`Report::damage`]; all the rest is read.
//!
//! ```
//! use eeruf_logs::{Echo, Options, read_log};
//! let file = std::env::temp_dir().join("eeruf-logs-example.csv");
//! std::fs::write(&file, "t,left,right\n0.00,1.20,\n0.06,1.21,2.50\n")?;
//! let mut options = Options::default();
//! options.table.time = Some("t".to_owned());
//! let mut echoes = Vec::new();
//! let report = read_log(&file, &options, |_sensors, reading| echoes.push((reading.sensor, reading.echo())))?;
//! assert_eq!(report.names(), ["left", "right"]);
//! assert_eq!(echoes[1..], [(0, Echo::At(1.21)), (1, Echo::Nothing), (1, Echo::At(2.5))]);
//! # std::fs::remove_file(&file)?;
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod bytes;
mod chunks;
mod diagnose;
mod error;
mod firing_files;
mod firing_messages;
mod firings;
mod mcap;
mod message;
mod options;
mod reading;
mod replay;
mod ros1;
mod rosbag2;
mod sink;
mod survey;
mod table;
mod unzstd;
mod weighed;
mod write;

use std::fs::File;
use std::io::Read;
use std::path::Path;

pub use diagnose::{
    AlignError, Alignment, Diagnosis, Fault, FoundPath, Hearing, Named, Settings, Share, Timing, TimingError, align,
    diagnose, timing,
};
pub use error::{Damage, LogError};
pub use firings::{Firing, FiringLog};
pub use options::{Options, RangeUnit, Table, TimeUnit};
pub use reading::{Echo, Reading, Sensor};
pub use replay::{ReplayError, replay};
pub use sink::{Report, Skipped};
pub use survey::{PathSettings, Surveyed, survey};
pub use weighed::Weighed;
pub use write::McapWriter;

/// Reads a log from beginning to end, and calls `each` with the sensors so far and each reading, in the order in which
/// they were recorded. The kind of log shows in its first bytes, else in the ending of its name.
///
/// # Errors
/// A file that is not there or cannot be opened, a folder without bag files, and for CSV a value that is none, with its
/// line. Of a bag that is damaged, what can be read is.
pub fn read_log(file: &Path, options: &Options, mut each: impl FnMut(&[Sensor], &Reading)) -> Result<Report, LogError> {
    let mut sink = sink::Sink::new(&mut each);
    if file.is_dir() {
        rosbag2::read(file, &mut sink)?;
        return Ok(sink.finish(file));
    }
    let mut first = Vec::new();
    let opened = File::open(file).map_err(|error| LogError::new(file, error))?;
    opened.take(16).read_to_end(&mut first).map_err(|error| LogError::new(file, error))?;
    let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    if first.starts_with(&mcap::MAGIC) || ending == "mcap" {
        mcap::read(file, false, &mut sink)?;
    } else if first.starts_with(ros1::MAGIC) || ending == "bag" {
        ros1::read(file, &mut sink)?;
    } else if first.starts_with(rosbag2::SQLITE_MAGIC) || ending == "db3" {
        rosbag2::read_sqlite(file, false, &mut sink)?;
    } else {
        table::read(file, options, &mut sink)?;
    }
    Ok(sink.finish(file))
}

/// As [`read_log`] reads a CSV file, from whatever can be read; `file` stands in errors.
///
/// # Errors
/// As [`read_log`] for CSV.
pub fn read_csv(
    input: impl Read,
    file: &Path,
    options: &Options,
    mut each: impl FnMut(&[Sensor], &Reading),
) -> Result<Report, LogError> {
    let mut sink = sink::Sink::new(&mut each);
    table::read_from(input, file, options, &mut sink)?;
    Ok(sink.finish(file))
}

/// The listing of the crate's README compiles and holds.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
