//! The verb `experiment`: its JSON has the names that others rely on, and its pictures can be drawn.

use crate::common::{Scratch, eeruf, json};
use serde_json::Value;

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
        (["experiment", "set-one", "--method", "eruf"], "`eruf`; expected simultaneous"),
        (["experiment", "set-two", "--speed", "9"], "expected 0.1 to 5"),
        (["experiment", "set-two", "--seeds", "0"], "1..=100000"),
    ] {
        let outcome = eeruf(&words);
        assert_eq!(outcome.code, Some(2));
        assert!(outcome.err.contains(says), "{}", outcome.err);
    }
}
