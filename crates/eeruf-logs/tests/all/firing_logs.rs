//! Firing logs in the wild: any separator, frames of the serial line, damaged lines.

use eeruf_core::{Instant, Micros, ReadingKind};
use eeruf_logs::{Firing, FiringLog, Options};
use eeruf_serial::Encoder;

use crate::read;

fn read_text(text: &str) -> FiringLog {
    FiringLog::read_from(text.as_bytes(), "log".as_ref()).unwrap()
}

#[test]
fn each_form_of_text_gives_the_same_firings() {
    let comma = "# clock: board\nsensor,fired_us,period,phase,t_echo_us,reading\n0,15000,0,0,5872,rejected\n\
                 4,15000,0,1,,no_echo\n";
    let expected = read_text(comma);
    assert_eq!((expected.clock.as_str(), expected.firings.len()), ("board", 2));
    assert_eq!((expected.firings[0].reading, expected.firings[1].t_echo_us), (Some(ReadingKind::Rejected), None));
    for text in [
        comma.replace(',', ";"),
        comma.replace(',', "\t"),
        comma.replace(',', " | "),
        comma.replace('\n', "\r\n"),
        comma.replace("sensor,fired_us", "Sensor,Fired us"),
        comma.replace(",,no_echo", ",None,no_echo"),
        comma.replace("5872", "5871.6"),
        comma.replace(',', ";").replace("5872", "5871,6"),
        format!("\u{feff}{comma}"),
        comma.lines().map(|line| format!("12:00:01.100 -> {line}\n")).skip(1).collect(),
    ] {
        let found = read_text(&text);
        assert_eq!((&found.firings, &found.damage), (&expected.firings, &None), "{text}");
    }
}

#[test]
fn damaged_lines_are_left_out_and_named() {
    let header = "sensor,fired_us,period,phase,t_echo_us\n";
    let row = |n: u32| format!("{},{},{n},0,5872\n", n % 3, 60_000 * n);
    let whole: String = (0..9).map(row).collect();
    let all = read_text(&format!("{header}{whole}"));
    assert_eq!((all.firings.len(), all.damage.as_deref()), (9, None));
    for (wrong, why) in [
        ("64,0,0,0,\n", "line 11 is left out: column sensor: `64`; expected 0 to 63"),
        ("1,0,0,0\n", "line 11 is left out: 4 cells; expected 5"),
        ("1,0,x,0,700\n", "line 11 is left out: column period: `x`; expected a number from 0"),
        ("1,540000,9,0,58", "line 11 is left out: it ends without a line break and may be cut"),
        ("1,0,0,0,70\u{fffd}\n", "line 11 is left out: bytes that are no text"),
    ] {
        let found = read_text(&format!("{header}{whole}{wrong}"));
        assert_eq!((&found.firings, found.damage.as_deref()), (&all.firings, Some(why)));
    }
    let two = read_text(&format!("{header}a,b\n{whole}x\n"));
    assert_eq!(two.firings, all.firings);
    assert_eq!(two.damage.as_deref(), Some("2 lines are left out, first line 2: 2 cells; expected 5"));
}

/// Frames of 3 sensors through a wrap of the clock.
fn frames() -> Vec<Vec<u8>> {
    let mut encoder = Encoder::new();
    let mut frames = vec![encoder.hello(3, "board").as_bytes().to_vec()];
    for n in 0..30_u32 {
        let firing = eeruf_serial::FiringMessage {
            sensor: (n % 3) as u8,
            phase: 0,
            kind: if n % 5 == 0 { ReadingKind::NoEcho } else { ReadingKind::Accepted },
            fired: Instant::from_micros(u32::MAX - 100_000) + Micros::new(20_000 * n),
            period: n / 3,
            t_echo: (n % 5 != 0).then_some(Micros::new(5000 + n)),
            late: Micros::ZERO,
            age: Micros::ZERO,
            explained_by: None,
        };
        frames.push(encoder.firing(&firing).as_bytes().to_vec());
    }
    frames
}

#[test]
fn frames_of_the_serial_line_are_readings_and_firings() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("line.bin");
    std::fs::write(&file, frames().concat()).unwrap();
    let (report, readings) = read(&file, &Options::default()).unwrap();
    assert_eq!((report.form.as_str(), report.damage.len()), ("frames of the serial line", 0));
    assert_eq!(report.names(), ["sonar_1", "sonar_2", "sonar_3"]);
    assert_eq!(readings.len(), 30);
    for (n, reading) in (0..).zip(&readings) {
        assert_eq!(reading.at_ns, Some(1000 * (u64::from(u32::MAX) - 100_000 + 20_000 * n)));
        let metres = if n % 5 == 0 { f64::INFINITY } else { 0.5e-6 * 343.2 * (5000 + n) as f64 };
        assert!(reading.range_m == metres || (reading.range_m - metres).abs() < 0.02, "{reading:?}");
    }
    let log = FiringLog::read(&file).unwrap();
    assert_eq!((log.clock.as_str(), log.firings.len(), &log.damage), ("board", 30, &None));
    let is_rising = |two: &[Firing]| two[1].fired_us - two[0].fired_us == 20_000;
    assert!(log.firings.windows(2).all(is_rising));

    // A frame that is lost, one that is damaged, and a recording that begins in the middle of one.
    let mut frames = frames();
    frames.remove(7);
    frames[9][5] ^= 1;
    std::fs::write(&file, &frames.concat()[4..]).unwrap();
    let (report, readings) = read(&file, &Options::default()).unwrap();
    assert_eq!(readings.len(), 28);
    assert_eq!(report.damage[0].message(), "frames: 1 damaged, 2 missing by their numbers");
    let log = FiringLog::read(&file).unwrap();
    assert_eq!(log.damage.as_deref(), Some("frames: 1 damaged, 2 missing by their numbers"));
}

#[test]
fn other_columns_are_ignored() {
    let text = "sensor,fired_us,period,phase,t_echo_us,steady,g\n0,15000,0,0,5872,yes,1.5\n";
    let log = FiringLog::read_from(text.as_bytes(), "log".as_ref()).unwrap();
    assert_eq!((log.firings[0].g_us_ms, log.doubts()), (Some(1.5), vec![]));
}
