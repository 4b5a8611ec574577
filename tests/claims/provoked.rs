//! Runs that provoke errors and warnings: each names thing, value and expectation in one style, on lines of at most 80
//! columns, and none panics or hangs.

use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Time after which a run counts as hanging.
const HANGS_AFTER: Duration = Duration::from_secs(120);

struct Ended {
    code: Option<i32>,
    out: String,
    err: String,
}

/// Runs the program in a folder with this many columns.
fn run(folder: &Path, words: &[&str], columns: usize) -> Ended {
    let (out, err) = (folder.join("out.txt"), folder.join("err.txt"));
    let create = |file: &Path| fs::File::create(file).expect("the folder can be written to");
    let mut child = Command::new(env!("CARGO_BIN_EXE_eeruf"))
        .args(words)
        .current_dir(folder)
        .env("COLUMNS", columns.to_string())
        .stdin(Stdio::null())
        .stdout(create(&out))
        .stderr(create(&err))
        .spawn()
        .expect("the program was built beside this test");
    let began = Instant::now();
    let status = loop {
        if let Some(status) = child.try_wait().expect("a child of ours") {
            break status;
        }
        if began.elapsed() > HANGS_AFTER {
            child.kill().expect("a child of ours");
            panic!("{words:?} hangs");
        }
        std::thread::sleep(Duration::from_millis(5));
    };
    let text = |file: &Path| String::from_utf8_lossy(&fs::read(file).expect("it was created")).into_owned();
    Ended { code: status.code(), out: text(&out), err: text(&err) }
}

const RING: &str = "sensors = 4\nt_delta_us = 900\nmin_interval_us = 15000\nwindow_us = 30000\ntick_us = 1000\n";
const WAITS: &str = "sensors = 3\nperiod_us = 40000\nwait_max_us = 9000\ntick_us = 1000\nt_delta_us = 999\n\
    t_lag_us = [0, 5000, 10000]\n";
const SCHEDULE: &str = "period_us = 100000\nt_fire_a_us = [0, 20000]\nt_fire_b_us = [4000, 30000]\n";
const SCENE: &str = "[[wall]]\npoints_m = [[1.0, -2.0], [1.0, 2.0]]\n[[robot]]\npose = { x_m = 0.0, y_m = 0.0 }\n\
    ring = { \
                     sensors = 4, spacing_deg = 15, radius_m = 0.3 }\nperiod_us = 60_000\nt_delta_us = 200\n";
const FIRINGS: &str = "sensor,fired_us,period,phase,t_echo_us\n0,0,0,0,5000\n1,20000,1,0,6\n";
const MAP: &str = "image: cell.pgm\nresolution: 0.05\norigin: [0, 0, 0]\n";
const LOG: &str = "a,b\n1.0,2.0\n1.0,2.0\n1.1,2.1\n";

/// Writes the files of the corpus besides the right ones.
fn write_files(folder: &Path) {
    let files: [(&str, &[u8]); 21] = [
        ("ring.toml", RING.as_bytes()),
        ("waits.toml", WAITS.as_bytes()),
        ("schedule.toml", SCHEDULE.as_bytes()),
        ("hopping.toml", b"period_us = 60_000\nstep_us = 240\nphases = 11\nt_lag_us = [0, 0]\n"),
        ("scene.toml", SCENE.as_bytes()),
        ("log.csv", LOG.as_bytes()),
        ("firings.csv", b"sensor,fired_us,period,phase,t_echo_us\n0,0,0,0,5000\n1,20000,1,0,6000\n"),
        ("map.yaml", b"image: none.pgm\nresolution: 0.05\n"),
        ("none.firings.csv", b"sensor,fired_us,period,phase,t_echo_us\n"),
        ("negative.csv", b"sensor,fired_us,period,phase,t_echo_us\n0,0,0,0,-5\n"),
        ("cell.pgm", b"P2 2 2 1 0 0 0 1\n"),
        ("empty.yaml", b""),
        ("empty.bag", b""),
        ("empty.toml", b""),
        ("empty.csv", b""),
        ("latin.toml", b"sensors = \xff\xfe\n"),
        ("latin.csv", b"a,b\n\xff,\xfe\n"),
        ("no.bag", b"#ROSBAG V2.0\nshort"),
        ("no.mcap", b"not at all"),
        ("wrong.toml", b"a = ["),
        ("list.toml", b"sensors = [1, 2]\n"),
    ];
    for (name, contents) in files {
        fs::write(folder.join(name), contents).expect("the folder can be written to");
    }
    fs::create_dir(folder.join("folder.toml")).expect("the folder can be written to");
}

