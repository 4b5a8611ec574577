//! Flight logs, written byte by byte according to their specifications.

use std::path::Path;

use eeruf_logs::{Echo, Options, Report, read_stream};

fn read(name: &str, bytes: &[u8]) -> (Report, Vec<(usize, u64, Echo)>) {
    let mut readings = vec![];
    let report = read_stream(bytes, Path::new(name), &Options::default(), |_, of| {
        readings.push((of.sensor, of.at_ns.unwrap(), of.echo()));
    });
    (report.unwrap(), readings)
}

fn padded(text: &str, length: usize) -> Vec<u8> {
    let mut bytes = text.as_bytes().to_vec();
    bytes.resize(length, 0);
    bytes
}

/// Echoes of a log, rounded to centimetres.
fn cm(readings: &[(usize, u64, Echo)]) -> Vec<i64> {
    let of = |echo: &Echo| if let Echo::At(m) = echo { (100.0 * m).round() as i64 } else { -1 };
    readings.iter().map(|(.., echo)| of(echo)).collect()
}

#[test]
fn ardupilots_log_gives_ranges_whose_status_is_good() {
    let format = |kind: u8, length: u8, name: &str, kinds: &str, labels: &str| {
        [vec![0xa3, 0x95, 0x80, kind, length], padded(name, 4), padded(kinds, 16), padded(labels, 64)].concat()
    };
    let mut log = format(0x80, 89, "FMT", "BBnNZ", "Type,Length,Name,Format,Columns");
    log.extend(format(7, 15, "ATT", "Qf", "TimeUS,Roll"));
    log.extend(format(9, 16, "RFND", "QBCBB", "TimeUS,Instance,Dist,Stat,Orient"));
    for n in 0..4_u64 {
        log.extend([0xa3, 0x95, 7].iter().chain(&n.to_le_bytes()).chain(&1.5_f32.to_le_bytes()));
        let (cm, status) = [(123_u16, 4), (124, 4), (700, 3), (2, 2)][n as usize];
        log.extend([0xa3, 0x95, 9].iter().chain(&(n * 50_000).to_le_bytes()).chain(&[n as u8 % 2]));
        log.extend(cm.to_le_bytes().iter().chain(&[status, 25]));
    }
    let (report, readings) = read("flight.BIN", &log);
    assert_eq!((report.names(), report.damage.len()), (vec!["RFND 0".to_owned(), "RFND 1".to_owned()], 0));
    assert_eq!(cm(&readings), [123, 124, -1, -1]);
    assert_eq!((readings[1].1, readings[2].2, readings[3].2), (50_000_000, Echo::Nothing, Echo::TooClose));
    // Cut, and with noise in the middle.
    log.splice(300..300, [1, 2, 3]);
    let (report, readings) = read("flight.BIN", &log[..log.len() - 5]);
    assert!(readings.len() == 3 && report.damage.len() == 1, "{report:?}");
}

#[test]
fn telemetry_gives_ultrasound_and_says_what_it_leaves_out() {
    // A frame of MAVLink 2 as pymavlink packs DISTANCE_SENSOR (1000 ms, 20 to 700 cm, 123 cm, type, id 3).
    let frame = |kind: u8, cm: u16| {
        let mut body = [1000_u32.to_le_bytes().to_vec(), vec![20, 0, 0xbc, 2]].concat();
        body.extend(cm.to_le_bytes().iter().chain(&[kind, 3, 25]));
        let head = [body.len() as u8, 0, 0, 7, 1, 1, 132, 0, 0];
        let summed = head.iter().chain(&body).chain(&[85]).copied().collect::<Vec<u8>>();
        let mut sum = 0xffff_u16;
        for byte in summed {
            sum ^= u16::from(byte);
            (0..8).for_each(|_| sum = (sum >> 1) ^ if sum & 1 == 1 { 0x8408 } else { 0 });
        }
        let at_us = 1_700_000_000_000_000_u64.to_be_bytes();
        [at_us.to_vec(), vec![0xfd], head.to_vec(), body, sum.to_le_bytes().to_vec()].concat()
    };
    let mut damaged = frame(1, 99);
    damaged[20] ^= 1;
    let log = [frame(1, 123), frame(0, 500), damaged, vec![9, 9], frame(1, 124), frame(1, 700)].concat();
    let (report, readings) = read("flight.tlog", &log);
    assert_eq!((report.names(), cm(&readings)), (vec!["DISTANCE_SENSOR 3".to_owned()], vec![123, 124, -1]));
    assert!(report.skipped[0].messages == 1 && report.skipped[0].why.contains("lasers"), "{report:?}");
    assert_eq!(report.damage.len(), 1);
}

#[test]
fn px4s_log_gives_distances_of_good_quality() {
    let message = |kind: u8, body: &[u8]| [&(body.len() as u16).to_le_bytes()[..], &[kind], body].concat();
    let mut log = [b"ULog\x01\x12\x35\x01".to_vec(), vec![0; 8]].concat();
    let fields = "distance_sensor:uint64_t timestamp;float[4] q;float max_distance;float current_distance;\
                  int8_t signal_quality;uint8_t type;uint8_t[2] _padding0;";
    log.extend(message(b'F', fields.as_bytes()));
    log.extend(message(b'A', b"\x01\x05\x00distance_sensor"));
    for (range, quality, kind) in [(1.23_f32, -1_i8, 1), (1.24, 0, 1), (8.0, 90, 1), (1.25, 90, 0), (1.26, 90, 1)] {
        let mut body = [5_u16.to_le_bytes().to_vec(), 50_000_u64.to_le_bytes().to_vec(), vec![0; 16]].concat();
        body.extend(7.0_f32.to_le_bytes().iter().chain(&range.to_le_bytes()).chain(&[quality as u8, kind, 0, 0]));
        log.extend(message(b'D', &body));
    }
    let (report, readings) = read("flight.ulg", &log);
    assert_eq!((report.names(), cm(&readings)), (vec!["distance_sensor 1".to_owned()], vec![123, -1, -1, 126]));
    assert_eq!(report.skipped[0].messages, 1);
    let (empty, _) = read("flight.ulg", &log[..16]);
    assert!(empty.sensors.is_empty() && empty.skipped[0].why.contains("no such message in"));
}
