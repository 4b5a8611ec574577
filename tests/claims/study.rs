//! The verbs `study` and `paths` from a user's view: output, pictures and refusals.

use crate::common::{Scratch, eeruf, json};
use serde_json::Value;

/// Returns the names of the methods that a study compares.
fn methods() -> Vec<&'static str> {
    eeruf_sim::Method::usual().map(eeruf_sim::Method::as_str).collect()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is not a number"))
}

// Two methods in one are simulated where they are asked for by name. With several echoes nothing is rejected here, so
// that the ring that adapts stays as it is; no others are the same.
#[test]
fn pairs_of_methods_are_simulated_by_name() {
    let pairs = "flow,multi_echo,adaptive,adaptive_multi_echo,flow_multi_echo";
    let study = json(&["study", "scenes/alcove.toml", "--periods", "400", "--json", "--method", pairs]);
    let figures = |method: &str| {
        let of = &study["methods"][method];
        let figures = ["wrong_of_accepted", "rejected", "readings_per_s"].map(|figure| number(&of[figure]));
        assert!(figures[2] > 10.0, "{method}: {figures:?}");
        figures
    };
    let all: Vec<_> = pairs.split(',').map(figures).collect();
    assert_eq!(study["methods"].as_object().unwrap().len(), all.len());
    let [flow, several, adaptive, adaptive_several, flow_several] = all[..] else { panic!("{all:?}") };
    assert_eq!(adaptive_several, several);
    assert!(adaptive != several && flow_several != several && flow_several != flow, "{all:?}");
}

// Eeruf believes next to no crosstalk where constant lags believe it with and without comparing.
#[test]
fn eeruf_believes_next_to_no_crosstalk() {
    let study = json(&["study", "scenes/alcove.toml", "--periods", "300", "--json"]);
    let wrong = |method: &str| number(&study["methods"][method]["wrong_of_accepted"]);
    assert!(wrong("conventional") > 0.2, "{}", wrong("conventional"));
    assert!(wrong("comparison") > 0.2, "{}", wrong("comparison"));
    assert!(wrong("eeruf") < 0.02, "{}", wrong("eeruf"));
    // It reads more often than one by one all the same, but not for nothing.
    let rate = |method: &str| number(&study["methods"][method]["readings_per_s"]);
    assert!(rate("eeruf") > 2.0 * rate("sequential"));
    assert!(number(&study["methods"]["eeruf"]["good_lost"]) > 0.0);
}

#[test]
fn the_help_names_every_method() {
    let help = eeruf(&["study", "--help"]).out;
    for method in methods() {
        assert!(help.contains(method), "{method} is missing in\n{help}");
    }
}

// Json has every method with shares of one in the order of the table.
#[test]
fn json_has_every_method_in_the_tables_order() {
    let outcome = eeruf(&["study", "scenes/alcove.toml", "--periods", "60", "--json"]);
    let places: Vec<_> = methods().iter().map(|method| outcome.out.find(&format!("\"{method}\":{{"))).collect();
    assert!(places.iter().all(Option::is_some) && places.is_sorted(), "{places:?}");
    let study: Value = serde_json::from_str(&outcome.out).unwrap();
    assert_eq!((&study["seed"], &study["periods"]), (&1.into(), &60.into()));
    for method in methods() {
        let entry = &study["methods"][method];
        for share in ["wrong_of_all", "rejected"] {
            assert!((0.0..=1.0).contains(&number(&entry[share])), "{method} {share}");
        }
        assert!(number(&entry["age_ms"]) <= number(&entry["age_p99_ms"]), "{method}");
        assert_eq!(entry["robots"].as_array().unwrap().len(), 1, "{method}");
        // One robot: its figures are those of all.
        assert_eq!(entry["robots"][0]["accepted"], entry["accepted"], "{method}");
        let believed: u64 =
            entry["fooled"].as_array().unwrap().iter().map(|row| row["accepted"].as_u64().unwrap()).sum();
        let expected = number(&entry["wrong_of_all"]) * number(&entry["readings"]);
        assert!((believed as f64 - expected).abs() < 0.5, "{method}: {believed} and {expected}");
    }
}