/// A file whose text has one thing replaced, the words before its name, and what the answer says.
type Spoilt<'a> = (&'a str, &'a str, &'a str, &'a str, &'a str);

/// Wrong keys, types and values in files.
const REFUSED_FILES: [Spoilt<'static>; 46] = [
    ("design", RING, "sensors = 4", "sensors = 0", "0 sensors; expected 1 to 64"),
    ("design", RING, "sensors = 4", "sensors = 65", "65 sensors; expected 1 to 64"),
    ("design", RING, "sensors = 4", "sensors = -4", "sensors: integer `-4`; expected a whole number"),
    ("design", RING, "sensors = 4", "sensors = 4.5", "sensors: floating point `4.5`; expected"),
    ("design", RING, "sensors = 4", "sensors = nan", "expected"),
    ("design", RING, "sensors = 4", "sensors = 1e300", "expected"),
    ("design", RING, "sensors = 4", "sensors = \"4\"", "sensors: string \"4\"; expected"),
    ("design", RING, "sensors = 4", "sensors = true", "sensors: boolean `true`; expected"),
    ("design", RING, "sensors = 4", "sensor = 4", "sensor: unknown key; did you mean `sensors`?"),
    ("design", RING, "sensors = 4", "", "sensors"),
    (
        "design",
        RING,
        "t_delta_us",
        "t_delta_ms",
        "t_delta_ms: unknown key; did you mean `t_delta_us`, in microseconds?",
    ),
    ("design", RING, "t_delta_us = 900\n", "", "t_delta_us"),
    ("design", RING, "window_us = 30000", "window_us = 0", "expected window_us or max_range_m above zero"),
    ("design", RING, "tick_us = 1000", "tick_us = 0", "expected 1 us or more"),
    ("design", RING, "tick_us = 1000", "neighbours = 0", "neighbours = 0; expected 1 to 64"),
    ("design", RING, "tick_us = 1000", "neighbours = 65", "neighbours = 65; expected 1 to 64"),
    ("design", RING, "tick_us = 1000", "layout = \"star\"", "expected"),
    ("design", RING, "tick_us = 1000", "layout = [[0, 9]]", "[0, 9]; expected two different sensors"),
    ("design", RING, "tick_us = 1000", "layout = [[1, 1]]", "[1, 1]; expected two different sensors"),
    ("design", RING, "tick_us = 1000", "max_range_m = 3.0", "expected one of window_us, max_range_m and module"),
    ("design", RING, "tick_us = 1000", "jitter_us = 30", "expected either t_delta_us, or jitter_us"),
    ("design", RING, "15000", "4000000000", "expected at most 268435.456 ms"),
    ("design", RING, "window_us", "horizon", "horizon: unknown key; expected one of `sensors`"),
    ("design", RING, "window_us", "windw_us", "did you mean `window_us`?"),
    (
        "design",
        RING,
        "tick_us = 1000",
        "tick_us = 1\ntick_us = 2",
        "line 6: tick_us: set twice; expected each key once",
    ),
    ("design", RING, "window_us = 30000", "window_us = 30", "window_us: 30, and no echo from 10 cm or more within it"),
    ("design", RING, "tick_us = 1000", "layout = 5", "line 5: layout: `5`; expected \"line\""),
    ("paths", SCENE, "x_m = 0.0", "x_m = \"a\"", "line 4: x_m: string \"a\"; expected a number"),
    ("search", WAITS, "[0, 5000, 10000]", "[0, 500, 10000]", "a lag of 500 us; expected a whole number of ticks"),
    ("search", WAITS, "[0, 5000, 10000]", "[0]", "1 lags; expected one for each of 3 sensors"),
    ("search", WAITS, "sensors = 3", "sensors = 65", "65 sensors; expected 1 to 64"),
    ("search", WAITS, "tick_us = 1000", "tick_us = 3000", "expected a whole number of ticks"),
    ("search", WAITS, "wait_max_us = 9000", "wait_max_us = -1", "integer `-1`; expected"),
    ("verify", SCHEDULE, "100000", "0", "a period of 0 us; expected 1 us to"),
    ("verify", SCHEDULE, "[0, 20000]", "[0]", "expected"),
    ("verify", SCHEDULE, "[0, 20000]", "[0, 200000]", "sensor 2 fires 200 ms into phase a; expected less than"),
    ("verify", SCHEDULE, "[0, 20000]", "[0, -1]", "integer `-1`; expected"),
    ("verify", SCHEDULE, "t_fire_b_us", "t_fire_c_us", "t_fire_c_us: unknown key; did you mean `t_fire_"),
    ("verify", SCHEDULE, "[0, 20000]", "[0, 1e300]", "expected"),
    ("study", SCENE, "sensors = 4", "sensors = 65", "robot 1 has 65 sensors; expected 1 to 64"),
    ("study", SCENE, "[1.0, 2.0]]", "[nan, 2.0]]", "expected"),
    ("study", SCENE, "[1.0, 2.0]]", "[1e300, 2.0]]", "expected"),
    ("study", SCENE, "radius_m = 0.3", "radius_m = inf", "expected"),
    ("study", SCENE, "points_m", "point_m", "point_m: unknown key; did you mean `points_m`?"),
    ("paths", SCENE, "period_us = 60_000", "period_us = 0", "expected"),
    (
        "paths",
        SCENE,
        "period_us = 60_000",
        "module = \"hcsr40\"",
        "no preset \"hcsr40\"; expected polaroid-6500, hc-sr04",
    ),
];

