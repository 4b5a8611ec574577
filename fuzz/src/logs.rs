//! Robot logs: CSV, logs of firings, and bags, recognised by the program's rules. Each reading must belong to a known
//! sensor, and each error must take one line.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use eeruf_logs::{Echo, FiringLog, Options, RangeUnit, Report, Table, TimeUnit, read_log, read_stream};

use crate::one_line;

static FOLDER: LazyLock<PathBuf> = LazyLock::new(crate::folder);

/// Reads a bag (`.mcap`, `.bag`, `.db3`, or the `metadata.yaml` next to one), recognised by its first bytes.
pub fn bags(bytes: &[u8]) {
    let metadata = b"rosbag2_bagfile_information";
    if bytes.starts_with(metadata) {
        let folder = FOLDER.join("bag");
        fs::create_dir_all(&folder).expect("a folder can be made");
        write(&folder.join("metadata.yaml"), bytes);
        return read(&folder);
    }
    // The file name's ending gives the format, so that a damaged beginning does not hide the rest.
    let ending = match bytes.first() {
        Some(b'#') => "bag",
        Some(b'S') => "db3",
        _ => "mcap",
    };
    let file = FOLDER.join("log").with_extension(ending);
    write(&file, bytes);
    read(&file);
}

fn write(file: &Path, bytes: &[u8]) {
    let mut opened = fs::File::create(file).expect("a file can be made");
    opened.write_all(bytes).expect("a file can be written");
}

fn read(file: &Path) {
    let mut readings = 0_u64;
    let report = read_log(file, &Options::default(), |report, reading| {
        let sensor = &report.sensors[reading.sensor];
        assert!(sensor.beam.is_none_or(|beam| beam < 4096));
        // Each echo is one of four kinds, and reading it does not fail.
        _ = reading.echo();
        readings += 1;
    });
    match report {
        Ok(report) => {
            assert!(report.messages == 0 || report.sensors.len() <= 4096 * report.messages as usize);
            assert!(readings >= report.sensors.len() as u64 && readings <= 4096 * report.messages);
            said(&report);
        }
        Err(error) => one_line(&error.to_string()),
    }
}

fn said(report: &Report) {
    assert!(report.damage.len() <= 101);
    for damage in &report.damage {
        one_line(damage.message());
    }
    assert_eq!(report.names().len(), report.sensors.len());
}

/// Reads a table in every way that its header allows, and as a log of firings.
pub fn tables(bytes: &[u8]) {
    let file = Path::new("file");
    let header = bytes.split(|&byte| byte == b'\n').next().unwrap_or_default();
    let names: Vec<String> =
        String::from_utf8_lossy(header).split(',').map(|name| name.trim().trim_matches('"').to_owned()).collect();
    let length = bytes.len();
    let (range_unit, time_unit) = (Some(RangeUnit::NAMES[length % 7].1), Some(TimeUnit::NAMES[length / 7 % 4].1));
    let wide = Table { range_unit, time_unit, ..Table::default() };
    let timed = Table { time: names.first().cloned(), ..wide.clone() };
    let long = match &names[..] {
        [time, sensor, range, ..] => Table {
            time: Some(time.clone()),
            sensor: Some(sensor.clone()),
            ranges: vec![range.clone()],
            ..wide.clone()
        },
        _ => timed.clone(),
    };
    for table in [wide, timed, long] {
        rows(bytes, file, &Options { table, ..Options::default() });
    }
    match FiringLog::read_from(bytes, file) {
        Ok(log) => {
            assert!((1..=64).contains(&log.sensors()) && log.firings.is_sorted_by_key(|firing| firing.fired_us));
            let mut written = Vec::new();
            log.write(&mut written).expect("a log can be written");
            assert_eq!(FiringLog::read_from(&*written, file).expect("what was written is a log"), log);
        }
        Err(error) => line(&error, bytes),
    }
}

fn rows(bytes: &[u8], file: &Path, options: &Options) {
    let mut readings = vec![];
    match read_stream(bytes, file, options, |_, reading| readings.push(*reading)) {
        Ok(report) => {
            let sensors = report.sensors.len();
            let mut of = vec![0; sensors];
            for reading in &readings {
                of[reading.sensor] += 1;
                // No echo is below zero, nor at or beyond the range that stands for silence.
                if let Echo::At(range_m) = reading.echo() {
                    assert!((0.0..options.no_echo_m).contains(&range_m), "{range_m} m");
                }
            }
            // A sensor has at most one reading in each row.
            assert!(of.iter().all(|&of| of <= report.messages), "{of:?} of {}", report.messages);
            assert!(sensors > 0 || !report.skipped.is_empty());
            said(&report);
        }
        Err(error) => line(&error, bytes),
    }
}

/// Checks that the line of an error, if it names one, exists.
fn line(error: &eeruf_files::FileError, bytes: &[u8]) {
    let lines = bytes.iter().filter(|&&byte| matches!(byte, b'\n' | b'\r')).count() as u64 + 1;
    assert!(error.line().is_none_or(|line| line <= lines), "{error} of {lines} lines");
    one_line(&error.to_string());
}
