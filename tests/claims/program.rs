//! The program from a user's view: its output and its exit code.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use eeruf_design::RingSpec;
use eeruf_sim::World;
use eeruf_sim::modules::Module;
use serde_json::Value;

use crate::common::{C, Scratch, compile_and_run, cpp, eeruf, json};

#[test]
fn table_i_d_is_verified_up_to_999_us_and_not_at_1000() {
    for (t_delta, code) in [("999", 0), ("1000", 1)] {
        for criterion in ["paper", "exact"] {
            let outcome = eeruf(&["verify", "rings/table-i-d.toml", "--t-delta-us", t_delta, "--criterion", criterion]);
            assert_eq!(outcome.code, Some(code), "{}", outcome.out);
        }
    }
    let outcome = eeruf(&["verify", "rings/table-i-d.toml", "--t-delta-us", "999"]);
    for said in ["2000 us", "999 us", "17000 us  sensors 2 and 5 in phase b", "19000 us"] {
        assert!(outcome.out.contains(said), "{said}\n{}", outcome.out);
    }
}

// The report of table i d has the figures of the paper in blocks and ours in a line.
#[test]
fn report_of_table_i_d_has_the_papers_figures() {
    for criterion in ["paper", "exact"] {
        for (layout, min_interval) in [("line", 17_000), ("blocks", 19_000), ("0-1,1-2,2-3", 19_000)] {
            let report =
                json(&["verify", "rings/table-i-d.toml", "--json", "--layout", layout, "--criterion", criterion]);
            assert_eq!(report["ok"], true);
            assert_eq!(report["separation_us"], 2000);
            assert_eq!(report["max_t_delta_us"], 999);
            assert_eq!(report["min_interval_us"], min_interval);
            assert_eq!(report["min_refire_us"], 76_000);
            assert_eq!(report["violations"], serde_json::json!([]));
        }
    }
}

#[test]
fn table_i_c_has_sensors_4_and_1_one_millisecond_apart() {
    let asked = ["verify", "rings/table-i-c.toml", "--min-interval-us", "15000"];
    let outcome = eeruf(&asked);
    assert_eq!(outcome.code, Some(1));
    assert!(outcome.out.contains("sensors 4 and 1 fire 1 ms apart between phases a and b"), "{}", outcome.out);
    let report = json(&[&asked[..], &["--json"]].concat());
    assert_eq!(report["min_interval_us"], 1000);
    let violation = &report["violations"][0];
    assert_eq!(violation["kind"], "interval");
    assert_eq!(violation["sensors"], serde_json::json!([3, 0]));
    assert_eq!((&violation["value_us"], &violation["required_us"]), (&1000.into(), &15_000.into()));
    assert_eq!(violation["source"], "Sec. 3.1 c");
}

#[test]
fn the_files_of_the_papers_tables_are_the_tables_of_the_core() {
    use eeruf_core::tables;
    let tables = [
        ("table-i-a", tables::TABLE_I_A),
        ("table-i-b", tables::TABLE_I_B),
        ("table-i-c", tables::TABLE_I_C),
        ("table-i-d", tables::TABLE_I_D),
        ("table-i-19ms", tables::THE_ONE_WITH_19_MS),
    ];
    for (name, table) in tables {
        let report = json(&["verify", &format!("rings/{name}.toml"), "--json"]);
        let requirements = eeruf_core::Requirements::new(eeruf_core::Micros::ZERO);
        let expected = table.verify(&requirements);
        let interval = expected.min_interval().map(|interval| interval.value.as_micros());
        assert_eq!(report["min_interval_us"].as_u64(), interval.map(u64::from), "{name}");
        assert_eq!(report["min_refire_us"], expected.min_refire().as_micros(), "{name}");
        assert_eq!(report["separation_us"], expected.separation().unwrap().value.as_micros(), "{name}");
    }
}