/// Wrong arguments and wrong files.
const REFUSED_RUNS: [(&[&str], &str); 95] = [
    (&["desing", "ring.toml"], "desing: no command; did you mean `design`?; see `eeruf --help`"),
    (&["design"], "RING.toml: missing; expected `eeruf design RING.toml`"),
    (&["verify"], "SCHEDULE.toml: missing; expected `eeruf verify"),
    (&["replay", "log.csv"], "--t-delta-us: missing; expected `eeruf replay .. --t-delta-us US`"),
    (&["design", "ring.toml", "ring.toml"], "ring.toml: one argument too many; expected one file"),
    (&["design", "ring.toml", "--emitt", "rust"], "--emitt: unknown; did you mean `--emit`?"),
    (&["design", "ring.toml", "--emit", "ada"], "--emit: `ada`; expected toml, rust, c"),
    (&["design", "ring.toml", "--emit"], "--emit: no value; expected FORM"),
    (&["design", "ring.toml", "--time-limit", "0"], "--time-limit: `0`; expected seconds above 0"),
    (&["design", "ring.toml", "--time-limit", "nan"], "--time-limit: `nan`; expected seconds above 0"),
    (&["design", "ring.toml", "--budget", "-1"], "`-1`; expected no negative number"),
    (&["design", "ring.toml", "--emit", "c", "--json"], "given with --json; expected one of the two"),
    (&["design", "ring.toml", "--json", "--json"], "--json: given more than once; expected once"),
    (
        &["design", "ring.toml", "--svg", "out.jpg"],
        "--svg: `out.jpg`; expected a folder, or a name that ends in .svg or .png",
    ),
    (&["design", "ring.toml", "--svg", "no/such/out.svg"], "no/such/out.svg: No such file"),
    (&["verify", "schedule.toml", "--t-delta-us", "1.5"], "--t-delta-us: `1.5`; expected a whole number"),
    (&["verify", "schedule.toml", "--t-delta-us", "1e300"], "--t-delta-us: `1e300`; expected a whole number"),
    (
        &["verify", "schedule.toml", "--t-delta-us", "99999999999"],
        "`99999999999`; expected a number from 0 to 4294967295",
    ),
    (&["verify", "schedule.toml", "--neighbours", "0"], "--neighbours: `0`; expected a number from 1 to 64"),
    (&["verify", "schedule.toml", "--layout", "star"], "--layout: `star`; expected line, ring, blocks"),
    (&["verify", "schedule.toml", "--layout", "0-9"], "layout: neighbours [0, 9]; expected two different sensors"),
    (&["verify", "schedule.toml", "--criterion", "strict"], "--criterion: `strict`; expected"),
    (&["verify", "schedule.toml", "--ring", "ring.toml"], "4 sensors; expected the 2 of the schedule"),
    (&["study", "scene.toml", "--periods", "0"], "--periods: `0`; expected a number from 1 to 10000000"),
    (&["study", "scene.toml", "--method", "eruf"], "--method: `eruf`; did you mean `eeruf`?"),
    (&["study", "scene.toml", "--physics", "real"], "--physics: `real`; expected"),
    (&["study", "scene.toml", "--log", "out.csv"], "--log: 0 methods; expected one --method"),
    (&["paths", "scene.toml", "--order", "-1"], "`-1`; expected no negative number"),
    (&["experiment"], "command: missing; expected set-one, set-two, set-three"),
    (&["experiment", "set-four"], "set-four: no command; did you mean `set-three`?"),
    (&["experiment", "set-one", "--seeds", "0"], "--seeds: `0`; expected a number from 1 to 100000"),
    (&["experiment", "set-two", "--speed", "nan"], "--speed: `nan`; expected 0.1 to 5"),
    (&["atlas", "--shard", "3/2"], "--shard: `3/2`; expected I/N, such as 2/8"),
    (&["scene", "map.yaml"], "map.yaml: "),
    (&["completions", "cmd"], "SHELL: `cmd`; expected bash"),
    (&["verify", "ring.toml"], "this is a ring for `eeruf design`; expected a schedule; did you mean `eeruf design"),
    (&["verify", "scene.toml"], "this is a scene; expected a schedule; did you mean `eeruf study"),
    (&["verify", "waits.toml"], "this is a ring for `eeruf lab search`; expected a schedule; did you mean `eeruf lab"),
    (&["verify", "log.csv"], "this is a log; expected a schedule; did you mean `eeruf logs log.csv`?"),
    (
        &["design", "schedule.toml"],
        "this is a schedule; expected a ring for `eeruf design`; did you mean `eeruf verify",
    ),
    (&["study", "schedule.toml"], "this is a schedule; expected a scene; did you mean `eeruf verify"),
    (&["search", "ring.toml"], "this is a ring for `eeruf design`; expected a ring for `eeruf lab search`"),
    (&["paths", "map.yaml"], "this is a map; expected a scene; did you mean `eeruf lab scene map.yaml`?"),
    (&["replay", "schedule.toml", "--t-delta-us", "500"], "this is a schedule; expected a log; did you mean"),
    (&["diagnose", "scene.toml"], "this is a scene; expected a log; did you mean `eeruf study scene.toml`?"),
    (&["verify", "folder.toml"], "folder.toml: Is a directory"),
    (&["verify", "none.toml"], "none.toml: No such file"),
    (&["design", "latin.toml"], "latin.toml: no text; expected text in UTF-8"),
    (&["design", "wrong.toml"], "wrong.toml, line 1: "),
    (&["replay", "empty.csv", "--t-delta-us", "500"], "the file is empty; expected lines with readings"),
    (&["diagnose", "none.csv"], "none.csv: No such file"),
    (&["logs", "log.csv", "--no-echo-m", "-1"], "--no-echo-m: `-1`; expected no negative number"),
    (&["logs", "log.csv", "--field", "/s", "f"], "--field: 2 values; expected 3"),
    (
        &["logs", "log.csv", "--field", "/s", "f", "h"],
        "--field: /s: unit `h`; expected one of m, cm, mm, in, ft, ms, us",
    ),
    (&["logs", "none.csv"], "none.csv: No such file or directory (os error 2); expected a file that exists"),
    (&["diagnose", "log.csv", "--speed-of-sound", "nan"], "--speed-of-sound: `nan`; expected a number above zero"),
    (&["survey", "log.csv"], "log.csv: no column `sensor`; expected sensor, fired_us"),
    (&["survey", "firings.csv", "--ring", "ring.toml"], "ring.toml: a file that no survey wrote; expected a new name"),
    (
        &["experiment", "set-one", "--period-us", "1"],
        "expected a number from 45000 to 1000000; see `eeruf experiment set-one",
    ),
    (&["merge"], "FILE: missing; expected `eeruf merge FILE`"),
    (&["merge", "log.csv"], "log.csv, line 1: no JSON; expected what `eeruf lab experiment .. --shard I/N` prints"),
    (&["atlas", "ring.toml", "--most-sensors", "2"], "ring.toml: no row of an atlas; expected a file that"),
    (
        &["scene", "ring.toml"],
        "this is a ring for `eeruf design`; expected a map; did you mean `eeruf design ring.toml`?",
    ),
    (&["dataset", "out", "--first", "18446744073709551615"], "--first: 18446744073709551615; expected at most"),
    (&["study", "scene.toml", "--places", "2"], "--places: given with scene.toml; expected it with a ring file alone"),
    (&["replay", "log.csv", "--t-delta-us", "500", "--out", "log.csv"], "expected another file than the one that is"),
    (&["study", "scene.toml", "--method", "eeruf", "--log", "scene.toml"], "--log: scene.toml; expected another file"),
    (&["design", "ring.toml", "--certificate", "ring.toml"], "--certificate: ring.toml; expected another file"),
    (&["design", "ring.toml", "--certificate", "folder.toml"], "folder.toml; expected a file, not a folder"),
    (&["design", "ring.toml", "--certificate", "no/c"], "no/c: No such file or directory (os error 2); expected a fol"),
    (
        &["study", "scene.toml", "--svg", "out.jpg"],
        "--svg: `out.jpg`; expected a folder, or a name that ends in .svg or .png",
    ),
    (&["replay", "log.csv", "--t-delta-us", "500", "--out", "x.mcap"], "a reading without a time; expected --time"),
    (&["replay", "log.csv", "log.csv", "--t-delta-us", "500"], "log.csv: one argument too many; expected one file"),
    (&["logs", "empty.bag"], "the first bytes are not those of a ROS 1 bag of format 2.0; expected a whole"),
    (&["logs", "no.mcap"], "the first bytes are not those of MCAP; expected a whole and undamaged log"),
    (&["logs", "log.csv", "--range", "nope"], "no column `nope`; expected one of: a, b"),
    (&["diagnose", "none.firings.csv"], "none.firings.csv: 0 firings; expected one or more"),
    (&["diagnose", "negative.csv"], "negative.csv, line 2: column t_echo_us: `-5`; expected microseconds, or nothing"),
    (&["diagnose", "firings.csv", "--schedule", "schedule.toml"], "fewer than ten periods; expected ten or more"),
    (&["dataset", "out", "--alcoves", "0", "--courses", "0"], "--alcoves: 0, and --courses: 0; expected one or more"),
    (&["atlas", "latin.toml"], "latin.toml: stream did not contain valid UTF-8; expected text in UTF-8"),
    (&["scene", "empty.yaml"], "empty.yaml: no keys; expected image, resolution and origin"),
    (&["examples", "log.csv"], "log.csv/checker: Not a directory (os error 20); expected a file that can be written"),
    (&["design", "ring.toml", "--period", "0"], "--period: `0`; expected a number from 1 to 4294967295"),
    (&["survey", "firings.csv", "--simulate", "scene.toml"], "given with --simulate"),
    (&["study", "scene.toml", "--seed", "-1"], "--seed: `-1`; expected no negative number"),
    (&["plot", "scene.toml"], "plot: no command; did you mean `eeruf study SCENE.toml --svg DIR`?"),
    (&["simulate", "scene.toml"], "simulate: no command; did you mean `eeruf study`?"),
    (&["study", "scene.toml", "--method", "EERUF"], "--method: `EERUF`; did you mean `eeruf`?"),
    (&["study", "scene.toml", "--method", "flow", "dither"], "dither: one argument too many; expected commas"),
    (&["study", "scene.toml", "-svg", "out"], "-svg: unknown; did you mean `--svg`?"),
    (&["--method", "flow", "study", "scene.toml"], "--method: unknown; expected it after the command"),
    (&["design", "ring.toml", "--method", "flow"], "`eeruf study` has it; see `eeruf design --help`"),
    (&["study", "~/scene.toml"], "expected a path without `~`, which only shells know"),
    (&["study", "scen.toml"], "scen.toml: No such file or directory (os error 2); did you mean `scene.toml`?"),
];

