//! Logs in, logs out: the verdicts of `eeruf replay` on files from robots.

use eeruf_logs::{Echo, Options, read_log};

use crate::common::{Scratch, eeruf, json};
use crate::ros2::Message;

// Replay writes what it accepts beside what was recorded by rep 117.
#[test]
fn replay_writes_accepted_ranges_by_rep_117() {
    let rows = ["1.0", "1.0", "2.0", "2.001", "", "", "3.0"];
    let rows: Vec<_> = rows.iter().enumerate().map(|(n, range)| format!("{}.5,{range}", n + 10)).collect();
    let (folder, log) = Scratch::new("log.csv", &format!("t,left\n{}\n", rows.join("\n")));
    let out = folder.path().join("out.mcap");
    let (log, path) = (log.to_str().unwrap(), out.to_str().unwrap());
    let total = json(&["replay", log, "--t-delta-us", "100", "--time", "t", "--out", path, "--json"])["total"].clone();
    let counts = serde_json::json!({"accepted": 2, "rejected": 1, "first": 2, "no_echo": 1, "clear": 1});
    assert_eq!(total, counts);
    let mut written = vec![];
    let report = read_log(&out, &Options { judged: true, ..Options::default() }, |report, reading| {
        written.push((report.sensors[reading.sensor].topic.clone(), reading.at_ns.unwrap(), reading.echo()));
    });
    assert_eq!(report.unwrap().damage, []);
    let of = |topic: &str| -> Vec<_> {
        written.iter().filter(|entry| entry.0 == topic).map(|entry| (entry.1, entry.2)).collect()
    };
    assert_eq!(of("left").len(), 7);
    let second = |n: u64| n * 1_000_000_000 + 500_000_000;
    let range = |metres: f64| Echo::At(f64::from(metres as f32));
    assert_eq!(
        of("left/accepted"),
        [(second(11), range(1.0)), (second(13), range(2.001)), (second(15), Echo::Nothing)]
    );
    let (_folder, log) = Scratch::new("log.csv", "left\n1.0\n1.5\n");
    let without = eeruf(&["replay", log.to_str().unwrap(), "--t-delta-us", "100", "--out", path]);
    assert_eq!((without.code, without.out.as_str()), (Some(2), ""));
    assert!(without.err.ends_with("expected --time COLUMN for a table, as MCAP needs times\n"), "{}", without.err);
}

#[test]
fn replay_prints_what_a_cut_bag_still_holds() {
    let whole = std::fs::read("crates/eeruf-logs/tests/bags/ros1-none.bag").unwrap();
    let (folder, _) = Scratch::new("unused", "");
    let file = folder.path().join("cut.bag");
    std::fs::write(&file, &whole[..whole.len() / 2 + 2200]).unwrap();
    let outcome = eeruf(&["replay", file.to_str().unwrap(), "--t-delta-us", "100"]);
    assert_eq!((outcome.code, outcome.err.lines().count()), (Some(2), 1), "{}", outcome.err);
    assert!(outcome.err.contains("the bag is cut, or a length in it is wrong"), "{}", outcome.err);
    assert!(outcome.out.contains("| /sonar/1 |"), "{}", outcome.out);
}

#[test]
fn diagnose_says_who_fools_whom_from_a_study() {
    let (folder, log) = Scratch::new("log.csv", "");
    let (log, picture) = (log.to_str().unwrap(), folder.path().join("pairs.svg"));
    let study = |method| {
        let outcome = eeruf(&["study", "scenes/alcove.toml", "--method", method, "--log", log]);
        assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    };
    study("dither");
    let outcome = eeruf(&["diagnose", log, "--svg", picture.to_str().unwrap()]);
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    let found = json(&["diagnose", log, "--json"]);
    let paths = found["paths"].as_array().unwrap();
    // Table row and object agree, the one from 1, the other from 0.
    let fooled = paths.iter().find(|path| path["sender"] != path["receiver"]).unwrap();
    let from_one = |key: &str| fooled[key].as_u64().unwrap() + 1;
    let row = format!("| {:<13} | {:>7} |", from_one("receiver"), from_one("sender"));
    assert!(outcome.out.contains(&row), "{row}\n{}", outcome.out);
    assert!(paths.iter().all(|path| path["accidents"].as_f64().unwrap() < 0.01));
    assert!(
        found["rejected_foreign"].as_u64() <= found["rejected"].as_u64() && found["faults"] == serde_json::json!([])
    );
    assert!(std::fs::read_to_string(picture).unwrap().contains("Whose sound each sensor reads"));

    study("eeruf");
    let outcome = eeruf(&["diagnose", log]);
    assert!(
        outcome.out.contains("No sender can be named") && outcome.out.contains("whose waits are drawn at random"),
        "{}",
        outcome.out
    );
    // The scene's ring fires by the paper's table at another period.
    let other = eeruf(&["diagnose", log, "--schedule", "rings/table-i-d.toml"]);
    assert_eq!((other.code, other.out.as_str()), (Some(2), ""));
    assert!(other.err.contains("its periods last 60.0 % of the schedule's; expected 90 to 110 %"), "{}", other.err);
}