#[test]
fn the_log_of_a_real_robot_is_judged_reading_by_reading() {
    let log = "tests/data/scitos-g5-24-sonars.csv";
    for (t_delta, accepted, rejected) in [("1000", 101_332, 8257), ("500", 99_210, 10_379)] {
        let replay = json(&["replay", log, "--t-delta-us", t_delta, "--json"]);
        let expected = serde_json::json!({
            "accepted": accepted, "rejected": rejected, "first": 3226, "no_echo": 3208, "clear": 14_921,
        });
        assert_eq!(replay["total"], expected);
        let sensors = replay["sensors"].as_array().unwrap();
        assert_eq!((sensors.len(), &sensors[23]["name"]), (24, &"S24".into()));
        let sum: u64 = sensors.iter().map(|sensor| sensor["accepted"].as_u64().unwrap()).sum();
        assert_eq!(sum, accepted);
    }
}

#[test]
fn a_replay_draws_what_it_counts() {
    let (folder, log) = Scratch::new("log.csv", "left,note,right\n1.0,x,\n1.0,y,2.5\n1.5,z,2.5\n");
    let picture = folder.path().join("picture.svg");
    let outcome = eeruf(&["replay", log.to_str().unwrap(), "--t-delta-us", "100", "--svg", picture.to_str().unwrap()]);
    assert_eq!((outcome.code, outcome.err.as_str()), (Some(0), ""));
    assert!(outcome.out.contains("| left   |        1 |        1 |         50.0 % |     1 |"), "{}", outcome.out);
    // The first row of `right` has no echo; it is a sensor all the same, and `note` is none.
    assert!(
        outcome.out.contains("| right  |        1 |        0 |          0.0 % |     1 |       1 |"),
        "{}",
        outcome.out
    );
    assert!(!outcome.out.contains("| note"), "{}", outcome.out);
    let svg = std::fs::read_to_string(picture).unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("left") && svg.contains("3 firings"));
}

// The papers ring can run at 65 ms and the answer is the same in every form.
#[test]
fn papers_ring_runs_at_65_ms_in_every_form() {
    let found = json(&["design", "rings/paper-12.toml", "--no-atlas", "--places", "1", "--emit", "json"]);
    assert_eq!((&found["value_us"], &found["bound_us"]), (&65_000.into(), &65_000.into()));
    assert_eq!(found["proven"], true);
    assert_eq!(found["schedule"]["period_us"], 65_000);
    assert_eq!(found["schedule"]["t_fire_a_us"].as_array().unwrap().len(), 12);
    let again = json(&["design", "--period-only", "rings/paper-12.toml", "--no-atlas", "--json"]);
    assert_eq!((&again["schedule"], &again["nodes"]), (&found["schedule"], &found["nodes"]));
    let known = json(&["design", "--period-only", "rings/paper-12.toml", "--json"]);
    assert_eq!((&known["from_atlas"], &again["from_atlas"]), (&true.into(), &false.into()));
    // Of the schedules with that period which keep as much, the atlas may hold another.
    assert_eq!((&known["value_us"], &known["reason"]), (&found["value_us"], &found["reason"]));
    assert_eq!(known["nodes"], 0);

    // The schedule file passes what was asked for, and not a microsecond more of separation or window.
    let toml = eeruf(&["design", "rings/paper-12.toml", "--emit", "toml"]);
    let (_folder, file) = Scratch::new("schedule.toml", &toml.out);
    let asked = ["--t-delta-us", "999", "--min-interval-us", "15000", "--window-us", "30000"];
    let report = json(&[&["verify", file.to_str().unwrap(), "--json"], &asked[..]].concat());
    assert_eq!((&report["ok"], &report["max_t_delta_us"]), (&true.into(), &999.into()));

    let described = eeruf(&["design", "--period-only", "rings/paper-12.toml"]);
    for said in [
        "65 ms",
        "proven: no schedule in ticks of 1 ms is shorter",
        "1.54 times Table I-d",
        "Not shorter because",
        "To get faster than 65 ms, one change at a time:\n 13 ms instead of 15 ms between neighbours  59 ms",
        "listening for 27 ms instead of 30 ms       no shorter",
        "any 3 instead of 4 adjacent sensors apart  52 ms",
        "# fires",
    ] {
        assert!(described.out.contains(said), "{said}\n{}", described.out);
    }
}