/// Legal and implausible input, and its warning.
const IMPLAUSIBLE: [Spoilt<'static>; 29] = [
    ("design", RING, "min_interval_us = 15000", "min_interval_us = 15", "min_interval_us: 15; expected 200 to"),
    ("design", RING, "t_delta_us = 900", "t_delta_us = 1", "t_delta_us: 1; expected 20 to 20000; T_delta is in micro"),
    ("design", RING, "tick_us = 1000", "tick_us = 200000", "tick_us: 200000; expected 1 to 100000"),
    ("design", RING, "window_us = 30000", "max_range_m = 400.0", "max_range_m: 400; expected 0.05 to 30; likely centi"),
    ("search", WAITS, "wait_max_us = 9000", "wait_max_us = 9", "wait_max_us: 9; expected 200 to"),
    ("verify", SCHEDULE, "period_us = 100000", "period_us = 100000000", "period_us: 100000000; expected 2000 to"),
    (
        "study --periods 2 --method sequential",
        SCENE,
        "spacing_deg = 15",
        "spacing_deg = 360",
        "spacing_deg: 360; expected",
    ),
    ("study --periods 2 --method sequential", SCENE, "spacing_deg = 15", "spacing_deg = 0.26", "likely radians"),
    ("paths", SCENE, "[1.0, 2.0]]", "[1.0, 500.0]]", "points_m: 500; expected 0 to 200; likely centimetres"),
    ("paths", SCENE, "x_m = 0.0", "x_m = -300.0", "x_m: -300; expected 0 to 200; likely centimetres"),
    ("paths", SCENE, "radius_m = 0.3", "radius_m = 0.0003", "radius_m: 0.0003; expected 0.001 to 20"),
    ("paths", SCENE, "t_delta_us = 200", "t_delta_us = 1", "t_delta_us: 1; expected 20 to 20000"),
    ("verify --t-delta-us 2", SCHEDULE, "", "", "--t-delta-us: 2; expected 20 to 20000"),
    ("verify --window-us 30", SCHEDULE, "", "", "--window-us: 30; expected 1000 to 1000000; likely milliseconds"),
    ("verify --min-interval-us 15", SCHEDULE, "", "", "--min-interval-us: 15; expected 200 to"),
    ("design --period 1000", RING, "", "", "--period: 1000; expected 2000 to 60000000; likely milliseconds"),
    ("paths", SCENE, "t_delta_us = 200", "height_m = 100.0", "height_m: 100; expected 0 to 20; likely centimetres"),
    ("paths --order 20", SCENE, "", "", "--order: 20; expected 0 to 12; each bounce multiplies the paths"),
    ("paths", SCENE, "t_delta_us = 200", "height_m = 1e300", "height_m: 1e300; expected 0 to 20"),
    ("logs --speed-of-sound 34", LOG, "", "", "--speed-of-sound: 34; expected 250 to 450; speeds are metres"),
    ("logs --no-echo-m 500", LOG, "", "", "--no-echo-m: 500; expected 0.05 to 60; likely centimetres"),
    ("diagnose", FIRINGS, "5000", "5", "column t_echo_us: at most 6; expected 200 or more; likely milliseconds"),
    ("survey", FIRINGS, "20000", "20", "column fired_us: mean steps of 20; expected 200 or more; likely milliseconds"),
    (
        "logs --topic /sonar",
        LOG,
        "",
        "",
        "--topic has no effect; expected a log that it could choose from; this one has",
    ),
    ("replay --t-delta-us 500 --field /sonar data cm", LOG, "", "", "--field has no effect"),
    ("logs --range-unit mm", LOG, "", "", "2 millimetres, 0.002 m; expected 0.01 to 25 m from an ultrasonic sensor"),
    ("replay --t-delta-us 0", LOG, "", "", "--t-delta-us: 0; expected 20 to 20000"),
    ("scene", MAP, "0.05", "50", "resolution: 50; expected 0.001 to 1; likely centimetres"),
    ("replay --t-delta-us 500 --speed-of-sound 34320", LOG, "", "", "--speed-of-sound: 34320; expected 250 to 450"),
];

