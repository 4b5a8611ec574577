//! `eeruf design` and `eeruf study RING.toml`: ways of firing judged in rooms.

use crate::common::{Scratch, eeruf, eeruf_at_80, json};
use serde_json::Value;

const ROOMS: [&str; 8] = ["corridor", "office", "hall", "clutter", "alcove", "garage", "aisle", "meeting"];

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

fn way<'a>(answer: &'a Value, name: &str) -> &'a Value {
    let ways = answer["ways"].as_array().expect("ways");
    ways.iter().find(|way| way["way"] == name).unwrap_or_else(|| panic!("no way {name}"))
}

/// Returns the mean of a figure over rooms.
fn mean(way: &Value, figure: &str) -> f64 {
    ROOMS.iter().map(|room| number(&way["rooms"][room][figure])).sum::<f64>() / ROOMS.len() as f64
}

#[test]
fn four_lines_get_a_way_with_its_figures_in_each_room() {
    let (_scratch, file) =
        Scratch::new("ring.toml", "sensors = 8\nmodule = 'hc-sr04'\nlayout = 'ring'\nspeed_m_s = 0.5\n");
    let ring = file.to_str().unwrap();
    let answer = json(&["design", ring, "--places", "1", "--json"]);
    assert!(answer["schedule"].is_object() && answer["proven"] == true);
    assert_eq!(answer["ways"][0]["way"], "sequential");
    assert_eq!(way(&answer, "sequential_median")["title"], "one by one, median of three");
    let best = way(&answer, answer["recommended"].as_str().expect("a way"));
    assert_eq!((&answer["period"]["value_us"], &answer["period"]["proven"]), (&answer["value_us"], &answer["proven"]));
    for room in ROOMS {
        let figures = &best["rooms"][room];
        let shares = ["belief_right", "unknown", "phantom", "too_far", "faint"];
        let sum: f64 = shares.iter().map(|share| number(&figures[share])).sum();
        assert!((sum - 1.0).abs() < 1e-6, "{room}: {figures}");
        assert!(number(&figures["right_echoes_per_s"]) >= 0.0 && number(&figures["blind"]) >= 0.0);
    }
    // Eight rooms, one of each kind: 90 % of them are all.
    let blind = ROOMS.map(|room| number(&best["rooms"][room]["blind"]));
    let [least, most] = [0, 1].map(|end| number(&best["blind_90"][end]));
    assert_eq!(least, blind.iter().copied().fold(f64::MAX, f64::min).floor());
    assert_eq!(most, blind.iter().copied().fold(0.0, f64::max).ceil());
    assert_eq!(answer["elsewhere"].as_array().map(Vec::len), Some(3));
    // The same question has the same answer.
    let again = json(&["study", ring, "--places", "1", "--cost", "--json"]);
    assert_eq!(again["ways"], answer["ways"]);
    // The best of each cell is named, and the kind to recommend is one of them.
    let by_cost = &again["by_cost"];
    let kinds = by_cost["kinds"].as_array().expect("kinds");
    assert!(kinds.iter().any(|kind| kind["kind"] == by_cost["recommended"]), "{by_cost}");
    for best in kinds.iter().flat_map(|kind| kind["best"].as_array().expect("ways")) {
        assert!(best["way"].is_string() && best["votes"].is_string() && best["t95_ms"].is_object(), "{best}");
    }
    let said = eeruf(&["design", ring, "--places", "1"]).out;
    assert!(said.contains("recommended: ") && said.contains("period"), "{said}");
    let sensors = if most == 0.0 { "none of its sensors is blind.\n" } else { "of its 8 sensors are blind.\n" };
    assert!(said.contains(sensors), "{said}");
    let period = eeruf(&["design", ring, "--period-only"]).out;
    assert!(!period.contains("recommended") && period.contains("5.5 cm of range"), "{period}");
}

