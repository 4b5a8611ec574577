//! Small logs as people have them, and what the program says of each.

use crate::common::{Outcome, Scratch, eeruf};
use serde_json::Value;

/// A file, options, and what each sensor counts.
type Case<'a> = (&'a str, &'a [&'a str], &'a [(&'a str, [u64; 4])]);

/// Result of `replay` on a case: its outcome and its object.
fn replay(file: &str, options: &[&str]) -> (Outcome, Value) {
    let path = format!("tests/data/field-cases/{file}");
    let outcome = eeruf(&[&["replay", &path, "--t-delta-us", "500", "--json"], options].concat());
    let object = serde_json::from_str(&outcome.out).unwrap_or(Value::Null);
    (outcome, object)
}

/// Accepted, rejected, no echo and clear of each sensor, by its name.
fn sensors(object: &Value) -> Vec<(String, [u64; 4])> {
    let of = |sensor: &Value| {
        let counts = ["accepted", "rejected", "no_echo", "clear"].map(|name| sensor[name].as_u64().unwrap());
        (sensor["name"].as_str().unwrap().to_owned(), counts)
    };
    object["sensors"].as_array().unwrap().iter().map(of).collect()
}

#[test]
fn text_of_the_field_reads_with_its_right_counts() {
    let timed = &["--time", "t"][..];
    let cases: [Case; 10] = [
        ("zero-is-no-echo.csv", &[], &[("left", [0, 0, 1, 4]), ("right", [4, 0, 0, 0])]),
        ("minus-one-is-no-echo.csv", &[], &[("left", [1, 0, 1, 2]), ("right", [4, 0, 0, 0])]),
        ("null-first.csv", &[], &[("left", [1, 0, 1, 1]), ("right", [3, 0, 0, 0])]),
        ("none-in-the-middle.csv", &[], &[("left", [1, 0, 1, 0]), ("right", [3, 0, 0, 0])]),
        ("no-header.csv", &[], &[("column 1", [3, 0, 0, 0]), ("column 2", [3, 0, 0, 0]), ("column 3", [3, 0, 0, 0])]),
        ("column-of-time.csv", &[], &[("left", [2, 0, 0, 0]), ("right", [2, 0, 0, 0])]),
        ("semicolon-decimal-comma.csv", &[], &[("left", [2, 0, 0, 0]), ("right", [2, 0, 0, 0])]),
        ("first-empty.csv", timed, &[("left", [2, 0, 1, 0]), ("right", [3, 0, 0, 0])]),
        ("time-from-zero.csv", timed, &[("left", [3, 0, 0, 0]), ("right", [3, 0, 0, 0])]),
        ("serial-monitor.txt", &[], &[("column 1", [3, 0, 0, 0]), ("column 2", [3, 0, 0, 0])]),
    ];
    for (file, options, expected) in cases {
        for unit in [&[][..], &["--range-unit", "cm"]] {
            let (outcome, object) = replay(file, &[options, unit].concat());
            assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""), "{file}");
            let expected: Vec<_> = expected.iter().map(|&(name, counts)| (name.to_owned(), counts)).collect();
            assert_eq!(sensors(&object), expected, "{file}");
        }
    }
    let (_, object) = replay("first-empty.csv", timed);
    assert!(object["sensors"].as_array().unwrap().iter().all(|sensor| sensor["duration_s"].as_f64().unwrap() > 0.299));
    let (folder, _) = Scratch::new("unused", "");
    let out = folder.path().join("out.mcap");
    for options in [&["--max-speed", "1"][..], &["--out", out.to_str().unwrap()]] {
        for file in ["first-empty.csv", "time-from-zero.csv"] {
            assert_eq!(replay(file, &[timed, options].concat()).0.code, Some(0), "{file} {options:?}");
        }
    }
}

#[test]
fn cut_lines_are_left_out_and_named() {
    let (outcome, object) = replay("cut-lines.csv", &["--range-unit", "cm"]);
    assert_eq!(outcome.code, Some(2));
    let names: Vec<_> = sensors(&object).into_iter().map(|sensor| sensor.0).collect();
    assert_eq!(names, ["left", "right"]);
    let total: u64 = ["accepted", "rejected", "first", "no_echo", "clear"]
        .map(|name| object["total"][name].as_u64().unwrap())
        .iter()
        .sum();
    assert_eq!((total, object["damage"].as_array().unwrap().len()), (10, 2));
    assert!(outcome.err.contains("line 5: `40` has 1 cells; expected 2"), "{}", outcome.err);
}

