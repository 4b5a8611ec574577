//! Firing logs in the wild: any separator, damaged lines.

use eeruf_core::ReadingKind;
use eeruf_logs::FiringLog;

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

#[test]
fn other_columns_are_ignored() {
    let text = "sensor,fired_us,period,phase,t_echo_us,steady,g\n0,15000,0,0,5872,yes,1.5\n";
    let log = FiringLog::read_from(text.as_bytes(), "log".as_ref()).unwrap();
    assert_eq!((log.firings[0].g_us_ms, log.doubts()), (Some(1.5), vec![]));
}
