//! `eeruf design` and `eeruf study RING.toml`: ways of firing judged in rooms by the one cost.

use crate::common::{Scratch, eeruf, eeruf_at_80, json};
use serde_json::Value;

const ALONE: [&str; 7] = ["corridor", "office", "hall", "clutter", "alcove", "garage", "aisle"];

/// A ring whose rooms are simulated in a moment.
const THREE: &str = "sensors = 3\nmodule = 'hc-sr04'\nlayout = 'ring'\nspeed_m_s = 0.5\n";

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().expect("an object").keys().map(String::as_str).collect()
}

fn names<'a>(list: &'a Value, key: &str) -> Vec<&'a str> {
    let of = |value: &'a Value| value[key].as_str().expect("a name");
    list.as_array().expect("a list").iter().map(of).collect()
}

/// The best ways of a kind, by their conditions.
fn best<'a>(answer: &'a Value, kind: &str) -> &'a Vec<Value> {
    let kinds = answer["kinds"].as_array().expect("kinds");
    let of = kinds.iter().find(|it| it["kind"] == kind).unwrap_or_else(|| panic!("no {kind}"));
    of["best"].as_array().expect("ways")
}

#[test]
fn four_lines_get_a_way_with_its_cost_and_figures() {
    let (_scratch, file) = Scratch::new("ring.toml", THREE);
    let ring = file.to_str().unwrap();
    let answer = json(&["design", ring, "--places", "1", "--json"]);
    assert!(answer["schedule"].is_object() && answer["proven"] == true);
    assert_eq!((&answer["period"]["value_us"], &answer["period"]["proven"]), (&answer["value_us"], &answer["proven"]));
    assert_eq!(names(&answer["kinds"], "kind"), ["one by one", "groups", "two phases", "flow"]);
    assert_eq!(names(&answer["baseline"], "condition"), ["standing", "driving", "turning"]);
    let drives = &answer["conditions"][1];
    assert!(drives["condition"] == "driving" && drives["blind_travel_m"].as_f64() > Some(0.0), "{drives}");
    for way in best(&answer, "flow") {
        assert_eq!(keys(&way["rooms"]).len(), ALONE.len(), "{way}");
        for room in ALONE {
            // Without an echo nothing can be right.
            let right = &way["rooms"][room];
            assert!(right.is_null() || right.as_f64().is_some_and(|it| (0.0..=1.0).contains(&it)), "{room}: {way}");
        }
        assert!(way["votes"].is_string() && way["t95_ms"]["interval_95"].is_array(), "{way}");
    }
    let conditions = ["standing", "driving", "turning"];
    assert_eq!(names(&Value::from(best(&answer, "flow").clone()), "condition"), conditions);
    assert_eq!(answer["elsewhere"].as_array().map(Vec::len), Some(3));
    // How to fire the way that is recommended, in figures.
    let how = &answer["how"];
    let way = match answer["recommended"].as_str().expect("a way") {
        "far_groups" => "groups",
        "eeruf" => "two-phases",
        "flow" => "flow",
        _ => "sequential",
    };
    assert_eq!(how["way"], way, "{answer}");
    // The same question has the same answer; options that are gone change nothing, and say so.
    let again = eeruf(&["study", ring, "--places", "1", "--driving", "--wrong", "5", "--json"]);
    let figures: Value = serde_json::from_str(&again.out).unwrap();
    assert_eq!(figures["kinds"], answer["kinds"]);
    for option in ["--driving", "--wrong"] {
        assert!(
            again.err.contains(&format!("warning: {option}: no effect; a ring is judged standing")),
            "{}",
            again.err
        );
    }
    let help = eeruf(&["study", "--help"]).out;
    assert!(!help.contains("--driving") && !help.contains("--wrong"), "{help}");
    let period = eeruf(&["design", ring, "--period-only"]).out;
    assert!(!period.contains("recommended") && period.contains(" cm of range"), "{period}");
}

// A map of a robot is a room with as many places as asked for, in files and in folders.
#[test]
fn maps_are_rooms_with_places_by_their_numbers() {
    let (_scratch, file) = Scratch::new("ring.toml", "sensors = 3\nmodule = 'hc-sr04'\n");
    let ring = file.to_str().unwrap();
    let figures = |more: &[&str]| {
        let answer = json(&[&["study", ring, "--json", "--places", "1", "--rooms"], more].concat());
        best(&answer, "flow").iter().map(|way| way["rooms"].clone()).collect::<Vec<_>>()
    };
    let first = figures(&["tests/data/maps/flat.yaml"]);
    assert!(first.iter().all(|of| keys(of) == ["flat"]) && first[0]["flat"].as_f64() > Some(0.5), "{first:?}");
    assert_eq!(figures(&["tests/data/maps"]), first);
    assert_ne!(figures(&["tests/data/maps/flat.yaml", "--first", "1"]), first);
    let both = figures(&["tests/data/maps/flat.yaml", "--rooms", "scenes/wall.toml"]);
    assert_eq!((&both[0]["flat"], keys(&both[0])), (&first[0]["flat"], vec!["flat", "wall"]));
    let said = eeruf(&["study", ring, "--places", "2", "--rooms", "tests/data/maps/flat.yaml"]).out;
    assert!(said.contains("2 rooms each"), "{said}");
    std::fs::write(&file, "sensors = 3\nmodule = 'hc-sr04'\nspacing_deg = 30\nradius_m = 3\n").unwrap();
    let wide = eeruf(&["study", ring, "--rooms", "tests/data/maps/flat.yaml"]);
    let error = wide.err.lines().last().unwrap_or_default();
    assert!(error.starts_with("eeruf: tests/data/maps/flat.yaml: ") && error.contains("6.00 m wide"), "{}", wide.err);
}

