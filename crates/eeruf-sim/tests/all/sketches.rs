//! Rings fired like sketches and modules: the order of firings, and the readings that are believed.

use std::path::Path;

use eeruf_core::{Micros, ReadingKind};
use eeruf_sim::experiments::set_one::Alcove;
use eeruf_sim::*;

/// Four sensors in a row that all face a wall 1.715 m ahead, which gives an echo of 10 ms at 343 m/s.
const ROW: &str = "
[noise]
fading_db_rms = 0.0
jitter_us_rms = 0.0
[[wall]]
points_m = [[1.715, -9.0], [1.715, 9.0]]
faces = \"both\"
[[robot]]
pose = { x_m = 0.0, y_m = 0.0 }
sensors = [{ x_m = 0, y_m = 0.3 }, { x_m = 0, y_m = 0.1 }, { x_m = 0, y_m = -0.1 }, { x_m = 0, y_m = -0.3 }]
module = \"hc-sr04\"
";

fn read(text: &str) -> Result<World, String> {
    World::from_text(Path::new("w.toml"), text).map_err(|error| error.to_string())
}

fn run(firing: &str, method: Method) -> Readings {
    simulate(&read(&format!("{ROW}{firing}")).unwrap(), method, &Options::periods(20)).unwrap()
}

/// Returns the firings in order: microsecond and sensor.
fn firings(readings: &Readings) -> Vec<(u64, u8)> {
    let mut firings: Vec<_> =
        (0..readings.len()).map(|k| ((1e6 * readings.fired_s[k]).round() as u64, readings.sensor[k])).collect();
    firings.sort_unstable();
    firings
}

/// Returns the times between consecutive firings of some sensors.
fn steps(readings: &Readings, of: &[u8]) -> Vec<u64> {
    let own: Vec<_> = firings(readings).into_iter().filter(|(_, sensor)| of.contains(sensor)).collect();
    own.windows(2).map(|pair| pair[1].0 - pair[0].0).collect()
}

#[test]
fn echo_or_timeout_fires_the_next_in_turn() {
    let readings = run("firing = { pause_us = 700 }", Method::InTurn);
    let order: Vec<_> = firings(&readings).iter().map(|(_, sensor)| *sensor).collect();
    assert!(order.len() > 100 && order.iter().zip([0, 1, 2, 3].iter().cycle()).all(|(a, b)| a == b), "{order:?}");
    assert!(steps(&readings, &[0, 1, 2, 3]).iter().all(|step| (10_600..=10_800).contains(step)));
    // The wall is out of reach of a time-out of 8 ms: the next sensor takes the late echo for its own.
    let readings = run("firing = { timeout_us = 8_000 }", Method::InTurn);
    let late = steps(&readings, &[0, 1, 2, 3]);
    assert_eq!(late[0], 8_000);
    assert!((2_000..2_100).contains(&late[1]), "{late:?}");
    assert_eq!(readings.cause[..2], [Cause::Nothing, Cause::Crosstalk]);
    assert_eq!(readings.kind[..2], [ReadingKind::Clear, ReadingKind::Accepted]);
    // Without a wall the time-out sets the pace.
    let open = read(&format!("{}firing.timeout_us = 8_000", ROW.replace("1.715", "-50.0"))).unwrap();
    let readings = simulate(&open, Method::InTurn, &Options::periods(20)).unwrap();
    assert!(steps(&readings, &[0, 1, 2, 3]).iter().all(|&step| step == 8_000));
    let silent = |kind: &ReadingKind| *kind == ReadingKind::Clear;
    assert!(readings.cause.iter().all(|&cause| cause == Cause::Nothing) && readings.kind.iter().all(silent));
    // A ping timer fires on time, with or without an echo.
    let readings = run("firing = { turn_us = 33_000 }", Method::InTurn);
    assert!(steps(&readings, &[0, 1, 2, 3]).iter().all(|&step| step == 33_000));
}

#[test]
fn arrays_take_turns_side_by_side() {
    let readings = run("firing = { arrays = [[0, 2, 3], [1]], turn_us = 12_000 }", Method::Arrays);
    let of = |sensors: &[u8]| -> Vec<u8> {
        let all = firings(&readings);
        all.into_iter().map(|(_, sensor)| sensor).filter(|sensor| sensors.contains(sensor)).collect()
    };
    assert_eq!(of(&[0, 2, 3])[..6], [0, 2, 3, 0, 2, 3]);
    for array in [&[0, 2, 3][..], &[1]] {
        assert!(steps(&readings, array).iter().all(|&step| step == 12_000), "{array:?}");
    }
    // The arrays are two halves unless the sketch sets others.
    let halves = run("", Method::Arrays);
    assert_eq!(firings(&halves)[..2], [(0, 0), (0, 2)]);
}