#[test]
fn the_schedule_of_eeruf_best_keeps_what_the_study_promises() {
    let study = json(&["study", "scenes/alcove.toml", "--periods", "20", "--method", "eeruf_best", "--json"]);
    assert_eq!(study["methods"].as_object().unwrap().keys().collect::<Vec<_>>(), ["eeruf_best"]);
    let schedule = &study["best"]["schedule"];
    let text = ["period_us", "t_fire_a_us", "t_fire_b_us"].map(|key| format!("{key} = {}\n", schedule[key])).concat();
    let (_folder, file) = Scratch::new("best.toml", &text);
    let file = file.to_str().unwrap();
    let checked = ["verify", file, "--t-delta-us", "500", "--window-us", "36000", "--stale-echo", "--json"];
    assert_eq!(json(&checked)["ok"], true);
    assert!(schedule["period_us"].as_u64().unwrap() < 60_000);
}

#[test]
fn the_same_seed_gives_the_same_answer_and_another_seed_another() {
    let study = |seed: &str| eeruf(&["study", "scenes/alcove.toml", "--periods", "100", "--json", "--seed", seed]).out;
    assert_eq!(study("5"), study("5"));
    assert_ne!(study("5").replace("\"seed\":5", ""), study("6").replace("\"seed\":6", ""));
}

#[test]
fn the_table_names_every_method_and_who_was_fooled_by_whom() {
    let outcome = eeruf(&["study", "scenes/alcove.toml", "--periods", "300"]);
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    for method in methods() {
        assert!(outcome.out.contains(&format!("| {method:<17} |")), "{method}\n{}", outcome.out);
    }
    for said in ["Who was fooled by whom", "|      8 |     4 |     1 | wall 1", "300 of 300", "t95"] {
        assert!(outcome.out.contains(said), "{said}\n{}", outcome.out);
    }
}

// Crosstalk between robots is kept apart.
#[test]
fn each_robot_has_tables_of_its_own() {
    let outcome = eeruf(&["study", "scenes/lab.toml", "--periods", "40", "--method", "conventional,eeruf"]);
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    for said in ["Robot 1: 8 sensors", "Robot 2: 24 sensors", " of robot 2 |"] {
        assert!(outcome.out.contains(said), "{said}\n{}", outcome.out);
    }
    assert_eq!(outcome.out.matches("| conventional |").count(), 2 * (3 + 1), "{}", outcome.out);
}

#[test]
fn pictures_are_drawn_and_say_what_they_show() {
    let (folder, _) = Scratch::new("unused", "");
    let made = folder.path().join("pictures/of");
    let outcome = eeruf(&["study", "scenes/alcove.toml", "--periods", "200", "--svg", made.to_str().unwrap()]);
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    assert!(outcome.out.contains("5 pictures in "), "{}", outcome.out);
    let picture = |name: &str| std::fs::read_to_string(made.join(name)).unwrap();
    for (name, says) in [
        (
            "scene.svg",
            vec![
                "conventional: who fools whom",
                "flow: who",
                "sound sent by sensor",
                "wrong readings believed",
                " m\n",
            ],
        ),
        ("timing.svg", vec!["flow: two rounds as they happened", "crosstalk, rejected", "time, ms"]),
        ("readings.svg", vec!["What sensor ", "range, m", "time, s", "rejected", "upper edge"]),
        ("methods.svg", [&methods()[..], &["good lost", "readings a second"]].concat()),
        ("blind.svg", [&methods()[..], &["Blind sensors (red)"]].concat()),
    ] {
        let svg = picture(name);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
        for said in says {
            assert!(svg.contains(said), "{name}: {said}");
        }
    }
    // A cone for each sensor in either panel, and arrow heads of the paths that fool someone: four, and none by flow.
    assert_eq!(picture("scene.svg").matches("<polygon").count(), 16 + 4);
    assert!(picture("scene.svg").contains("of what it believes (0 of "));
}