#[test]
fn study_writes_the_log_of_one_method() {
    let outcome = eeruf(&["study", "scenes/wall.toml", "--log", "log.csv"]);
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.err.ends_with("expected one --method, whose firings it writes\n"), "{}", outcome.err);
}

// Study writes ranges poses scene and paths that another reader reads.
#[test]
fn study_writes_what_another_reader_reads() {
    let (folder, _) = Scratch::new("unused", "");
    let file = folder.path().join("study.mcap");
    let args = ["study", "scenes/alcove.toml", "--method", "conventional,eeruf", "--periods", "40", "--mcap"];
    let outcome = eeruf(&[&args[..], &[file.to_str().unwrap()]].concat());
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));

    // Ours: each method has 8 sensors, and accepts no more than it reads.
    let mut counts = std::collections::BTreeMap::<String, u32>::new();
    let report = read_log(&file, &Options { judged: true, ..Options::default() }, |report, reading| {
        *counts.entry(report.sensors[reading.sensor].topic.clone()).or_default() += 1;
    });
    assert_eq!(report.unwrap().damage, []);
    for sensor in 1..=8 {
        let of = |topic: &str| counts.get(topic).copied().unwrap_or(0);
        let conventional = format!("/conventional/robot_1/sonar_{sensor}");
        assert_eq!((of(&conventional), of(&format!("{conventional}/accepted"))), (40, 40));
        let eeruf = format!("/eeruf/robot_1/sonar_{sensor}");
        assert!(of(&eeruf) == 40 && of(&format!("{eeruf}/accepted")) < 40);
    }

    // By the definitions in the file: all messages are of ROS 2.
    let mut paths = 0;
    for Message { topic, kind, value, .. } in crate::ros2::messages(&file) {
        match kind.as_str() {
            "sensor_msgs/msg/Range" => assert_eq!(value["header"]["frame_id"], topic_frame(&topic)),
            "tf2_msgs/msg/TFMessage" => assert_eq!(value["transforms"].as_array().unwrap().len(), 9),
            "nav_msgs/msg/Odometry" => assert_eq!(value["child_frame_id"], "robot_1"),
            "visualization_msgs/msg/MarkerArray" if topic == "/scene" => {
                assert_eq!(value["markers"][1]["points"].as_array().unwrap().len(), 2 * 3);
            }
            "visualization_msgs/msg/MarkerArray" => {
                assert!(value["markers"][0]["points"].as_array().unwrap().len() >= 2);
                paths += 1;
            }
            "eeruf_msgs/msg/Firing" => {
                let echo = value["t_echo_us"].as_u64().unwrap();
                assert_eq!(value["has_echo"], echo > 0);
            }
            other => panic!("{other}"),
        }
    }
    assert!(paths > 400, "{paths}");
}

/// The frame of a sensor by its topic, `/METHOD/FRAME` or `/METHOD/FRAME/accepted`.
fn topic_frame(topic: &str) -> &str {
    topic[1..].split_once('/').unwrap().1.trim_end_matches("/accepted")
}

#[test]
fn logs_say_whether_there_is_crosstalk() {
    let (folder, _) = Scratch::new("unused", "");
    let file = folder.path().join("log.mcap");
    let file = file.to_str().unwrap();
    for (method, verdict) in [("eeruf", "crosstalk"), ("sequential", "none seen"), ("conventional", "cannot tell")] {
        // 100 rounds one by one take 60 s.
        let periods = if method == "sequential" { "1200" } else { "300" };
        let study = ["study", "scenes/alcove.toml", "--method", method, "--periods", periods, "--mcap", file];
        assert_eq!(eeruf(&study).code, Some(0));
        let found = &json(&["logs", file, "--json"])["crosstalk"];
        assert_eq!(found["verdict"], verdict, "{found}");
        assert_eq!(found["fooled"].as_array().unwrap().is_empty(), method != "eeruf", "{found}");
        assert_eq!(found["record"].is_null(), method != "conventional", "{found}");
        let text = eeruf(&["logs", file]).out;
        let begins = match method {
            "eeruf" => "Crosstalk: sensors read each other's sound.\nconcerns: /eeruf/robot_1/sonar_",
            "sequential" => "No crosstalk seen.\nbecause each sensor fires",
            _ => "This log cannot tell whether there is crosstalk.\ndo 1: hold a cloth before /conventional/",
        };
        assert!(text.starts_with(begins), "{text}");
    }
}

