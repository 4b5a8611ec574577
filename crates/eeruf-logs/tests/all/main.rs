//! Logs of every kind, whole and damaged.

mod bags;
mod csv;
mod damage;
mod diagnose;
mod diagnose_driving;
mod diagnose_rooms;
mod firing_logs;
mod flight;
mod forms;
mod mutated;
mod random;
mod replay;
mod survey;
mod verdicts;
mod worlds;
mod written;

use std::io::Cursor;
use std::path::{Path, PathBuf};

use eeruf_files::FileError;
use eeruf_logs::{LogReading, Options, Report, Sensor, read_from, read_log, read_stream};

/// The bags that `write_bags.py` writes.
const BAGS: [&str; 10] = [
    "ros1-none.bag",
    "ros1-bz2.bag",
    "ros1-lz4.bag",
    "sqlite-humble",
    "sqlite-jazzy",
    "sqlite-jazzy-packed",
    "mcap-humble",
    "mcap-jazzy",
    "mcap-jazzy-packed",
    "mcap-jazzy-zstd",
];

/// Copies a bag into a folder; `SQLite` bags are made from SQL.
fn bag(name: &str, folder: &Path) -> PathBuf {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bags").join(name);
    let to = folder.join(name);
    if from.is_file() {
        std::fs::copy(from, &to).unwrap();
        return to;
    }
    std::fs::create_dir_all(&to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let entry = entry.unwrap().path();
        let copy = to.join(entry.file_name().unwrap());
        if entry.extension().is_some_and(|ending| ending == "sql") {
            let database = rusqlite::Connection::open(copy.with_extension("db3")).unwrap();
            database.execute_batch(&std::fs::read_to_string(entry).unwrap()).unwrap();
        } else {
            std::fs::copy(entry, copy).unwrap();
        }
    }
    to
}

/// All readings of a log, checked to be the same from its file, from memory, and as a stream.
fn read(file: &Path, options: &Options) -> Result<(Report, Vec<LogReading>), FileError> {
    let of_file = read_by(|each| read_log(file, options, each));
    if let Ok(bytes) = std::fs::read(file) {
        // Readings may be no numbers, which equal nothing.
        let said = |read: &Result<(Report, Vec<LogReading>), FileError>| format!("{read:?}");
        let in_memory = read_by(|each| read_from(Cursor::new(&bytes), file, options, each));
        let streamed = read_by(|each| read_stream(&bytes[..], file, options, each));
        assert_eq!((said(&in_memory), said(&streamed)), (said(&of_file), said(&of_file)));
    }
    of_file
}

fn read_by(
    by: impl FnOnce(&mut dyn FnMut(&Report, &LogReading)) -> Result<Report, FileError>,
) -> Result<(Report, Vec<LogReading>), FileError> {
    let mut readings = Vec::new();
    let mut met = Vec::<Sensor>::new();
    let report = by(&mut |report, reading| {
        let sensors = &report.sensors;
        assert!(reading.sensor < sensors.len() && sensors.starts_with(&met));
        if met.len() < sensors.len() {
            met.clone_from(sensors);
        }
        readings.push(*reading);
    })?;
    assert_eq!(report.sensors, met);
    Ok((report, readings))
}