fn longest(text: &str) -> usize {
    text.lines().map(|line| line.chars().count()).max().unwrap_or(0)
}

/// Returns one line of words, however it was wrapped.
fn joined(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Writes the text with one thing replaced into a file of the folder; returns the words that name it.
fn spoil<'a>(folder: &Path, (words, text, old, new, _): Spoilt<'a>) -> Vec<&'a str> {
    assert!(text.contains(old), "{old}");
    let spoilt = if old.is_empty() { text.to_owned() } else { text.replacen(old, new, 1) };
    let name = match text {
        LOG | FIRINGS => "spoilt.csv",
        MAP => "spoilt.yaml",
        _ => "spoilt.toml",
    };
    fs::write(folder.join(name), spoilt).expect("the folder can be written to");
    let mut words: Vec<_> = words.split(' ').collect();
    words.insert(1, name);
    if words[0] == "design" {
        words.push("--period-only");
    }
    words
}

/// Returns the faults of an answer that should name thing, value and expectation.
fn faults_of(ended: &Ended, columns: usize, says: &str) -> Vec<&'static str> {
    let Ended { code, out, err } = ended;
    // A word that is longer than the line is broken.
    let squeezed = |text: &str| text.split_whitespace().collect::<String>();
    let held = [
        ("its exit code is not 2", *code == Some(2)),
        ("it prints to standard output", out.is_empty()),
        ("its style differs", err.starts_with("eeruf: ") && err.matches("eeruf: ").count() == 1),
        ("a line is too long", longest(err) <= columns),
        ("it panics", !err.contains("panicked")),
        ("it names no expectation", err.contains("expected") || joined(err).contains("; did you mean")),
        ("it does not say so", squeezed(err).contains(&squeezed(says))),
    ];
    held.into_iter().filter(|(_, held)| !held).map(|(fault, _)| fault).collect()
}

