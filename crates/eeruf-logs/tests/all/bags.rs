//! Bags written by other programs.

use std::path::Path;

use eeruf_logs::{Echo, LogReading, Options, Report};

use crate::{BAGS, bag, read};

/// The contents of message `m` of topic `n` that `write_bags.py` wrote.
fn expected(topic: usize, message: usize) -> Echo {
    match message {
        2 => Echo::Nothing,
        3 => Echo::TooClose,
        4 => Echo::Invalid,
        _ => Echo::At(1.0 + topic as f64 / 4.0 + message as f64 / 64.0),
    }
}

fn stamp(message: usize) -> u64 {
    1_700_000_000_000_000_000 + 100_000_000 * message as u64
}

/// Checks that the readings of each topic `/sonar/N` equal those written, in order.
fn holds(name: &str, report: &Report, readings: &[LogReading], messages: usize, variance: Option<f32>) {
    for (sensor, of) in report.sensors.iter().enumerate().filter(|(_, sensor)| sensor.beam.is_none()) {
        let number: usize = of.topic.strip_prefix("/sonar/").unwrap().parse().unwrap();
        assert_eq!(of.frame, format!("sonar_{number}"));
        let own: Vec<_> = readings.iter().filter(|reading| reading.sensor == sensor).collect();
        assert_eq!(own.len(), messages, "{name}");
        for (message, reading) in own.into_iter().enumerate() {
            assert_eq!((reading.echo(), reading.at_ns), (expected(number, message), Some(stamp(message))), "{name}");
            assert_eq!((reading.variance, reading.radiation, reading.field_of_view_rad), (variance, 0, 0.25), "{name}");
            assert_eq!((reading.min_range_m, reading.max_range_m), (f64::from(0.02_f32), 4.0));
        }
    }
}

// Bags written by rosbags give the original readings, with and without variance.
#[test]
fn rosbags_files_give_their_readings() {
    let folder = tempfile::tempdir().unwrap();
    for name in BAGS {
        let (report, readings) = read(&bag(name, folder.path()), &Options::default()).unwrap();
        assert_eq!(report.damage, [], "{name}");
        let ros1 = name.starts_with("ros1");
        assert_eq!((report.sensors.len(), report.messages), if ros1 { (6, 14) } else { (2, 12) }, "{name}");
        holds(name, &report, &readings, 6, name.contains("jazzy").then_some(0.5));
    }
}

// Without a schema the length of a message says whether it has a variance.
#[test]
fn message_length_says_if_it_has_a_variance() {
    let folder = tempfile::tempdir().unwrap();
    for (name, variance) in [("sqlite-humble", None), ("sqlite-jazzy", Some(0.5))] {
        let bag = bag(name, folder.path());
        let database = rusqlite::Connection::open(bag.join(format!("{name}.db3"))).unwrap();
        database.execute_batch("DROP TABLE message_definitions").unwrap();
        drop(database);
        let (report, readings) = read(&bag, &Options::default()).unwrap();
        assert_eq!(report.damage, []);
        holds(name, &report, &readings, 6, variance);
    }
}

// A schema that does not fit the messages is reported, and nothing is guessed.
#[test]
fn schema_that_does_not_fit_is_reported() {
    let folder = tempfile::tempdir().unwrap();
    let bag = bag("sqlite-jazzy", folder.path());
    let database = rusqlite::Connection::open(bag.join("sqlite-jazzy.db3")).unwrap();
    let shorter = "UPDATE message_definitions SET encoded_message_definition =
        replace(encoded_message_definition, 'float32 variance', '')";
    assert_eq!(database.execute(shorter, []).unwrap(), 1);
    drop(database);
    let (report, readings) = read(&bag, &Options::default()).unwrap();
    assert_eq!((readings.len(), report.skipped.len()), (0, 2));
    assert_eq!((&*report.skipped[0].why, report.skipped[0].messages), ("a length that does not fit their type", 6));
}

// Each beam of a scan made of sonars is a sensor with its own time.
#[test]
fn each_beam_of_a_sonar_scan_is_a_sensor() {
    let folder = tempfile::tempdir().unwrap();
    let (report, readings) = read(&bag("ros1-lz4.bag", folder.path()), &Options::default()).unwrap();
    let beams: Vec<_> = report.sensors.iter().filter_map(|sensor| sensor.beam).collect();
    assert_eq!(beams, [0, 1, 2, 3]);
    assert_eq!(report.names()[2..], ["/ring[0]", "/ring[1]", "/ring[2]", "/ring[3]"]);
    let third: Vec<_> = readings.iter().filter(|reading| report.sensors[reading.sensor].beam == Some(2)).collect();
    assert_eq!(third.len(), 2);
    for (message, reading) in third.into_iter().enumerate() {
        assert_eq!(reading.echo(), expected(2, message));
        assert_eq!(reading.at_ns.unwrap().abs_diff(stamp(message) + 20_000_000) / 1000, 0);
    }
}

// The files of a split bag are read in order, even without its metadata.
#[test]
fn bag_in_several_files_is_read_in_order() {
    let folder = tempfile::tempdir().unwrap();
    let bag = bag("mcap-jazzy", folder.path());
    let first = bag.join("mcap-jazzy.mcap");
    for number in [2, 10] {
        std::fs::copy(&first, bag.join(format!("mcap-jazzy_{number}.mcap"))).unwrap();
    }
    let metadata = bag.join("metadata.yaml");
    let text = std::fs::read_to_string(&metadata).unwrap();
    let three = "relative_file_paths: [mcap-jazzy.mcap, mcap-jazzy_2.mcap, mcap-jazzy_10.mcap]";
    let named: Vec<_> = text
        .lines()
        .filter(|line| !line.trim_start().starts_with("- mcap-jazzy.mcap"))
        .map(|line| if line.contains("relative_file_paths") { format!("  {three}") } else { line.to_owned() })
        .collect();
    std::fs::write(&metadata, named.join("\n")).unwrap();
    let whole = read(&bag, &Options::default()).unwrap();
    assert_eq!((whole.0.messages, &whole.0.damage[..], whole.0.sensors.len()), (36, &[][..], 2), "{text}");
    std::fs::remove_file(&metadata).unwrap();
    let without = read(&bag, &Options::default()).unwrap();
    assert_eq!((without.1.len(), without.0.damage.len()), (whole.1.len(), 1));
    assert!(without.0.damage[0].message().ends_with("all bag files of the folder are read"));
}

#[test]
fn what_is_no_log_gets_one_clear_line() {
    let folder = tempfile::tempdir().unwrap();
    let said = |file: &Path| read(file, &Options::default()).unwrap_err().message().to_owned();
    assert!(said(&folder.path().join("none.mcap")).starts_with("No such file"));
    assert_eq!(said(folder.path()), "no .mcap and no .db3 file; expected the folder of a ROS 2 bag");
    let file = folder.path().join("text.db3");
    std::fs::write(&file, "no database").unwrap();
    assert!(said(&file).starts_with("as an SQLite bag: "), "{}", said(&file));
}