#[test]
fn groups_fire_together_and_wait_for_each_other() {
    let readings = run("firing = { groups = [[0, 3], [1], [2]], turn_us = 15_000 }", Method::Groups);
    let expected = [(0, 0), (0, 3), (15_000, 1), (30_000, 2), (45_000, 0), (45_000, 3)];
    assert_eq!(firings(&readings)[..6], expected);
    // The groups keep neighbours apart unless the sketch sets others.
    let apart = run("neighbours = 2", Method::Groups);
    assert_eq!(firings(&apart)[..2], [(0, 0), (0, 2)]);
}

#[test]
fn a_sync_line_fires_all_when_the_slowest_is_ready() {
    // An HC-SR04 rests for 60 ms; one of the four for 80 ms.
    for (more, cycle) in [("", 60_000), ("firing = { rest_us = 5_000, pause_us = 40_000 }", 50_000)] {
        let readings = run(more, Method::SyncLine);
        let all = firings(&readings);
        let turns: Vec<_> =
            all.chunks(4).map(|turn| turn.iter().map(|(_, sensor)| *sensor).collect::<Vec<_>>()).collect();
        assert!(turns.iter().all(|turn| turn == &[0, 1, 2, 3]), "{turns:?}");
        assert!(all.chunks(4).all(|turn| turn[0].0 == turn[3].0));
        assert!(steps(&readings, &[2]).iter().all(|step| (cycle..cycle + 100).contains(step)), "{more}");
    }
}

#[test]
fn modules_that_run_freely_drift_apart() {
    let cycles = |firing: &str| {
        let readings = run(firing, Method::FreeRunning);
        let cycle = |sensor: u8| {
            let steps = steps(&readings, &[sensor]);
            assert!(steps.len() > 12 && steps.iter().all(|&step| step == steps[0]), "{steps:?}");
            steps[0]
        };
        [0, 1, 2, 3].map(cycle)
    };
    let drifting = cycles("firing = { drift_ppm = 20_000 }");
    assert!(drifting.iter().all(|cycle| (58_800..=61_200).contains(cycle)), "{drifting:?}");
    assert!(drifting[0] != drifting[1] && drifting[1] != drifting[2], "{drifting:?}");
    assert_eq!(cycles("firing = { drift_ppm = 0.0, turn_us = 70_000 }"), [70_000; 4]);
}

#[test]
fn a_table_of_three_phases_fires_as_it_says() {
    let rows = "[[0, 10_000, 20_000, 30_000], [1_000, 11_000, 21_000, 31_000], [9_000, 0, 25_000, 35_000]]";
    let firing = format!("firing.schedule = {{ period_us = 50_000, t_fire_us = {rows} }}");
    let readings = run(&firing, Method::Table);
    let first: Vec<_> = firings(&readings).into_iter().filter(|(_, sensor)| *sensor == 1).map(|(at, _)| at).collect();
    assert_eq!(first[..4], [10_000, 61_000, 100_000, 160_000]);
    // Without a table it is the robot's own schedule, which as one of our methods would judge readings.
    let own = "schedule = { period_us = 60_000, t_fire_a_us = [0, 5_000, 9_000, 14_000], \
               t_fire_b_us = [2_000, 8_000, 11_000, 20_000] }";
    let own = run(own, Method::Table);
    assert_eq!(firings(&own)[..5], [(0, 0), (5_000, 1), (9_000, 2), (14_000, 3), (62_000, 0)]);
    assert!(own.kind.iter().all(|&kind| kind == ReadingKind::Accepted));
}

#[test]
fn a_sketch_believes_each_reading_or_two_that_agree() {
    // In an alcove, sensors that fire at once hear each other's sound before their own, and all of it is believed.
    let alcove = Alcove::random(1);
    let believed = |consecutive: u8| {
        let robot = Robot { firing: Sketch { consecutive, ..Sketch::default() }, ..alcove.robot() };
        let world = World::new(alcove.scene().unwrap(), vec![robot], Noise::NONE).unwrap();
        simulate(&world, Method::SyncLine, &Options::periods(100)).unwrap()
    };
    let (each, two) = (believed(1), believed(2));
    assert!(each.kind.iter().all(|kind| matches!(kind, ReadingKind::Accepted | ReadingKind::Clear)));
    // Two readings that agree are believed too, since crosstalk of one trigger repeats and no explanations are checked.
    let first = two.kind.iter().filter(|kind| matches!(kind, ReadingKind::First | ReadingKind::NoEcho)).count();
    assert_eq!(first, 8);
    let wrong = [each, two].map(|readings| readings.summary().wrong_of_all);
    assert!(wrong[0] > 0.1 && wrong[1] > 0.9 * wrong[0], "{wrong:?}");
}