#[test]
fn provoked_errors_name_thing_value_and_expectation() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    write_files(folder.path());
    assert!(REFUSED_FILES.len() + REFUSED_RUNS.len() + IMPLAUSIBLE.len() >= 105);
    let mut faulty = vec![];
    for columns in [80, 40] {
        let mut note = |words: &[&str], new: &str, says: &str| {
            let ended = run(folder.path(), words, columns);
            let faults = faults_of(&ended, columns, says);
            if !faults.is_empty() {
                faulty.push(format!("{words:?} {new}: {faults:?}: expected {says} in\n{}", ended.err));
            }
        };
        for (words, says) in REFUSED_RUNS {
            note(words, "", says);
        }
        for spoilt in REFUSED_FILES {
            let words = spoil(folder.path(), spoilt);
            note(&words, spoilt.3, spoilt.4);
        }
    }
    assert!(faulty.is_empty(), "{}", faulty.join("\n"));
    let read = |name: &str| fs::read_to_string(folder.path().join(name)).expect("what is read stays");
    assert_eq!([read("log.csv"), read("ring.toml"), read("scene.toml")], [LOG, RING, SCENE]);
    #[cfg(unix)]
    assert!(run(folder.path(), &["verify", "/dev/zero"], 80).err.contains("64 MiB or more; expected a smaller file"));
}