#[test]
fn survey_gives_a_ring_file_for_design() {
    let (folder, log) = Scratch::new("survey.csv", "");
    let (log, ring, picture) =
        (log.to_str().unwrap(), folder.path().join("ring.toml"), folder.path().join("survey.svg"));
    let simulated = ["survey", "--simulate", "scenes/alcove.toml", "--physics", "default", "--out", log];
    let found = json(&[&simulated[..], &["--json"]].concat());
    let of = |name: &str| found["truth"][name].as_u64().unwrap();
    assert_eq!(found["physics"], "default");
    assert!(of("loud_pairs_found") * 10 >= of("loud_pairs") * 6 && of("loud_pairs") > 40, "{}", found["truth"]);
    assert_eq!((of("pairs_wrong"), of("paths_wrong")), (0, 0), "{}", found["truth"]);
    // The log alone says the same.
    let read = json(&["survey", log, "--json"]);
    assert_eq!((&read["paths"], &read["conflicts"]), (&found["paths"], &found["conflicts"]));
    let (ring, picture) = (ring.to_str().unwrap(), picture.to_str().unwrap());
    let outcome = eeruf(&["survey", log, "--ring", ring, "--svg", picture, "--until-us", "8000"]);
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    assert!(outcome.out.contains("pairs hear each other within 8.0 ms"), "{}", outcome.out);
    let design = eeruf(&["design", "--period-only", ring, "--budget", "20000", "--json"]);
    assert_eq!((design.code, design.err.as_str()), (Some(0), ""), "{}", std::fs::read_to_string(ring).unwrap());
    assert!(std::fs::read_to_string(picture).unwrap().contains("hears the others first"));
}

#[test]
fn diagnose_says_the_same_of_a_log_in_mcap_and_in_csv() {
    let (folder, csv) = Scratch::new("log.csv", "");
    let mcap = folder.path().join("log.mcap");
    for log in [&csv, &mcap] {
        let log = log.to_str().unwrap();
        let study = ["study", "scenes/alcove.toml", "--method", "flow", "--periods", "300", "--log", log];
        assert_eq!(eeruf(&study).code, Some(0));
    }
    let found = |log: &std::path::Path| json(&["diagnose", log.to_str().unwrap(), "--json"]);
    assert_eq!(found(&csv), found(&mcap));
}

#[test]
fn experiments_write_their_first_alcove_and_course_as_mcap() {
    let (folder, _) = Scratch::new("unused", "");
    for (name, arguments, most) in [
        ("one.mcap", &["experiment", "set-one", "--first", "7", "--method", "eeruf"][..], 8_000),
        ("two.mcap", &["experiment", "set-two", "--first", "7", "--method", "eeruf"], 6_000),
    ] {
        let file = folder.path().join(name);
        let path = file.to_str().unwrap();
        let outcome = eeruf(&[arguments, &["--mcap", path, "--physics", "plain"]].concat());
        assert_eq!((outcome.code, outcome.out.as_str(), outcome.err.as_str()), (Some(0), "", ""));
        let mut readings = 0;
        let report = read_log(&file, &Options { judged: true, ..Options::default() }, |report, reading| {
            readings += u32::from(!report.sensors[reading.sensor].topic.ends_with("/accepted"));
        });
        assert_eq!(report.unwrap().damage, []);
        assert!((1_000..=most).contains(&readings), "{name}: {readings}");
        let diagnosed = json(&["diagnose", path, "--json"]);
        assert!(diagnosed["firings"].as_u64().is_none_or(|firings| firings == u64::from(readings)), "{name}");
    }
    let without = eeruf(&["experiment", "set-two", "--mcap", "x.mcap", "--seeds", "1"]);
    assert_eq!((without.code, without.err.contains("--mcap needs one --method")), (Some(2), true), "{}", without.err);
}

// The data set is the same bit for bit and knows whose sound each reading is.
#[test]
fn data_set_is_equal_bit_for_bit_with_causes() {
    let (folder, _) = Scratch::new("unused", "");
    let out = folder.path().join("data");
    let small = ["--alcoves", "1", "--courses", "1", "--periods", "40", "--physics", "default"];
    let outcome = eeruf(&[&["dataset", out.to_str().unwrap()], &small[..]].concat());
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    let mut files = vec![];
    for kind in ["alcoves", "courses"] {
        for entry in std::fs::read_dir(out.join(kind).join("60000")).unwrap() {
            files.push(entry.unwrap().path());
        }
    }
    files.sort();
    assert_eq!(files.len(), 4 + 7);
    // FNV-1a, 64 bits, of all but flow, whose dice and belief core's own tests hold.
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    let is_flow = |file: &std::path::Path| file.file_name().unwrap().to_string_lossy().starts_with("flow");
    for file in files.iter().filter(|file| !is_flow(file)) {
        let text = std::fs::read(file).unwrap();
        text.iter().for_each(|&byte| hash = (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3));
    }
    assert_eq!(format!("{hash:016x}"), "509bb4cde989a596");
    let readings = std::fs::read_to_string(out.join("alcoves/60000/conventional.csv")).unwrap();
    let fooled = readings.lines().filter(|line| line.contains(",crosstalk,")).count();
    assert!(fooled > 20 && readings.lines().count() == 2 + 8 * 40, "{fooled} of {}", readings.lines().count());
}
