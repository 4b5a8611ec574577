//! The atlas, written by any number of processes that may end at any time; it answers in place of the search.

use std::process::{Command, Stdio};

use eeruf_design::atlas::{ATLAS, Neighbourhood, Row, rows};

use crate::common::{Scratch, eeruf, json};

const FEW: [&str; 2] = ["--most-sensors", "4"];

// Two processes that share the rings make the file that one makes.
#[test]
fn two_processes_make_the_file_of_one() {
    let (folder, one) = Scratch::new("one.txt", "");
    let both = folder.path().join("both.txt");
    let made = eeruf(&[&["atlas", one.to_str().unwrap()], &FEW[..]].concat());
    assert_eq!((made.code, made.out.as_str(), made.err.as_str()), (Some(0), "", ""));
    let share = |share| {
        Command::new(env!("CARGO_BIN_EXE_eeruf"))
            .args(["atlas", both.to_str().unwrap(), "--shard", share])
            .args(FEW)
            .stdout(Stdio::null())
            .spawn()
            .unwrap()
    };
    for mut process in [share("1/2"), share("2/2")] {
        assert!(process.wait().unwrap().success());
    }
    let text = |file| std::fs::read_to_string(file).unwrap();
    assert_eq!(text(&one), text(&both));
    let rows = text(&one).lines().filter(|line| !line.starts_with('#')).count();
    assert!(rows > 40, "{rows} rows");
}

// A file that was cut within a row is completed and rows that are there are not made again.
#[test]
fn cut_file_is_completed_without_repeating_rows() {
    let (_folder, file) = Scratch::new("atlas.txt", "");
    let name = file.to_str().unwrap();
    let command = [&["atlas", name], &FEW[..]].concat();
    assert_eq!(eeruf(&command).code, Some(0));
    let whole = std::fs::read_to_string(&file).unwrap();
    // As a process leaves it that is ended while it writes: rows in any order, the last cut.
    let mut rows: Vec<&str> = whole.lines().filter(|line| !line.starts_with('#')).collect();
    rows.rotate_left(7);
    // A hash that no search gives shows that its row was kept.
    let hash = rows[0].split(' ').nth(10).unwrap();
    let marked = rows[0].replace(hash, &"0".repeat(32));
    let cut = format!("{marked}\n{}\n{}", rows[1..20].join("\n"), &rows[20][..30]);
    std::fs::write(&file, cut).unwrap();
    assert_eq!(eeruf(&command).code, Some(0));
    let again = std::fs::read_to_string(&file).unwrap();
    assert_eq!(again.replace(&marked, rows[0]), whole);
    assert!(again.contains(&marked));
}

#[test]
fn a_share_that_makes_no_sense_is_refused() {
    let (_folder, file) = Scratch::new("atlas.txt", "");
    for share in ["0/2", "3/2", "1", "a/b"] {
        let refused = eeruf(&["atlas", file.to_str().unwrap(), "--shard", share]);
        assert_eq!(refused.code, Some(2), "{share}");
        assert!(refused.err.contains("expected I/N, such as 2/8"), "{}", refused.err);
    }
}

// A ring of the atlas is answered in any tick that its needs are as many of.
#[test]
fn atlas_answers_in_any_multiple_tick() {
    for (tick, us) in [("1000", 1000), ("500", 500)] {
        let times = |ticks: u32| ticks * us;
        let ring = format!(
            "sensors = 12\nt_delta_us = {}\nmin_interval_us = {}\nwindow_us = {}\ntick_us = {tick}\n",
            times(1) - 1,
            times(15),
            times(30)
        );
        let (_folder, file) = Scratch::new("ring.toml", &ring);
        let found = json(&["design", "--period-only", file.to_str().unwrap(), "--json"]);
        assert_eq!((&found["from_atlas"], &found["value_us"]), (&true.into(), &times(65).into()), "{tick}");
        // One tick more to listen is another ring.
        let other = ring.replace(&format!("window_us = {}", times(30)), &format!("window_us = {}", times(31)));
        std::fs::write(&file, other).unwrap();
        let searched = json(&["design", "--period-only", file.to_str().unwrap(), "--json"]);
        assert_eq!((&searched["from_atlas"], &searched["proven"]), (&false.into(), &true.into()), "{tick}");
    }
    let described = eeruf(&["design", "--period-only", "rings/paper-12.toml"]);
    assert!(described.out.contains("from the atlas, verified"), "{}", described.out);
    let searched = eeruf(&["design", "--period-only", "rings/paper-12.toml", "--no-atlas"]);
    assert!(searched.out.contains("540 nodes, and"), "{}", searched.out);
}

// Where a row's certificate says less than its bound, design and verify say so.
#[test]
fn proven_says_if_it_is_not_certified() {
    for is_certified in [false, true] {
        let is_one =
            |row: &Row| row.ring.sensors > 8 && row.bound == row.period && (row.certified == row.bound) == is_certified;
        let Row { ring, period, certified, .. } = rows(ATLAS).find(is_one).unwrap();
        let (layout, neighbours) = match ring.neighbourhood {
            Neighbourhood::All => ("line", ring.sensors),
            Neighbourhood::Line(n) => ("line", n),
            Neighbourhood::Ring(n) => ("ring", n),
        };
        let needs = format!(
            "sensors = {}\nlayout = \"{layout}\"\nneighbours = {neighbours}\nt_delta_us = {}\n\
             min_interval_us = {}000\nwindow_us = {}000\n",
            ring.sensors,
            500 * ring.separation - 1,
            ring.interval,
            ring.window
        );
        let (folder, file) = Scratch::new("ring.toml", &needs);
        let (file, schedule) = (file.to_str().unwrap(), folder.path().join("schedule.toml"));
        let found = json(&["design", "--period-only", file, "--json"]);
        let times = [1000 * period, 1000 * certified].map(serde_json::Value::from);
        assert_eq!([&found["value_us"], &found["certified_us"]], [&times[0], &times[1]], "{ring}");
        let said = if is_certified { "proven: no schedule" } else { "proven, not certified: no schedule" };
        let out = eeruf(&["design", "--period-only", file]).out;
        assert!(out.contains(said), "{out}");
        std::fs::write(&schedule, eeruf(&["design", file, "--emit", "toml"]).out).unwrap();
        let verify = ["verify", schedule.to_str().unwrap(), "--ring", file];
        let verified = json(&[&verify[..], &["--json"]].concat());
        assert_eq!([&verified["shortest_us"], &verified["certified_us"]], [&times[0], &times[1]], "{ring}");
        let said = if is_certified { "; proven.\n" } else { "; proven, not certified: its certificate" };
        let out = eeruf(&verify).out;
        assert!(out.contains("is the shortest for this ring") && out.contains(said), "{out}");
    }
}
