//! Damaged text: no reading comes from a damaged line, and nothing panics.

use std::collections::HashSet;
use std::path::Path;

use eeruf_logs::{Options, read_stream};

use crate::random::Random;

/// Logs of 40 rows whose values have three digits each, so that a part of a value is not a value.
fn logs() -> Vec<String> {
    let value = |row: usize, sensor: usize| 200 + (row * 37 + sensor * 101) % 250;
    let rows = |line: &dyn Fn(usize) -> String| (0..40).map(|row| line(row) + "\n").collect::<String>();
    vec![
        "left,right\n".to_owned() + &rows(&|row| format!("{},{}", value(row, 0), value(row, 1))),
        rows(&|row| format!("{};{};{}", value(row, 0), value(row, 1), value(row, 2))),
        "t\tleft\tright\n".to_owned()
            + &rows(&|row| format!("{}\t{}\t{}", 1000 + 60 * row, value(row, 0), value(row, 1))),
        rows(&|row| format!("left: {} cm, right: {} cm", value(row, 0), value(row, 1))),
        rows(&|row| format!("{{\"left\":{},\"right\":{}}}", value(row, 0), value(row, 1))),
        rows(&|row| format!("12:00:{:02}.100 -> {},{}", row, value(row, 0), value(row, 1))),
        "time,sensor,cm\n".to_owned()
            + &rows(&|row| format!("{},{},{}", 1000 + row, ["a", "b"][row % 2], value(row, 0))),
        rows(&|row| {
            let stamp = format!("stamp:\n    sec: 7\n    nanosec: {}", 100_000_000 + row);
            format!("header:\n  {stamp}\n  frame_id: {}\nrange: 0.{}\n---", ["us_a", "us_b"][row % 2], value(row, 0))
        }),
        rows(&|row| format!("0={}cm 1={}cm ", value(row, 0), value(row, 1))),
        rows(&|row| format!("{{'t': {}, 'left': {}}}", 1000 + row, value(row, 0))),
        rows(&|row| format!("I ({}) us: left: {}", 1000 + row, value(row, 0))),
        rows(&|row| format!("Jan 12 12:00:{:02} robot us[7]: left={}", row, value(row, 0))),
        rows(&|row| {
            let (before, range) = (format!("[12:00:{row:02}][D][ultrasonic.sensor:040]"), value(row, 0));
            let state = format!("'Front': Sending state 0.{range}00 m with 2 decimals of accuracy");
            format!("{before}: 'Front' - Got distance: 0.{range} m\n[12:00:{row:02}][D][sensor:126]: {state}")
        }),
        rows(&|row| format!("- t: {}\n  left: {}\n  right: {}", 1000 + row, value(row, 0), value(row, 1))),
        rows(&|row| format!("ring/{} {{\"distance\":{}}}", ["a", "b"][row % 2], value(row, 0))),
        rows(&|row| format!("ring left={},right={} 17000000{row:02}000000000", value(row, 0), value(row, 1))),
        rows(&|row| format!("range{{sensor=\"{}\"}} {} 17000000{row:02}000", ["a", "b"][row % 2], value(row, 0))),
        rows(&|row| format!("{{\"log\":\"left: {}\",\"time\":\"2026-01-01T14:00:{row:02}Z\"}}", value(row, 0))),
        rows(&|row| format!(">left:{}:{}", 1_700_000_000_000u64 + row as u64, value(row, 0))),
        rows(&|row| format!("Distance to the wall is {} cm", value(row, 0))),
        "cm,mm\n".to_owned() + &rows(&|row| format!("{},{}0", value(row, 0), value(row, 0))),
        rows(&|row| format!("{} cm\n{} mm", value(row, 0), 10 * value(row, 0))),
        "t,left,right\n".to_owned()
            + &rows(&|row| {
                let own = value(row, 0);
                if row % 2 == 0 { format!("{},{own},", 1000 + row) } else { format!("{},,{own}", 1000 + row) }
            }),
    ]
}