// A map of a robot is a room with as many places as asked for, in files and in folders.
#[test]
fn maps_are_rooms_with_places_by_their_numbers() {
    let (_scratch, file) = Scratch::new("ring.toml", "sensors = 3\nmodule = 'hc-sr04'\n");
    let ring = file.to_str().unwrap();
    let figures = |more: &[&str]| {
        let answer = json(&[&["study", ring, "--json", "--places", "1", "--rooms"], more].concat());
        way(&answer, "simultaneous")["rooms"].clone()
    };
    let first = figures(&["tests/data/maps/flat.yaml"]);
    assert!(first["flat"]["right_echoes_per_s"].as_f64().is_some_and(|rate| rate > 0.0), "{first}");
    assert_eq!(first.as_object().map(serde_json::Map::len), Some(1));
    assert_eq!(figures(&["tests/data/maps"]), first);
    assert_ne!(figures(&["tests/data/maps/flat.yaml", "--first", "1"]), first);
    let both = figures(&["tests/data/maps/flat.yaml", "--rooms", "scenes/wall.toml"]);
    assert_eq!((&both["flat"], both.as_object().map(serde_json::Map::len)), (&first["flat"], Some(2)));
    let said = eeruf(&["study", ring, "--places", "2", "--rooms", "tests/data/maps/flat.yaml"]).out;
    assert!(said.contains("In 2 rooms"), "{said}");
    std::fs::write(&file, "sensors = 3\nmodule = 'hc-sr04'\nspacing_deg = 30\nradius_m = 3\n").unwrap();
    let wide = eeruf(&["study", ring, "--rooms", "tests/data/maps/flat.yaml"]);
    let error = wide.err.lines().last().unwrap_or_default();
    assert!(error.starts_with("eeruf: tests/data/maps/flat.yaml: ") && error.contains("6.00 m wide"), "{}", wide.err);
}

// Way recommended keeps foreign sound low where all at once does not.
#[test]
fn recommended_way_keeps_foreign_sound_low() {
    let answer = json(&["study", "rings/hc-sr04-8.toml", "--places", "4", "--first", "20000", "--json"]);
    assert_eq!(answer["keeps"], true);
    let best = way(&answer, answer["recommended"].as_str().unwrap());
    let foreign = |way: &Value| {
        ROOMS.map(|room| number(&way["rooms"][room]["foreign_of_believed"])).into_iter().fold(0.0, f64::max)
    };
    assert!(foreign(best) <= 0.03, "{}", foreign(best));
    assert!(foreign(way(&answer, "simultaneous")) > 0.1);
    let base = way(&answer, "sequential");
    assert!(mean(best, "belief_right") > mean(base, "belief_right") - 0.02);
    assert!(mean(best, "right_echoes_per_s") > 2.0 * mean(base, "right_echoes_per_s"));
    // The geometric mean over kinds of rooms, between its limits; of one by one to itself it is 1.
    let echoes = |way: &Value, room| number(&way["rooms"][room]["right_echoes_per_s"]) + 0.1;
    let times =
        ROOMS.map(|room| (echoes(best, room) / echoes(base, room)).ln()).iter().sum::<f64>() / ROOMS.len() as f64;
    let limits = |way: &Value| [0, 1].map(|end| number(&way["times_95"][end]).ln());
    let [low, high] = limits(best);
    assert!(low < times && times < high && high - low < 0.5, "{low} {times} {high}");
    assert_eq!(limits(base), [0.0, 0.0]);
}

#[test]
fn two_sensors_back_to_back_need_no_eeruf() {
    let ring = "sensors = 2\nmodule = 'hc-sr04'\nlayout = 'ring'\njitter_us = 100\n\
                poses = [{ x_m = 0.1, y_m = 0, heading_deg = 0 }, \
                { x_m = -0.1, y_m = 0, heading_deg = 180 }]\n";
    let (_scratch, file) = Scratch::new("ring.toml", ring);
    let file = file.to_str().unwrap();
    let said = eeruf(&["design", file, "--places", "3"]).out;
    assert!(said.contains("You do not need eeruf here"), "{said}");
    let answer = json(&["design", file, "--period-only", "--json"]);
    assert_eq!(answer["not_neighbours"].to_string(), "[[0,1]]");
}

