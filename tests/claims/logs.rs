//! Logs in, logs out: what `eeruf replay` makes of files from robots.

use eeruf_logs::{Echo, Options, read_log};

use crate::common::{Scratch, eeruf, json};

#[test]
fn replay_writes_what_it_accepts_beside_what_was_recorded_by_rep_117() {
    let rows = ["1.0", "1.0", "2.0", "2.001", "", "", "3.0"];
    let rows: Vec<_> = rows.iter().enumerate().map(|(n, range)| format!("{}.5,{range}", n + 10)).collect();
    let (folder, log) = Scratch::new("log.csv", &format!("t,left\n{}\n", rows.join("\n")));
    let out = folder.path().join("out.mcap");
    let (log, path) = (log.to_str().unwrap(), out.to_str().unwrap());
    let total = json(&["replay", log, "--t-delta-us", "100", "--time", "t", "--out", path, "--json"])["total"].clone();
    let counts = serde_json::json!({"accepted": 2, "rejected": 1, "first": 2, "no_echo": 1, "clear": 1});
    assert_eq!(total, counts);
    let mut written = vec![];
    let report = read_log(&out, &Options::default(), |sensors, reading| {
        written.push((sensors[reading.sensor].topic.clone(), reading.at_ns, reading.echo()));
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
    let without = eeruf(&["replay", log, "--t-delta-us", "100", "--range", "left", "--out", path]);
    assert_eq!((without.code, without.out.as_str()), (Some(2), ""));
    assert!(without.err.ends_with("a reading without a time; --out needs --time COLUMN for CSV\n"), "{}", without.err);
}

#[test]
fn of_a_cut_bag_replay_prints_what_can_be_read_and_says_what_cannot() {
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
fn diagnose_says_from_a_log_of_study_who_fools_whom_and_that_two_phases_do_not_tell() {
    let (folder, log) = Scratch::new("log.csv", "");
    let (log, picture) = (log.to_str().unwrap(), folder.path().join("pairs.svg"));
    let study = |method| {
        let outcome = eeruf(&["study", "scenes/alcove.toml", "--method", method, "--log", log]);
        assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    };
    study("eeruf_hopping");
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
        outcome.out.contains("No sender can be named") && outcome.out.contains("under time hopping"),
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
    assert!(outcome.err.ends_with("--log needs one --method, whose firings are written\n"), "{}", outcome.err);
}

#[test]
fn study_writes_ranges_poses_scene_and_paths_that_another_reader_reads() {
    let (folder, _) = Scratch::new("unused", "");
    let file = folder.path().join("study.mcap");
    let args = ["study", "scenes/alcove.toml", "--method", "conventional,eeruf", "--periods", "40", "--mcap"];
    let outcome = eeruf(&[&args[..], &[file.to_str().unwrap()]].concat());
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));

    // Ours: each method has 8 sensors, and accepts no more than it reads.
    let mut counts = std::collections::BTreeMap::<String, u32>::new();
    let report = read_log(&file, &Options::default(), |sensors, reading| {
        *counts.entry(sensors[reading.sensor].topic.clone()).or_default() += 1;
    });
    assert_eq!(report.unwrap().damage, []);
    for sensor in 1..=8 {
        let of = |topic: &str| counts.get(topic).copied().unwrap_or(0);
        let conventional = format!("/conventional/robot_1/sonar_{sensor}");
        assert_eq!((of(&conventional), of(&format!("{conventional}/accepted"))), (40, 40));
        let eeruf = format!("/eeruf/robot_1/sonar_{sensor}");
        assert!(of(&eeruf) == 40 && of(&format!("{eeruf}/accepted")) < 40);
    }

    // The reader of the crate `mcap`: all messages in JSON are objects of a type of Foxglove's.
    let bytes = std::fs::read(&file).unwrap();
    let mut paths = 0;
    for message in mcap::MessageStream::new(&bytes).unwrap() {
        let message = message.unwrap();
        if message.channel.message_encoding != "json" {
            continue;
        }
        let object: serde_json::Value = serde_json::from_slice(&message.data).unwrap();
        let type_name = message.channel.schema.as_ref().unwrap().name.clone();
        match type_name.as_str() {
            "foxglove.FrameTransforms" => assert_eq!(object["transforms"].as_array().unwrap().len(), 9),
            "foxglove.PoseInFrame" => assert!(object["pose"]["position"]["x"].is_number()),
            "foxglove.SceneUpdate" => {
                let lines = object["entities"][0]["lines"].as_array().unwrap();
                let scene = message.channel.topic == "/scene";
                assert_eq!(lines.len(), if scene { 3 } else { 1 });
                assert!(lines.iter().all(|line| line["points"].as_array().unwrap().len() >= 2));
                paths += usize::from(!scene);
            }
            other => panic!("{other}"),
        }
    }
    assert!(paths > 400, "{paths}");
}