#[test]
fn sequential_waits_for_as_long_as_its_modules_hear() {
    let cycle = |text: &str| {
        let readings = simulate(&read(text).unwrap(), Method::Sequential, &Options::periods(30)).unwrap();
        steps(&readings, &[0])[0]
    };
    // The distance is 5.69 m, which takes 33.2 ms, less than the window of 36 ms.
    assert_eq!(cycle(ROW), 4 * 36_001);
    assert_eq!(cycle(&ROW.replace("hc-sr04", "polaroid-6500")), 4 * (73_252 + 1));
    assert_eq!(cycle(&ROW.replace("module = \"hc-sr04\"", "")), 4 * 36_001);
    assert_eq!(cycle(&format!("{ROW}audible_us = 50_000")), 4 * 50_001);
    // With two sensors a clone's rest of 210 ms takes longer than two turns.
    let two = ROW.replace(", { x_m = 0, y_m = -0.1 }, { x_m = 0, y_m = -0.3 }", "").replace("hc-sr04", "hc-sr04-clone");
    assert_eq!(cycle(&two), 210_000);
}

#[test]
fn a_scene_says_how_its_robots_fire() {
    let two = format!("firing.turn_us = 20_000\n{ROW}firing = {{ groups = [[0, 1], [2, 3]], consecutive = 3 }}");
    let world = read(&two).unwrap();
    assert_eq!(world.robots()[0].firing.consecutive, 3);
    // The robot's own settings override the common ones.
    assert_eq!(world.robots()[0].firing.turn, Micros::ZERO);
    let world = read(&format!("firing.turn_us = 20_000\n{ROW}")).unwrap();
    assert_eq!(world.robots()[0].firing, Sketch { turn: Micros::from_millis(20), ..Sketch::default() });
    let rows = "{ period_us = 50_000, t_fire_us = [[1, 2, 3, 4], [5, 6, 7, 8], [9, 9, 9, 9]] }";
    let all = "timeout_us = 9_000, pause_us = 8, turn_us = 7, rest_us = 6, arrays = [[3, 1], [0, 2]], \
               groups = [[2, 3], [0, 1]], consecutive = 4, drift_ppm = 12.5";
    let parts = |text: &str| WorldParts::from_text(Path::new("w.toml"), text).unwrap();
    let first = parts(&format!("{ROW}audible_us = 70_000\nfiring = {{ {all}, schedule = {rows} }}"));
    assert_eq!(parts(&first.to_toml()).robots, first.robots);
}

#[test]
fn settings_that_suit_no_ring_are_refused_by_name() {
    let refused = |firing: &str| read(&format!("{ROW}firing = {{ {firing} }}")).unwrap_err();
    for (firing, expected) in [
        ("timeout_us = 36_001", "timeout_us is 36001; expected 1 to window_us"),
        ("turn_us = 10_000_001", "turn_us is 10000001; expected 0 to 10000000"),
        ("arrays = [[0, 1], [2, 4]]", "arrays is 4; expected each sensor once, from 0"),
        ("groups = [[0, 1], [1, 2]]", "groups is 1; expected each sensor once, from 0"),
        ("groups = [[0, 1], [3]]", "groups is 2; expected each sensor once; this one is missing"),
        ("groups = [[0, 1], [], [2, 3]]", "groups is 0; expected one sensor or more in each list"),
        ("consecutive = 9", "firing.consecutive is 9; expected 1 to 8"),
        ("drift_ppm = -1.0", "drift_ppm is -1; expected 0 to 100000"),
        ("schedule = { period_us = 9, t_fire_us = [[1, 2, 3]] }", "firing.schedule is 3; expected in each phase"),
        ("schedule = { period_us = 9, t_fire_us = [[1, 2, 3, 9]] }", "firing.schedule is 9; expected times before"),
        (
            "schedule = { period_us = 9, step_us = 1 }",
            "schedule: step_us: a code of time hopping, which is gone; expected t_fire_us",
        ),
        ("schedule = \"nowhere.toml\"", "nowhere.toml: "),
    ] {
        let error = refused(firing);
        assert!(error.contains(expected), "{firing}: {error}");
    }
}