// Every ring file that we ship gets a proven schedule with a picture.
#[test]
fn every_shipped_ring_is_proven_with_a_picture() {
    let uneven = [("car-12", 106_200), ("hc-sr04-8-two-multiplexers", 61_500), ("mower-8-and-4", 64_500)];
    for (ring, period_us) in
        [("labmate-8", 48_300), ("ring-24", 76_000), ("hc-sr04-8", 67_500)].into_iter().chain(uneven)
    {
        let (folder, _) = Scratch::new("unused", "");
        let picture = folder.path().join("timing.svg");
        let file = format!("rings/{ring}.toml");
        let found = json(&["design", &file, "--period-only", "--json", "--svg", picture.to_str().unwrap()]);
        assert_eq!((&found["value_us"], &found["proven"]), (&period_us.into(), &true.into()), "{ring}");
        assert!(std::fs::read_to_string(picture).unwrap().contains("phase b"));
    }
}

// Pairs that hear nothing of each other where they stand are said, and ask for no interval.
#[test]
fn pairs_that_do_not_hear_each_other_are_said() {
    let ring = "sensors = 8\nmodule = \"hc-sr04\"\nretrigger_us = 0\nmax_range_m = 1\n";
    let (_scratch, file) = Scratch::new("ring.toml", &format!("{ring}spacing_deg = 45\nradius_m = 0.2\n"));
    let file = file.to_str().unwrap();
    let placed = eeruf(&["design", file, "--period-only"]).out;
    assert!(placed.contains("8 sensors, 3 adjacent sensors of a ring"), "{placed}");
    assert!(placed.contains("From their places 8 pairs of 4 adjacent sensors hear nothing of each other"), "{placed}");
    assert!(placed.contains("up to 2.57 m, and may fire close together: 1 and 4, 1 and 6, "), "{placed}");
    let period = || json(&["design", file, "--period-only", "--json"])["value_us"].as_u64().unwrap();
    let with_places = period();
    std::fs::write(file, format!("{ring}layout = \"ring\"\n")).unwrap();
    assert!(with_places < period(), "{with_places}");
    assert!(!eeruf(&["design", file, "--period-only"]).out.contains("From their places"));
}