/// The sensors' names and ranges in centimetres; infinite ones mean no echo.
fn read(bytes: &[u8]) -> Vec<(String, f64)> {
    let mut readings = vec![];
    let report = read_stream(bytes, Path::new("log"), &Options::default(), |report, reading| {
        readings.push((report.sensors[reading.sensor].topic.clone(), reading.range_m));
    });
    match report {
        Ok(report) => {
            let lines = bytes.iter().filter(|&&byte| byte == b'\n' || byte == b'\r').count() as u64 + 1;
            assert!(report.messages <= lines && report.damage.len() <= 101);
            assert!(report.damage.iter().all(|damage| !damage.message().contains('\n')));
        }
        Err(error) => assert!(!error.to_string().contains('\n')),
    }
    readings
}

#[test]
fn nothing_is_read_from_a_damaged_line() {
    let mut random = Random(47);
    let logs = logs().into_iter().map(|whole| {
        let before = read(whole.as_bytes());
        let ranges: HashSet<u64> = before.iter().map(|(_, range)| range.to_bits()).collect();
        (whole.into_bytes(), before.len(), ranges)
    });
    let logs: Vec<_> = logs.collect();
    let (mut lost, mut kept) = (0, 0);
    for round in 0..12_000 {
        let (whole, before, ranges) = &logs[round % logs.len()];
        let mut bytes = whole.clone();
        let at = random.below(bytes.len());
        match random.below(6) {
            // The end, and the beginning. A single row does not show how long its values are.
            0 => bytes.truncate(at.max(150)),
            1 => _ = bytes.drain(..random.below(40.min(at + 1))),
            // A byte that is not a digit.
            2 => bytes[at] = b"x?#\0\xff~"[random.below(6)],
            // A separator, or a line break.
            3 => {
                let places: Vec<_> = (0..bytes.len()).filter(|&at| b",;\t\n:".contains(&bytes[at])).collect();
                bytes.remove(places[random.below(places.len())]);
            }
            4 => {
                let junk = [
                    &b"boot: ready\n"[..],
                    b"\n\n\n",
                    b"\xff\xfe\xfd\n",
                    b"Guru Meditation Error\n",
                    b"ets Jul 29 2019 12:21:46\nload:0x3fff0030,len:1344\nentry 0x400805f0\n",
                    b"I (29) boot: ESP-IDF v5.1\n",
                ];
                let start = bytes[..at].iter().rposition(|&byte| byte == b'\n').map_or(0, |place| place + 1);
                _ = bytes.splice(start..start, junk[random.below(6)].iter().copied());
            }
            // A line that ends early.
            _ => {
                let end = bytes[at..].iter().position(|&byte| byte == b'\n').map_or(bytes.len(), |end| at + end);
                let start = bytes[..at].iter().rposition(|&byte| byte == b'\n').map_or(0, |place| place + 1);
                // A cut between the digits of the last value cannot be detected.
                let last = end.saturating_sub(4).max(start);
                _ = bytes.drain(at.min(last)..end);
            }
        }
        let after = read(&bytes);
        for (name, range) in &after {
            let is_known = ranges.contains(&range.to_bits()) || range.is_infinite();
            let text = String::from_utf8_lossy(&bytes);
            assert!(is_known, "round {round}: {name} {range} from\n{text}");
        }
        lost += usize::from(after.len() < *before);
        kept += usize::from(after.len() + 8 > *before);
    }
    assert!(lost > 3000 && kept > 6000, "{lost} {kept}");
}

#[test]
fn random_bytes_neither_fail_nor_hang() {
    let mut random = Random(20_000);
    let logs = logs();
    let mut readings = 0;
    for round in 0..8000 {
        let mut bytes = logs[round % logs.len()].clone().into_bytes();
        for _ in 0..=random.below(12) {
            let at = random.below(bytes.len());
            match random.below(4) {
                0 => bytes[at] = random.below(256) as u8,
                1 => bytes.insert(at, b"{}[]\",;:=\r\n\0-.eE#"[random.below(17)]),
                2 => _ = bytes.drain(at..(at + random.below(200)).min(bytes.len())),
                _ => {
                    let part = bytes[at..(at + random.below(100)).min(bytes.len())].to_vec();
                    let to = random.below(bytes.len());
                    _ = bytes.splice(to..to, part);
                }
            }
            if bytes.is_empty() {
                bytes.push(b'\n');
            }
        }
        readings += read(&bytes).len();
    }
    assert!(readings > 100_000, "{readings}");
}
