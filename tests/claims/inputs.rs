//! Wrong input files: one line on standard error that names file, line or field, value and the expected value.

use crate::common::{Scratch, eeruf};

// Bad input gets one line that names file place value and what is expected.
#[test]
fn bad_input_gets_one_line_with_its_place() {
    let cases = [
        (
            "period_us = 100000\nt_lag_us = [0]\nt_wait_a_us = [1, 2]\nt_wait_b_us = [1]\n",
            ", line 3: t_wait_a_us has 2 numbers; expected 1, as many as t_lag_us",
        ),
        (
            "period_us = 100\nt_fire_a_us = [10, 100]\nt_fire_b_us = [1, 2]\n",
            ": sensor 2 fires 100 us into phase a; expected less than the period of 100 us",
        ),
        (
            "period_us = 100000\nt_fire_a_us = [0]\n",
            ", line 2: expected either t_lag_us, t_wait_a_us and t_wait_b_us, or t_fire_a_us and t_fire_b_us, \
             one number for each sensor",
        ),
        ("period_us = 100000\nt_fire_a_us = [0]\nt_fire_b_us = [-3]\n", ", line 3: "),
        (
            "period_us = 100000\nt_fires_a_us = [0]\n",
            ", line 2: t_fires_a_us: unknown key; did you mean `t_fire_a_us`?",
        ),
        (
            "period_us = 0\nt_fire_a_us = [0]\nt_fire_b_us = [0]\n",
            ", line 1: a period of 0 us; expected 1 us to 268435.456 ms",
        ),
        ("period_us = 9\nt_fire_a_us = []\nt_fire_b_us = []\n", ": 0 sensors; expected 1 to 64"),
        ("period_us = \n", ", line 1: "),
    ];
    for (contents, expected) in cases {
        let (_folder, file) = Scratch::new("bad.toml", contents);
        let outcome = eeruf(&["verify", file.to_str().unwrap()]);
        assert_eq!((outcome.code, outcome.out.as_str()), (Some(2), ""), "{contents}");
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
        let prefix = format!("eeruf: {}{expected}", file.display());
        assert!(outcome.err.starts_with(&prefix), "{}\n{prefix}", outcome.err);
    }
    let cases = [
        ("a,b\n1.0,2.0\n1.0,?\n", ", line 3: column b: `?`; expected a range in metres; the line is left out", 2),
        ("a,b\n1.0,2.0\n1.0\n", ", line 3: `1.0`: number of cells 1; expected 2; the line is left out", 2),
        ("a,b\nx,y\n", ": a table, columns parted by comma: no sensors; expected ranges; found ", 2),
        ("", ": the file is empty; expected lines with readings", 2),
    ];
    for (contents, expected, code) in cases {
        let (_folder, file) = Scratch::new("bad.csv", contents);
        let outcome = eeruf(&["replay", file.to_str().unwrap(), "--t-delta-us", "100"]);
        // What stands in whole lines is replayed.
        assert_eq!((outcome.code, outcome.out.is_empty()), (Some(code), !contents.contains('1')), "{contents}");
        let prefix = format!("eeruf: {}{expected}", file.display());
        assert!(outcome.err.starts_with(&prefix), "{}\n{prefix}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    }
    let missing = eeruf(&["verify", "no-such-file.toml"]);
    assert_eq!(missing.code, Some(2));
    assert!(missing.err.starts_with("eeruf: no-such-file.toml: No such file"), "{}", missing.err);
}

#[test]
fn impossible_rings_get_one_clear_line() {
    let ring =
        |line: &str| format!("sensors = 8\nt_delta_us = 999\nmin_interval_us = 15000\nwindow_us = 30000\n{line}\n");
    let cases = [
        (ring("").replace("sensors = 8", "sensors = 0"), ", line 1: 0 sensors; expected 1 to 64"),
        (ring("").replace("sensors = 8", "sensors = 65"), ", line 1: 65 sensors; expected 1 to 64"),
        (ring("neighbours = 0"), ", line 5: neighbours = 0; expected 1 to 64"),
        (ring("tick_us = 0"), ": a tick of 0 us; expected 1 us or more"),
        (
            ring("").replace("30000", "0"),
            ", line 4: a listening window of 0 us; expected window_us or max_range_m above zero",
        ),
        (ring("max_range_m = 3.0"), ", line 4: expected one of window_us, max_range_m and module"),
        (ring("jitter_us = 3"), ", line 2: expected either t_delta_us, or jitter_us with or without speed_m_s"),
        (ring("layout = \"star\""), ", line 5: "),
        (
            ring("layout = [[0, 8]]"),
            ", line 5: layout: neighbours [0, 8]; expected two different sensors, counted from 0 to 7",
        ),
        (ring("").replace("15000", "4294967295") + "tick_us = 1\n", ": firing one by one already takes "),
        (
            ring("").replace("15000", "4000000000"),
            ": firing one by one already takes 32000 s; expected at most 268435.456 ms, so a shorter interval",
        ),
        (ring("").replace("= 8", "= -8"), ", line 1: sensors: integer `-8`; expected a whole number from 0 on"),
    ];
    for (contents, expected) in cases {
        let (_folder, file) = Scratch::new("ring.toml", &contents);
        let outcome = eeruf(&["design", "--period-only", file.to_str().unwrap()]);
        assert_eq!((outcome.code, outcome.out.as_str()), (Some(2), ""), "{contents}");
        let prefix = format!("eeruf: {}{expected}", file.display());
        assert!(outcome.err.starts_with(&prefix), "{}\n{prefix}", outcome.err);
        assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
    }
    let foreign = eeruf(&["verify", "rings/table-i-d.toml", "--t-delta-us", "999", "--layout", "0-1,1-12"]);
    assert_eq!((foreign.code, foreign.out.as_str()), (Some(2), ""));
    let message =
        "eeruf: rings/table-i-d.toml: layout: neighbours [1, 12]; expected two different sensors, counted from 0 to 11";
    assert_eq!(foreign.err.trim_end(), message);
    let waits = "sensors = 3\nperiod_us = 40000\nwait_max_us = 9000\ntick_us = 1000\nt_delta_us = 999\n";
    let cases = [
        (format!("{waits}t_lag_us = [0, 500, 10000]\n"), ": a lag of 500 us; expected a whole number of ticks of 1 ms"),
        (format!("{waits}t_lag_us = [0, 35000, 10000]\n"), ": sensor 2 has lag 35 and waits up to 9 ticks; "),
        (format!("{waits}t_lag_us = [0]\n"), ": 1 lags; expected one for each of 3 sensors"),
    ];
    for (contents, expected) in cases {
        let (_folder, file) = Scratch::new("waits.toml", &contents);
        let outcome = eeruf(&["search", file.to_str().unwrap()]);
        assert_eq!((outcome.code, outcome.out.as_str()), (Some(2), ""), "{contents}");
        let prefix = format!("eeruf: {}{expected}", file.display());
        assert!(outcome.err.starts_with(&prefix), "{}\n{prefix}", outcome.err);
    }
}