#[test]
fn implausible_input_warns_unless_quiet() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    write_files(folder.path());
    for spoilt in IMPLAUSIBLE {
        let words = spoil(folder.path(), spoilt);
        let of = format!("{} {}", spoilt.0, spoilt.3);
        let warned = run(folder.path(), &words, 80);
        // 3: a log that cannot tell.
        assert!(matches!(warned.code, Some(0 | 1 | 3)), "{of}: {}", warned.err);
        assert!(warned.err.starts_with("eeruf: warning: ") && longest(&warned.err) <= 80, "{of}: {}", warned.err);
        assert!(joined(&warned.err).contains(spoilt.4), "{of}: {}", warned.err);
        let quiet = run(folder.path(), &[&words[..], &["--quiet"]].concat(), 80);
        assert_eq!((quiet.err.as_str(), quiet.code), ("", warned.code), "{of}");
        let denied = run(folder.path(), &[&words[..], &["--deny-warnings"]].concat(), 80);
        assert_eq!((denied.code, denied.out.as_str()), (Some(2), ""), "{of}: {}", denied.err);
        assert!(joined(&denied.err).contains(spoilt.4), "{of}: {}", denied.err);
    }
}

#[test]
fn plausible_examples_do_not_warn() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    for (verb, of) in [("verify", "rings"), ("paths", "scenes")] {
        for entry in fs::read_dir(root.join(of)).expect("the repository has it") {
            let file = entry.expect("an entry").path();
            let ended = run(folder.path(), &[verb, file.to_str().expect("UTF-8")], 80);
            assert!(!ended.err.contains("warning"), "{}: {}", file.display(), ended.err);
        }
    }
}

