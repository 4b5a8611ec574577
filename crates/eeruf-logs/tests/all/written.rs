//! Output of `McapWriter`.

use eeruf_logs::{LogReading, McapWriter, Options, read_log};

use crate::read;

const READING: LogReading = LogReading {
    sensor: 0,
    at_ns: Some(1_700_000_000_123_456_789),
    radiation: 0,
    field_of_view_rad: 0.25,
    min_range_m: 0.25,
    max_range_m: 4.0,
    range_m: 1.5,
    variance: Some(0.0),
};

#[test]
fn what_was_written_is_read_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out.mcap");
    let mut out = McapWriter::create(&file).unwrap();
    let ranges = [1.5, f64::INFINITY, f64::NEG_INFINITY, 3.25];
    for (number, range_m) in ranges.into_iter().enumerate() {
        // Texts of every length modulo four, since fields behind them are aligned.
        let (topic, frame) = (format!("/sonar/{number}"), "f".repeat(number));
        out.range(&topic, &frame, &LogReading { range_m, ..READING }).unwrap();
    }
    out.finish().unwrap();
    let (report, readings) = read(&file, &Options::default()).unwrap();
    assert_eq!((report.damage.len(), report.names()[3].as_str()), (0, "/sonar/3"));
    assert_eq!(report.sensors[3].frame, "fff");
    for (sensor, (range_m, reading)) in ranges.into_iter().zip(readings).enumerate() {
        assert_eq!(reading, LogReading { sensor, range_m, ..READING });
    }
}

#[test]
fn of_two_chunks_a_damaged_one_takes_nothing_from_the_other() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("out.mcap");
    let mut out = McapWriter::create(&file).unwrap();
    let messages = 60_000;
    for number in 0..messages {
        out.range("/sonar", "s", &LogReading { range_m: f64::from(number % 977) / 256.0, ..READING }).unwrap();
    }
    out.finish().unwrap();
    let mut bytes = std::fs::read(&file).unwrap();
    bytes[2000] ^= 1;
    std::fs::write(&file, &bytes).unwrap();
    let mut read = 0;
    let report = read_log(&file, &Options::default(), |_, _| read += 1).unwrap();
    assert_eq!(report.damage.len(), 2, "{:?}", report.damage);
    assert!(report.damage[0].message().starts_with("a chunk is lost: "), "{}", report.damage[0]);
    assert!(read > 0 && read < messages, "{read}");
    let lost = format!("{} of the {messages} messages that it counts were not found", messages - read);
    assert_eq!(report.damage[1].message(), lost);
}