// Whatever was chosen elsewhere, a way that surely stops for nothing more than once a minute here is not recommended.
#[test]
fn ring_among_others_is_judged_beside_another() {
    let (_scratch, file) = Scratch::new("ring.toml", &format!("{THREE}others = true\n"));
    let answer = json(&["study", file.to_str().unwrap(), "--places", "1", "--first", "20000", "--json"]);
    let flow = best(&answer, "flow");
    assert_eq!((flow.len(), keys(&flow[5]["rooms"])), (6, vec!["meeting"]));
    let kinds = answer["kinds"].as_array().unwrap();
    for kind in kinds.iter().filter(|kind| kind["kind"] != "one by one" && kind["cost"].is_object()) {
        for way in kind["best"].as_array().unwrap() {
            let least = way["false_stops_per_min"]["interval_95"][0].as_f64();
            assert!(way["keeps"] == true && least <= Some(1.0), "{way}");
        }
    }
    assert_eq!(answer["elsewhere"].as_array().map(Vec::len), Some(6));
}

#[test]
fn two_sensors_back_to_back_need_no_eeruf() {
    let ring = "sensors = 2\nmodule = 'hc-sr04'\nlayout = 'ring'\njitter_us = 100\n\
                poses = [{ x_m = 0.1, y_m = 0, heading_deg = 0 }, \
                { x_m = -0.1, y_m = 0, heading_deg = 180 }]\n";
    let (_scratch, file) = Scratch::new("ring.toml", ring);
    let file = file.to_str().unwrap();
    let said = eeruf(&["design", file, "--places", "2"]).out;
    assert!(said.contains("You do not need eeruf here"), "{said}");
    let answer = json(&["design", file, "--period-only", "--json"]);
    assert_eq!(answer["not_neighbours"].to_string(), "[[0,1]]");
}

// The first answers are short: at 80 columns 17 lines, and 25.
#[test]
fn answers_fit_a_look_and_say_what_to_do() {
    let lines = |words: &[&str]| {
        let said = eeruf_at_80(words);
        (said.lines().count(), said)
    };
    for ring in ["rings/hc-sr04-8.toml", "rings/magni-5.toml"] {
        let (count, said) = lines(&["study", ring, "--places", "1"]);
        assert!(count <= 17 && said.contains("| flow"), "{count}\n{said}");
        let (count, said) = lines(&["design", ring, "--places", "1"]);
        assert!(count <= 25 && said.contains("How: ") && said.contains("--program"), "{count}\n{said}");
        assert!(said.contains("--proof") && !said.contains("t_wait_a_us"), "{said}");
    }
    let (count, said) = lines(&["study", "scenes/wall.toml"]);
    assert!(count <= 15 && said.contains("t95") && said.contains("One by one is enough"), "{count}\n{said}");
    let (_scratch, file) = Scratch::new("ring.toml", THREE);
    let proof = eeruf(&["design", file.to_str().unwrap(), "--places", "1", "--proof", "--all"]).out;
    for said in ["proven: no schedule", "t_fire_a_us", "blocking,", "never %", "corridor"] {
        assert!(proof.contains(said), "{said}\n{proof}");
    }
}

#[test]
fn own_scenes_are_rooms_and_options_of_scenes_are_refused() {
    let rooms = ["--rooms", "scenes/alcove.toml", "--rooms", "scenes/lab.toml"];
    let answer = json(&[&["study", "rings/hc-sr04-8.toml", "--places", "1", "--json"], &rooms[..]].concat());
    assert_eq!(keys(&best(&answer, "flow")[0]["rooms"]), ["alcove", "lab"]);
    for (words, said) in [
        (
            ["study", "rings/hc-sr04-8.toml", "--periods", "5"],
            "--periods: given with rings/hc-sr04-8.toml; expected it with a scene alone",
        ),
        (
            ["study", "scenes/alcove.toml", "--places", "5"],
            "--places: given with scenes/alcove.toml; expected it with a ring file alone",
        ),
        (["study", "rings/hc-sr04-8.toml", "--rooms", "rings/paper-12.toml"], "expected a scene"),
        (
            ["study", "rings/hc-sr04-8.toml", "--rooms", "docs"],
            "no file that ends in .toml, and no map; expected scenes or maps",
        ),
    ] {
        let refused = eeruf(&words);
        assert!(refused.code == Some(2) && refused.err.contains(said), "{words:?}: {}", refused.err);
    }
    let mower = include_str!("../../rings/mower-8-and-4.toml");
    let (_scratch, file) = Scratch::new("ring.toml", mower.split_once("poses = ").unwrap().0);
    let pairs = eeruf(&["study", file.to_str().unwrap()]);
    assert!(
        pairs.code == Some(1) && pairs.out.contains("not judged in rooms: the ring file does not say"),
        "{}",
        pairs.out
    );
}