// The first answers are short: at 80 columns 14 lines, 15 where a way has a long name, and 25.
#[test]
fn answers_fit_a_look_and_say_what_to_do() {
    let lines = |words: &[&str]| {
        let said = eeruf_at_80(words);
        (said.lines().count(), said)
    };
    for ring in ["rings/hc-sr04-8.toml", "rings/car-12.toml", "rings/ring-24.toml", "rings/labmate-8.toml"] {
        let (count, said) = lines(&["study", ring, "--places", "1"]);
        assert!(count <= 14 && said.contains("| flow"), "{count}\n{said}");
        let (count, said) = lines(&["design", ring, "--places", "1"]);
        assert!(count <= 25 && said.contains("How: ") && said.contains("--program"), "{count}\n{said}");
        assert!(said.contains("--proof") && !said.contains("t_wait_a_us"), "{said}");
    }
    let (count, said) = lines(&["study", "scenes/wall.toml"]);
    assert!(count <= 15 && said.contains("t95") && said.contains("One by one is enough"), "{count}\n{said}");
    let proof = eeruf(&["design", "rings/hc-sr04-8.toml", "--places", "1", "--proof", "--all"]).out;
    for said in ["proven: no schedule", "t_fire_a_us", "| sequential_votes ", "corridor"] {
        assert!(proof.contains(said), "{said}\n{proof}");
    }
}

// JSON says how in figures, and what that buys where the ring is used; in the user's own rooms nothing appears.
#[test]
fn way_of_firing_is_said_in_figures() {
    let answer = json(&["design", "rings/hc-sr04-8.toml", "--places", "1", "--json"]);
    let how = &answer["how"];
    assert_eq!((how["way"].as_str(), how["votes"].as_str()), (Some("flow"), Some("by_motion")));
    assert_eq!(how["order"], serde_json::json!([0, 3, 6, 1, 4, 7, 2, 5]));
    assert!(how["gaps_us"][0].as_u64() < how["gaps_us"][1].as_u64());
    let named: Vec<_> = answer["conditions"].as_array().into_iter().flatten().collect();
    assert_eq!(named.iter().map(|of| &of["condition"]).collect::<Vec<_>>(), ["standing", "driving", "turning"]);
    for of in named {
        assert!(of["t95_ms_95"][0].as_f64() <= of["t95_ms"].as_f64().or(Some(f64::INFINITY)), "{of}");
        assert_eq!(of["blind_travel_m_95"].is_array(), of["condition"] == "driving");
        assert!(of["false_stops_per_min"].is_f64() && of["false_stops_per_min_95"].is_array(), "{of}");
    }
    let own = json(&["design", "rings/hc-sr04-8.toml", "--rooms", "scenes/alcove.toml", "--json"]);
    assert!(own["recommended"].is_string() && own["conditions"].is_null(), "{own}");
}

#[test]
fn limits_no_way_keeps_are_named() {
    let ring = "sensors = 32\nmodule = 'polaroid-6500'\nlayout = 'ring'\njitter_us = 100\n";
    let (_scratch, file) = Scratch::new("ring.toml", ring);
    let said = eeruf(&["study", file.to_str().unwrap(), "--places", "2", "--all"]).out;
    assert!(said.contains("No way keeps foreign sound at 3 %"), "{said}");
}

#[test]
fn own_scenes_are_rooms_and_options_of_scenes_are_refused() {
    let answer = json(&[
        "study",
        "rings/hc-sr04-8.toml",
        "--rooms",
        "scenes/alcove.toml",
        "--rooms",
        "scenes/lab.toml",
        "--json",
    ]);
    let rooms = way(&answer, "flow")["rooms"].as_object().unwrap();
    assert_eq!(rooms.keys().collect::<Vec<_>>(), ["alcove", "lab"]);
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
    let pairs = eeruf(&["study", "rings/mower-8-and-4.toml"]);
    assert!(
        pairs.code == Some(1) && pairs.out.contains("not judged in rooms: the ring file does not say"),
        "{}",
        pairs.out
    );
}