#[test]
fn a_picture_whose_name_ends_in_png_is_one() {
    let (folder, _) = Scratch::new("unused", "");
    let made = folder.path().to_str().unwrap();
    let moving = ["study", "scenes/wall.toml", "--periods", "12", "--method", "conventional", "--png", made];
    assert_eq!(eeruf(&moving).code, Some(0));
    for name in ["scene.png", "timing.png", "readings.png", "methods.png"] {
        let png = std::fs::read(folder.path().join(name)).unwrap();
        assert!(png.starts_with(b"\x89PNG\r\n\x1a\n") && png.len() > 5000, "{name}");
        // Twice as many pixels as the picture is wide, for screens that have them.
        assert_eq!(png[16..20], 1800_u32.to_be_bytes(), "{name}");
    }
    let file = folder.path().join("timing-of-a-design.png");
    let ring = ["design", "--period-only", "rings/hc-sr04-8.toml", "--svg", file.to_str().unwrap()];
    assert_eq!(eeruf(&ring).code, Some(0));
    assert!(std::fs::read(file).unwrap().starts_with(b"\x89PNG"));
}

// A name without an ending is a folder, one with an ending a file, for every command that draws.
#[test]
fn name_of_a_picture_is_a_folder_without_an_ending() {
    let (folder, _) = Scratch::new("unused", "");
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let study = ["study", "scenes/wall.toml", "--periods", "12", "--method", "conventional,flow"];
    let design = ["design", "--period-only", "rings/hc-sr04-8.toml"];
    let set_one = ["lab", "experiment", "set-one", "--seeds", "1", "--method", "eeruf"];
    for (words, name, drawn) in [
        (&study[..], "a", "a/methods.svg"),
        (&study, "comparison.svg", "comparison.svg"),
        (&design, "b/c", "b/c/timing.svg"),
        (&design, "d.svg", "d.svg"),
        (&set_one, "e", "e/set-one.svg"),
        (&set_one, "f.svg", "f.svg"),
    ] {
        let outcome = eeruf(&[words, &["--svg", &at(name)]].concat());
        assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""), "{name}");
        assert!(std::fs::read_to_string(at(drawn)).unwrap().starts_with("<svg"), "{drawn}");
    }
    // Pictures that cannot be drawn are refused before the work.
    let began = std::time::Instant::now();
    let refused = eeruf(&["study", "scenes/wall.toml", "--periods", "10000000", "--svg", &at("d.svg/x")]);
    assert!(
        refused.code == Some(2) && refused.err.contains("d.svg/x") && began.elapsed().as_secs() < 60,
        "{}",
        refused.err
    );
}

// Paths are listed by emitter receiver and length with the names that python uses.
#[test]
fn paths_are_listed_by_emitter_receiver_and_length() {
    let paths = json(&["paths", "scenes/alcove.toml", "--order", "2", "--json"]);
    let columns = ["emitter", "receiver", "length_m", "order", "departure_rad", "arrival_rad", "amplitude", "walls"];
    let count = paths["length_m"].as_array().unwrap().len();
    assert!(count > 20);
    for column in columns {
        assert_eq!(paths[column].as_array().unwrap().len(), count, "{column}");
    }
    let mut last = (0, 0, 0.0);
    for k in 0..count {
        let id = |column: &str| paths[column][k].as_u64().unwrap();
        let key = (id("emitter"), id("receiver"), number(&paths["length_m"][k]));
        assert!(key > last && key.0 != key.1, "{key:?} after {last:?}");
        assert!(id("order") <= 2 && paths["walls"][k].as_array().unwrap().len() as u64 == id("order"));
        assert!(number(&paths["level_db"][k]) >= 0.0);
        last = key;
    }
    let table = eeruf(&["paths", "scenes/alcove.toml", "--order", "2"]).out;
    assert!(table.contains(&format!("{count} critical paths of up to 2 bounces")), "{table}");
    // A line for each, the caption, and the table's head of two.
    assert_eq!(table.lines().count(), count + 3);
}

#[test]
fn a_way_there_is_a_way_back() {
    let paths = json(&["paths", "scenes/alcove.toml", "--order", "3", "--json"]);
    let count = paths["length_m"].as_array().unwrap().len();
    let of = |k: usize| {
        let walls: Vec<i64> = paths["walls"][k].as_array().unwrap().iter().map(|wall| wall.as_i64().unwrap()).collect();
        (paths["emitter"][k].as_u64(), paths["receiver"][k].as_u64(), walls)
    };
    let all: Vec<_> = (0..count).map(of).collect();
    for (emitter, receiver, walls) in &all {
        let back = (*receiver, *emitter, walls.iter().rev().copied().collect());
        assert!(all.contains(&back), "{back:?}");
    }
}

