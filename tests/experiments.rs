//! The verb `experiment`: the tables in docs/experiments.md are what it prints, its JSON has the names that others rely on,
//! and its pictures can be drawn.

mod common;

use common::{Scratch, eeruf, json};
use serde_json::Value;

/// What a table of the docs begins with, and the command that prints it.
const PRINTED_BY: &str = "<!-- printed by: eeruf ";
const END: &str = "<!-- end -->";

/// Commands with up to this many seeds are run again here.
const SMALL: u64 = 3;

#[test]
fn the_small_tables_in_the_docs_are_what_the_commands_print() {
    let docs = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/docs/experiments.md")).unwrap();
    let mut sets = Vec::new();
    for block in docs.split(PRINTED_BY).skip(1) {
        let (command, rest) = block.split_once(" -->\n").unwrap();
        let (expected, _) = rest.split_once(END).unwrap();
        let words: Vec<&str> = command.split_whitespace().collect();
        let seeds =
            words.iter().position(|word| *word == "--seeds").map(|place| words[place + 1].parse::<u64>().unwrap());
        if seeds.is_some_and(|seeds| seeds <= SMALL) {
            assert_eq!(eeruf(&words).out.trim(), expected.trim(), "{command}");
            sets.push(words[1]);
        }
    }
    assert!(sets.contains(&"set-one") && sets.contains(&"set-two"), "{sets:?}");
}

#[test]
fn every_picture_in_the_docs_exists_and_is_small() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/docs/");
    let docs = std::fs::read_to_string(folder.to_owned() + "experiments.md").unwrap();
    let pictures: Vec<&str> = docs.split("](pictures/").skip(1).filter_map(|rest| rest.split(')').next()).collect();
    assert!(pictures.len() >= 3, "{pictures:?}");
    for picture in pictures {
        let size = std::fs::metadata(format!("{folder}pictures/{picture}")).unwrap().len();
        assert!(size < 300_000, "{picture}: {size}");
    }
}

#[test]
fn json_of_set_one_has_quantiles_for_each_method() {
    let found = json(&["experiment", "set-one", "--seeds", "1", "--method", "eeruf,multi_echo", "--json"]);
    for method in ["eeruf", "multi_echo"] {
        for figure in ["wrong_of_all", "wrong_of_accepted", "rejected", "good_lost", "age_ms", "readings_per_s"] {
            for quantile in ["p10", "median", "p90"] {
                assert!(found["methods"][method][figure][quantile].is_f64(), "{method} {figure} {quantile}");
            }
        }
    }
}

#[test]
fn json_of_set_two_counts_courses_for_each_method() {
    let words = ["experiment", "set-two", "--seeds", "2", "--second-robot", "--method", "eeruf,conventional", "--json"];
    let found = json(&words);
    assert_eq!((&found["second_robot_m"], &found["seeds"]), (&Value::from(vec![0.6, 5.4]), &Value::from(2)));
    for method in ["eeruf", "conventional"] {
        let figures = &found["methods"][method];
        let count = |name: &str| figures[name].as_u64().unwrap();
        assert_eq!(count("courses"), 2);
        assert_eq!(count("finished") + count("contacts") + count("timed_out"), 2);
        for name in ["mean_speed_m_s", "top_speed_m_s", "nearest_m", "rejected", "phantom_echoes", "poles_missed"] {
            assert!(figures[name].as_f64().unwrap() >= 0.0, "{name}");
        }
    }
}

#[test]
fn pictures_are_drawn_into_a_folder_that_is_made() {
    let (folder, _) = Scratch::new("empty", "");
    let into = folder.path().join("new");
    let into = into.to_str().unwrap();
    eeruf(&["experiment", "set-one", "--seeds", "1", "--method", "eeruf", "--svg", into]);
    eeruf(&["experiment", "set-two", "--seeds", "1", "--method", "eeruf", "--svg", into, "--png", into]);
    for name in ["set-one.svg", "set-two.svg", "set-two.png"] {
        assert!(folder.path().join("new").join(name).metadata().unwrap().len() > 1000, "{name}");
    }
}

#[test]
fn an_unknown_method_and_a_speed_out_of_range_are_refused_in_words() {
    for (words, says) in [
        (["experiment", "set-one", "--method", "eruf"], "no method `eruf`; expected simultaneous"),
        (["experiment", "set-two", "--speed", "9"], "expected 0.1 to 5"),
        (["experiment", "set-two", "--seeds", "0"], "1..=100000"),
    ] {
        let outcome = eeruf(&words);
        assert_eq!(outcome.code, Some(2));
        assert!(outcome.err.contains(says), "{}", outcome.err);
    }
}
