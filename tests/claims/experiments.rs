//! The verb `experiment`: its JSON has the names that programs rely on, and its pictures can be drawn.

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

// An unknown method and a speed out of range are refused in words.
#[test]
fn unknown_method_and_speed_are_refused_in_words() {
    for (words, says) in [
        (["experiment", "set-one", "--method", "eruf"], "`eruf`; did you mean `eeruf`?"),
        (["experiment", "set-two", "--speed", "9"], "expected 0.1 to 5"),
        (["experiment", "set-two", "--seeds", "0"], "a number from 1 to 100000"),
    ] {
        let outcome = eeruf(&words);
        assert_eq!(outcome.code, Some(2));
        assert!(outcome.err.contains(says), "{}", outcome.err);
    }
}

#[test]
fn nine_methods_stand_in_two_tables_of_groups() {
    let methods = "simultaneous,sequential,conventional,in_turn,arrays,groups,sync_line,free_running,table";
    let set = ["experiment", "set-three", "--seeds", "1", "--periods", "10", "--method", methods];
    let printed = eeruf(&set).out;
    let headers = printed.lines().filter(|line| line.contains("placings |"));
    let tables: Vec<Vec<&str>> = headers.map(|line| line.split('|').map(str::trim).skip(3).collect()).collect();
    let names: Vec<&str> = methods.split(',').collect();
    let expected: Vec<Vec<&str>> = [&names[..5], &names[5..]].map(|names| [names, &[""]].concat()).into();
    assert_eq!(tables, expected);
}

#[test]
fn merged_parts_equal_the_whole_run() {
    for set in [
        &["set-one", "--seeds", "5", "--method", "eeruf,median,flow"][..],
        &["set-two", "--seeds", "4", "--method", "eeruf,conventional", "--second-robot", "ahead", "--exact-odometry"],
        &["set-three", "--seeds", "5", "--periods", "15", "--method", "eeruf,flow", "--height", "room"],
    ] {
        let folder = tempfile::tempdir().unwrap();
        let words = [&["experiment"], set].concat();
        let mut files = vec![];
        for part in ["2/3", "3/3", "1/3"] {
            let outcome = eeruf(&[&words[..], &["--shard", part]].concat());
            assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
            let file = folder.path().join(part.replace('/', "-"));
            std::fs::write(&file, outcome.out).unwrap();
            files.push(file.to_str().unwrap().to_owned());
        }
        let files: Vec<_> = files.iter().map(String::as_str).collect();
        let merged = |more: &[&str]| eeruf(&[&["merge"], &files[..], more].concat());
        assert_eq!(merged(&[]).out, eeruf(&words).out, "{set:?}");
        assert_eq!(merged(&["--json"]).out, eeruf(&[&words[..], &["--json"]].concat()).out, "{set:?}");
        let missing = eeruf(&["merge", files[0], files[1]]);
        assert_eq!(missing.code, Some(2));
        assert!(
            missing.err.contains("1 of 3 parts are missing, the first is 1; run `eeruf lab experiment set-"),
            "{}",
            missing.err
        );
        let twice = eeruf(&["merge", files[0], files[0]]);
        assert!(twice.err.contains("part 2/3; expected each once"), "{}", twice.err);
    }
}

#[test]
fn merge_refuses_parts_that_do_not_belong_together() {
    let folder = tempfile::tempdir().unwrap();
    let part = |name: &str, words: &[&str]| {
        let outcome =
            eeruf(&[&["experiment", "set-three", "--method", "sequential", "--periods", "10"], words].concat());
        let file = folder.path().join(name);
        std::fs::write(&file, &outcome.out).unwrap();
        (file.to_str().unwrap().to_owned(), outcome.out)
    };
    let (first, text) = part("first", &["--seeds", "2", "--shard", "1/2"]);
    let (other, _) = part("other", &["--seeds", "2", "--first", "7", "--shard", "2/2"]);
    let (third, _) = part("third", &["--seeds", "3", "--shard", "2/3"]);
    let refused = |files: &[&str], says: &str| {
        let outcome = eeruf(&[&["merge"], files].concat());
        assert!(outcome.code == Some(2) && outcome.err.contains(says), "{}", outcome.err);
    };
    refused(&[&first, &other], "expected one of `set-three --first 20000 --gain constant");
    refused(&[&first, &third], "part 2/3; expected one of 2 as");
    refused(&[folder.path().join("none").to_str().unwrap()], "none");
    for (name, cut) in
        [("half", &text[..text.len() / 2]), ("empty", ""), ("old", &text.replace("\"eeruf\":\"", "\"eeruf\":\"0.0.1-"))]
    {
        let file = folder.path().join(name);
        std::fs::write(&file, cut).unwrap();
        let says = if name == "old" {
            "a part of eeruf 0.0.1-"
        } else {
            "expected what `eeruf lab experiment .. --shard I/N` prints"
        };
        refused(&[file.to_str().unwrap()], says);
    }
    let outcome = eeruf(&["experiment", "set-one", "--seeds", "2", "--shard", "3/9"]);
    assert!(outcome.err.contains("--shard: 3/9 of 2 seeds; expected at most 2 parts"), "{}", outcome.err);
    let outcome = eeruf(&["experiment", "set-one", "--shard", "4/3"]);
    assert!(outcome.err.contains("expected I/N, such as 2/8"), "{}", outcome.err);
}
