//! Small logs as users have them, and the program's answers.

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
    let options = &["--out", out.to_str().unwrap()];
    for file in ["first-empty.csv", "time-from-zero.csv"] {
        assert_eq!(replay(file, &[timed, options].concat()).0.code, Some(0), "{file}");
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
    assert!(outcome.err.contains("line 5: `40`: number of cells 1; expected 2"), "{}", outcome.err);
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

// Forms from threads, each with the answer that was written down before the program saw it: for each sensor its name,
// readings, echoes, and the nearest and farthest in millimetres.
#[test]
fn sensors_of_the_field_are_ranges_that_were_measured() {
    type Sensor = (&'static str, [u64; 2], [u64; 2]);
    let whole = |name, readings| (name, [15, readings], [0, 5000]);
    let cases: [(&str, &[Sensor]); 6] = [
        (
            "six-lines.txt",
            &[
                ("Distance 1", [15, 13], [770, 800]),
                ("Distance 2", [15, 14], [1420, 1450]),
                whole("Distance 3", 15),
                ("Distance 4", [15, 14], [310, 350]),
                ("Distance 5", [15, 14], [2080, 2120]),
                whole("Distance 6", 15),
            ],
        ),
        ("tasmota-two.log", &[("SR04-1.Distance", [12, 12], [705, 716]), ("SR04-2.Distance", [12, 12], [1350, 1372])]),
        ("mavlogdump-rfnd.csv", &[("0", [20, 20], [1230, 1250]), ("1", [20, 8], [2570, 2570])]),
        ("toa5.dat", &[("DT_1", [14, 14], [1234, 1247]), ("DT_2", [14, 13], [873, 873])]),
        ("dates-in-columns.csv", &[("distance", [60, 60], [1102, 1110])]),
        (
            "ten-echoes.csv",
            &[("US/Left/Sensor/Value", [15, 15], [610, 620]), ("US/Right/Sensor/Value", [15, 15], [830, 830])],
        ),
    ];
    for (file, expected) in cases {
        let said = eeruf(&["logs", &format!("tests/data/field-cases/{file}"), "--json"]);
        // Nobody can say whether these sensors hear each other.
        assert_eq!((said.code, said.err.as_str()), (Some(3), ""), "{file}");
        let found: Value = serde_json::from_str(&said.out).unwrap();
        let sensors = found["sensors"].as_array().unwrap();
        assert_eq!(sensors.len(), expected.len(), "{file}: {}", said.out);
        for (sensor, (name, counts, [least, most])) in sensors.iter().zip(expected) {
            let count = ["readings", "echoes"].map(|key| sensor[key].as_u64().unwrap());
            assert_eq!((sensor["name"].as_str().unwrap(), &count), (*name, counts), "{file}");
            let mm = ["least_m", "most_m"].map(|key| (1000.0 * sensor[key].as_f64().unwrap()).round() as u64);
            assert!(mm[0] >= *least && mm[1] <= *most, "{file}: {name}: {mm:?}");
        }
    }
}

#[test]
fn many_measurements_a_row_are_readings_of_the_same_sensors() {
    let said = eeruf(&["logs", "tests/data/field-cases/bicycle.csv", "--json"]);
    let found: Value = serde_json::from_str(&said.out).unwrap();
    let sensors = found["sensors"].as_array().unwrap();
    let of = |key: &str| sensors.iter().map(|sensor| sensor[key].as_f64().unwrap()).collect::<Vec<_>>();
    assert_eq!(sensors.iter().map(|sensor| sensor["name"].as_str().unwrap()).collect::<Vec<_>>(), ["L_us", "R_us"]);
    assert!(of("readings")[0] >= 300.0 && of("no_echo")[0] > 10.0, "{}", said.out);
    assert!((1.558..1.566).contains(&of("least_m")[0]) && (1.558..1.566).contains(&of("most_m")[0]));
    assert!((0.889..0.897).contains(&of("least_m")[1]) && (0.889..0.897).contains(&of("most_m")[1]));
}

#[test]
fn number_that_nothing_measures_is_said_to_never_change() {
    let said = eeruf(&["logs", "tests/data/field-cases/never-computed.txt"]);
    assert!(said.code == Some(3) && said.out.contains("note Sensor 1: never changes: 20 readings"), "{}", said.out);
}

#[test]
fn log_from_a_pipe_has_all_its_readings() {
    let text = std::fs::read("tests/data/field-cases/six-lines.txt").unwrap();
    for name in ["-", "/dev/stdin"] {
        let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_eeruf"))
            .args(["logs", name, "--json"])
            .stdin(std::process::Stdio::piped())
            .stdout(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), &text).unwrap();
        let found: Value = serde_json::from_slice(&child.wait_with_output().unwrap().stdout).unwrap();
        let readings = found["sensors"].as_array().unwrap().iter().map(|sensor| sensor["readings"].as_u64().unwrap());
        assert_eq!(readings.sum::<u64>(), 90, "{name}");
    }
}

#[test]
fn bags_of_the_field_give_sensors_or_what_was_found() {
    let (outcome, _) = replay("pointcloud.bag", &[]);
    assert_eq!(outcome.code, Some(2));
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

// The document's ten answers are what is printed, up to the first empty line.
#[test]
fn ten_answers_of_the_document_are_as_printed() {
    let document = std::fs::read_to_string("docs/log/answers.md").unwrap();
    let blocks: Vec<_> = document.split("```text\n$ eeruf ").skip(1).collect();
    assert_eq!(blocks.len(), 10);
    for block in blocks {
        let (command, shown) = block.split_once('\n').unwrap();
        let said = eeruf(&command.split(' ').collect::<Vec<_>>());
        let (answer, _) = said.out.split_once("\n\n").unwrap();
        assert_eq!(shown.split_once("\n```").unwrap().0, answer, "{command}");
    }
}