#[test]
fn json_lines_are_read_by_their_keys() {
    let asked = ["--time", "t", "--range", "front_left", "--range", "front_right", "--range", "back"];
    for options in [&asked[..], &[]] {
        let (_, object) = replay("lines.jsonl", options);
        let counts = [("front_left", [2, 0, 0, 0]), ("front_right", [1, 0, 1, 0]), ("back", [1, 0, 1, 0])];
        assert_eq!(sensors(&object), counts.map(|(name, counts)| (name.to_owned(), counts)));
    }
}

#[test]
fn bags_of_the_field_give_sensors_or_what_was_found() {
    let (outcome, _) = replay("pointcloud.bag", &[]);
    assert_eq!(outcome.code, Some(1));
    assert!(
        outcome.err.contains("no sensors; expected ranges; found /RosAria/sonar: sensor_msgs/PointCloud"),
        "{}",
        outcome.err
    );
    assert_eq!(replay("multiarray.bag", &[]).1["sensors"].as_array().unwrap().len(), 6);
    for options in [&[][..], &["--topic", "/ultrasonic_scan"]] {
        assert_eq!(replay("scan73.bag", options).1["sensors"].as_array().unwrap().len(), 73);
    }
    let (outcome, _) = replay("cmranges.bag", &[]);
    assert!(outcome.err.contains("if the driver writes centimetres"), "{}", outcome.err);
    let (outcome, object) = replay("cmranges.bag", &["--field", "/us", "range", "cm"]);
    assert_eq!((outcome.err.as_str(), object["sensors"][0]["accepted"].as_u64()), ("", Some(49)));
    let diagnosed = eeruf(&["diagnose", "tests/data/field-cases/scan73.bag"]);
    assert_eq!(diagnosed.code, Some(2));
    assert!(diagnosed.err.contains("a ROS 1 bag, which holds ranges and no firings"), "{}", diagnosed.err);
}

#[test]
fn replay_says_what_agreement_proves_for_how_sensors_fire() {
    let (folder, _) = Scratch::new("unused", "");
    for (method, said) in [
        ("simultaneous", "the sensors fire at the same instant"),
        ("sequential", "the sensors fire in turn"),
        ("conventional", "the sensors fire with constant lags"),
        ("eeruf", "lags alternate by at least"),
    ] {
        let log = folder.path().join(method.to_owned() + ".mcap");
        let log = log.to_str().unwrap();
        let study = ["study", "scenes/alcove.toml", "--method", method, "--periods", "120", "--mcap", log];
        assert_eq!(eeruf(&study).code, Some(0));
        let outcome = eeruf(&["replay", log, "--t-delta-us", "500"]);
        assert!(outcome.out.contains(said), "{method}: {}", outcome.out);
        // What the method accepted is no second ring.
        assert!(outcome.out.contains(", 8 sensors") && outcome.out.contains("what a filter made of another topic"));
    }
}

#[test]
fn gap_and_clock_step_begin_a_comparison_anew() {
    let rows = |times: [f64; 8]| times.map(|time| format!("{time:.2},1.0\n")).concat();
    for (times, name) in [
        ([0.1, 0.2, 0.3, 0.4, 600.0, 600.1, 600.2, 600.3], "gaps"),
        ([9.1, 9.2, 9.3, 9.4, 0.1, 0.2, 0.3, 0.4], "backwards"),
    ] {
        let (_folder, log) = Scratch::new("log.csv", &format!("t,left\n{}", rows(times)));
        let outcome = eeruf(&["replay", log.to_str().unwrap(), "--t-delta-us", "500", "--json"]);
        let found: Value = serde_json::from_str(&outcome.out).unwrap();
        let counts = ["accepted", "first", name].map(|count| found["total"][count].as_u64());
        assert_eq!(counts, [Some(6), Some(2), Some(1)], "{name}");
    }
}
