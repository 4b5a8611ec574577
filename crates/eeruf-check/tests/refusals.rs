//! Refusals, their words, and the program's exit codes.

use eeruf_check::{check, read_claim};
use std::process::Command;

const PAIR: &str = "eeruf-certificate 1\ntick_us 1000 1\nsensors 2\nseparation 2 1\nwindow 3 1\nstale_echo 0\n\
                    over_reals 0\ngap 0 1 3 1\nperiod 4\nfire_a 0 3\nfire_b 1 0\nno_period_below 4\nend\n";

/// The text with one line replaced.
fn with(line: usize, new: &str) -> String {
    let mut lines: Vec<&str> = PAIR.split('\n').collect();
    lines[line - 1] = new;
    lines.join("\n")
}

fn refusal(text: &str) -> String {
    check(text).expect_err("it must be refused").to_string()
}

#[test]
fn a_certificate_of_two_sensors_with_uneven_gaps_is_accepted() {
    let certified = check(PAIR).expect("it holds");
    assert_eq!(certified.to_string(), "4000 us is the shortest period (tick 1000 us)");
    assert_eq!(certified.nodes, 1);
    assert_eq!(read_claim(PAIR), Ok(certified.claim));
}

#[test]
fn a_refusal_names_line_value_and_expectation() {
    for (text, expected) in [
        (String::new(), "line 1: found \"\", expected a line eeruf-certificate"),
        (with(1, "eeruf-certificate 2"), "line 1: found 2, expected 1 to 1"),
        (with(3, "sensors 65"), "line 3: found 65, expected 1 to 64"),
        (with(4, "separation 2"), "line 4: found 1 numbers, expected 2"),
        (with(5, "window 3 01"), "line 5: found \"01\", expected a number up to 1048576"),
        (with(5, "window 3  1"), "line 5: found \"\", expected a number up to 1048576"),
        (with(5, "window 3 9999999"), "line 5: found \"9999999\", expected a number up to 1048576"),
        (with(8, "gap 1 0 3 1"), "line 8: found the pair 1 0, expected pairs x < y in ascending order"),
        (with(10, "fire_a 0 4"), "line 10: found 4, expected 0 to 3"),
        (with(11, "fire_b 1 2"), "line 11: sensors 0 and 1: |d| differ by 0, expected at least 2"),
        (with(12, "no_period_below 5"), "line 12: found 5, expected 1 to 4"),
        (with(13, "sign 0\nend"), "line 13: found \"sign 0\", expected a line end"),
        (
            with(13, "reverse 0 1\nend"),
            "line 13: sensors 0 and 1 have the gaps 3 and 1, expected all gaps the same both ways",
        ),
        (
            with(13, "permutation 1 0\ngreatest 0\nend"),
            "line 13: sensor 0 is taken to 1, which has another separation or window",
        ),
        (format!("{PAIR}end\n"), "line 13: expected nothing after the line end"),
        (PAIR.trim_end().to_owned(), "line 13: expected nothing after the line end"),
    ] {
        assert_eq!(refusal(&text), expected);
    }
}

#[test]
fn the_program_exits_with_0_1_or_2() {
    let folder = env!("CARGO_TARGET_TMPDIR");
    let program = env!("CARGO_BIN_EXE_eeruf-check");
    for (name, text, code, out) in [
        ("good", PAIR.to_owned(), 0, "4000 us is the shortest period (tick 1000 us)\n"),
        ("bound", with(12, "no_period_below 3"), 0, "no period below 3000 us; schedule of 4000 us (tick 1000 us)\n"),
        ("bad", with(13, ""), 1, "line 13: found \"\", expected a line end\n"),
    ] {
        let file = format!("{folder}/{name}.txt");
        std::fs::write(&file, text).expect("the folder can be written to");
        let done = Command::new(program).arg(&file).output().expect("it runs");
        assert_eq!(done.status.code(), Some(code), "{name}");
        assert!(String::from_utf8_lossy(&done.stdout).ends_with(out), "{name}: {done:?}");
    }
    let done = Command::new(program).arg(format!("{folder}/missing")).output().expect("it runs");
    assert_eq!(done.status.code(), Some(2));
}