#[test]
fn tables_fit_80_and_40_columns() {
    let root = env!("CARGO_MANIFEST_DIR");
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let in_root = |name: &str| format!("{root}/{name}");
    let (scene, log) = (in_root("scenes/alcove.toml"), in_root("tests/data/scitos-g5-24-sonars.csv"));
    let (table, ring) = (in_root("rings/table-i-d.toml"), in_root("rings/nao-2.toml"));
    let runs: [&[&str]; 7] = [
        &["study", &scene, "--periods", "20"],
        &["paths", &scene],
        &["replay", &log, "--t-delta-us", "500"],
        &["verify", &table, "--t-delta-us", "1000"],
        &["design", &ring, "--places", "1"],
        &["experiment", "set-one", "--seeds", "2"],
        &["experiment", "set-two", "--seeds", "1", "--method", "sequential"],
    ];
    for words in runs {
        let whole = run(folder.path(), words, 80);
        assert!(longest(&whole.out) <= 80, "{words:?}\n{}", whole.out);
        let narrow = run(folder.path(), words, 40);
        assert!(longest(&narrow.out) <= 40, "{words:?}\n{}", narrow.out);
    }
    let few = ["study", &scene, "--periods", "20", "--method", "conventional,eeruf", "--wide"];
    let wide = run(folder.path(), &few, 40);
    assert!(longest(&wide.out) > 80, "{}", wide.out);
}

#[test]
fn colours_are_asked_for_or_absent() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    let coloured = run(folder.path(), &["verify", "none.toml", "--color", "always"], 80);
    assert!(coloured.err.starts_with("\x1b[1;31meeruf: \x1b[0m"), "{:?}", coloured.err);
    for when in ["auto", "never"] {
        let plain = run(folder.path(), &["verify", "none.toml", "--color", when], 80);
        assert!(!plain.err.contains('\x1b'), "{:?}", plain.err);
    }
}

#[test]
fn help_fits_80_columns() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    for words in [&["--help"][..], &["design", "--help"], &["study", "--help"], &["experiment", "set-two", "--help"]] {
        let help = run(folder.path(), words, 80).out;
        assert!(longest(&help) <= 80 && help.contains("Exit codes: 0 "), "{help}");
    }
}

// What earlier versions took answers by its name, and says what does its work.
#[test]
fn gone_options_and_keys_answer_by_name() {
    let folder = tempfile::tempdir().expect("a folder for temporary files");
    write_files(folder.path());
    let runs: [(&[&str], &str); 8] = [
        (&["design", "ring.toml", "--phases", "4"], "--phases: gone; flow does it\n"),
        (&["design", "ring.toml", "--fleet-number=2"], "--fleet-number: gone; flow needs no numbers\n"),
        (&["experiment", "set-three", "--numbered"], "--numbered: gone; flow needs no numbers\n"),
        (&["experiment", "set-two", "--hopping", "maps"], "--hopping: gone; flow does it\n"),
        (&["replay", "log.csv", "--hopping", "quick"], "--hopping: gone; flow does it\n"),
        (&["verify", "schedule.toml", "--margin-us", "5"], "--margin-us: gone; schedules have two phases\n"),
        (&["verify", "hopping.toml"], "hopping.toml: step_us, of many phases: gone; flow does it\n"),
        (&["verify", "schedule.toml", "--reach-us", "5000"], "--reach-us: gone; schedules have two phases\n"),
    ];
    for (args, expected) in runs {
        let outcome = run(folder.path(), args, 80);
        assert_eq!((outcome.code, outcome.err), (Some(2), format!("eeruf: {expected}")), "{args:?}");
    }
}
