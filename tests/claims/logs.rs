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