// Bad scenes get one line that names file line value and what is expected.
#[test]
fn bad_scenes_get_one_line_with_their_place() {
    let ring = "ring = { sensors = 8, spacing_deg = 15.0, radius_m = 0.3 }";
    let within =
        format!("[[robot]]\npose = {{ x_m = 0.0, y_m = 0.0 }}\n{ring}\n[[wall]]\npoints_m = [[0.2, -1], [0.2, 1]]\n");
    let cases = [
        ("[[wall]\n", "line 1: "),
        (
            "[[robot]]\npose = { x_m = 0.0, y_m = 0.0 }\nring = { sensors = 99, spacing_deg = 3.0, radius_m = 0.3 }\n",
            "99",
        ),
        (&within, "robot 1 touches wall 0"),
        ("seed = 1\n", "0 robots; expected 1 to 64"),
        ("sede = 1\n", "line 1: sede: unknown key"),
    ];
    for (text, says) in cases {
        let (_folder, file) = Scratch::new("bad.toml", text);
        let file = file.to_str().unwrap();
        for verb in ["study", "paths"] {
            let outcome = eeruf(&[verb, file]);
            assert_eq!((outcome.code, outcome.out.as_str()), (Some(2), ""), "{verb} {text}");
            assert_eq!(outcome.err.lines().count(), 1, "{}", outcome.err);
            assert!(outcome.err.starts_with(&format!("eeruf: {file}")), "{}", outcome.err);
            assert!(outcome.err.contains(says), "{says}\n{}", outcome.err);
        }
    }
    let outcome = eeruf(&["study", "no-such-scene.toml"]);
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.err.contains("no-such-scene.toml"), "{}", outcome.err);
    let outcome = eeruf(&["study", "scenes/alcove.toml", "--method", "eruf"]);
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.err.contains("`eruf`; did you mean `eeruf`?"), "{}", outcome.err);
}

#[test]
fn a_folder_that_cannot_be_made_is_bad_input() {
    let (_folder, file) = Scratch::new("a-file", "");
    let inside = file.join("pictures");
    let outcome = eeruf(&[
        "study",
        "scenes/alcove.toml",
        "--periods",
        "5",
        "--method",
        "eeruf",
        "--svg",
        inside.to_str().unwrap(),
    ]);
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.err.contains("a-file"), "{}", outcome.err);
}

#[test]
fn a_simulated_log_is_as_simulated_and_a_planted_one_is_not() {
    let ((folder, log), scene) = (Scratch::new("log.csv", ""), "scenes/alcove-hc-sr04.toml");
    let log = log.to_str().unwrap();
    let study = ["study", scene, "--method", "sequential", "--periods", "60", "--log", log];
    assert_eq!(eeruf(&study).code, Some(0));
    let like = |log: &str| -> Vec<bool> {
        let found = json(&["lab", "reality", log, scene, "--json"]);
        found["sensors"].as_array().unwrap().iter().map(|sensor| sensor["is_like"] == true).collect()
    };
    assert_eq!(like(log), [true; 8]);
    // Sensor 3 hears nothing, and sensor 5 sees its wall 20 cm farther away.
    let planted = std::fs::read_to_string(log).unwrap().lines().fold(String::new(), |planted, line| {
        let mut cells: Vec<String> = line.split(',').map(str::to_owned).collect();
        match (cells[0].as_str(), cells.get(4).and_then(|us| us.parse::<u32>().ok())) {
            ("2", Some(_)) => cells[4].clear(),
            ("4", Some(us)) => cells[4] = (us + 1_170).to_string(),
            _ => {}
        }
        planted + &cells.join(",") + "\n"
    });
    let other = folder.path().join("planted.csv");
    std::fs::write(&other, planted).unwrap();
    assert_eq!(like(other.to_str().unwrap()), [true, true, false, true, false, true, true, true]);
}