#[test]
fn rings_of_the_files_keep_their_neighbours() {
    let spec = |text: &str| RingSpec::from_text(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let read = |name: &str| std::fs::read_to_string(name).unwrap();
    for name in ["rings/round-16.toml", "rings/car-12.toml", "rings/hc-sr04-8.toml", "tests/data/pioneer-16.toml"] {
        let spec = spec(&read(name));
        assert!(spec.not_neighbours.is_empty(), "{name}: {:?}", spec.not_neighbours);
    }
    // Of a car whose file asks for more, bumpers are none.
    let car = read("rings/car-12.toml");
    let spec = spec(&car.replace("neighbours = 3", "neighbours = 6"));
    let neighbours = |x, y| spec.layout.layout().neighbours(12, x, y);
    assert!((0..11).all(|x| neighbours(x, x + 1)), "{:?}", spec.not_neighbours);
    assert!(!neighbours(2, 7) && spec.not_neighbours.contains(&(2, 7)), "{:?}", spec.not_neighbours);
}

#[test]
fn ring_file_scene_and_emitted_table_say_the_same_of_a_module() {
    let scene = World::from_toml(Path::new("scenes/alcove-hc-sr04.toml")).unwrap();
    let module = scene.robots()[0].module_of(0);
    let spec = RingSpec::from_text(&std::fs::read_to_string("rings/hc-sr04-8.toml").unwrap()).unwrap();
    // The scene sets its own beam.
    assert_eq!(spec.modules, [Module { beam: spec.modules[0].beam, ..module }; 8]);
    let (trigger_us, rest_us, held_us) = (module.trigger_us, module.rest_us, module.no_echo.hold_us());
    let said =
        format!("Sensors 0 to 7: hc-sr04, pulse_width, trigger {trigger_us} us, rest {rest_us} us, held {held_us} us");
    for (form, begin) in [("toml", "# "), ("rust", "// "), ("c", "/* "), ("arduino", "/* ")] {
        let emitted = eeruf(&["design", "rings/hc-sr04-8.toml", "--period-only", "--emit", form]).out;
        assert!(emitted.starts_with(&format!("{begin}{said}")), "{emitted}");
    }
    let mixed = "sensors = 3\nlayout = \"ring\"\nmodule = [\"hc-sr04\", \"hc-sr04\", \"srf08\"]\njitter_us = 100\n\
                 crosstalk_range_m = 1.0\n";
    let (_folder, file) = Scratch::new("mixed.toml", mixed);
    let emitted = eeruf(&["design", file.to_str().unwrap(), "--emit", "toml"]).out;
    let modules: Vec<_> = emitted.lines().take(2).collect();
    assert!(modules[0].starts_with("# Sensors 0 to 1: hc-sr04, pulse_width"), "{emitted}");
    assert_eq!(modules[1], "# Sensors 2 to 2: srf08, i2c, trigger 0 us, rest 65000 us");
}

// A schedule is held against a ring file with all that differs in it.
#[test]
fn schedule_is_verified_against_an_uneven_ring_file() {
    let (folder, schedule) = Scratch::new("mower.toml", "");
    let file = schedule.to_str().unwrap();
    let designed = eeruf(&["design", "rings/mower-8-and-4.toml", "--emit", "toml"]).out;
    std::fs::write(&schedule, &designed).unwrap();
    let asked = ["verify", file, "--ring", "rings/mower-8-and-4.toml"];
    let kept = eeruf(&asked);
    assert_eq!(kept.code, Some(0), "{}{}", kept.out, kept.err);
    assert!(kept.out.ends_with("verified for what each sensor needs\n"), "{}", kept.out);
    // The last two fire together; one of them a tick later.
    let (before, last) = designed.trim_end().trim_end_matches(']').rsplit_once(", ").unwrap();
    let later: u32 = last.replace('_', "").parse::<u32>().unwrap() + 100;
    std::fs::write(&schedule, format!("{before}, {later}]\n")).unwrap();
    let report = json(&[&asked[..], &["--json"]].concat());
    assert_eq!(report["ok"], false);
    let kinds: Vec<_> = report["violations"].as_array().unwrap().iter().map(|found| found["kind"].clone()).collect();
    assert!(kinds.contains(&"together".into()), "{report}");
    let other = eeruf(&["verify", file, "--ring", "rings/paper-12.toml", "--t-delta-us", "9"]);
    assert_eq!(other.code, Some(2), "the ring file or the options");
    let fewer = eeruf(&["verify", file, "--ring", "rings/labmate-8.toml"]);
    assert!(fewer.err.contains("8 sensors; expected the 12 of the schedule"), "{}", fewer.err);
    drop(folder);
}

#[test]
fn a_robot_that_moves_gets_a_t_delta_that_covers_its_motion() {
    let still = "sensors = 8\nwindow_us = 20_000\nmin_interval_us = 10_000\njitter_us = 60\ntick_us = 100\n";
    let (_folder, file) = Scratch::new("still.toml", still);
    let still_period =
        json(&["design", "--period-only", file.to_str().unwrap(), "--json"])["value_us"].as_u64().unwrap();
    let moving = format!("{still}speed_m_s = 1.0\n");
    let (_folder, file) = Scratch::new("moving.toml", &moving);
    let found = json(&["design", "--period-only", file.to_str().unwrap(), "--json"]);
    assert!(found["value_us"].as_u64().unwrap() > still_period);
    // No good reading changes by more than jitter and 2 v dt / c over the longest dt.
    let times = |key: &str| -> Vec<i64> {
        found["schedule"][key].as_array().unwrap().iter().map(|t| t.as_i64().unwrap()).collect()
    };
    let longest = times("t_fire_a_us").iter().zip(times("t_fire_b_us")).map(|(a, b)| (a - b).abs()).max().unwrap();
    let change = 60.0 + 2.0 * (found["value_us"].as_i64().unwrap() + longest) as f64 / 343.2;
    let toml = eeruf(&["design", file.to_str().unwrap(), "--emit", "toml"]);
    let (_folder, schedule) = Scratch::new("schedule.toml", &toml.out);
    let t_delta = change.floor().to_string();
    assert_eq!(eeruf(&["verify", schedule.to_str().unwrap(), "--t-delta-us", &t_delta]).code, Some(0));

    let (_folder, file) = Scratch::new("rocket.toml", &format!("{still}speed_m_s = 100.0\n"));
    let rocket = eeruf(&["design", "--period-only", file.to_str().unwrap()]);
    assert_eq!(rocket.code, Some(1));
    assert!(rocket.out.contains("no schedule"), "{}", rocket.out);
}

// For those who have tables of their own kind: without the library.
#[test]
fn emitted_c_compiles_alone_without_warning() {
    let c = eeruf(&["design", "rings/paper-12.toml", "--period-only", "--emit", "c"]).out;
    let (folder, header) = Scratch::new("schedule.h", &c);
    let main = "int main(void) { return eeruf_t_fire_us[1][EERUF_SENSORS - 1] >= EERUF_PERIOD_US; }";
    let user = format!("#include \"{}\"\n{main}\n", header.display());
    for language in [C].into_iter().chain(cpp()) {
        compile_and_run(&folder, &user, language);
    }
}

#[test]
fn the_search_for_waits_counts_proves_and_finds() {
    let waits = "sensors = 4\nperiod_us = 40000\nwait_max_us = 9000\ntick_us = 1000\nt_delta_us = 999\n\
                 min_interval_us = 5000\n";
    for (criterion, count) in [("paper", 178_048), ("exact", 1_058_048)] {
        let (_folder, file) = Scratch::new("waits.toml", &format!("{waits}criterion = \"{criterion}\"\n"));
        let file = file.to_str().unwrap();
        assert_eq!(json(&["search", file, "--count", "--json"]), serde_json::json!({ "count": count }));
        let best = json(&["search", file, "--best", "interval", "--json"]);
        assert_eq!((&best["value_us"], &best["bound_us"], &best["proven"]), (&8000.into(), &8000.into(), &true.into()));
        let (_folder, schedule) = Scratch::new("schedule.toml", &eeruf(&["search", file]).out.replace("a table", "#"));
        let asked = ["--t-delta-us", "999", "--min-interval-us", "5000", "--criterion", criterion];
        assert_eq!(eeruf(&[&["verify", schedule.to_str().unwrap()], &asked[..]].concat()).code, Some(0));
    }
    let (_folder, file) = Scratch::new("waits.toml", &waits.replace("999", "1999"));
    let none = eeruf(&["search", file.to_str().unwrap()]);
    assert_eq!(none.code, Some(1));
    assert!(none.out.starts_with("there is no such table: all were searched"), "{}", none.out);
    for (from, to, reason) in [
        ("999", "1999", "t_delta alone cannot be met: 4 sensors need waits that differ by amounts 4 ms apart"),
        ("5000", "15000", "the smallest interval alone cannot be met: with these lags and waits of at most 9 ms"),
        ("5000", "9000", "t_delta and the smallest interval cannot be met together"),
    ] {
        let (_folder, file) = Scratch::new("waits.toml", &waits.replace(from, to));
        for option in [None, Some("--count")] {
            let asked: Vec<_> = ["search", file.to_str().unwrap()].into_iter().chain(option).collect();
            let none = eeruf(&asked);
            assert_eq!(none.code, Some(1));
            assert!(none.out.lines().nth(1).is_some_and(|line| line.starts_with(reason)), "{}", none.out);
        }
    }
}

#[test]
fn search_that_ends_early_is_not_decided() {
    let file = "rings/table-i-waits.toml";
    for option in [&[][..], &["--count"], &["--best", "t-delta"], &["--best", "pareto"]] {
        let ended = eeruf(&[&["search", file, "--budget", "3"], option].concat());
        assert_eq!(ended.code, Some(3), "{option:?}: {}{}", ended.out, ended.err);
        assert!(ended.out.contains("not decided: the search ended before"), "{option:?}: {}", ended.out);
        let late = eeruf(&[&["search", file, "--time-limit", "1e-9"], option].concat());
        // What needs fewer nodes than lie between two looks at the clock is found all the same.
        assert!(matches!(late.code, Some(0 | 3)), "{option:?}: {}{}", late.out, late.err);
    }
    let bad = eeruf(&["search", file, "--time-limit", "0"]);
    assert_eq!(bad.code, Some(2), "{}", bad.err);
}

#[test]
fn pareto_front_of_tables_is_what_the_two_bests_span() {
    let waits = "sensors = 4\nperiod_us = 40000\nwait_max_us = 9000\ntick_us = 500\nt_delta_us = 99\n";
    let (_folder, file) = Scratch::new("waits.toml", waits);
    let file = file.to_str().unwrap();
    let front = json(&["search", file, "--best", "pareto", "--json"]);
    let tables = front["tables"].as_array().unwrap();
    assert_eq!((&front["proven"], tables.len() > 1), (&true.into(), true), "{front}");
    let best = |what: &str| json(&["search", file, "--best", what, "--json"])["value_us"].clone();
    let (first, last) = (&tables[0], &tables[tables.len() - 1]);
    assert_eq!((&first["min_interval_us"], &last["t_delta_us"]), (&best("interval"), &best("t-delta")));
    for pair in tables.windows(2) {
        let value = |at: usize, key: &str| pair[at][key].as_u64().unwrap();
        assert!(value(0, "min_interval_us") > value(1, "min_interval_us"), "{front}");
        assert!(value(0, "t_delta_us") < value(1, "t_delta_us"), "{front}");
    }
    let said = eeruf(&["search", file, "--best", "pareto"]).out;
    assert!(said.contains("and no others") && said.matches("t_wait_a_us").count() == tables.len(), "{said}");
}

#[test]
fn shortest_waits_and_period_have_a_table_and_a_tick_less_none() {
    let waits = "sensors = 4\nperiod_us = 40000\nwait_max_us = 9000\ntick_us = 500\nt_delta_us = 999\n\
                 min_interval_us = 5000\nt_lag_us = [0, 10000, 20000, 30000]\n";
    let (_folder, file) = Scratch::new("waits.toml", waits);
    for (what, key) in [("waits", "wait_max_us = 9000"), ("period", "period_us = 40000")] {
        std::fs::write(&file, waits).unwrap();
        let file = file.to_str().unwrap();
        let found = json(&["search", file, "--best", what, "--json"]);
        assert_eq!((&found["proven"], &found["bound_us"]), (&true.into(), &found["value_us"]), "{found}");
        let shortest = found["value_us"].as_u64().unwrap();
        let code = |us: u64| {
            let (name, _) = key.split_once(" = ").unwrap();
            std::fs::write(file, waits.replace(key, &format!("{name} = {us}"))).unwrap();
            eeruf(&["search", file]).code
        };
        assert!(shortest < 40_000 && code(shortest) == Some(0) && code(shortest - 500) != Some(0), "{found}");
    }
}

#[test]
fn period_that_is_given_says_what_fits() {
    let file = "rings/paper-12.toml";
    for (period, code, t_delta) in [("64000", 1, 499), ("65000", 0, 999), ("100000", 0, 2999)] {
        let asked = eeruf(&["design", file, "--period", period, "--json"]);
        let found: Value = serde_json::from_str(&asked.out).unwrap();
        assert_eq!((asked.code, &found["fits"]), (Some(code), &(code == 0).into()), "{}", asked.out);
        assert_eq!((&found["value_us"], &found["proven"]), (&t_delta.into(), &true.into()), "{}", asked.out);
    }
    let toml = eeruf(&["design", file, "--period", "100000", "--emit", "toml"]).out;
    assert!(toml.contains("period_us = 100_000"), "{toml}");
    let none = eeruf(&["design", file, "--period", "64000", "--emit", "toml"]);
    assert_eq!((none.code, none.out.contains("no schedule of 64 ms")), (Some(1), true), "{}", none.out);
    let off = eeruf(&["design", file, "--period", "64500"]);
    assert_eq!(off.code, Some(2), "{}", off.out);
}

#[test]
fn curve_prints_twenty_periods_with_the_rings_own_among_them() {
    let curve = json(&["design", "rings/paper-12.toml", "--curve", "interval", "--json"]);
    let points = curve["points"].as_array().unwrap();
    assert_eq!((&curve["need"], points.len()), (&"interval".into(), 20));
    assert_eq!((&points[9]["value_us"], &points[9]["period_us"]), (&15_000.into(), &65_000.into()));
    let said = eeruf(&["design", "rings/paper-12.toml", "--curve", "t_delta"]).out;
    assert_eq!(said.matches("the ring's own").count(), 1, "{said}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_long_design_with_the_best_schedule_so_far() {
    // Open after minutes of search.
    let needs = "t_delta_us = 999\nmin_interval_us = 15_000\nwindow_us = 15_000\ntick_us = 100";
    let (_scratch, ring) = Scratch::new("ring-15.toml", &format!("sensors = 15\nlayout = 'ring'\n{needs}\n"));
    let mut program = Command::new(env!("CARGO_BIN_EXE_eeruf"));
    let search = program
        .arg("design")
        .arg(&ring)
        .args(["--period-only", "--budget", "1000000000"])
        .stdout(Stdio::piped())
        .spawn()
        .unwrap();
    // Long enough to begin, on a busy machine too.
    std::thread::sleep(Duration::from_secs(2));
    let signalled = Command::new("sh").args(["-c", &format!("kill -INT {}", search.id())]).status().unwrap();
    assert!(signalled.success());
    let outcome = search.wait_with_output().unwrap();
    let out = String::from_utf8(outcome.stdout).unwrap();
    assert_eq!(outcome.status.code(), Some(130), "{out}");
    assert!(out.contains("not proven: it may be as short as") && out.contains("t_fire_a_us"), "{out}");
}

#[cfg(unix)]
#[test]
fn ctrl_c_keeps_the_seeds_of_an_experiment_that_are_done() {
    // A busy machine may need longer for the first of them.
    for seconds in [2, 8, 30] {
        let mut program = Command::new(env!("CARGO_BIN_EXE_eeruf"));
        let words = "lab experiment set-three --seeds 100000 --periods 10 --method sequential --json";
        program.args(words.split(' ')).stdout(Stdio::piped()).stderr(Stdio::piped());
        let run = program.spawn().unwrap();
        std::thread::sleep(Duration::from_secs(seconds));
        let signalled = Command::new("sh").args(["-c", &format!("kill -INT {}", run.id())]).status().unwrap();
        assert!(signalled.success());
        let outcome = run.wait_with_output().unwrap();
        let err = String::from_utf8(outcome.stderr).unwrap();
        assert_eq!(outcome.status.code(), Some(130), "{err}");
        if outcome.stdout.is_empty() && seconds < 30 {
            continue;
        }
        let found: Value = serde_json::from_slice(&outcome.stdout).unwrap();
        let seeds = found["seeds"].as_u64().unwrap();
        assert!(err.contains(&format!("stopped after {seeds} of 100000 seeds, from 20000 on")), "{err}");
        // They are those of a run of as many.
        let words = format!("lab experiment set-three --seeds {seeds} --periods 10 --method sequential --json");
        let same = json(&words.split(' ').collect::<Vec<_>>());
        assert_eq!(found, same);
        return;
    }
}

// The examples are written where they are wanted and never over what is there.
#[test]
fn examples_never_overwrite() {
    let (folder, _) = Scratch::new("unused", "");
    let folder = folder.path().to_str().unwrap();
    let listed = eeruf(&["examples"]).out;
    assert!(listed.lines().any(|line| line == "scenes/alcove.toml"), "{listed}");
    std::fs::create_dir(format!("{folder}/rings")).unwrap();
    std::fs::write(format!("{folder}/rings/paper-12.toml"), "mine").unwrap();
    let written = eeruf(&["examples", folder]);
    assert_eq!((written.code, written.out.lines().count()), (Some(0), listed.lines().count()));
    assert!(written.out.contains("paper-12.toml is there already"), "{}", written.out);
    let text = |name: &str| std::fs::read_to_string(format!("{folder}/{name}")).unwrap();
    assert_eq!(text("rings/paper-12.toml"), "mine");
    assert_eq!(text("scenes/wall.toml"), include_str!("../../scenes/wall.toml"));
}

// Shells complete every verb and the manual has a page for each.
#[test]
fn shells_complete_every_verb() {
    let help = eeruf(&["--help"]).out;
    let (_, verbs) = help.split_once("Commands:\n").unwrap();
    let verbs: Vec<_> =
        verbs.lines().take_while(|line| !line.is_empty()).filter_map(|line| line.split_whitespace().next()).collect();
    let (folder, _) = Scratch::new("unused", "");
    let pages = folder.path().join("man1");
    assert_eq!(eeruf(&["man", pages.to_str().unwrap()]).code, Some(0));
    let bash = eeruf(&["completions", "bash"]).out;
    assert!(verbs.len() > 8, "{help}");
    for verb in verbs.into_iter().filter(|verb| *verb != "help") {
        assert!(bash.contains(&format!("eeruf__subcmd__{verb}")), "{verb}");
        assert!(pages.join(format!("eeruf-{verb}.1")).is_file(), "{verb}");
    }
}

// The program prints its licences, and those of what is within it where they were made; else that they were not.
#[test]
fn program_prints_its_licences() {
    let said = eeruf(&["licenses"]);
    assert_eq!(said.code, Some(0));
    let font = include_str!("../../src/report/draw/font/LICENSE");
    for part in [include_str!("../../LICENSE-MIT"), include_str!("../../LICENSE-APACHE"), font] {
        assert!(said.out.contains(part), "{part}");
    }
    let (_, others) = said.out.split_once("What others wrote\n").unwrap();
    let made = ["\nclap 4", "\nzstd-sys 2", "SQLite", "Rust's standard library"].map(|part| others.contains(part));
    assert!(made == [true; 4] || others.contains("was built without them") && made == [false; 4], "{made:?}");
}

#[test]
fn the_version_names_the_commit_of_the_clone() {
    let said = eeruf(&["--version"]).out;
    let rest = said.trim().strip_prefix(concat!("eeruf ", env!("CARGO_PKG_VERSION"))).expect("name and version");
    // A tarball of cargo's has a commit as well; a plain copy of the files has none.
    let commit = rest.strip_prefix(" (").and_then(|rest| rest.strip_suffix(')'));
    assert!(rest.is_empty() || commit.is_some_and(|commit| commit.len() >= 7), "{said}");
}

/// Checks that closing a pipe causes no panic: printing into it would panic in Rust.
#[cfg(unix)]
#[test]
fn early_end_of_reading_makes_no_panic() {
    let mut program = Command::new(env!("CARGO_BIN_EXE_eeruf"));
    let printing = program.args(["completions", "zsh"]).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut printing = printing.spawn().unwrap();
    drop(printing.stdout.take());
    let outcome = printing.wait_with_output().unwrap();
    assert_eq!(String::from_utf8(outcome.stderr).unwrap(), "");
}
